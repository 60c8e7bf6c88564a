/* gravity.c - weight: F = -m g along y, U = m g y. */
#include "base/base.h"
#include "base/number.h"

#include <math.h>

static msr_status check(const void *params, msr_error *err) {
  const msr_gravity *gravity = params;
  if (isfinite(gravity->g)) return MSR_OK;
  return msri_fail(err, MSR_EUSAGE, "gravity must be a finite number of px/s^2");
}

static bool idle(const void *params, const msr_view *s, char *why, size_t size) {
  const msr_gravity *gravity = params;
  if (gravity->g != 0 && s->n > 0) return false;
  msri_format(why, size, gravity->g == 0 ? "GRAVITE is 0" : "there is no mass");
  return true;
}

static void describe(const void *params, const msr_view *s, char *text, size_t size) {
  (void)s;
  msri_format(text, size, "GRAVITE = %g px/s^2", ((const msr_gravity *)params)->g);
}

static msr_status add(const void *self, void *scratch, const msr_view *s, double *fx, double *fy) {
  (void)scratch, (void)fx;
  const double g = ((const msr_gravity *)self)->g;
  if (s->m_stride == 0) {
    const double weight = s->m[0] * g;
    for (size_t i = 0; i < s->n; i++) fy[i] -= weight;
    return MSR_OK;
  }
  for (size_t i = 0; i < s->n; i++) fy[i] -= s->m[i] * g;
  return MSR_OK;
}

static void uniform(const void *self, const msr_view *s, double *f) {
  f[1] -= s->m[0] * ((const msr_gravity *)self)->g;
}

static msr_status between(const void *self, void *scratch, const msr_view *s, const msr_view *to,
                          double *fx, double *fy) {
  (void)to;
  return add(self, scratch, s, fx, fy);
}

static double energy(const void *self, const msr_view *s) {
  double sum = 0;
  for (size_t i = 0; i < s->n; i++) sum += msr_view_mass(s, i) * s->y[i];
  return ((const msr_gravity *)self)->g * sum;
}

const msr_force msr_force_gravity = {
    .name = "gravity",
    .summary = "F = -m g along y",
    .absent = "GRAVITE is 0",
    .conservative = true,
    .ignores_start = true,
    .params_size = sizeof(msr_gravity),
    .check = check,
    .idle = idle,
    .describe = describe,
    .add = add,
    .energy = energy,
    .between = between,
    .uniform = uniform,
    .add_load = {.mass = 1, .mass_bytes = 16},
};
