/* test_integrators.c - tries to refute what every integrator of the library declares: its order, on
 * plain systems with known solutions and on lattices with every kind of force; its limits of
 * stability; reversibility; symplecticity; evaluations. And a run has the same bits however it is
 * cut in pieces. */
#include "scenes.h"

#include <gsl/gsl_sf_elljac.h>
#include <stdio.h>
#include <unistd.h>

/* Calls check for every integrator of the library. */
static void on_all(void (*check)(const msr_integrator *integrator)) {
  for (const msr_integrator *const *i = msr_integrators; *i; i++) check(*i);
}

/* ---- Plain systems */

/* What the callbacks of a system share: how often a was asked for. */
typedef struct counted {
  double omega, gamma;
  uint64_t calls;
} counted;

static msr_status oscillate(void *self, double t, const double *q, const double *v, double *a) {
  (void)t, (void)v;
  counted *c = self;
  c->calls++;
  a[0] = -c->omega * c->omega * q[0];
  return MSR_OK;
}

static msr_status swing(void *self, double t, const double *q, const double *v, double *a) {
  (void)self, (void)t, (void)v;
  a[0] = -sin(q[0]);
  return MSR_OK;
}

static msr_status fall_to_sun(void *self, double t, const double *q, const double *v, double *a) {
  (void)self, (void)t, (void)v;
  const double r = hypot(q[0], q[1]);
  a[0] = -q[0] / (r * r * r);
  a[1] = -q[1] / (r * r * r);
  return MSR_OK;
}

static msr_status shaken(void *self, double t, const double *q, const double *v, double *a) {
  (void)self, (void)v;
  a[0] = -q[0] + sin(2 * t);
  return MSR_OK;
}

static msr_status slow_down(void *self, double t, const double *q, const double *v, double *a) {
  (void)t, (void)q;
  a[0] = -((const counted *)self)->gamma * v[0];
  return MSR_OK;
}

/* Solutions: z = q[n], v[n] at time t. */

static void oscillation(double t, double *z) { z[0] = cos(t), z[1] = -sin(t); }

/* From rest at the angle 2 asin(k): sin(q/2) = k cd(t). */
static void pendulum(double t, double *z) {
  const double k = 0.8;
  double sn, cn, dn;
  gsl_sf_elljac_e(t, k * k, &sn, &cn, &dn);
  z[0] = 2 * asin(k * cn / dn);
  z[1] = -2 * k * sqrt(1 - k * k) * sn / dn;
}

/* Eccentricity e from the perihelion: E - e sin E = t. */
static void kepler(double t, double *z) {
  const double e = 0.3, b = sqrt(1 - e * e);
  double E = t;
  for (int n = 0; n < 30; n++) E -= (E - e * sin(E) - t) / (1 - e * cos(E));
  const double rate = 1 / (1 - e * cos(E));
  z[0] = cos(E) - e, z[1] = b * sin(E);
  z[2] = -sin(E) * rate, z[3] = b * cos(E) * rate;
}

/* q'' = -q + sin 2t from q = 1, v = 0. */
static void forced(double t, double *z) {
  z[0] = cos(t) + 2.0 / 3 * sin(t) - sin(2 * t) / 3;
  z[1] = -sin(t) + 2.0 / 3 * (cos(t) - cos(2 * t));
}

static const struct plain {
  const char *name;
  size_t n;
  msr_status (*acceleration)(void *, double, const double *, const double *, double *);
  void (*solution)(double t, double *z);
} plains[] = {
    {"oscillator", 1, oscillate, oscillation},
    {"pendulum", 1, swing, pendulum},
    {"Kepler", 2, fall_to_sun, kepler},
    {"forced", 1, shaken, forced},
};

static msr_system system_of(const struct plain *p, counted *c) {
  return (msr_system){.n = p->n, .self = c, .acceleration = p->acceleration};
}

/* ---- Order */

/* The order of errors[levels], h halved from each to the next: at the smallest two that rounding
 * leaves alone. */
static double order_of(size_t levels, const double *errors, double rounding) {
  size_t last = levels - 1;
  while (last > 1 && errors[last] < rounding) last--;
  return log2(errors[last - 1] / errors[last]);
}

enum { LEVELS = 8 };

/* Until t = 4 by 2^level times 16 steps, not a period of any: a method that is conjugate to one of
 * higher order would show that one's. */
static void check_plain_order(const msr_integrator *integrator) {
  for (size_t p = 0; p < LENGTH(plains); p++) {
    counted c = {.omega = 1};
    const msr_system system = system_of(&plains[p], &c);
    double errors[LEVELS], exact[4], z[4];
    plains[p].solution(4, exact);
    for (size_t level = 0; level < LEVELS; level++) {
      const uint64_t steps = (uint64_t)32 << level;
      plains[p].solution(0, z);
      must(
          msr_integrate(integrator, &system, 0, 4.0 / (double)steps, steps, z, z + system.n, &why));
      errors[level] = distance(2 * system.n, z, exact);
    }
    const double order = order_of(LEVELS, errors, 1e-11);
    if (!(fabs(order - integrator->order) < 0.1))
      fail_msg("%s, %s: order %g", integrator->name, plains[p].name, order);
  }
}

static void plain_systems_show_the_declared_order(void **state) {
  (void)state;
  on_all(check_plain_order);
}

/* Forces of a user: one that depends on t, one on v, without a flow. */

static msr_status add_tide(const void *self, void *scratch, const msr_view *s, double *fx,
                           double *fy) {
  (void)self, (void)scratch;
  for (size_t i = 0; i < s->n; i++) {
    fx[i] += 3 * cos(9 * s->t) * msr_view_mass(s, i);
    fy[i] -= sin(7 * s->t + s->x[i]);
  }
  return MSR_OK;
}
static const msr_force tide = {.name = "tide", .summary = "t", .uses_time = true, .add = add_tide};

static msr_status add_swirl(const void *self, void *scratch, const msr_view *s, double *fx,
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

/* A smoothly deformed lattice in motion, with up to three forces. */
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

static void deform(world *w) {
  const msr_arrays s = msr_state_edit(w->state);
  for (size_t i = 0; i < MASSES; i++) {
    const double x = s.x[i], y = s.y[i];
    s.x[i] += 0.15 * sin(0.9 * x + 0.3 * y);
    s.y[i] += 0.15 * cos(0.5 * x - 0.8 * y);
    s.vx[i] = 1.5 * cos(0.7 * x) - 0.2 * y;
    s.vy[i] = sin(0.6 * y) + 0.2 * x;
  }
}

static world deformed(const struct medium *m, const msr_integrator *integrator, double dt,
                      uint64_t substeps) {
  msr_scene *scene = lattice(WIDTH, HEIGHT, 8, &(msr_conf){dt, 0, 0.5, 30, 1, 1});
  for (size_t f = 0; f < MOST_FORCES && m->force[f]; f++)
    must(msr_scene_add_force(scene, m->force[f], trial_params(m->force[f]), &why));
  world w = open_world(scene, integrator, substeps);
  deform(&w);
  return w;
}

/* Any force that depends on v holds a splitting to order 2: its flow is taken by half steps at both
 * ends (Strang). Other methods keep theirs. */
static int expected_order(const msr_integrator *integrator, const struct medium *m) {
  bool uses_velocity = false;
  for (size_t f = 0; f < MOST_FORCES && m->force[f]; f++)
    uses_velocity |= m->force[f]->uses_velocity;
  return integrator->splits && uses_velocity && integrator->order > 2 ? 2 : integrator->order;
}

/* By the differences between one h and its half, over 0.4 s from h = 0.025 on (omega h = 0.5). */
static void check_scene_order(const msr_integrator *integrator) {
  enum { FINEST = 6 };
  double z[FINEST + 1][4 * MASSES], errors[FINEST];
  for (size_t m = 0; m < LENGTH(media); m++) {
    for (size_t level = 0; level <= FINEST; level++) {
      world w = deformed(&media[m], integrator, 0.4, (int64_t)16 << level);
      advance(&w, 1);
      read_world(&w, z[level]);
      close_world(&w);
    }
    for (size_t level = 0; level < FINEST; level++)
      errors[level] = distance(4 * MASSES, z[level], z[level + 1]);
    const double order = order_of(FINEST, errors, 1e-10);
    if (!(fabs(order - expected_order(integrator, &media[m])) < 0.1))
      fail_msg("%s, %s: order %g", integrator->name, media[m].name, order);
  }
}

static void lattices_show_the_declared_order(void **state) {
  (void)state;
  on_all(check_scene_order);
}

/* All converge to the same: within 10 (omega h)^order px, as things change in 1/omega = 0.04 s, and
 * the reference's own 1e-9. */
static void integrators_agree(void **state) {
  (void)state;
  double z[4 * MASSES], reference[4 * MASSES];
  for (size_t m = 0; m < LENGTH(media); m++) {
    world fine = deformed(&media[m], &msr_integrator_rk4, 0.4, 512);
    advance(&fine, 1);
    read_world(&fine, reference);
    close_world(&fine);
    for (const msr_integrator *const *i = msr_integrators; *i; i++) {
      world w = deformed(&media[m], *i, 0.4, 2048);
      advance(&w, 1);
      read_world(&w, z);
      close_world(&w);
      const double most = 1e-8 + 10 * pow(0.4 / 2048 / 0.04, expected_order(*i, &media[m]));
      if (!(distance(4 * MASSES, z, reference) < most))
        fail_msg("%s, %s: %g", (*i)->name, media[m].name, distance(4 * MASSES, z, reference));
    }
  }
}

/* ---- Stability */

/* Largest |q|, |v| of the last of `steps` steps of h = 1 from q = v = 1. */
static double grown(const msr_integrator *integrator, const msr_system *system, uint64_t steps) {
  double q = 1, v = 1;
  must(msr_integrate(integrator, system, 0, 1, steps, &q, &v, &why));
  return isfinite(q) && isfinite(v) ? fmax(fabs(q), fabs(v)) : (double)INFINITY;
}

/* Below the limit by one in a thousand, Verlet swings by 1 / sqrt(1 - 0.999^2) = 22. Above, what
 * grows least is Runge-Kutta's, by 0.7 % a step. */
static void check_frequency_limit(const msr_integrator *integrator) {
  const double limit = integrator->stability, none[] = {1.5, 0.5, 0.1};
  counted c = {.omega = 0.999 * limit};
  const msr_system system = {.n = 1, .self = &c, .acceleration = oscillate};
  if (limit > 0) assert_true(grown(integrator, &system, 20000) < 100);
  c.omega = 1.001 * limit;
  if (limit > 0) assert_true(grown(integrator, &system, 20000) > 1e6);
  for (size_t i = 0; limit <= 0 && i < LENGTH(none); i++) {
    c.omega = none[i];
    assert_true(grown(integrator, &system, 20000) > 1e6);
  }
}

static void the_limit_of_frequency_is_sharp(void **state) {
  (void)state;
  on_all(check_frequency_limit);
}

/* q = 1 + the sum of all v: bounded too. */
static void check_damping_limit(const msr_integrator *integrator) {
  counted c = {.gamma = 0.999 * integrator->damping_stability};
  const msr_system system = {.n = 1, .self = &c, .acceleration = slow_down};
  assert_true(grown(integrator, &system, 20000) < 100);
  c.gamma = 1.001 * integrator->damping_stability;
  assert_true(grown(integrator, &system, 20000) > 1e6);
}

static void the_limit_of_damping_is_sharp(void **state) {
  (void)state;
  on_all(check_damping_limit);
}

static msr_status oscillate_slowing(void *self, double t, const double *q, const double *v,
                                    double *a) {
  const counted *c = self;
  must(oscillate(self, t, q, v, a));
  if (v) a[0] -= c->gamma * v[0];
  return MSR_OK;
}

static msr_status decay(void *self, double t, double h, bool backward, const double *q, double *v) {
  (void)t, (void)backward, (void)q;
  v[0] *= exp(-((const counted *)self)->gamma * h);
  return MSR_OK;
}

/* A splitting is stable up to its limit of frequency for any damping taken exactly; any other
 * method on the segment between its two limits. */
static void check_both_limits(const msr_integrator *integrator) {
  if (!(integrator->stability > 0)) return;
  for (double part = 0.05; part < 1; part += 0.1) {
    const bool splits = integrator->splits;
    counted c = {.omega = 0.99 * integrator->stability * (splits ? 1 : part),
                 .gamma = splits ? 10 * part : 0.99 * integrator->damping_stability * (1 - part)};
    const msr_system system = {.n = 1,
                               .self = &c,
                               .acceleration = splits ? oscillate : oscillate_slowing,
                               .damp = splits ? decay : NULL};
    if (!(grown(integrator, &system, 20000) < 100))
      fail_msg("%s: h omega %g, h gamma %g", integrator->name, c.omega, c.gamma);
  }
}

static void both_limits_hold_together(void **state) {
  (void)state;
  on_all(check_both_limits);
}

/* Two masses on a spring, omega^2 = 2 k / m: the plan's bound is their frequency itself. */
static void check_plan_limit(const msr_integrator *integrator) {
  msr_scene *scene = empty_scene(0.01);
  for (int i = 0; i < 2; i++) add_mass(scene, i, 0, 0, 0, 0.5);
  must(msr_scene_add_spring(scene, 0, 1, 400, 1, &why));
  world w = open_world(scene, integrator, 1);
  const msr_plan_figures f = msr_plan_describe(w.plan);
  assert_true(fabs(f.omega - 40) < 40 * 4 * DBL_EPSILON);
  assert_true(fabs(f.stable_step - integrator->stability / 40) <= 4 * DBL_EPSILON);
  close_world(&w);
}

static void the_stable_step_of_a_pair_is_exact(void **state) {
  (void)state;
  on_all(check_plan_limit);
}

/* The pair, swinging along itself from a phase on, with a brake of `rate` times its omega. */
static world swinging(const msr_integrator *integrator, double dt, double phase,
                      const msr_force *brake, double rate) {
  const double k = 400, m = 0.5, omega = 40, a = 0.02; /* far from turning inside out */
  msr_scene *scene = empty_scene(dt);
  for (int side = -1; side <= 1; side += 2)
    add_mass(scene, side * (0.5 + a * cos(phase)), 0, side * a * omega * sin(phase), 0, m);
  must(msr_scene_add_spring(scene, 0, 1, k, 1, &why));
  const msr_drag c = {rate * omega * m}; /* all that a damping holds, too */
  if (rate > 0) must(msr_scene_add_force(scene, brake, &c, &why));
  return open_world(scene, integrator, 1);
}

/* At the library's own largest step, where the bound of frequencies is sharp, nothing runs away and
 * the guard is content. Symplectic Euler's energy swings most, by 1.9 / 0.1 = 19. */
static void check_safe_step(const msr_integrator *integrator, const msr_force *brake, double rate) {
  world any = swinging(integrator, 1, 0, brake, rate);
  const double dt = msr_plan_describe(any.plan).safe_step;
  close_world(&any);
  for (double phase = 0; phase < 3.1; phase += 0.2) {
    world w = swinging(integrator, dt, phase, brake, rate);
    const double e0 = msr_state_energy(w.state).total;
    if (msr_state_step(w.state, 1000, &why) != MSR_OK)
      fail_msg("%s, %s %g omega: %s", integrator->name, brake->name, rate, why.message);
    assert_true(msr_state_energy(w.state).total < 20 * e0);
    close_world(&w);
  }
}

static void check_brakes(const msr_integrator *integrator) {
  for (double rate = 0.01; rate < 200 && integrator->stability > 0; rate *= 4) {
    check_safe_step(integrator, &msr_force_drag, rate);
    check_safe_step(integrator, &msr_force_damping, rate);
  }
}

static void safe_steps_are_stable_with_damping(void **state) {
  (void)state;
  on_all(check_brakes);
}

static void check_free_swing(const msr_integrator *integrator) {
  if (integrator->stability > 0) check_safe_step(integrator, &msr_force_drag, 0);
}

static void safe_steps_content_the_guard(void **state) {
  (void)state;
  on_all(check_free_swing);
}

/* ---- Reversibility */

static void flip(size_t n, double *v) {
  for (size_t i = 0; i < n; i++) v[i] = -v[i];
}

/* There and back in `steps` steps each way leaves rounding alone, eps times what an error at the
 * start may have become, less than 1000 here; or, if it isn't declared, clearly more. */
static void check_return(const msr_integrator *integrator, uint64_t steps, double error) {
  const double rounding = 1000 * (double)steps * DBL_EPSILON;
  if (integrator->reversible ? !(error < rounding) : !(error > 100 * rounding))
    fail_msg("%s comes back with %g", integrator->name, error);
}

static void check_plain_return(const msr_integrator *integrator) {
  const uint64_t steps = 50;
  for (size_t p = 0; p < LENGTH(plains); p++) {
    if (plains[p].acceleration == shaken) continue; /* t would have to come back too */
    counted c = {.omega = 1};
    const msr_system system = system_of(&plains[p], &c);
    double z[4], start[4];
    plains[p].solution(0, start);
    memcpy(z, start, sizeof z);
    for (int way = 0; way < 2; way++) {
      must(msr_integrate(integrator, &system, 0, 0.1, steps, z, z + system.n, &why));
      flip(system.n, z + system.n);
    }
    check_return(integrator, steps, distance(2 * system.n, z, start));
  }
}

static void check_scene_return(const msr_integrator *integrator) {
  const uint64_t steps = 100;
  double start[4 * MASSES], z[4 * MASSES];
  world w = deformed(&media[1], integrator, 0.004, 1);
  read_world(&w, start);
  for (int way = 0; way < 2; way++) {
    advance(&w, steps);
    read_world(&w, z);
    flip(2 * MASSES, z + 2 * MASSES);
    write_world(&w, z);
  }
  check_return(integrator, steps, distance(4 * MASSES, z, start));
  close_world(&w);
}

static void flipping_v_retraces_the_path_if_declared(void **state) {
  (void)state;
  on_all(check_plain_return);
  on_all(check_scene_return);
}

/* ---- Symplecticity */

enum { DEGREES = 6, PHASE = 2 * DEGREES };

/* Largest entry of J^T S J - S, with J[i][j] the derivative of z[i] by z[j] and S the areas
 * sum m dq dv. */
static double area_error(double J[PHASE][PHASE], const double *m) {
  double worst = 0;
  for (size_t a = 0; a < PHASE; a++)
    for (size_t b = 0; b < PHASE; b++) {
      double area = b == a + DEGREES ? -m[a] : a == b + DEGREES ? m[b] : 0;
      for (size_t i = 0; i < DEGREES; i++)
        area += m[i] * (J[i][a] * J[i + DEGREES][b] - J[i + DEGREES][a] * J[i][b]);
      worst = fmax(worst, fabs(area));
    }
  return worst;
}

static msr_status pull_symmetrically(void *self, double t, const double *q, const double *v,
                                     double *a) {
  (void)self, (void)t, (void)v;
  for (size_t i = 0; i < DEGREES; i++) {
    a[i] = 0;
    for (size_t j = 0; j < DEGREES; j++) a[i] -= q[j] / (double)(1 + i + j + i * j);
  }
  return MSR_OK;
}

/* Forces linear in q: a step is a matrix, whose columns are the steps of unit vectors. */
static void check_linear_area(const msr_integrator *integrator) {
  const msr_system system = {.n = DEGREES, .acceleration = pull_symmetrically};
  double J[PHASE][PHASE];
  const double m[DEGREES] = {1, 1, 1, 1, 1, 1};
  for (size_t j = 0; j < PHASE; j++) {
    double z[PHASE] = {0};
    z[j] = 1;
    must(msr_integrate(integrator, &system, 0, 0.7, 1, z, z + DEGREES, &why));
    for (size_t i = 0; i < PHASE; i++) J[i][j] = z[i];
  }
  const double error = area_error(J, m), rounding = 100 * DBL_EPSILON;
  if (integrator->symplectic ? !(error < rounding) : !(error > 1e6 * rounding))
    fail_msg("%s: areas change by %g", integrator->name, error);
}

static const mesh triangle = {.masses = 3, .springs = 5, .anchors = 2, .seed = 31};

/* z after one step of 0.05 s, omega h being about 1. */
static void step_triangle(world *w, const double *z, double *after) {
  write_world(w, z);
  advance(w, 1);
  read_world(w, after);
}

/* Springs that turn, masses that differ. J by differences of the 4th order, d = 1e-3 px: off by
 * d^4 and eps / d, below 1e-11 for derivatives of order 1. */
static void check_mesh_area(const msr_integrator *integrator) {
  double J[PHASE][PHASE], z[PHASE], after[4][PHASE], m[DEGREES];
  const double d = 1e-3, at[] = {-2, -1, 1, 2}, weight[] = {1.0 / 12, -2.0 / 3, 2.0 / 3, -1.0 / 12};
  msr_scene *scene = random_mesh(&triangle, NULL);
  must(msr_scene_set_times(scene, 0.05, 1, 1, &why));
  world w = open_world(scene, integrator, 1);
  const msr_view s = msr_state_view(w.state);
  for (size_t i = 0; i < DEGREES; i++) m[i] = msr_view_mass(&s, i % s.n);
  read_world(&w, z);
  for (size_t j = 0; j < PHASE; j++) {
    const double middle = z[j];
    for (size_t k = 0; k < 4; k++) {
      z[j] = middle + at[k] * d;
      step_triangle(&w, z, after[k]);
    }
    z[j] = middle;
    for (size_t i = 0; i < PHASE; i++) {
      J[i][j] = 0;
      for (size_t k = 0; k < 4; k++) J[i][j] += weight[k] * after[k][i] / d;
    }
  }
  const double error = area_error(J, m);
  close_world(&w);
  if (integrator->symplectic ? !(error < 1e-8) : !(error > 1e-5))
    fail_msg("%s on a mesh: areas change by %g", integrator->name, error);
}

static void areas_are_kept_if_declared(void **state) {
  (void)state;
  on_all(check_linear_area);
  on_all(check_mesh_area);
}

/* ---- Evaluations */

static uint64_t calls_for(const msr_integrator *integrator, uint64_t steps) {
  counted c = {.omega = 1};
  const msr_system system = system_of(&plains[0], &c);
  double q = 1, v = 0;
  must(msr_integrate(integrator, &system, 0, 0.01, steps, &q, &v, &why));
  return c.calls;
}

/* In a scene, effect 0 is the springs. */
static uint64_t calls_of_springs(const msr_integrator *integrator, uint64_t iterations) {
  world w = deformed(&media[3], integrator, 0.01, 1);
  advance(&w, iterations);
  const uint64_t calls = msr_state_calls(w.state, 0);
  close_world(&w);
  return calls;
}

/* Beyond those of begin(). */
static void check_evaluations(const msr_integrator *integrator) {
  const double per_step = (double)(calls_for(integrator, 30) - calls_for(integrator, 20)) / 10;
  assert_true(fabs(per_step - integrator->evaluations) < 1e-9);
  const uint64_t more = calls_of_springs(integrator, 30) - calls_of_springs(integrator, 20);
  assert_true(fabs((double)more / 10 - integrator->evaluations) < 1e-9);
  assert_true((double)calls_for(integrator, 20) <= 20 * integrator->evaluations + 1);
}

static void steps_take_the_declared_evaluations(void **state) {
  (void)state;
  on_all(check_evaluations);
}

/* ---- A run in pieces */

enum { ITERATIONS = 70 }; /* past two looks of the guard */

static void at_once(world *w) { advance(w, ITERATIONS); }

static void one_at_a_time(world *w) {
  for (int i = 0; i < ITERATIONS; i++) advance(w, 1);
}

static void touched(world *w) {
  advance(w, 33);
  (void)msr_state_edit(w->state);
  advance(w, ITERATIONS - 33);
}

static void copied(world *w) {
  msr_state *copy;
  must(msr_state_create(w->plan, &copy, &why));
  advance(w, 20);
  msr_state_copy(copy, w->state);
  advance(w, 5);
  msr_state_free(w->state);
  w->state = copy;
  advance(w, ITERATIONS - 20);
}

static void saved_and_loaded(world *w) {
  char path[4096];
  const char *dir = getenv("TMPDIR");
  snprintf(path, sizeof path, "%s/msr-state-XXXXXX", dir ? dir : "/tmp");
  const int file = mkstemp(path);
  assert_true(file >= 0);
  close(file);
  advance(w, 41);
  must(msr_state_save(w->state, path, &why));
  msr_state_free(w->state);
  must(msr_state_create(w->plan, &w->state, &why));
  advance(w, 3);
  must(msr_state_load(w->state, path, &why));
  remove(path);
  advance(w, ITERATIONS - 41);
}

static void forked(world *w) {
  msr_state *copy;
  must(msr_state_create(w->plan, &copy, &why));
  msr_state_copy(copy, w->state);
  must(msr_state_step(copy, 60, &why));
  advance(w, 10);
  msr_state_copy(w->state, copy);
  msr_state_free(copy);
  advance(w, ITERATIONS - 60);
}

static const struct way {
  const char *name;
  void (*go)(world *w);
} ways[] = {{"at once", at_once}, {"one at a time", one_at_a_time},       {"touched", touched},
            {"copied", copied},   {"saved and loaded", saved_and_loaded}, {"forked", forked}};

static void check_ways(const msr_integrator *integrator) {
  for (size_t m = 0; m < LENGTH(media); m++) {
    double first[4 * MASSES], z[4 * MASSES];
    uint64_t hash = 0;
    for (size_t n = 0; n < LENGTH(ways); n++) {
      world w = deformed(&media[m], integrator, 0.003, 3);
      ways[n].go(&w);
      assert_int_equal(msr_state_iteration(w.state), ITERATIONS);
      read_world(&w, n == 0 ? first : z);
      if (n == 0) hash = msr_state_hash(w.state);
      if (hash != msr_state_hash(w.state) || (n > 0 && memcmp(z, first, sizeof z) != 0))
        fail_msg("%s, %s, %s: other bits", integrator->name, media[m].name, ways[n].name);
      close_world(&w);
    }
  }
}

static void a_run_in_pieces_has_the_same_bits(void **state) {
  (void)state;
  on_all(check_ways);
}

/* Where a doesn't depend on t. */
static void check_plain_pieces(const msr_integrator *integrator) {
  counted c = {.omega = 1};
  const msr_system system = system_of(&plains[1], &c);
  double whole[] = {1, 0.5}, pieces[] = {1, 0.5};
  must(msr_integrate(integrator, &system, 0, 0.1, 20, whole, whole + 1, &why));
  for (int n = 0; n < 4; n++)
    must(msr_integrate(integrator, &system, 0, 0.1, 5, pieces, pieces + 1, &why));
  assert_memory_equal(whole, pieces, sizeof whole);
}

static void a_plain_run_in_pieces_has_the_same_bits(void **state) {
  (void)state;
  on_all(check_plain_pieces);
}

/* 4 substeps are 4 iterations of a quarter of DT: the same bits where nothing depends on t, and
 * where something does, to the rounding of t, 1e-16 s times rates of 100 a second. */
static void check_substeps(const msr_integrator *integrator) {
  for (size_t m = 0; m < LENGTH(media); m++) {
    double few[4 * MASSES], many[4 * MASSES];
    bool uses_time = false;
    for (size_t f = 0; f < MOST_FORCES && media[m].force[f]; f++)
      uses_time |= media[m].force[f]->uses_time;
    world w = deformed(&media[m], integrator, 0.01, 4);
    advance(&w, 20);
    read_world(&w, few);
    close_world(&w);
    w = deformed(&media[m], integrator, 0.0025, 1);
    advance(&w, 80);
    read_world(&w, many);
    close_world(&w);
    const double apart = distance(4 * MASSES, few, many);
    if (!(apart <= (uses_time ? 1e-12 : 0)))
      fail_msg("%s, %s: %g apart", integrator->name, media[m].name, apart);
  }
}

static void substeps_are_smaller_iterations(void **state) {
  (void)state;
  on_all(check_substeps);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(plain_systems_show_the_declared_order),
      cmocka_unit_test(lattices_show_the_declared_order),
      cmocka_unit_test(integrators_agree),
      cmocka_unit_test(the_limit_of_frequency_is_sharp),
      cmocka_unit_test(the_limit_of_damping_is_sharp),
      cmocka_unit_test(both_limits_hold_together),
      cmocka_unit_test(the_stable_step_of_a_pair_is_exact),
      cmocka_unit_test(safe_steps_are_stable_with_damping),
      cmocka_unit_test(safe_steps_content_the_guard),
      cmocka_unit_test(flipping_v_retraces_the_path_if_declared),
      cmocka_unit_test(areas_are_kept_if_declared),
      cmocka_unit_test(steps_take_the_declared_evaluations),
      cmocka_unit_test(a_run_in_pieces_has_the_same_bits),
      cmocka_unit_test(a_plain_run_in_pieces_has_the_same_bits),
      cmocka_unit_test(substeps_are_smaller_iterations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
