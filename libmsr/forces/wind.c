/* wind.c - drag of air that moves: F = c (w(t) - v), w a mean wind along x plus random gusts.
 *
 * Its flow is exact while w is held: v tends to w as exp(-c h / m). With no gusts, no random number
 * is ever drawn. */
#include "forces/air.h"
#include "forces/noise.h"

#include "base/number.h"

#include <math.h>
#include <stdlib.h>

typedef struct wind {
  double c, speed;
  bool gusts;
  msri_noise noise;
} wind;

/* In each state. */
typedef struct memory {
  msri_air_decay decay;
  msri_noise_cache noise;
} memory;

/* Gusts of shorter correlation are noise that no step could follow. */
static const double shortest = 1e-6; /* [s] */

static msr_status check(const void *params, msr_error *err) {
  const msr_wind *w = params;
  const bool finite =
      isfinite(w->c) && isfinite(w->speed) && isfinite(w->gust) && isfinite(w->gust_time);
  if (finite && w->c >= 0 && w->gust >= 0 && (w->gust_time == 0 || w->gust_time >= shortest))
    return MSR_OK;
  return msri_fail(err, MSR_EUSAGE,
                   "wind: speed must be finite, drag and gust finite and 0 or more, gust time "
                   "%g s or more",
                   shortest);
}

static double total_mass(const msr_view *s) {
  double sum = 0;
  for (size_t i = 0; i < s->n; i++) sum += msr_view_mass(s, i);
  return sum;
}

static double coefficient(const msr_wind *params, const msr_view *s) {
  return params->c > 0 ? params->c : total_mass(s) / (double)s->n;
}

static bool idle(const void *params, const msr_view *s, char *why, size_t size) {
  (void)params;
  if (s->n > 0) return false;
  msri_format(why, size, "there is no mass");
  return true;
}

static double gust_time(const msr_wind *params) {
  return params->gust_time > 0 ? params->gust_time : 1;
}

static void describe(const void *params, const msr_view *s, char *text, size_t size) {
  const msr_wind *w = params;
  msri_format(text, size,
              "asked for: mean %g px/s, gusts %g px/s over %g s, seed %llu; drag c = %g kg/s",
              w->speed, w->gust, gust_time(w), (unsigned long long)w->seed, coefficient(w, s));
}

static msr_status prepare(const void *params, const msr_view *s, void **self, msr_error *err) {
  const msr_wind *of = params;
  wind *made = msri_alloc(1, sizeof *made, "the wind", err);
  if (!made) return MSR_ENOMEM;
  made->c = coefficient(of, s);
  made->speed = of->speed;
  made->gusts = of->gust > 0;
  made->noise = msri_noise_of(of->gust, gust_time(of), of->seed);
  *self = made;
  return MSR_OK;
}

/* The air at time t. */
static msri_air air_at(const wind *w, void *scratch, double t) {
  msri_air air = {w->c, 0, 0};
  if (w->gusts) msri_noise_at(&w->noise, &((memory *)scratch)->noise, t, &air.ax, &air.ay);
  air.ax += w->speed;
  return air;
}

static msr_status add(const void *self, void *scratch, const msr_view *s, double *fx, double *fy) {
  const msri_air air = air_at(self, scratch, s->t);
  msri_air_add(&air, s, fx, fy);
  return MSR_OK;
}

static msr_status flow(const void *self, void *scratch, const msr_view *s, double h, bool backward,
                       double *vx, double *vy) {
  (void)backward;
  const msri_air air = air_at(self, scratch, s->t);
  msri_air_flow(&air, s, h, vx, vy);
  return MSR_OK;
}

static double relax(const void *self, void *scratch, const msr_view *s, double h, double *push) {
  const msri_air air = air_at(self, scratch, s->t);
  return msri_air_relax(&air, s, h, &((memory *)scratch)->decay, push);
}

static msr_status rates(const void *self, const msr_view *s, double *omega2, double *gamma) {
  (void)omega2;
  *gamma = msri_air_rate(((const wind *)self)->c, s);
  return MSR_OK;
}

/* F.v = c (w - v).v is at most c w^2 / 4, at v = w / 2. */
static double power(const void *self, void *scratch, const msr_view *s) {
  const msri_air air = air_at(self, scratch, s->t);
  return (double)s->n * air.c * (air.ax * air.ax + air.ay * air.ay) / 4;
}

const msr_force msr_force_wind = {
    .name = "wind",
    .summary = "F = c (w(t) - v), w random (Ornstein-Uhlenbeck)",
    .uses_velocity = true,
    .uses_time = true,
    .ignores_start = true,
    .params_size = sizeof(msr_wind),
    .scratch_size = sizeof(memory),
    .check = check,
    .idle = idle,
    .describe = describe,
    .prepare = prepare,
    .release = free,
    .add = add,
    .flow = flow,
    .rates = rates,
    .relax = relax,
    .power = power,
    .add_load = {.mass = 6, .mass_bytes = 48},
    .flow_load = {.mass = 4, .mass_bytes = 32},
};
