/* drag.c - drag of air at rest: F = -c v. Its flow is exact: v exp(-c h / m). */
#include "forces/air.h"

#include "base/number.h"

#include <math.h>

static msr_status check(const void *params, msr_error *err) {
  const double c = ((const msr_drag *)params)->c;
  if (isfinite(c) && c >= 0) return MSR_OK;
  return msri_fail(err, MSR_EUSAGE, "drag must be a finite number of kg/s, 0 or more");
}

static bool idle(const void *params, const msr_view *s, char *why, size_t size) {
  const double c = ((const msr_drag *)params)->c;
  if (c > 0 && s->n > 0) return false;
  msri_format(why, size, c > 0 ? "there is no mass" : "its coefficient is 0");
  return true;
}

static void describe(const void *params, const msr_view *s, char *text, size_t size) {
  (void)s;
  msri_format(text, size, "asked for: c = %g kg/s", ((const msr_drag *)params)->c);
}

static msri_air still(const void *self) { return (msri_air){((const msr_drag *)self)->c, 0, 0}; }

static msr_status add(const void *self, void *scratch, const msr_view *s, double *fx, double *fy) {
  (void)scratch;
  const msri_air air = still(self);
  msri_air_add(&air, s, fx, fy);
  return MSR_OK;
}

static msr_status flow(const void *self, void *scratch, const msr_view *s, double h, bool backward,
                       double *vx, double *vy) {
  (void)scratch, (void)backward;
  const msri_air air = still(self);
  msri_air_flow(&air, s, h, vx, vy);
  return MSR_OK;
}

static double relax(const void *self, void *scratch, const msr_view *s, double h, double *push) {
  const msri_air air = still(self);
  return msri_air_relax(&air, s, h, scratch, push);
}

static msr_status rates(const void *self, const msr_view *s, double *omega2, double *gamma) {
  (void)omega2;
  *gamma = msri_air_rate(((const msr_drag *)self)->c, s);
  return MSR_OK;
}

const msr_force msr_force_drag = {
    .name = "drag",
    .summary = "F = -c v",
    .dissipative = true,
    .uses_velocity = true,
    .ignores_start = true,
    .params_size = sizeof(msr_drag),
    .scratch_size = sizeof(msri_air_decay),
    .check = check,
    .idle = idle,
    .describe = describe,
    .add = add,
    .flow = flow,
    .rates = rates,
    .relax = relax,
    .add_load = {.mass = 6, .mass_bytes = 48},
    .flow_load = {.mass = 2, .mass_bytes = 32},
};
