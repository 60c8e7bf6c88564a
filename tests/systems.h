/* systems.h - what the tests of integrators share: an oscillator, a planet, and lattices in motion
 * with every kind of force. */
#ifndef TESTS_SYSTEMS_H
#define TESTS_SYSTEMS_H

#include "scenes.h"

/* Calls check for every integrator of the library. */
static inline void on_all(void (*check)(const msr_integrator *integrator)) {
  for (const msr_integrator *const *i = msr_integrators; *i; i++) check(*i);
}

/* ---- An oscillator */

/* What the callbacks of a system share: how often a was asked for. */
typedef struct counted {
  double omega, gamma;
  uint64_t calls;
} counted;

static inline msr_status oscillate(void *self, double t, const double *q, const double *v,
                                   double *a) {
  (void)t, (void)v;
  counted *c = self;
  c->calls++;
  a[0] = -c->omega * c->omega * q[0];
  return MSR_OK;
}

/* ---- A planet */

static inline msr_status fall_to_sun(void *self, double t, const double *q, const double *v,
                                     double *a) {
  (void)self, (void)t, (void)v;
  const double r = hypot(q[0], q[1]);
  a[0] = -q[0] / (r * r * r);
  a[1] = -q[1] / (r * r * r);
  return MSR_OK;
}

/* ---- Lattices */

/* Forces of a user: one that depends on t, one on v, without a flow. */

static inline msr_status add_tide(const void *self, void *scratch, const msr_view *s, double *fx,
                                  double *fy) {
  (void)self, (void)scratch;
  for (size_t i = 0; i < s->n; i++) {
    fx[i] += 3 * cos(9 * s->t) * msr_view_mass(s, i);
    fy[i] -= sin(7 * s->t + s->x[i]);
  }
  return MSR_OK;
}
static const msr_force tide = {.name = "tide", .summary = "t", .uses_time = true, .add = add_tide};

static inline msr_status add_swirl(const void *self, void *scratch, const msr_view *s, double *fx,
                                   double *fy) {
  (void)self, (void)scratch;
  for (size_t i = 0; i < s->n; i++) {
    fx[i] += 0.4 * s->vy[i] - 0.1 * s->vx[i] * s->vx[i] * s->vx[i];
    fy[i] -= 0.4 * s->vx[i] - 0.1 * s->vy[i] * s->x[i];
  }
  return MSR_OK;
}
static const msr_force swirl = {
    .name = "swirl", .summary = "v", .uses_velocity = true, .add = add_swirl};

/* A smoothly deformed lattice in motion, with up to five forces. */
enum { WIDTH = 5, HEIGHT = 4, MASSES = WIDTH * HEIGHT, MOST_FORCES = 5 };
static const struct medium {
  const char *name;
  const msr_force *force[MOST_FORCES];
} media[] = {
    {"nothing", {NULL}},
    {"gravity", {&msr_force_gravity}},
    {"drag", {&msr_force_drag}},
    {"damping", {&msr_force_damping}},
    {"wind", {&msr_force_wind}},
    {"tide", {&tide}},
    {"swirl", {&swirl}},
    {"all", {&msr_force_drag, &tide, &msr_force_damping, &swirl, &msr_force_wind}},
};

static inline void deform(world *w) {
  const msr_arrays s = msr_state_edit(w->state);
  for (size_t i = 0; i < MASSES; i++) {
    const double x = s.x[i], y = s.y[i];
    s.x[i] += 0.15 * sin(0.9 * x + 0.3 * y);
    s.y[i] += 0.15 * cos(0.5 * x - 0.8 * y);
    s.vx[i] = 1.5 * cos(0.7 * x) - 0.2 * y;
    s.vy[i] = sin(0.6 * y) + 0.2 * x;
  }
}

static inline world deformed_with(const struct medium *m, double dt,
                                  const msr_plan_options *options) {
  msr_scene *scene = lattice(WIDTH, HEIGHT, 8, &(msr_conf){dt, 0, 0.5, 30, 1, 1});
  for (size_t f = 0; f < MOST_FORCES && m->force[f]; f++)
    add_force(scene, m->force[f], trial_params(m->force[f]));
  world w = open_world_with(scene, options);
  deform(&w);
  return w;
}

static inline world deformed(const struct medium *m, const msr_integrator *integrator, double dt,
                             uint64_t substeps) {
  return deformed_with(m, dt, &(msr_plan_options){.integrator = integrator, .substeps = substeps});
}

#endif
