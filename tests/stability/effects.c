/* effects.c - wind and pushes of absurd strength, damping and drag from none to a million times
 * what is critical, with every integrator. */
#include "suite.h"

#include <stdio.h>

static const char flag[] = "............\n"
                           "#ooooooo....\n"
                           "#ooooooo....\n"
                           "#ooooooo....\n"
                           "#ooooooo....\n"
                           "............\n"
                           "............\n";
static const char pair[] = "......\n..oo..\n......\n######\n";

static void add_winds(suite *s) {
  for (double speed = 1e3; speed < 2e12; speed *= 1e3)
    for (int gusts = 0; gusts <= 1; gusts++) {
      hard_case row = {.art = flag,
                       .conf = conf_of_assignment,
                       .scene = {.attach = true, .closed_border = gusts},
                       .wind = speed,
                       .gust = gusts * speed,
                       .brief = 200,
                       .full = 20000,
                       .growth = 0.05,
                       .why = "of the energy that the wind brings, as the guard reckons it"};
      snprintf(row.name, sizeof row.name, "wind %g px/s%s", speed, gusts ? ", gusts, closed" : "");
      add_case(s, &row);
    }
}

static void add_pushes(suite *s) {
  for (double push = 1e3; push < 2e12; push *= 1e3)
    for (int closed = 0; closed <= 1; closed++) {
      hard_case row = {.art = flag,
                       .conf = conf_of_assignment,
                       .scene = {.attach = true, .closed_border = closed},
                       .push = push,
                       .brief = 200,
                       .full = 20000,
                       .growth = 0.05,
                       .loss = 0.05,
                       .why = "a push has a potential; undamped, what it swings crumples, which is "
                              "seen at 2 % of what there was to give, as the guard reckons it"};
      snprintf(row.name, sizeof row.name, "push %g%s", push, closed ? ", closed" : "");
      add_case(s, &row);
    }
}

/* Critical on the pair's spring: 2 sqrt(k m / 2). */
static const double critical = 17.320508;

/* Pulled apart, and turned. */
static void pull(size_t n, msr_mass *m) { m[n - 1].x += 0.3, m[n - 1].y += 0.2; }

/* With methods that don't split, substeps are as many as damping is over: fewer iterations. */
static void add_brakes(suite *s, const msr_integrator *integrator, bool drag) {
  for (double times = 1e-2; times < 2e6; times *= 1e4) {
    const bool slow = times > 1 && (!integrator->splits || integrator->damping_stability < 100);
    const double z = critical * times;
    hard_case row = {.art = pair,
                     .conf = {0.0005, 9.8, 0.1, 1500, 1, 1},
                     .damping = drag ? 0 : z,
                     .drag = drag ? z : 0,
                     .place = pull,
                     .plan = {.integrator = integrator},
                     .brief = slow ? 1 : 20,
                     .full = slow ? 4 : 2000,
                     .growth = 0.1,
                     .why = "damping only takes energy; at h omega / 2 = 0.043 that of symplectic "
                            "Euler swings by (1 + s) / (1 - s) = 1.09"};
    snprintf(row.name, sizeof row.name, "%s %g, %s", drag ? "drag" : "damping", times,
             integrator->name);
    add_case(s, &row);
  }
}

void add_effects(suite *s) {
  add_winds(s);
  add_pushes(s);
  for (const msr_integrator *const *i = msr_integrators; *i; i++)
    for (int drag = 0; drag <= 1 && (*i)->stability > 0; drag++) add_brakes(s, *i, drag);
}
