/* region.c - the steps for which a method is stable on damped swings q'' = -w^2 q - g v.
 *
 * One step takes (q, v) to A (q, v), and A is found by stepping (1, 0) and (0, 1). Powers of A stay
 * bounded while both eigenvalues are in the unit circle: |trace| <= 1 + det and det <= 1 (Jury).
 * Methods that split take damping by its exact flow. Time is in units of the step. */
#include "run/region.h"

#include <math.h>

typedef struct oscillator {
  double omega2, gamma; /* h^2 w^2, h g */
} oscillator;

static msr_status accelerate(void *self, double t, const double *q, const double *v, double *a) {
  (void)t;
  const oscillator *o = self;
  a[0] = -o->omega2 * q[0];
  if (v) a[0] -= o->gamma * v[0];
  return MSR_OK;
}

static msr_status damp(void *self, double t, double h, bool backward, const double *q, double *v) {
  (void)t, (void)backward, (void)q;
  v[0] *= exp(-h * ((const oscillator *)self)->gamma);
  return MSR_OK;
}

/* Does a step make it grow? */
static msr_status try(const msr_integrator *integrator, oscillator *o, bool *grows,
                      msr_error *err) {
  const msr_system system = {
      .n = 1, .self = o, .acceleration = accelerate, .damp = integrator->splits ? damp : NULL};
  const double rounding = 1e-13;
  double q[2] = {1, 0}, v[2] = {0, 1};
  for (int i = 0; i < 2; i++) {
    const msr_status status = msr_integrate(integrator, &system, 0, 1, 1, &q[i], &v[i], err);
    if (status != MSR_OK) return status;
  }
  const double trace = q[0] + v[1], det = q[0] * v[1] - q[1] * v[0];
  *grows = !(fabs(trace) <= 1 + det + rounding && det <= 1 + rounding);
  return MSR_OK;
}

/* Frequencies up to the largest, and just above the limit without damping: what grows there may do
 * so in a narrow band only. */
static msr_status any_grows(const msr_integrator *integrator, const msri_swings *s, double h,
                            bool *grows, msr_error *err) {
  enum { MODES = 48, SHARES = 8 };
  const double beyond = integrator->stability * 1.002;
  const int shares = s->most > 0 ? SHARES : 0;
  *grows = false;
  for (int mode = MODES + 1; mode > 0 && !*grows; mode--) {
    const double hw = mode > MODES ? msri_min(beyond, h * s->omega) : h * s->omega * mode / MODES;
    for (int n = 0; n <= shares && !*grows; n++) {
      const double share = shares > 0 ? (double)n / shares : 0;
      const double known = h * s->steady + s->growing * hw * hw / h;
      oscillator o = {hw * hw, known + share * h * s->most};
      const msr_status status = try(integrator, &o, grows, err);
      if (status != MSR_OK) return status;
    }
  }
  return MSR_OK;
}

msr_status msri_region_step(const msr_integrator *integrator, const msri_swings *swings,
                            double *step, msr_error *err) {
  const double fastest = msri_max(swings->omega, swings->steady + swings->most +
                                                     swings->growing * pow(swings->omega, 2));
  const double from = 1e-5, fine = 0.1, to = 1e3;
  const bool undamped = swings->most > 0 && swings->omega > 0;
  *step = undamped && integrator->stability == 0 ? 0 : (double)INFINITY;
  if (!(fastest > 0) || *step == 0) return MSR_OK;
  double stable = 0, grown = 0;
  bool grows = false;
  double x = from;
  while (x < to && !grows) {
    const msr_status status = any_grows(integrator, swings, x / fastest, &grows, err);
    if (status != MSR_OK) return status;
    *(grows ? &grown : &stable) = x / fastest;
    x *= x < fine ? 1.5 : 1.03;
  }
  if (!grows) return MSR_OK;
  while (grown - stable > 1e-4 * grown && stable > 0) {
    const double middle = (stable + grown) / 2;
    const msr_status status = any_grows(integrator, swings, middle, &grows, err);
    if (status != MSR_OK) return status;
    *(grows ? &grown : &stable) = middle;
  }
  *step = stable;
  return MSR_OK;
}
