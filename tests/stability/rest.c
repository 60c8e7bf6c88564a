/* rest.c - supports that take energy: what falls comes to rest, and stays. */
#include "suite.h"

static const char dropped[] = "............\n"
                              "..o.........\n"
                              "............\n"
                              "............\n"
                              "............\n"
                              "############\n";
static const char block[] = "............\n"
                            "..oooooo....\n"
                            "..oooooo....\n"
                            "..oooooo....\n"
                            "............\n"
                            "............\n"
                            "............\n"
                            "############\n";
static const char slope[] = "..oooo..........\n"
                            "..oooo..........\n"
                            "................\n"
                            "##..............\n"
                            "####............\n"
                            "######..........\n"
                            "########........\n"
                            "##########......\n"
                            "############....\n"
                            "################\n";
static const char funnel[] = "#....oooooo....#\n"
                             "#....oooooo....#\n"
                             "##............##\n"
                             "###..........###\n"
                             "####........####\n"
                             "#####......#####\n"
                             "######....######\n"
                             "################\n";

static const char why_single[] = "exactly 0: the contact leaves no velocity when a rebound would "
                                 "come back within a step";
static const char why_damped[] = "damping lets inner vibrations die: down to rounding, (eps g t)^2";

#define EXAMPLE .conf = {0.005, 9.8, 0.1, 1500, 1, 1}
#define CLOSED  .scene = {.closed_border = true}
#define JELLY   .scene = {.neighbours = 8, .closed_border = true}

static const hard_case rows[] = {
    {.name = "rest: a mass, e = 0.5",
     .art = dropped,
     EXAMPLE,
     .softness = 0.5,
     .brief = 10000,
     .full = 1000000,
     .wanted = RESTS,
     .growth = 0.01,
     .why = why_single},
    {.name = "rest: a mass, e = 0",
     .art = dropped,
     EXAMPLE,
     .softness = 1,
     .brief = 10000,
     .full = 1000000,
     .wanted = RESTS,
     .growth = 0.01,
     .why = why_single},
    {.name = "rest: a mass, e = 0.95",
     .art = dropped,
     EXAMPLE,
     .softness = 0.05,
     .brief = 20000,
     .full = 1000000,
     .wanted = RESTS,
     .growth = 0.01,
     .why = why_single},
    {.name = "rest: a mass slides, friction",
     .art = dropped,
     EXAMPLE,
     CLOSED,
     .vx = 5,
     .softness = 0.5,
     .friction = 0.3,
     .brief = 10000,
     .full = 1000000,
     .wanted = RESTS,
     .growth = 0.01,
     .why = why_single},
    {.name = "rest: a mass, e = 0.5, located",
     .art = dropped,
     EXAMPLE,
     .softness = 0.5,
     .plan = {.impacts = MSR_IMPACTS_LOCATED},
     .brief = 10000,
     .full = 1000000,
     .wanted = RESTS,
     .growth = 0.01,
     .why = why_single},
    {.name = "rest: a mass slides, located",
     .art = dropped,
     EXAMPLE,
     CLOSED,
     .vx = 5,
     .softness = 0.5,
     .friction = 0.3,
     .plan = {.impacts = MSR_IMPACTS_LOCATED},
     .brief = 10000,
     .full = 1000000,
     .wanted = RESTS,
     .growth = 0.01,
     .why = why_single},
    {.name = "rest: a block, damped",
     .art = block,
     EXAMPLE,
     CLOSED,
     .softness = 0.5,
     .friction = 0.3,
     .damping = 0.5,
     .brief = 10000,
     .full = 500000,
     .wanted = RESTS,
     .growth = 0.01,
     .rest = 1e-12,
     .why = why_damped},
    {.name = "rest: a jelly, damped",
     .art = block,
     EXAMPLE,
     JELLY,
     .softness = 0.5,
     .friction = 0.3,
     .damping = 0.5,
     .brief = 10000,
     .full = 500000,
     .wanted = RESTS,
     .growth = 0.01,
     .rest = 1e-12,
     .why = why_damped},
    {.name = "rest: a jelly, damped, located",
     .art = block,
     EXAMPLE,
     JELLY,
     .softness = 0.5,
     .friction = 0.3,
     .damping = 0.5,
     .plan = {.impacts = MSR_IMPACTS_LOCATED},
     .brief = 10000,
     .full = 500000,
     .wanted = RESTS,
     .growth = 0.01,
     .rest = 1e-12,
     .why = why_damped},
    {.name = "rest: a jelly on stairs",
     .art = slope,
     EXAMPLE,
     JELLY,
     .softness = 0.5,
     .friction = 0.6,
     .damping = 2,
     .brief = 20000,
     .full = 500000,
     .wanted = RESTS,
     .growth = 0.01,
     .rest = 1e-12,
     .why = why_damped},
    {.name = "rest: a jelly in a funnel",
     .art = funnel,
     EXAMPLE,
     JELLY,
     .softness = 0.5,
     .friction = 0.3,
     .damping = 2,
     .brief = 20000,
     .full = 500000,
     .wanted = RESTS,
     .growth = 0.01,
     .rest = 1e-12,
     .why = why_damped},
};

/* A mass on the floor, pushed along it by `push`: held within the cone of friction, else it slides
 * as Coulomb says, from rest. */
static const char floor_only[] = "........................................\n"
                                 ".o......................................\n"
                                 "########################################\n";

static const char *slides(const hard_case *row, const world *w) {
  const msr_view s = msr_state_view(w->state);
  const double a = row->push / row->conf.mass - row->friction * row->conf.gravity;
  const double fallen = 2 * 0.5; /* px/s, which the first touch takes from it at most: g, 0.5 px */
  return fabs(s.vx[0] - a * s.t) < fallen + 0.05 * a * s.t ? NULL : "it doesn't slide as it must";
}

/* Wind alone presses a mass on a wall: the rule doesn't see it, and leaves what a step of it gives.
 */
static const char *shakes_little(const hard_case *row, const world *w) {
  const msr_view s = msr_state_view(w->state);
  const double most = msr_plan_describe(w->plan).h * row->wind; /* c = m / 1 s */
  return hypot(s.vx[0], s.vy[0]) <= most ? NULL : "it shakes by more than h c w / m";
}

static const hard_case pushed[] = {
    {.name = "wind presses on a wall",
     .art = floor_only,
     .conf = {0.005, 0, 0.1, 1500, 1, 1},
     CLOSED,
     .wind = 5,
     .softness = 0.5,
     .friction = 0.3,
     .brief = 10000,
     .full = 1000000,
     .growth = 0.01,
     .check = shakes_little,
     .why = "drag of the air takes what it gives"},
    {.name = "rest: pushed, held by friction",
     .art = floor_only,
     EXAMPLE,
     .push = 0.25,
     .softness = 0.5,
     .friction = 0.3,
     .brief = 5000,
     .full = 1000000,
     .wanted = RESTS,
     .growth = 0.01,
     .why = "0.25 < 0.3 m g"},
    {.name = "pushed, slides against friction",
     .art = floor_only,
     EXAMPLE,
     .push = 0.4,
     .softness = 0.5,
     .friction = 0.3,
     .brief = 1000,
     .full = 1000,
     .growth = 0.01,
     .check = slides,
     .why = "0.4 > 0.3 m g: a = F / m - 0.3 g"},
};

/* By every method: where the library sees to impacts after each step, too. */
static void add_methods(suite *s) {
  for (const msr_integrator *const *i = msr_integrators; *i; i++) {
    hard_case row = {.art = dropped,
                     EXAMPLE,
                     .softness = 0.5,
                     .friction = 0.3,
                     .plan = {.integrator = *i},
                     .brief = 5000,
                     .full = 100000,
                     .wanted = RESTS,
                     .growth = 0.01,
                     .rest = *i == &msr_integrator_symplectic_euler ? 1e-5 : 1e-30,
                     .why = "0 but for rounding; symplectic Euler has h g / 2 too much, always"};
    msri_format(row.name, sizeof row.name, "rest: a mass, %s", (*i)->name);
    if ((*i)->stability > 0) add_case(s, &row);
  }
}

void add_rest(suite *s) {
  for (size_t i = 0; i < LENGTH(rows); i++) add_case(s, &rows[i]);
  for (size_t i = 0; i < LENGTH(pushed); i++) add_case(s, &pushed[i]);
  add_methods(s);
}
