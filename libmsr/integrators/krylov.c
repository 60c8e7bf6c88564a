/* krylov.c - A x = r by BiCGSTAB (van der Vorst 1992, SIAM J. Sci. Stat. Comput. 13, 631) for the A
 * = 1 - w da/dq of a stage, whose products are differences of a: A x = x - w (a(q + e x) - a(q)) /
 * e. For systems that don't bring a solver of their own: any n, no matrix. */
#include "integrators/krylov.h"

#include "base/vector.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* All vectors are [n]. */
typedef struct krylov {
  const msri_stage *stage;
  size_t n;
  const double *q;
  double size;    /* of q */
  double *middle; /* a(q) */
  double *place;  /* q + e x */
  double *shadow, *residual, *direction, *image, *second;
} krylov;

msr_status msri_stage_acceleration(const msri_stage *stage, const double *q, double *a) {
  const msr_system *s = stage->system;
  if (stage->between) return s->between(s->self, stage->t, stage->q0, q, a);
  return s->acceleration(s->self, stage->t, q, s->damp ? NULL : stage->v0, a);
}

/* y = A x. The displacement e x is the square root of rounding, where the errors of the difference,
 * of order e and eps / e, are alike. */
static msr_status multiply(const krylov *k, const double *x, double *y) {
  const double length = sqrt(msri_dot(k->n, x, x));
  const double e = length > 0 ? sqrt(DBL_EPSILON) * (1 + k->size) / length : 1;
  memcpy(k->place, k->q, k->n * sizeof *x);
  msri_add_scaled(k->n, e, x, k->place);
  const msr_status status = msri_stage_acceleration(k->stage, k->place, y);
  const double w = k->stage->weight / e;
  for (size_t i = 0; i < k->n; i++) y[i] = x[i] - w * (y[i] - k->middle[i]);
  for (size_t i = 0; k->stage->held && i < k->n; i++)
    if (k->stage->held[i]) y[i] = x[i];
  return status;
}

static bool small(const krylov *k, double tolerance, const double *x) {
  return msri_dot(k->n, k->residual, k->residual) <= tolerance * tolerance * msri_dot(k->n, x, x);
}

/* One step; `done` if it's the last. rho is shadow . residual. */
static msr_status iterate(const krylov *k, double tolerance, double *x, double *rho, bool *done) {
  const size_t n = k->n;
  msr_status status = multiply(k, k->direction, k->image);
  if (status != MSR_OK) return status;
  const double alpha = *rho / msri_dot(n, k->shadow, k->image);
  *done = !isfinite(alpha);
  if (*done) return msri_dot(n, x, x) > 0 ? MSR_OK : MSR_EUNSTABLE;
  msri_add_scaled(n, alpha, k->direction, x);
  msri_add_scaled(n, -alpha, k->image, k->residual);
  *done = small(k, tolerance, x);
  if (*done) return MSR_OK;
  status = multiply(k, k->residual, k->second);
  if (status != MSR_OK) return status;
  const double omega = msri_dot(n, k->second, k->residual) / msri_dot(n, k->second, k->second);
  *done = !(fabs(omega) > 0);
  if (*done) return MSR_OK;
  msri_add_scaled(n, omega, k->residual, x);
  msri_add_scaled(n, -omega, k->second, k->residual);
  const double next = msri_dot(n, k->shadow, k->residual), beta = next / *rho * alpha / omega;
  for (size_t i = 0; i < n; i++)
    k->direction[i] = k->residual[i] + beta * (k->direction[i] - omega * k->image[i]);
  *rho = next;
  *done = small(k, tolerance, x) || !(fabs(next) > 0);
  return MSR_OK;
}

msr_status msri_krylov_solve(const msri_stage *stage, const double *q, const double *r,
                             double tolerance, double *memory, double *x) {
  const size_t n = stage->system->n, bytes = n * sizeof *x;
  const krylov k = {stage,
                    n,
                    q,
                    sqrt(msri_dot(n, q, q)),
                    memory,
                    memory + n,
                    memory + 2 * n,
                    memory + 3 * n,
                    memory + 4 * n,
                    memory + 5 * n,
                    memory + 6 * n};
  const int most = n < 100 ? 2 * (int)n + 10 : 200;
  msr_status status = msri_stage_acceleration(stage, q, k.middle);
  memset(x, 0, bytes);
  memcpy(k.shadow, r, bytes);
  memcpy(k.residual, r, bytes);
  memcpy(k.direction, r, bytes);
  double rho = msri_dot(n, r, r);
  bool done = rho == 0;
  for (int i = 0; i < most && !done && status == MSR_OK; i++)
    status = iterate(&k, tolerance, x, &rho, &done);
  return status;
}
