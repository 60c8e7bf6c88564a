/* impacts.c - impacts at 1 to 1e6 px/s against walls of one pixel, corners and wedges, and stacks
 * at rest for a million steps. */
#include "suite.h"

#include <stdio.h>

static const char wall[] = "....................\n"
                           "..............#.....\n"
                           "..............#.....\n"
                           "...ooooo......#.....\n"
                           "...ooooo......#.....\n"
                           "...ooooo......#.....\n"
                           "...ooooo......#.....\n"
                           "..............#.....\n"
                           "..............#.....\n"
                           "....................\n";
static const char corner[] = "####################\n"
                             "#..................#\n"
                             "#..................#\n"
                             "#..ooooo...........#\n"
                             "#..ooooo...........#\n"
                             "#..ooooo...........#\n"
                             "#..ooooo.......##..#\n"
                             "#...............#..#\n"
                             "#..................#\n"
                             "####################\n";
static const char wedge[] = "##################..\n"
                            "..................##\n"
                            "...............####.\n"
                            "..ooooo.....####....\n"
                            "..ooooo...###.......\n"
                            "..ooooo...####......\n"
                            "..ooooo.....####....\n"
                            "...............####.\n"
                            "..................##\n"
                            "##################..\n";
static const char notch[] = "####################\n"
                            "...............#####\n"
                            "................####\n"
                            "..ooooo...........##\n"
                            "..ooooo............#\n"
                            "..ooooo............#\n"
                            "..ooooo...........##\n"
                            "................####\n"
                            "...............#####\n"
                            "####################\n";
static const char bullets[] = "####################\n"
                              "#.........#........#\n"
                              "#.o.......#..####..#\n"
                              "#...o.....#.....#..#\n"
                              "#.o.......#.....#..#\n"
                              "#...o..o..#.....#..#\n"
                              "#.o.......#........#\n"
                              "#...o......#.......#\n"
                              "#...........#......#\n"
                              "####################\n";
static const char stack[] = "......\n"
                            ".oooo.\n"
                            ".oooo.\n"
                            ".oooo.\n"
                            ".oooo.\n"
                            "######\n";

static const char close_room[] = ".........\n"
                                 "..ooooo..\n"
                                 "..ooooo..\n"
                                 "..ooooo..\n"
                                 "..ooooo..\n"
                                 ".........\n"
                                 ".........\n";

static const struct {
  const char *name, *art;
  double vx, vy;
  msr_impacts impacts;
} targets[] = {{"wall", wall, 1, 0, MSR_IMPACTS_KEPT},
               {"corner", corner, 1, -1, MSR_IMPACTS_KEPT},
               {"wedge", wedge, 1, 0, MSR_IMPACTS_KEPT},
               {"notch", notch, 1, 0.3, MSR_IMPACTS_KEPT},
               {"bullets", bullets, 1, 0.37, MSR_IMPACTS_KEPT},
               {"bullets, located", bullets, 1, 0.37, MSR_IMPACTS_LOCATED},
               {"wall, located", wall, 1, 0, MSR_IMPACTS_LOCATED},
               {"notch, located", notch, 1, 0.3, MSR_IMPACTS_LOCATED}};

/* The block is crushed where m v^2 / 2 is near k: at 100 px/s. Faster, it hardly gets on in a room
 * that it would cross many times in a step. */
static void add_speeds(suite *s, size_t target) {
  const bool located = targets[target].impacts == MSR_IMPACTS_LOCATED;
  for (double speed = 1; speed < 2e6; speed *= 10) {
    const bool slow = speed<50, blur = speed> 5e3, exact = !slow && !located;
    hard_case row = {.art = targets[target].art,
                     .conf = {0.005, 0, 0.1, 1500, 1, 1},
                     .scene = {.closed_border = true},
                     .vx = speed * targets[target].vx,
                     .vy = speed * targets[target].vy,
                     .plan = {.impacts = targets[target].impacts},
                     .brief = slow   ? 2000
                              : blur ? 50
                                     : 400,
                     .full = slow ? 20000 : 2000,
                     .growth = exact     ? 1e-8
                               : located ? 0.05
                                         : 0.02,
                     .loss = exact     ? 1e-8
                             : blur    ? 0
                             : located ? 0.1
                                       : 0.03,
                     .why = slow    ? why_modified
                            : exact ? why_exact
                            : blur  ? "more impacts in a step than are followed: springs may slow "
                                      "what doesn't get on, and give nothing"
                                    : why_crushed};
    snprintf(row.name, sizeof row.name, "%s at %g px/s", targets[target].name, speed);
    add_case(s, &row);
  }
}

/* As hot as a lattice is that has crumpled, but none of it crushed. */
static void heat(const hard_case *row, const world *w) {
  uint64_t dice = 3;
  const msr_arrays s = msr_state_edit(w->state);
  for (size_t i = 0; i < msr_plan_describe(w->plan).masses; i++) {
    s.vx[i] = uniform(&dice, -row->parameter, row->parameter);
    s.vy[i] = uniform(&dice, -row->parameter, row->parameter);
  }
}

static const hard_case rows[] = {
    {.name = "a hot block, by name",
     .art = close_room,
     .conf = {0.005, 0, 0.1, 1500, 1, 1},
     .scene = {.closed_border = true},
     .arrange = heat,
     .parameter = 20,
     .plan = {.integrator = &msr_integrator_verlet, .substeps = 2},
     .brief = 200000,
     .full = 1000000,
     .growth = 0.05,
     .loss = 0.05,
     .why = "impacts keep Verlet's modified energy; without that it's 12 % after 200 000"},
    {.name = "stack at rest, elastic",
     .art = stack,
     .conf = {0.005, 9.8, 0.1, 1500, 1, 1},
     .brief = 5000,
     .full = 500000,
     .growth = 0.025,
     .loss = 0.05,
     .why = "3 substeps, so more than a million steps; over the energy of its first sag"},
    {.name = "stack at rest, soft supports",
     .art = stack,
     .conf = {0.005, 9.8, 0.1, 1500, 1, 1},
     .softness = 0.5,
     .friction = 0.5,
     .brief = 5000,
     .full = 500000,
     .growth = 0.05,
     .why = "supports only take energy"},
};

void add_impacts(suite *s) {
  for (size_t i = 0; i < LENGTH(targets); i++) add_speeds(s, i);
  for (size_t i = 0; i < LENGTH(rows); i++) add_case(s, &rows[i]);
}
