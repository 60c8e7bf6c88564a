/* limits.c - both sides of every limit: just below a step is bounded for a million steps, just
 * above it explodes. The largest angular frequencies are known in closed form, sqrt(k/m) times
 *     chain, free ends              2 sin((N - 1) pi / 2N)
 *     lattice at rest, free edges   the same, N a side: along each axis it's a chain of rows
 *     lattice stretched s times     2 sqrt(2 - 1/s) sin(N pi / 2(N + 1)), tied all around */
#include "suite.h"

#include <stdio.h>

enum { CHAIN = 16, SIDE = 8 };

static const double pi = 3.14159265358979323846, k = 1500, m = 0.1;
static const double nudge = 1e-6; /* of a mass, over omega: far below where springs are nonlinear */

typedef struct shape_row {
  const char *name;
  size_t width, height;
  double stretch;
} shape_row;

static const shape_row shapes[] = {{"chain", CHAIN, 1, 1},
                                   {"lattice", SIDE, SIDE, 1},
                                   {"stretched lattice", SIDE, SIDE, 2},
                                   {"pair", 2, 1, 1}};

static double omega_of(const shape_row *shape) {
  const double n = (double)shape->width;
  const double mode = shape->stretch > 1
                          ? sqrt(2 - 1 / shape->stretch) * sin(n * pi / (2 * (n + 1)))
                          : sin((n - 1) * pi / (2 * n));
  return 2 * sqrt(k / m) * mode;
}

static const shape_row *shape_of(const hard_case *row) { return &shapes[(size_t)row->parameter]; }

static void tie_around(msr_scene *scene, const shape_row *shape) {
  const size_t w = shape->width, h = shape->height;
  const double s = shape->stretch;
  for (size_t i = 0; i < w * h; i++) {
    const double x = s * (double)(i % w), y = s * (double)(i / w);
    const double dx = i % w == 0 ? -s : i % w == w - 1 ? s : 0;
    const double dy = i / w == 0 ? -s : i / w == h - 1 ? s : 0;
    if (dx != 0) must(msr_scene_add_anchor(scene, &(msr_anchor){i, x + dx, y, k, 1}, &why));
    if (dy != 0) must(msr_scene_add_anchor(scene, &(msr_anchor){i, x, y + dy, k, 1}, &why));
  }
}

/* Velocities along x that leave each row of masses where it is. */
static void add_moving(msr_scene *scene, const shape_row *shape) {
  uint64_t dice = 11;
  const double s = shape->stretch, most = nudge * omega_of(shape);
  for (size_t j = 0; j < shape->height; j++) {
    double v[CHAIN] = {0}, mean = 0;
    for (size_t i = 0; i < shape->width; i++) {
      v[i] = uniform(&dice, -most, most);
      mean += v[i] / (double)shape->width;
    }
    for (size_t i = 0; i < shape->width; i++)
      add_mass(scene, s * (double)i, s * (double)j, v[i] - mean, 0, m);
  }
}

static msr_scene *make_shape(const hard_case *row, bool brief) {
  (void)brief;
  const shape_row *shape = shape_of(row);
  const size_t w = shape->width, h = shape->height;
  msr_scene *scene = empty_scene(row->conf.dt);
  add_moving(scene, shape);
  for (size_t i = 0; i < w * h; i++) {
    if (i % w > 0) must(msr_scene_add_spring(scene, i - 1, i, k, 1, &why));
    if (i >= w) must(msr_scene_add_spring(scene, i - w, i, k, 1, &why));
  }
  if (shape->stretch > 1) tie_around(scene, shape);
  return scene;
}

/* Just above the limit; three methods are unstable only in a narrow band above theirs. */
static double above_limit(const msr_integrator *integrator) {
  static const struct {
    const msr_integrator *integrator;
    double share;
  } narrow[] = {{&msr_integrator_srkn4, 1.001},
                {&msr_integrator_srkn6, 1.0002},
                {&msr_integrator_kahan_li_8, 1.005}};
  for (size_t i = 0; i < LENGTH(narrow); i++)
    if (integrator == narrow[i].integrator) return narrow[i].share;
  return 1.02;
}

/* A side of a limit; `stability` is the method's. */
static void add_side(suite *s, const msr_integrator *integrator, size_t shape, bool above) {
  const double share = above ? above_limit(integrator) : 0.98;
  const bool none = integrator->stability == 0;
  // what grows leaves a narrow band, as springs aren't linear
  const bool band = integrator == &msr_integrator_srkn6 && shapes[shape].stretch > 1;
  hard_case row = {
      .make = make_shape,
      .parameter = (double)shape,
      .conf = {.dt = (none ? 0.05 : share * integrator->stability) / omega_of(&shapes[shape])},
      .plan = {.integrator = integrator, .substeps = 1},
      .brief = above || none ? 50000 : 10000,
      .full = 1000000,
      .wanted = !(above || none) ? SOUND
                : band           ? GROWS
                                 : EXPLODES,
      .from_rest = true,
      .growth = 100,
      .why = "at a share s of the limit the energy of a mode swings by at most "
             "4 / (1 - s^2) = 100"};
  if (none)
    snprintf(row.name, sizeof row.name, "no limit, %s", shapes[shape].name);
  else
    snprintf(row.name, sizeof row.name, "limit x%g, %s", share, shapes[shape].name);
  add_case(s, &row);
}

/* Its own substeps are small enough: there is nothing to go back from. */
static const char *went_on(const hard_case *row, const world *w) {
  (void)row;
  return msr_state_work(w->state).careful == UINT64_MAX ? NULL : "its steps weren't small enough";
}

/* The library's own substeps, of a DT of a second. */
static void add_default(suite *s, size_t shape) {
  hard_case row = {.make = make_shape,
                   .parameter = (double)shape,
                   .conf = {.dt = 1},
                   .brief = 50,
                   .full = 5000,
                   .from_rest = true,
                   .growth = 4.4,
                   .check = went_on,
                   .why = "at 0.9 of the limit, where a pair is, energy swings to 1 / (1 - 0.81)"};
  snprintf(row.name, sizeof row.name, "limit: default step, %s", shapes[shape].name);
  add_case(s, &row);
}

void add_limits(suite *s) {
  for (size_t shape = 0; shape < LENGTH(shapes); shape++) add_default(s, shape);
  for (const msr_integrator *const *i = msr_integrators; *i; i++)
    for (size_t shape = 0; shape < LENGTH(shapes); shape++)
      for (int above = 0; above <= 1; above++)
        if (isfinite((*i)->stability) && ((*i)->stability > 0 || above))
          add_side(s, *i, shape, above);
}
