/* newton.c - Newton's method for d = known + w a(q0 + d): d -= p with A p = d - known - w a, where
 * A is what the system's linearise makes, near 1 - w da/dq and positive, or differences of a.
 *
 * Where A isn't quite the derivative (springs that push, turn within a step, or forces that A
 * doesn't know) the iteration converges linearly; then the last two corrections tell how much too
 * long or short they are (Anderson 1965, J. ACM 12, 547, depth 1). Full steps, whatever the
 * residual does: where springs are stiff it has to grow on the way.
 *
 * d is kept more exactly than q0 + d can be: the last correction, though lost in q, is in d, and so
 * in the velocity, so that the energy is kept to rounding however stiff the springs are. */
#include "integrators/newton.h"

#include "base/vector.h"
#include "integrators/krylov.h"

#include <float.h>
#include <math.h>

enum { MOST_ITERATIONS = 200, FIRST_MIXING = 4, PATIENCE = 4 };

static const double inexact = 1e-2;    /* largest error of a correction, over it */
static const double exactness = 1e-2;  /* the same, over the rate at which corrections shrink */
static const double negligible = 1e-3; /* error of d, over the rounding of q */

/* All vectors are [n]. */
typedef struct newton {
  const msri_stage *stage;
  void *object;
  double *q, *before;   /* the place, and the one before */
  double *p, *p_before; /* the corrections there */
  double *residual;
  double size, size_before; /* of the corrections */
  double rounding;          /* of q */
  double least;             /* size so far */
  int waited;               /* iterations since */
} newton;

msr_status msri_newton_open(const msr_integrator *self, const msr_system *system, void **object,
                            msr_error *err) {
  if (system->linearise && system->solve) return MSR_OK;
  *object = msri_alloc(MSRI_KRYLOV_VECTORS * system->n, sizeof(double), self->name, err);
  return *object ? MSR_OK : MSR_ENOMEM;
}

/* p of A p = residual, and its size, which is no number if that can't be solved. It is solved a
 * hundred times better than corrections shrink: an iteration of conjugate gradients costs a third
 * of a matrix. */
static msr_status solve(newton *s, int k) {
  const msri_stage *e = s->stage;
  const msr_system *system = e->system;
  const double rate = k < 2 ? 1 : s->size / s->size_before;
  const double tolerance = msri_max(1e-10, msri_min(inexact, exactness * rate));
  msr_status status;
  if (s->object) {
    status = msri_krylov_solve(e, s->q, s->residual, tolerance, s->object, s->p);
  } else {
    status =
        system->linearise(system->self, e->t, e->between ? e->q0 : NULL, k > 0 ? s->before : e->q0,
                          s->q, e->between ? e->weight / 2 : e->weight, e->held);
    if (status == MSR_OK) status = system->solve(system->self, s->residual, tolerance, s->p);
  }
  s->size_before = s->size;
  s->size = status == MSR_EUNSTABLE ? (double)NAN : msri_largest(system->n, s->p);
  return status;
}

/* Takes what is held out of the equations. */
static void hold(const msri_stage *e, double *r) {
  for (size_t i = 0; e->held && i < e->system->n; i++) {
    e->push[i] = e->held[i] ? r[i] : 0;
    if (e->held[i]) r[i] = 0;
  }
}

/* The residual at q = q0 + d, and the correction. */
static msr_status correct(newton *s, int k) {
  const msri_stage *e = s->stage;
  const double *q0 = e->q0, *known = e->known;
  double *r = s->residual;
  const msr_status status = msri_stage_acceleration(e, s->q, r);
  if (status != MSR_OK) return status;
  for (size_t i = 0; i < e->system->n; i++) r[i] = s->q[i] - q0[i] - known[i] - e->weight * r[i];
  hold(e, r);
  if (isfinite(msri_largest(e->system->n, r))) return solve(s, k);
  s->size = (double)NAN;
  return MSR_OK;
}

/* Would the next correction be below the rounding of d, as the last two go on, or below what the
 * rounding of q leaves of a, a thousandth of it? If that can't be reached, they shrink no more, or
 * haven't for a while. */
static bool converged(newton *s, int k, double length) {
  const double least = msri_max(DBL_EPSILON * length, negligible * s->rounding);
  if (s->size <= DBL_EPSILON * length) return true;
  if (k > 0 && s->size * s->size <= least * s->size_before) return true;
  if (k > 0 && s->size <= s->rounding && s->size > 0.5 * s->size_before) return true;
  if (s->size < s->least) s->least = s->size, s->waited = 0;
  return ++s->waited > PATIENCE && s->least < 1e3 * s->rounding;
}

/* How much of the change from the correction before to this one goes into the step: none while
 * convergence is better than linear, or there is none. */
static double mixing(const newton *s, int k) {
  const size_t n = s->stage->system->n;
  if (k < FIRST_MIXING || !(s->size < s->size_before && s->size > 0.05 * s->size_before)) return 0;
  double along = 0, change = 0;
  for (size_t i = 0; i < n; i++) {
    const double d = s->p[i] - s->p_before[i];
    along += d * s->p[i];
    change += d * d;
  }
  return change > 0 ? along / change : 0;
}

static void swap(double **a, double **b) {
  double *c = *a;
  *a = *b;
  *b = c;
}

/* From q to q0 + d, d being the displacement of q less its correction, which is mixed with the one
 * before, or halved to get out of a cycle. */
static void move(newton *s, int k, double *d) {
  const size_t n = s->stage->system->n;
  const bool cycling = s->waited > 2 * PATIENCE;
  const double *q0 = s->stage->q0, g = cycling ? 0 : mixing(s, k);
  for (size_t i = 0; cycling && i < n; i++) d[i] += s->p[i] / 2;
  for (size_t i = 0; g != 0 && i < n; i++)
    d[i] -= g * (s->q[i] - s->before[i] - (s->p[i] - s->p_before[i]));
  swap(&s->q, &s->before);
  swap(&s->p, &s->p_before);
  for (size_t i = 0; i < n; i++) s->q[i] = q0[i] + d[i];
}

static msr_status give_up(const newton *s, msr_error *err) {
  if (isfinite(s->size))
    return msri_fail(err, MSR_EUNSTABLE,
                     "the equations of a step weren't solved in %d iterations (the last one moved "
                     "something by %.3g): take smaller steps (more substeps)",
                     MOST_ITERATIONS, s->size);
  return msri_fail(err, MSR_EUNSTABLE,
                   "the equations of a step are beyond what numbers can hold: take smaller steps "
                   "(more substeps), or look for a force or a value that is too large");
}

msr_status msri_newton(const msri_stage *stage, double *memory, void *object, double *d,
                       msr_error *err) {
  const size_t n = stage->system->n;
  newton s = {.stage = stage,
              .object = object,
              .q = memory,
              .before = memory + n,
              .p = memory + 2 * n,
              .p_before = memory + 3 * n,
              .residual = memory + 4 * n,
              .least = (double)INFINITY};
  for (size_t i = 0; i < n; i++) s.q[i] = stage->q0[i] + d[i];
  s.rounding = 2 * DBL_EPSILON * msri_largest(n, s.q);
  for (int k = 0; k < MOST_ITERATIONS; k++) {
    const msr_status status = correct(&s, k);
    if (!isfinite(s.size)) break;
    if (status != MSR_OK) return status;
    for (size_t i = 0; i < n; i++) d[i] = s.q[i] - stage->q0[i] - s.p[i];
    if (converged(&s, k, msri_largest(n, d))) return MSR_OK;
    move(&s, k, d);
  }
  return give_up(&s, err);
}
