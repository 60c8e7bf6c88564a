/* test_integrators.c - tries to refute what every integrator of the library declares: its order, on
 * plain systems with known solutions and on lattices with every kind of force, or, if it's
 * adaptive, that errors keep to the tolerance; reversibility; symplecticity; evaluations. */
#include "systems.h"

#include <gsl/gsl_sf_elljac.h>

/* ---- Plain systems */

static msr_status swing(void *self, double t, const double *q, const double *v, double *a) {
  (void)self, (void)t, (void)v;
  a[0] = -sin(q[0]);
  return MSR_OK;
}

static msr_status shaken(void *self, double t, const double *q, const double *v, double *a) {
  (void)self, (void)v;
  a[0] = -q[0] + sin(2 * t);
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

/* The order of errors[levels] at 1/h = steps[levels]: at the smallest two that rounding leaves
 * alone. */
static double order_of(size_t levels, const double *errors, const uint64_t *steps,
                       double rounding) {
  size_t last = levels - 1;
  while (last > 1 && errors[last] < rounding) last--;
  return log(errors[last - 1] / errors[last]) / log((double)steps[last] / (double)steps[last - 1]);
}

/* The largest error at t = 1, 2, 3, 4, by so many steps each: at a single time the leading
 * term may vanish, and at a period does for a method that is conjugate to one of higher order. */
static double plain_error(const msr_integrator *integrator, const struct plain *p, uint64_t steps,
                          double atol) {
  counted c = {.omega = 1};
  msr_system system = system_of(p, &c);
  system.atol = atol;
  double exact[4], z[4], most = 0;
  p->solution(0, z);
  for (int t = 0; t < 4; t++) {
    const double h = 1 / (double)steps;
    const msr_status status =
        msr_integrate(integrator, &system, t, h, steps, z, z + system.n, &why);
    if (status == MSR_EUNSTABLE && integrator->implicit) return INFINITE; /* too large a step */
    must(status);
    p->solution(t + 1, exact);
    most = fmax(most, distance(2 * system.n, z, exact));
  }
  return most;
}

/* At order 8 only few steps lie between too large a step and rounding. */
static void check_plain_order(const msr_integrator *integrator) {
  if (integrator->adaptive) return;
  static const uint64_t steps[] = {2, 3, 4, 5, 7, 10, 14, 20, 28, 40, 56, 80, 160, 320, 640, 1280};
  for (size_t p = 0; p < LENGTH(plains); p++) {
    double errors[LENGTH(steps)];
    for (size_t level = 0; level < LENGTH(steps); level++)
      errors[level] = plain_error(integrator, &plains[p], steps[level], 0);
    const double order = order_of(LENGTH(steps), errors, steps, 1e-11);
    if (!(fabs(order - integrator->order) < 0.1))
      fail_msg("%s, %s: order %g", integrator->name, plains[p].name, order);
  }
}

static void plain_systems_show_the_declared_order(void **state) {
  (void)state;
  on_all(check_plain_order);
}

/* ---- Order on lattices */

/* Does a force depend on v, and is it without a flow of its own? */
static bool without_a_flow(const struct medium *m) {
  for (size_t f = 0; f < MOST_FORCES && m->force[f]; f++)
    if (m->force[f]->uses_velocity && !m->force[f]->flow) return true;
  return false;
}

/* Without a flow the midpoint rule stands in for it: order 2 for what splits. */
static int expected_order(const msr_integrator *integrator, const struct medium *m) {
  bool uses_velocity = false;
  for (size_t f = 0; f < MOST_FORCES && m->force[f]; f++)
    uses_velocity |= m->force[f]->uses_velocity;
  if (integrator->splits && without_a_flow(m)) return integrator->order < 2 ? 1 : 2;
  return uses_velocity && integrator->damped_order ? integrator->damped_order : integrator->order;
}

enum { DIGITS = 4 * MASSES };

static void settle(const struct medium *m, const msr_plan_options *options, double *z) {
  world w = deformed_with(m, 1, options);
  advance(&w, 1);
  read_world(&w, z);
  close_world(w);
}

/* After 1 s by steps from omega h = 0.7 on. */
static void check_medium_order(const msr_integrator *integrator, const struct medium *m,
                               int declared, const double *truth) {
  static const uint64_t steps[] = {30, 40, 60, 80, 120, 160, 320, 640, 1280, 2560};
  double z[DIGITS], errors[LENGTH(steps)];
  for (size_t level = 0; level < LENGTH(steps); level++) {
    settle(m, &(msr_plan_options){.integrator = integrator, .substeps = steps[level]}, z);
    errors[level] = distance(DIGITS, z, truth);
  }
  const double order = order_of(LENGTH(steps), errors, steps, 1e-10);
  const bool more = order > declared && integrator->splits && without_a_flow(m);
  if (!(fabs(order - declared) < 0.1 || more))
    fail_msg("%s, %s: order %g", integrator->name, m->name, order);
}

/* Kahan and Li's method of order 8, whose own error is rounding. */
static const msr_plan_options truest = {.integrator = &msr_integrator_kahan_li_8, .substeps = 4096};

static void lattices_show_the_declared_order(void **state) {
  (void)state;
  double truth[DIGITS];
  for (const struct medium *m = media; m < media + LENGTH(media); m++) {
    settle(m, &truest, truth);
    for (const msr_integrator *const *i = msr_integrators; *i; i++)
      if (!(*i)->adaptive) check_medium_order(*i, m, expected_order(*i, m), truth);
  }
}

/* ---- Errors of adaptive methods */

/* Errors of up to atol in each of some tens of steps: measured, up to 0.9 times atol with rk8pd, 11
 * with rkf45 and rkck, 21 with msadams. */
static const double most_errors = 40;

static void check_plain_tolerance(const msr_integrator *integrator) {
  if (!integrator->adaptive) return;
  for (size_t p = 0; p < LENGTH(plains); p++)
    for (double atol = 1e-3; atol > 1e-11; atol /= 4) {
      const double error = plain_error(integrator, &plains[p], 1, atol);
      if (!(error < most_errors * atol))
        fail_msg("%s, %s: error %g at atol %g", integrator->name, plains[p].name, error, atol);
    }
}

/* In one iteration of 1 s. */
static void check_medium_tolerance(const msr_integrator *integrator, const struct medium *m,
                                   const double *truth) {
  for (double atol = 1e-3; atol > 1e-11; atol /= 10) {
    double z[DIGITS];
    settle(m, &(msr_plan_options){.integrator = integrator, .atol = atol}, z);
    const double error = distance(DIGITS, z, truth);
    if (!(error < most_errors * atol))
      fail_msg("%s, %s: error %g at atol %g", integrator->name, m->name, error, atol);
  }
}

static void errors_are_proportional_to_the_tolerance(void **state) {
  (void)state;
  double truth[DIGITS];
  on_all(check_plain_tolerance);
  for (const struct medium *m = media; m < media + LENGTH(media); m++) {
    settle(m, &truest, truth);
    for (const msr_integrator *const *i = msr_integrators; *i; i++)
      if ((*i)->adaptive) check_medium_tolerance(*i, m, truth);
  }
}

/* ---- A composition of one's own */

static msr_status begin_jumps(const msr_integrator *self, const msr_system *system, double t,
                              const double *q, const double *v, msr_workspace *work) {
  (void)self;
  return msr_integrator_verlet.begin(&msr_integrator_verlet, system, t, q, v, work);
}

/* Verlet thrice: forward beyond the end, back to before the start, and to the end. */
static msr_status jump(const msr_integrator *self, const msr_system *system,
                       const msr_interval *interval, double *q, double *v, msr_workspace *work,
                       msr_error *err) {
  (void)self;
  const double forward = 1 / (2 - cbrt(2)), at[] = {0, forward, 1 - forward, 1};
  msr_status status = MSR_OK;
  for (int n = 0; n < 3 && status == MSR_OK; n++) {
    const msr_interval part = {msr_interval_time(interval, at[n]),
                               (at[n + 1] - at[n]) * interval->h,
                               msr_interval_time(interval, at[n + 1])};
    status = msr_integrator_verlet.step(&msr_integrator_verlet, system, &part, q, v, work, err);
  }
  return status;
}

static const msr_integrator triple_jump = {.name = "triple-jump",
                                           .summary = "Verlet thrice",
                                           .reference = "Yoshida 1990, Phys. Lett. A 150, 262",
                                           .order = 4,
                                           .symplectic = true,
                                           .reversible = true,
                                           .splits = true,
                                           .evaluations = 3,
                                           .stability = 1.573,
                                           .damping_stability = 1,
                                           .vectors = 1,
                                           .begin = begin_jumps,
                                           .step = jump};

/* Forces that depend on t are asked for outside of the step, and the order is 4 all the same. */
static void a_composition_beyond_the_step_keeps_its_order(void **state) {
  (void)state;
  check_plain_order(&triple_jump);
  for (size_t m = 0; m < LENGTH(media); m++) {
    if (media[m].force[0] != &tide) continue;
    double truth[DIGITS];
    settle(&media[m], &truest, truth);
    check_medium_order(&triple_jump, &media[m], 4, truth);
  }
}

/* What t + c h gives, except at 1: there it's the end, which t + h is not here. */
static void stages_are_at_t_plus_c_h(void **state) {
  (void)state;
  const msr_interval interval = {0.1, 0.2, 0.3};
  const double shares[] = {0, 0.5, 0.999, 1.001, 1.35, 2, -0.35, -1};
  assert_true(0.1 + 0.2 > 0.3);
  assert_true(msr_interval_time(&interval, 1) == 0.3);
  for (size_t n = 0; n < LENGTH(shares); n++)
    assert_true(msr_interval_time(&interval, shares[n]) == 0.1 + shares[n] * 0.2);
}

/* Steps of length 0 leave all as it is; what isn't finite is refused. */
static void check_odd_steps(const msr_integrator *integrator) {
  counted c = {.omega = 1};
  const msr_system system = system_of(&plains[1], &c);
  const double odd[] = {INFINITE, -INFINITE, (double)NAN};
  double z[2] = {0.3, -0.2};
  must(msr_integrate(integrator, &system, 0, 0, 3, z, z + 1, &why));
  for (size_t i = 0; i < LENGTH(odd); i++) {
    assert_int_equal(msr_integrate(integrator, &system, 0, odd[i], 1, z, z + 1, NULL), MSR_EUSAGE);
    assert_int_equal(msr_integrate(integrator, &system, odd[i], 1, 1, z, z + 1, NULL), MSR_EUSAGE);
  }
  assert_true(z[0] == 0.3 && z[1] == -0.2);
}

static void odd_steps_do_nothing(void **state) {
  (void)state;
  on_all(check_odd_steps);
}

/* ---- Reversibility */

static void flip(size_t n, double *v) {
  for (size_t i = 0; i < n; i++) v[i] = -v[i];
}

/* There and back in `steps` steps each way leaves rounding alone, eps times what an error at the
 * start may have become, less than 1000 here; or, if it isn't declared, clearly more. */
static void check_return(const msr_integrator *integrator, uint64_t steps, double error) {
  if (integrator->adaptive && !integrator->reversible)
    return; /* its errors are as small as asked */
  const double rounding = 1000 * (double)steps * DBL_EPSILON;
  if (integrator->reversible ? !(error < rounding) : !(error > 100 * rounding))
    fail_msg("%s comes back with %g", integrator->name, error);
}

/* A step may be too large for its equations to have a solution, where nothing is to be shown. */
static void go_plainly(const msr_integrator *integrator, const msr_system *system, uint64_t steps,
                       double *z) {
  const msr_status status =
      msr_integrate(integrator, system, 0, 0.1, steps, z, z + system->n, &why);
  if (status != MSR_EUNSTABLE || !integrator->implicit || integrator->reversible) must(status);
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
      go_plainly(integrator, &system, steps, z);
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
  close_world(w);
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
  if (integrator->adaptive && !integrator->symplectic) return;
  const bool midpoint = integrator->conservative; /* of a quadratic: the midpoint rule is both */
  if (integrator->symplectic || midpoint ? !(error < rounding) : !(error > 1e6 * rounding))
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
  close_world(w);
  if (integrator->adaptive && !integrator->symplectic) return;
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
  close_world(w);
  return calls;
}

/* Beyond those of begin(). */
static void check_evaluations(const msr_integrator *integrator) {
  if (integrator->evaluations == 0) return; /* as many as it takes */
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

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(plain_systems_show_the_declared_order),
      cmocka_unit_test(lattices_show_the_declared_order),
      cmocka_unit_test(errors_are_proportional_to_the_tolerance),
      cmocka_unit_test(a_composition_beyond_the_step_keeps_its_order),
      cmocka_unit_test(stages_are_at_t_plus_c_h),
      cmocka_unit_test(odd_steps_do_nothing),
      cmocka_unit_test(flipping_v_retraces_the_path_if_declared),
      cmocka_unit_test(areas_are_kept_if_declared),
      cmocka_unit_test(steps_take_the_declared_evaluations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
