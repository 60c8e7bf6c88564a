/* masses.c - mass ratios, heavy and light masses, gravity weak, strong and upwards. */
#include "suite.h"

#include <stdio.h>

/* A falling 8 x 8 lattice above no floor, tied at two corners, of masses 0.1 and 0.1 * parameter
 * in turn. */
static msr_scene *mixed_lattice(const hard_case *row, bool brief) {
  (void)brief;
  enum { SIDE = 8 };
  msr_scene *scene = empty_scene(row->conf.dt);
  add_force(scene, &msr_force_gravity, &(msr_gravity){row->conf.gravity});
  for (size_t i = 0; i < SIDE * SIDE; i++)
    add_mass(scene, (double)(i % SIDE), (double)(i / SIDE), 0, 0,
             (i + i / SIDE) % 2 ? 0.1 : 0.1 * row->parameter);
  for (size_t i = 0; i < SIDE * SIDE; i++) {
    if (i % SIDE > 0) must(msr_scene_add_spring(scene, i - 1, i, row->conf.stiffness, 1, &why));
    if (i >= SIDE) must(msr_scene_add_spring(scene, i - SIDE, i, row->conf.stiffness, 1, &why));
  }
  const double top = SIDE;
  must(msr_scene_add_anchor(scene, &(msr_anchor){SIDE * (SIDE - 1), 0, top, 1500, 1}, &why));
  must(msr_scene_add_anchor(scene, &(msr_anchor){SIDE * SIDE - 1, SIDE - 1, top, 1500, 1}, &why));
  return scene;
}

static void add_ratios(suite *s) {
  for (double ratio = 1e2; ratio < 2e6; ratio *= 1e2) {
    hard_case row = {.make = mixed_lattice,
                     .conf = conf_of_assignment,
                     .parameter = ratio,
                     .brief = 200,
                     .full = 10000,
                     .growth = 0.05,
                     .loss = 0.05,
                     .why = "beyond 5 % of what there was to give, msr warns"};
    snprintf(row.name, sizeof row.name, "mass ratio %g", ratio);
    add_case(s, &row);
  }
}

/* Iterations cost sqrt(k/m): fewer where masses are light. */
static void add_weights(suite *s) {
  static const struct {
    double m;
    uint64_t brief, full;
  } rows[] = {{1e-9, 1, 1},     {1e-6, 1, 20},    {1e-3, 100, 2000}, {1, 200, 2000},
              {1e3, 200, 2000}, {1e6, 200, 2000}, {1e9, 200, 2000}};
  for (size_t i = 0; i < LENGTH(rows); i++) {
    hard_case row = {.conf = conf_of_assignment,
                     .brief = rows[i].brief,
                     .full = rows[i].full,
                     .growth = 0.05,
                     .loss = 0.05,
                     .why = "beyond 5 % of what there was to give, msr warns"};
    row.conf.mass = rows[i].m;
    snprintf(row.name, sizeof row.name, "MASSE %g", rows[i].m);
    add_case(s, &row);
  }
}

static void add_gravities(suite *s) {
  static const double g[] = {0, 1e-9, 1, 1e2, 1e3, 1e4, 1e5, 1e6, -1, -9.8, -1e3, -1e6};
  for (size_t i = 0; i < LENGTH(g); i++) {
    hard_case row = {.conf = conf_of_assignment,
                     .scene = {.closed_border = true},
                     .brief = 100,
                     .full = 1000,
                     .growth = 0.05,
                     .loss = 0.05,
                     .why = "beyond 5 % of what there was to give, msr warns"};
    row.conf.gravity = g[i];
    snprintf(row.name, sizeof row.name, "GRAVITE %g", g[i]);
    add_case(s, &row);
    row.plan.impacts = MSR_IMPACTS_LOCATED;
    snprintf(row.name, sizeof row.name, "GRAVITE %g, located", g[i]);
    if (fabs(g[i]) > 5) add_case(s, &row);
  }
}

void add_masses(suite *s) {
  add_ratios(s);
  add_weights(s);
  add_gravities(s);
}
