/* adaptive.c - methods that choose their own steps: GSL's explicit steppers (odeiv2) on y = q, v,
 * in a loop that sees to supports after each step, and to which an error that is no number isn't
 * small.
 *
 * The next step is 0.8 h error^(-1/p), the error being over the tolerance and of order h^p (Hairer,
 * Norsett & Wanner, Solving Ordinary Differential Equations I, 1993, II.4). GSL's Runge-Kutta pairs
 * go on with the better of their two solutions, so that errors are proportional to the tolerance.
 */
#include "integrators/tolerance.h"

#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct stepper {
  const gsl_odeiv2_step_type **type;
  size_t memory;    /* vectors of y that GSL allocates */
  unsigned surplus; /* p over the order that GSL tells */
  bool needs_slope; /* each step begins with y' */
  double share;     /* of the tolerance, so that errors of all methods are about as large */
} stepper;

/* What open makes. */
typedef struct adaptive {
  gsl_odeiv2_step *step;
  gsl_odeiv2_control control; /* by which msadams learns the tolerance */
  gsl_odeiv2_driver driver;   /* by which it finds the control */
  size_t n;
  msri_tolerance tolerance;
  double h;    /* of the next step, > 0; 0: to be chosen */
  bool begun;  /* the stepper's memory fits y */
  bool sloped; /* slope is y' at the start of the next step */
} adaptive;

/* An interval under way. */
typedef struct course {
  adaptive *own;
  const stepper *row;
  const msr_system *system;
  double *y, *y0, *slope, *error; /* [2n]; y0: before the step */
  double t, end;
  double smallest;   /* a step below it would be lost in the digits of t */
  double share;      /* error over tolerance of the last step tried */
  msr_status status; /* of the acceleration */
} course;

static const uint64_t most_tries = 10000000; /* of steps, in an interval */

/* ---- What GSL calls */

static int evaluate(double t, const double *y, double *slope, void *params) {
  course *c = params;
  const size_t n = c->own->n;
  memcpy(slope, y + n, n * sizeof *slope);
  c->status = c->system->acceleration(c->system->self, t, y, y + n, slope + n);
  return c->status == MSR_OK ? GSL_SUCCESS : GSL_EBADFUNC;
}

static int tell_tolerance(void *state, const double y, const double slope, const double h,
                          const size_t i, double *tolerance) {
  const adaptive *own = state;
  (void)y, (void)slope, (void)h;
  *tolerance = i < own->n ? own->tolerance.q : own->tolerance.v;
  return GSL_SUCCESS;
}

static const gsl_odeiv2_control_type control_type = {.name = "msr", .errlevel = tell_tolerance};

/* ---- Steps */

static msr_status find_slope(course *c) {
  if (c->own->sloped) return MSR_OK;
  (void)evaluate(c->t, c->y, c->slope, c);
  c->own->sloped = c->status == MSR_OK;
  return c->status;
}

/* Begins anew, with a step that is no longer than before and than y' lets y grow in the p-th root
 * of the tolerance: soon right, however wrong. */
static msr_status restart(course *c) {
  adaptive *own = c->own;
  gsl_odeiv2_step_reset(own->step);
  own->sloped = false;
  const msr_status status = find_slope(c);
  if (status != MSR_OK) return status;
  const double p = gsl_odeiv2_step_order(own->step) + c->row->surplus;
  const double longest = own->h > 0 ? own->h : fabs(c->end - c->t);
  msri_tolerance_fit(&own->tolerance, own->n, c->y, longest, c->slope);
  const double rate = msri_tolerance_share(&own->tolerance, own->n, c->slope);
  const double h = rate > 0 && isfinite(rate) ? pow(rate, -1 / p) : longest;
  own->h = msri_max(c->smallest, msri_min(longest, h));
  own->begun = true;
  return MSR_OK;
}

/* y over h; its error goes to c->share. */
static msr_status attempt(course *c, double h) {
  adaptive *own = c->own;
  const gsl_odeiv2_system system = {evaluate, NULL, 2 * own->n, c};
  const msr_status status = c->row->needs_slope ? find_slope(c) : MSR_OK;
  if (status != MSR_OK) return status;
  const double *slope = own->sloped ? c->slope : NULL;
  msri_tolerance_fit(&own->tolerance, own->n, c->y, h, slope);
  memcpy(c->y0, c->y, 2 * own->n * sizeof *c->y);
  const int gsl = gsl_odeiv2_step_apply(own->step, c->t, h, c->y, c->error, slope, NULL, &system);
  c->share = gsl == GSL_SUCCESS ? msri_tolerance_share(&own->tolerance, own->n, c->error)
                                : (double)INFINITY;
  return c->status;
}

/* What is in the way of the step just taken; whatever it reflects ends the method's memory. */
static msr_status bounce(course *c, double h) {
  const size_t n = c->own->n;
  bool met = false;
  if (!c->system->bounce) return MSR_OK;
  const msr_status status =
      c->system->bounce(c->system->self, h, c->y0, c->y0 + n, c->y, c->y + n, &met);
  if (met) c->own->begun = false;
  return status;
}

/* One try: y and t move on if the error allows, and in any case the next step is chosen. */
static msr_status advance(course *c, double h, msr_workspace *work) {
  adaptive *own = c->own;
  const double p = gsl_odeiv2_step_order(own->step) + c->row->surplus;
  const msr_status status = attempt(c, h);
  if (status != MSR_OK) return status;
  own->h = fabs(h) * msri_step_growth(c->share, p);
  if (!(c->share <= 1)) {
    memcpy(c->y, c->y0, 2 * own->n * sizeof *c->y);
    return MSR_OK;
  }
  c->t = h == c->end - c->t ? c->end : c->t + h;
  own->sloped = false;
  work->steps++;
  return bounce(c, h);
}

/* Why no smaller step than h is tried. What isn't finite makes the error of a pair no number; where
 * msadams fails, it's looked for. */
static msr_status give_up(course *c, double h, msr_error *err) {
  (void)evaluate(c->t + h, c->y, c->slope, c);
  if (c->status != MSR_OK) return c->status;
  const double rate = msri_tolerance_share(&c->own->tolerance, c->own->n, c->slope);
  if (isnan(c->share) || !isfinite(rate))
    return msri_fail(err, MSR_EUNSTABLE,
                     "at t = %.10g s the acceleration isn't finite, however small the step: look "
                     "for a force or a value that is too large",
                     c->t);
  return msri_fail(err, MSR_EUNSTABLE,
                   "at t = %.10g s no step is so small that its error is within atol and rtol: "
                   "raise them, or look for a force that grows without bound",
                   c->t);
}

static msr_status cover(course *c, msr_workspace *work, msr_error *err) {
  adaptive *own = c->own;
  for (uint64_t tries = 0; tries < most_tries; tries++) {
    if (c->t == c->end) return MSR_OK;
    msr_status status = own->begun ? MSR_OK : restart(c);
    if (status != MSR_OK) return status;
    const double rest = c->end - c->t, h = msri_step_portion(own->h, rest);
    if (fabs(h) < c->smallest && h != rest) return give_up(c, h, err);
    status = advance(c, h, work);
    if (status != MSR_OK) return status;
  }
  return msri_fail(err, MSR_EUNSTABLE,
                   "%llu steps of its own, within one of the run, lead no further than t = %.10g "
                   "s: raise atol or rtol, lower DT, or use an implicit method",
                   (unsigned long long)most_tries, c->t);
}

static msr_status step(const msr_integrator *self, const msr_system *system,
                       const msr_interval *interval, double *q, double *v, msr_workspace *work,
                       msr_error *err) {
  adaptive *own = work->object;
  if (!own) return MSR_OK;
  const size_t n = own->n, bytes = n * sizeof *q;
  double *y = work->vector;
  course c = {.own = own,
              .row = self->coefficients,
              .system = system,
              .y = y,
              .y0 = y + 2 * n,
              .slope = y + 4 * n,
              .error = y + 6 * n,
              .t = interval->t,
              .end = interval->end,
              .smallest = 16 * DBL_EPSILON * msri_max(fabs(interval->t), fabs(interval->end))};
  memcpy(y, q, bytes);
  memcpy(y + n, v, bytes);
  const msr_status status = cover(&c, work, err);
  if (status != MSR_OK) {
    own->begun = false;
    return status;
  }
  memcpy(q, y, bytes);
  memcpy(v, y + n, bytes);
  return MSR_OK;
}

static msr_status begin(const msr_integrator *self, const msr_system *system, double t,
                        const double *q, const double *v, msr_workspace *work) {
  (void)self, (void)system, (void)t, (void)q, (void)v;
  adaptive *own = work->object;
  if (!own) return MSR_OK;
  own->begun = false;
  own->h = 0;
  return MSR_OK;
}

/* ---- Memory */

/* Where memory runs out, GSL calls the program's handler of errors, which may end it: so what GSL
 * is about to take is asked for, and given back, first. */
static msr_status rehearse(const stepper *row, size_t n, msr_error *err) {
  const size_t spare = 1 << 16;
  if (n > (SIZE_MAX / sizeof(double) - spare) / 2 / row->memory)
    return msri_fail(err, MSR_ENOMEM, "out of memory for an integrator");
  void *block = msri_alloc(row->memory * 2 * n + spare, sizeof(double), "an integrator", err);
  free(block);
  return block ? MSR_OK : MSR_ENOMEM;
}

static void close(void *object) {
  adaptive *own = object;
  if (!own) return;
  gsl_odeiv2_step_free(own->step);
  free(own);
}

/* Nothing is made for a system without coordinates. */
static msr_status open(const msr_integrator *self, const msr_system *system, void **object,
                       msr_error *err) {
  const stepper *row = self->coefficients;
  const size_t n = system->n;
  msri_tolerance tolerance = {.atol = system->atol, .rtol = system->rtol};
  msr_status status = msri_tolerance_check(&tolerance, err);
  *object = NULL;
  if (status != MSR_OK || n == 0) return status;
  tolerance.atol *= row->share;
  tolerance.rtol *= row->share;
  status = rehearse(row, n, err);
  if (status != MSR_OK) return status;
  adaptive *own = msri_alloc(1, sizeof *own, "an integrator", err);
  if (!own) return MSR_ENOMEM;
  *own = (adaptive){.n = n,
                    .tolerance = tolerance,
                    .control = {&control_type, own},
                    .driver = {.c = &own->control}};
  own->step = gsl_odeiv2_step_alloc(*row->type, 2 * n);
  if (!own->step) {
    free(own);
    return msri_fail(err, MSR_ENOMEM, "out of memory for an integrator");
  }
  gsl_odeiv2_step_set_driver(own->step, &own->driver);
  *object = own;
  return MSR_OK;
}

/* ---- The methods */

static const stepper rkf45 = {&gsl_odeiv2_step_rkf45, 8, 0, true, 1};
static const stepper rkck = {&gsl_odeiv2_step_rkck, 8, 0, true, 1};
static const stepper rk8pd = {&gsl_odeiv2_step_rk8pd, 15, 0, true, 1};
static const stepper msadams = {&gsl_odeiv2_step_msadams, 33, 1, false, 0.1};

/* Of them all. A step that is too long for stability has a large error, and isn't taken. */
#define SHARED                                                                                     \
  .bounces = true, .adaptive = true, .remembers = true, .stability = (double)INFINITY,             \
  .damping_stability = (double)INFINITY, .vectors = 8, .open = open, .close = close,               \
  .begin = begin, .step = step

const msr_integrator msr_integrator_rkf45 = {
    .name = "rkf45",
    .summary = "Runge-Kutta pair of orders 4 and 5, chooses its steps",
    .reference = "Fehlberg 1969, NASA TR R-315; by GSL",
    .order = 5,
    SHARED,
    .coefficients = &rkf45,
};

const msr_integrator msr_integrator_rkck = {
    .name = "rkck",
    .summary = "Runge-Kutta pair of orders 4 and 5, chooses its steps",
    .reference = "Cash & Karp 1990, ACM Trans. Math. Softw. 16, 201; by GSL",
    .order = 5,
    SHARED,
    .coefficients = &rkck,
};

const msr_integrator msr_integrator_rk8pd = {
    .name = "rk8pd",
    .summary = "Runge-Kutta pair of orders 7 and 8, chooses its steps",
    .reference = "Prince & Dormand 1981, J. Comput. Appl. Math. 7, 67; by GSL",
    .order = 8,
    SHARED,
    .coefficients = &rk8pd,
};

const msr_integrator msr_integrator_msadams = {
    .name = "msadams",
    .summary = "Adams's multistep methods of orders 1 to 12, chooses its steps and orders",
    .reference = "Byrne & Hindmarsh 1975, ACM Trans. Math. Softw. 1, 71; by GSL",
    .order = 12,
    SHARED,
    .coefficients = &msadams,
};
