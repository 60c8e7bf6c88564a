/* stiff.c - stiffness from 1e-3 to 1e12 with the rest of the assignment's example, and stiffness
 * ratios within one system. */
#include "suite.h"

#include <stdio.h>

/* What a step costs grows with sqrt(k): fewer iterations, so that a case takes seconds. */
static const struct {
  double k;
  uint64_t brief, full;
} decades[] = {{1e-3, 100, 2000}, {1e-2, 100, 2000}, {1e-1, 100, 2000}, {1, 100, 2000},
               {1e1, 100, 2000},  {1e2, 100, 2000},  {1e3, 200, 2000},  {1e4, 200, 2000},
               {1e5, 100, 1000},  {1e6, 40, 300},    {1e7, 10, 100},    {1e8, 4, 30},
               {1e9, 1, 10},      {1e10, 1, 3},      {1e11, 1, 1},      {1e12, 1, 1}};

/* A chain hung from a fixed point, with springs of k and k * parameter in turn. */
static msr_scene *mixed_chain(const hard_case *row, bool brief) {
  (void)brief;
  enum { MASSES = 8 };
  msr_scene *scene = empty_scene(row->conf.dt);
  add_force(scene, &msr_force_gravity, &(msr_gravity){row->conf.gravity});
  for (size_t i = 0; i < MASSES; i++) add_mass(scene, (double)i + 1, 0, 0, 0, 0.1);
  must(msr_scene_add_anchor(scene, &(msr_anchor){0, 0, 0, 1, 1}, &why));
  for (size_t i = 1; i < MASSES; i++)
    must(msr_scene_add_spring(scene, i - 1, i, i % 2 ? row->parameter : 1, 1, &why));
  return scene;
}

void add_stiff(suite *s) {
  for (size_t i = 0; i < LENGTH(decades); i++) {
    hard_case row = {.conf = conf_of_assignment,
                     .brief = decades[i].brief,
                     .full = decades[i].full,
                     .growth = 0.05,
                     .loss = 0.05,
                     .why = "beyond 5 % of what there was to give, msr warns"};
    row.conf.stiffness = decades[i].k;
    snprintf(row.name, sizeof row.name, "stiff, k = %g", decades[i].k);
    add_case(s, &row);
  }
  for (double ratio = 1e2; ratio < 2e8; ratio *= 1e2) {
    hard_case row = {.make = mixed_chain,
                     .conf = conf_of_assignment,
                     .parameter = ratio,
                     .brief = 100,
                     .full = 4000,
                     .growth = 0.02,
                     .loss = 0.02,
                     .why =
                         "nothing is hit: the energy of Verlet swings, by (h omega)^2 / 4 of the "
                         "part that is in the fastest modes"};
    snprintf(row.name, sizeof row.name, "stiff, ratio %g in one chain", ratio);
    add_case(s, &row);
  }
}
