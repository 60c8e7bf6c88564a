/* test_advice.c - what the guard says of an explosion: the mass, the spring, the moment, and a step
 * that works; and that numbers at the ends of their range are told for what they are. */
#include "art.h"

/* ---- Many explosions, and what each is told to do */

static const char flag[] = "....................\n"
                           "#ooooooooo..........\n"
                           "#ooooooooo..........\n"
                           "#ooooooooo..........\n"
                           "#...................\n";

static const char drop[] = "..........\n"
                           ".oooooooo.\n"
                           ".oooooooo.\n"
                           ".oooooooo.\n"
                           "..........\n"
                           "..........\n"
                           "..#...#...\n"
                           "##########\n";

typedef struct trouble {
  const char *art;
  double k, m, g;
  int neighbours;
  bool attach, closed;
  double damping, drag, wind, push;
} trouble;

static const trouble troubles[] = {
    {.art = pegs, .k = 1500, .m = 0.1, .g = 9.8, .neighbours = 4},
    {.art = pegs, .k = 1500, .m = 0.1, .g = 9.8, .neighbours = 8, .closed = true},
    {.art = drop, .k = 1500, .m = 0.1, .g = 500, .neighbours = 8},
    {.art = drop, .k = 150, .m = 0.1, .g = 1000, .neighbours = 4},
    {.art = drop, .k = 1e6, .m = 1e-3, .g = 9.8, .neighbours = 4},
    {.art = drop, .k = 1500, .m = 1e3, .g = -200, .neighbours = 4, .closed = true},
    {.art = drop, .k = 1500, .m = 0.1, .g = 9.8, .neighbours = 4, .damping = 2},
    {.art = drop, .k = 1500, .m = 0.1, .g = 9.8, .neighbours = 8, .closed = true, .damping = 50},
    {.art = drop, .k = 1500, .m = 0.1, .g = 9.8, .neighbours = 4, .drag = 1},
    {.art = drop, .k = 1500, .m = 0.1, .g = 9.8, .neighbours = 4, .closed = true, .push = 300},
    {.art = flag, .k = 1500, .m = 0.1, .g = 9.8, .neighbours = 4, .attach = true, .wind = 40},
    {.art = flag, .k = 1500, .m = 0.1, .g = 98, .neighbours = 8, .attach = true},
};

static msr_scene *make(const trouble *t, double dt) {
  const msr_conf conf = {dt, t->g, t->m, t->k, 1, 1};
  msr_scene *scene =
      scene_of(t->art, &conf, &(msr_scene_options){t->neighbours, t->attach, t->closed});
  if (t->damping > 0) add_force(scene, &msr_force_damping, &(msr_damping){t->damping});
  if (t->drag > 0) add_force(scene, &msr_force_drag, &(msr_drag){t->drag});
  if (t->wind > 0)
    add_force(scene, &msr_force_wind,
              &(msr_wind){.c = 0.1, .speed = t->wind, .gust = 10, .seed = 3});
  if (t->push > 0) add_force(scene, &msr_force_push, &(msr_push){1, t->push, t->push});
  return scene;
}

/* What a safe step may heat at most, where springs are crushed: a few per cent are usual. */
static const double most_gain = 0.2;

/* Does it come through? Its energy grew by `gain` of what there was to give. */
static bool survives(const trouble *t, const msr_integrator *method, double dt, double substeps,
                     double *gain, msr_error *err) {
  const double seconds = 5;
  world w = open_world(make(t, dt), method, (uint64_t)substeps);
  const msr_status status = msr_state_step(w.state, (uint64_t)ceil(fmin(seconds / dt, 5000)), err);
  if (status != MSR_OK) assert_int_equal(status, MSR_EUNSTABLE);
  *gain = msr_state_energy_gain(w.state);
  close_world(w);
  return status == MSR_OK;
}

/* Twice; `times` the limit (of Verlet, where there is none). */
static bool follow_advice(const trouble *t, const msr_integrator *method, double times) {
  world w = open_world(make(t, 1), method, 1);
  const msr_plan_figures f = msr_plan_describe(w.plan);
  close_world(w);
  const double dt = times * (f.stable_step > 0 ? f.stable_step : 2 / f.omega);
  msr_error err, again = {.message = "it heats"};
  double gain = 0, more = 0;
  if (survives(t, method, dt, 1, &gain, &err)) return false;
  assert_non_null(strstr(err.message, "the mass of pixel ("));
  assert_non_null(strstr(err.message, "; its spring to "));
  assert_true(strlen(err.message) < MSR_MESSAGE_SIZE - 1);
  const double advised = number_after(err.message, "DT "),
               substeps = number_after(err.message, ", or ");
  if (strstr(err.message, "; use verlet: ")) method = &msr_integrator_verlet;
  if (!survives(t, method, advised, 1, &gain, &again) ||
      !survives(t, method, dt, substeps, &more, &again) || fmax(gain, more) > most_gain)
    fail_msg("%s, %s: %s (%g, %g)", method->name, err.message, again.message, gain, more);
  return true;
}

/* From what heats, below the limit, to 10^4 times the limit. */
static void what_is_advised_works(void **unused) {
  (void)unused;
  static const msr_integrator *const all[] = {&msr_integrator_verlet,
                                              &msr_integrator_symplectic_euler, &msr_integrator_rk4,
                                              &msr_integrator_pefrl, &msr_integrator_euler};
  static const double times[] = {0.7, 0.9, 1.1, 1.6, 10, 1e4};
  int told = 0;
  for (size_t t = 0; t < LENGTH(troubles); t++)
    for (size_t m = 0; m < LENGTH(all); m++)
      for (size_t i = 0; i < LENGTH(times); i++)
        told += follow_advice(&troubles[t], all[m], times[i]);
  assert_true(told > 100);
}

/* The spring that is named is the longest, by its rest length, of the mass that is named; told
 * within an iteration of many steps, and while there are numbers, however fast it goes. */
static void the_spring_and_the_moment_are_named(void **unused) {
  (void)unused;
  msr_conf conf = weightless;
  conf.dt = 100;
  world w =
      open_world(scene_of("#oooo\n", &conf, &(msr_scene_options){.attach = true}), NULL, 10000);
  const msr_arrays a = msr_state_edit(w.state);
  a.x[2] += 0.5;
  a.vy[2] = 1;
  msr_error err;
  assert_int_equal(msr_state_step(w.state, 1, &err), MSR_EUNSTABLE);
  assert_int_equal(msr_state_iteration(w.state), 0);
  assert_true(number_after(err.message, "t = ") <= 0.01 * 128);
  assert_non_null(strstr(err.message, "times the energy that the scene had to give"));
  close_world(w);
  w = open_world(scene_of("#oooo\n", &weightless, &(msr_scene_options){.attach = true}), NULL, 1);
  const msr_arrays b = msr_state_edit(w.state);
  for (size_t i = 0; i < 4; i++) b.vy[i] = i == 2 ? 1e200 : 0;
  b.x[2] += 0.5;
  assert_int_equal(msr_state_check(w.state, &err), MSR_EUNSTABLE);
  assert_non_null(strstr(err.message, "the mass of pixel (3,0) goes at 1e+200 px/s"));
  assert_non_null(strstr(err.message, "its spring to pixel (2,0) is 1.5 times its rest length"));
  b.vy[2] = 0, b.vy[0] = 1e200, b.x[0] = 9.5;
  assert_int_equal(msr_state_check(w.state, &err), MSR_EUNSTABLE);
  assert_non_null(strstr(err.message, "its spring to the fixed point (0.5,0.5) is 9 times"));
  close_world(w);
}

/* ---- Numbers at the ends of their range */

static msr_status run_of(double k, double m, double g, double dt, msr_error *err) {
  const msr_conf conf = {dt, g, m, k, 300, 3};
  msr_scene *scene = scene_of("ooo\nooo\n...\n###\n", &conf, NULL);
  msr_plan *plan;
  msr_state *state;
  msr_status status = msr_plan_create(scene, NULL, &plan, err);
  msr_scene_free(scene);
  if (status != MSR_OK) return status;
  must(msr_state_create(plan, &state, &why));
  status = msr_run(state, NULL, err);
  const msr_view s = msr_state_view(state);
  for (size_t i = 0; i < s.n && status == MSR_OK; i++)
    assert_true(isfinite(s.x[i]) && isfinite(s.y[i]) && isfinite(s.vx[i]) && isfinite(s.vy[i]));
  msr_state_free(state);
  msr_plan_free(plan);
  return status;
}

/* Either sound or an error that says which number: never one that blames a step that is stable, and
 * sound where k / m and g are ordinary, whatever the unit of mass. */
static void ends_of_the_range(void **unused) {
  (void)unused;
  static const double sizes[] = {5e-324, 1e-310, 1e-300, 1e-150, 1, 1e150, 1e300, DBL_MAX};
  static const double weights[] = {0, 1e-300, 9.8, 1e150, 1e300, -DBL_MAX};
  msr_error err;
  for (size_t i = 0; i < LENGTH(sizes); i++)
    for (size_t j = 0; j < LENGTH(sizes); j++)
      for (size_t g = 0; g < LENGTH(weights); g++) {
        const double k = sizes[i], m = sizes[j], omega = sqrt(k) / sqrt(m);
        const double dt = fmin(0.005, 0.1 / omega);
        if (dt == 0) continue;
        err.message[0] = '\0';
        const msr_status status = run_of(k, m, weights[g], dt, &err);
        const bool numbers = strstr(err.message, "range of numbers") ||
                             strstr(err.message, "too small to divide by");
        if (m < 1e-309) assert_non_null(strstr(err.message, "too small to divide by"));
        const bool value = strstr(err.message, "a value that is too large");
        if (status != MSR_OK && !numbers && !value)
          fail_msg("k %g, m %g, g %g: %d %s", k, m, weights[g], status, err.message);
      }
  for (double m = 1e-307; m < 1e291; m *= 1e10) must(run_of(15000 * m, m, 9.8, 0.001, &why));
  /* Energies of few digits, or of none. */
  for (double g = 1; g > 1e-16; g /= 3) must(run_of(0, 1e-307, g, 0.005, &why));
}

/* Far apart in mass, and sound: a mass of 1e300 kg beside a stiff pair of 1e-5 kg. */
static void a_star_and_a_pair(void **unused) {
  (void)unused;
  msr_scene *scene = empty_scene(1e-14);
  must(msr_scene_set_times(scene, 1e-14, 1000, 1, &why));
  add_mass(scene, 0, 0, 0, 0, 1e300);
  add_mass(scene, 5, 0, 0, 0, 1e-5);
  add_mass(scene, 6, 0, 1, 0, 1e-5);
  must(msr_scene_add_spring(scene, 1, 2, 1e20, 1, &why));
  world w = open_world(scene, NULL, 1);
  must(msr_run(w.state, NULL, &why));
  close_world(w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_is_advised_works),
      cmocka_unit_test(the_spring_and_the_moment_are_named),
      cmocka_unit_test(ends_of_the_range),
      cmocka_unit_test(a_star_and_a_pair),
  };
  return cmocka_run_group_tests_name("advice", tests, NULL, NULL);
}
