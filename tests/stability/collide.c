/* collide.c - masses that collide as discs: bodies that fall on each other and fold on themselves,
 * masses far faster than a step against a chain, heaps, and discs at one place. */
#include "suite.h"

#include <stdio.h>

static const char two_blocks[] = "............\n"
                                 "...ooooo....\n"
                                 "...ooooo....\n"
                                 "...ooooo....\n"
                                 "............\n"
                                 "............\n"
                                 "..ooooooo...\n"
                                 "..ooooooo...\n"
                                 "..ooooooo...\n"
                                 "............\n"
                                 "............\n"
                                 "############\n";
static const char heap[] = "#o.o.o.o.o#\n"
                           "#.o.o.o.o.#\n"
                           "#o.o.o.o.o#\n"
                           "#.o.o.o.o.#\n"
                           "#o.o.o.o.o#\n"
                           "#.........#\n"
                           "##.......##\n"
                           "###.....###\n"
                           "###########\n";
static const char rope[] = "..................\n"
                           ".oooooooooooooooo.\n"
                           "..................\n"
                           "..................\n"
                           "..................\n"
                           "#................#\n"
                           "####..........####\n"
                           "######......######\n"
                           "##################\n";

/* ---- What must hold */

static bool *find_ties(const msr_view *s) {
  bool *tied = zeroed(s->n * s->n, sizeof *tied);
  for (size_t r = 0; r < s->springs->n_runs; r++) {
    const msr_run_of_springs *run = &s->springs->run[r];
    for (size_t i = run->first; i < run->first + run->count; i++)
      tied[i * s->n + i + run->offset] = true;
  }
  return tied;
}

/* No pair without a spring is nearer than the diameter. */
static const char *are_apart(const hard_case *row, const world *w) {
  static const double rounding = 1e-9; /* of a diameter; the library leaves 1e-12 a step */
  const msr_view s = msr_state_view(w->state);
  bool *tied = find_ties(&s);
  double least = INFINITE;
  for (size_t i = 0; i < s.n; i++)
    for (size_t j = i + 1; j < s.n; j++)
      if (!tied[i * s.n + j]) least = fmin(least, hypot(s.x[j] - s.x[i], s.y[j] - s.y[i]));
  free(tied);
  return least >= row->diameter * (1 - rounding) ? NULL : "discs overlap";
}

/* ---- A fast mass and a chain */

enum { CHAIN = 15 };

/* Aimed at the middle of a free chain across its way; the last mass. */
static msr_scene *make_bullet(const hard_case *row, bool brief) {
  (void)brief;
  msr_scene *scene = empty_scene(row->conf.dt);
  for (size_t i = 0; i < CHAIN; i++) add_mass(scene, 10, (double)i, 0, 0, row->conf.mass);
  for (size_t i = 1; i < CHAIN; i++)
    must(msr_scene_add_spring(scene, i - 1, i, row->conf.stiffness, 1, &why));
  add_mass(scene, 0, (CHAIN - 1) / 2, row->parameter, 0, row->conf.mass);
  return scene;
}

/* Head on with equal masses it stops, and what it hit has its momentum. */
static const char *hit_it(const hard_case *row, const world *w) {
  const msr_view s = msr_state_view(w->state);
  const double p = msr_state_energy(w->state).px, p0 = row->conf.mass * row->parameter;
  if (!(fabs(p - p0) <= 1e-12 * p0)) return "momentum isn't kept";
  if (msr_state_contacts(w->state) == 0 || !(s.x[CHAIN] < s.x[(CHAIN - 1) / 2]))
    return "it passed through the chain";
  return are_apart(row, w);
}

static void add_bullets(suite *s) {
  for (double speed = 1e2; speed < 2e8; speed *= 100) {
    hard_case row = {.make = make_bullet,
                     .conf = {0.005, 0, 0.1, 1500, 1, 1},
                     .diameter = 0.9,
                     .parameter = speed,
                     .brief = 40,
                     .full = 40,
                     .growth = 0.02,
                     .check = hit_it,
                     .why = "collisions never make energy; the chain's springs swing by Verlet"};
    snprintf(row.name, sizeof row.name, "collide: chain hit at %g", speed);
    add_case(s, &row);
  }
}

/* ---- Discs at one place */

static msr_scene *make_coincident(const hard_case *row, bool brief) {
  (void)brief;
  msr_scene *scene = empty_scene(row->conf.dt);
  for (size_t i = 0; i < (size_t)row->parameter; i++) add_mass(scene, 5, 5, 1, 0, row->conf.mass);
  return scene;
}

#define EXAMPLE .conf = {0.005, 9.8, 0.1, 1500, 1, 1}
#define CLOSED  .scene = {.closed_border = true}

static const hard_case rows[] = {
    {.name = "collide: two blocks, elastic",
     .art = two_blocks,
     EXAMPLE,
     CLOSED,
     .diameter = 0.9,
     .brief = 1000,
     .full = 20000,
     .growth = 0.05,
     .check = are_apart,
     .why = why_modified},
    {.name = "collide: two blocks come to rest",
     .art = two_blocks,
     EXAMPLE,
     CLOSED,
     .softness = 0.5,
     .friction = 0.3,
     .damping = 0.5,
     .diameter = 0.9,
     .brief = 5000,
     .full = 100000,
     .wanted = RESTS,
     .growth = 0.01,
     .rest = 1e-6,
     .check = are_apart,
     .why = "damping and inelastic impacts take it all"},
    {.name = "collide: a rope folds on itself",
     .art = rope,
     EXAMPLE,
     CLOSED,
     .softness = 0.5,
     .friction = 0.3,
     .damping = 0.5,
     .diameter = 0.9,
     .brief = 2000,
     .full = 50000,
     .growth = 0.01,
     .check = are_apart,
     .why = "damping and inelastic impacts only take energy"},
    {.name = "collide: a heap in a hopper",
     .art = heap,
     .conf = {0.005, 9.8, 0.1, 0, 1, 1},
     CLOSED,
     .softness = 0.2,
     .diameter = 1,
     .brief = 2000,
     .full = 50000,
     .growth = 0.01,
     .check = are_apart,
     .why = "inelastic collisions only take energy"},
    {.name = "collide: 20 discs at one place",
     .make = make_coincident,
     .conf = {0.005, 0, 0.1, 0, 1, 1},
     .diameter = 1,
     .parameter = 20,
     .brief = 400,
     .full = 4000,
     .growth = 1e-9,
     .loss = 1e-9,
     .check = are_apart,
     .why = "what moves them apart gives them no speed"},
};

void add_collisions(suite *s) {
  add_bullets(s);
  for (size_t i = 0; i < LENGTH(rows); i++) add_case(s, &rows[i]);
}
