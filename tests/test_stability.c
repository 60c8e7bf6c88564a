/* test_stability.c - tries to refute the limits of stability that every integrator of the library
 * declares, and the safe step that a plan makes of them. */
#include "systems.h"

/* ---- Of plain systems */

/* Largest |q|, |v| of the last of `steps` steps of h = 1 from q = v = 1. */
static double grown(const msr_integrator *integrator, const msr_system *system, uint64_t steps) {
  double q = 1, v = 1;
  must(msr_integrate(integrator, system, 0, 1, steps, &q, &v, &why));
  return isfinite(q) && isfinite(v) ? fmax(fabs(q), fabs(v)) : INFINITE;
}

/* Steps that show growth if there is any: an adaptive method takes hundreds in each. */
static uint64_t many(const msr_integrator *integrator) {
  return integrator->adaptive ? 200 : 20000;
}

/* Below the limit by one in a thousand, Verlet swings by 1 / sqrt(1 - 0.999^2) = 22. Above it by
 * one in ten thousand, what grows least is srkn6, by 0.04 % a step: beyond a narrow band it would
 * be stable again. */
static void check_frequency_limit(const msr_integrator *integrator) {
  const double limit = integrator->stability, none[] = {1.5, 0.5, 0.1}, any[] = {1, 30, 600};
  counted c = {.omega = 0.999 * limit};
  const msr_system system = {.n = 1, .self = &c, .acceleration = oscillate};
  for (size_t i = 0; isinf(limit) && i < LENGTH(any); i++) {
    c.omega = any[i];
    assert_true(grown(integrator, &system, many(integrator)) < 1000);
  }
  if (isinf(limit)) return;
  if (limit > 0) assert_true(grown(integrator, &system, 20000) < 100);
  c.omega = 1.0001 * limit;
  if (limit > 0) assert_true(grown(integrator, &system, 100000) > 1e6);
  for (size_t i = 0; limit <= 0 && i < LENGTH(none); i++) {
    c.omega = none[i];
    assert_true(grown(integrator, &system, 20000) > 1e6);
  }
}

static void the_limit_of_frequency_is_sharp(void **state) {
  (void)state;
  on_all(check_frequency_limit);
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

/* A system that slows down, through damp() for what splits, else through a. */
static msr_system slowing(const msr_integrator *integrator, counted *c) {
  const bool splits = integrator->splits;
  return (msr_system){.n = 1,
                      .self = c,
                      .acceleration = splits ? oscillate : oscillate_slowing,
                      .damp = splits ? decay : NULL};
}

/* With hardly a force that depends on q, so that only damping counts: q is 1 + the sum of all v,
 * bounded too. A limit through damp() is that of many springs damped in turn; alone it is higher.
 */
static void check_damping_limit(const msr_integrator *integrator) {
  const double limit = integrator->damping_stability, any[] = {1, 30, 600};
  counted c = {.omega = integrator->splits ? 0.03 : 0, .gamma = 0.999 * limit};
  const msr_system system = slowing(integrator, &c);
  for (size_t i = 0; isinf(limit) && i < LENGTH(any); i++) {
    c.gamma = any[i];
    assert_true(grown(integrator, &system, many(integrator)) < 100);
  }
  if (isinf(limit)) return;
  assert_true(grown(integrator, &system, 20000) < 100);
  c.gamma = (integrator->splits ? 8 : 1.001) * limit;
  assert_true(grown(integrator, &system, 20000) > 1e6);
}

static void the_limit_of_damping_is_sharp(void **state) {
  (void)state;
  on_all(check_damping_limit);
}

/* A method is stable on the segment between its two limits: for any damping if it has no limit of
 * that. */
static void check_both_limits(const msr_integrator *integrator) {
  if (!(integrator->stability > 0)) return;
  for (double part = 0.05; part < 1; part += 0.1) {
    const bool any = isinf(integrator->damping_stability);
    const double limit = isinf(integrator->stability) ? 30 : integrator->stability;
    counted c = {.omega = 0.99 * limit * (any ? 1 : part),
                 .gamma = any ? 10 * part : 0.99 * integrator->damping_stability * (1 - part)};
    const msr_system system = slowing(integrator, &c);
    if (!(grown(integrator, &system, many(integrator)) < 100))
      fail_msg("%s: h omega %g, h gamma %g", integrator->name, c.omega, c.gamma);
  }
}

static void both_limits_hold_together(void **state) {
  (void)state;
  on_all(check_both_limits);
}

/* ---- Of scenes */

/* Two masses on a spring, omega^2 = 2 k / m: the plan's bound is their frequency itself. */
static void check_plan_limit(const msr_integrator *integrator) {
  msr_scene *scene = empty_scene(0.01);
  for (int i = 0; i < 2; i++) add_mass(scene, i, 0, 0, 0, 0.5);
  must(msr_scene_add_spring(scene, 0, 1, 400, 1, &why));
  world w = open_world(scene, integrator, 1);
  const msr_plan_figures f = msr_plan_describe(w.plan);
  assert_true(fabs(f.omega - 40) < 40 * 4 * DBL_EPSILON);
  const double limit = integrator->stability / 40;
  assert_true(f.stable_step == limit || fabs(f.stable_step - limit) <= 4 * DBL_EPSILON);
  close_world(w);
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
  if (rate > 0) add_force(scene, brake, &c);
  return open_world(scene, integrator, 1);
}

/* At the library's own largest step, where the bound of frequencies is sharp, nothing runs away and
 * the guard is content. Symplectic Euler's energy swings most, by 1.9 / 0.1 = 19. Where any step is
 * safe it is 0.1 s, or 4 / omega. */
static void check_safe_step(const msr_integrator *integrator, const msr_force *brake, double rate) {
  world any = swinging(integrator, 1, 0, brake, rate);
  const double safe = msr_plan_describe(any.plan).safe_step, dt = isinf(safe) ? 0.1 : safe;
  close_world(any);
  for (double phase = 0; phase < 3.1; phase += 0.2) {
    world w = swinging(integrator, dt, phase, brake, rate);
    const double e0 = msr_state_energy(w.state).total;
    if (msr_state_step(w.state, integrator->adaptive ? 10 : 1000, &why) != MSR_OK)
      fail_msg("%s, %s %g omega: %s", integrator->name, brake->name, rate, why.message);
    assert_true(msr_state_energy(w.state).total < 20 * e0);
    close_world(w);
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

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_limit_of_frequency_is_sharp),
      cmocka_unit_test(the_limit_of_damping_is_sharp),
      cmocka_unit_test(both_limits_hold_together),
      cmocka_unit_test(the_stable_step_of_a_pair_is_exact),
      cmocka_unit_test(safe_steps_are_stable_with_damping),
      cmocka_unit_test(safe_steps_content_the_guard),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
