/* steps.c - the assignment's example with DT times 1, 2, 10, 100, 1000. */
#include "suite.h"

#include <stdio.h>

static const struct {
  double times;
  uint64_t brief, full;
} rows[] = {{1, 400, 20000}, {2, 200, 10000}, {10, 40, 2000}, {100, 4, 200}, {1000, 1, 20}};

void add_steps(suite *s) {
  for (size_t i = 0; i < LENGTH(rows); i++) {
    hard_case row = {.conf = conf_of_assignment,
                     .whole = true,
                     .brief = rows[i].brief,
                     .full = rows[i].full,
                     .of_total = true,
                     .growth = 0.01,
                     .loss = 0.01,
                     .why = "100 s: the guide promises 1 % for this scene, whatever DT is"};
    row.conf.dt *= rows[i].times;
    snprintf(row.name, sizeof row.name, "large step, DT x%g", rows[i].times);
    add_case(s, &row);
  }
}

void add_ages(suite *s) {
  add_case(s, &(hard_case){.name = "the assignment for 10 000 s",
                           .conf = conf_of_assignment,
                           .full = 2000000,
                           .of_total = true,
                           .growth = 0.01,
                           .loss = 0.01,
                           .why = "no secular drift: a symplectic method keeps a modified energy"});
}
