/* test_costs.c - what steps is an effect, too; what the plan says that each takes is what it takes;
 * times are of each effect alone, and nothing but them changes. */
#include "art.h"

#include <time.h>

static const msr_effect *find(const world *w, const char *name, size_t *number) {
  size_t n, e = 0;
  const msr_effect *all = msr_plan_effects(w->plan, &n);
  while (e < n && strcmp(all[e].name, name) != 0) e++;
  if (e == n) fail_msg("no effect %s", name);
  if (number) *number = e;
  return &all[e];
}

/* ---- What steps */

static const char block[] = "........\n..ooo...\n..ooo...\n........\n........\n########\n";
static const char free_block[] = "........\n..ooo...\n..ooo...\n........\n";

static msr_scene *floor_below(void) { return scene_of(block, &example, NULL); }
static msr_scene *nothing_below(void) { return scene_of(free_block, &weightless, NULL); }
static msr_scene *one_mass(void) { return scene_of("o\n", &weightless, NULL); }
static msr_scene *no_mass(void) { return scene_of("#\n", &weightless, NULL); }

static msr_scene *stiff(void) {
  msr_conf conf = weightless;
  conf.stiffness = 1e10;
  return scene_of(free_block, &conf, NULL);
}

static msr_scene *colliding(void) {
  msr_scene *scene = nothing_below();
  must(msr_scene_set_collisions(scene, 0.5, &why));
  return scene;
}

static void steps_say_why(void **unused) {
  (void)unused;
  static const struct {
    msr_scene *(*scene)(void);
    msr_plan_options options;
    const char *name;
    bool on;
    const char *reason;
  } cases[] = {
      {nothing_below, {0}, "integrator", true, "verlet, the default: order 2"},
      {nothing_below,
       {.integrator = &msr_integrator_rk4},
       "integrator",
       true,
       "rk4, asked for: order 4"},
      {no_mass, {0}, "integrator", false, "there is no mass"},
      {no_mass, {0}, "guard", false, "there is no mass"},
      {no_mass, {0}, "leaps", false, "there is no mass"},
      {no_mass, {0}, "care", false, "there is no mass"},
      {nothing_below,
       {0},
       "guard",
       true,
       "always: stops what is unstable; speeds every 64 steps, energies every 256 steps"},
      {nothing_below,
       {.integrator = &msr_integrator_pefrl},
       "guard",
       true,
       "always: stops what is unstable; speeds every 13 steps, energies every 256 steps"},
      {nothing_below,
       {.integrator = &msr_integrator_rk4},
       "guard",
       true,
       "always: stops what is unstable; speeds every 16 steps, energies every 256 steps"},
      {stiff,
       {0},
       "leaps",
       true,
       "an iteration takes 2152 substeps: energy-momentum, implicit, wherever cheaper"},
      {nothing_below, {0}, "leaps", false, "an iteration takes 1 substep: too few for it to pay"},
      {nothing_below,
       {.integrator = &msr_integrator_verlet},
       "leaps",
       false,
       "an integrator was asked for"},
      {nothing_below, {.substeps = 2}, "care", false, "a number of substeps was asked for"},
      {colliding, {0}, "care", false, "masses collide"},
      {floor_below, {.impacts = MSR_IMPACTS_LOCATED}, "leaps", false, "impacts are located"},
      {one_mass, {0}, "care", false, "there is no spring"},
      {nothing_below,
       {0},
       "care",
       true,
       "energy-momentum takes over should energy come from nowhere"},
  };
  for (size_t i = 0; i < LENGTH(cases); i++) {
    const world w = open_world_with(cases[i].scene(), &cases[i].options);
    const msr_effect *effect = find(&w, cases[i].name, NULL);
    assert_string_equal(effect->reason, cases[i].reason);
    assert_int_equal(effect->on, cases[i].on);
    assert_int_equal(effect->role, MSR_ROLE_STEP);
    close_world(w);
  }
}

/* ---- What the plan foretells */

/* All that forces and contacts can be, in air that the block doesn't leave. */
static msr_scene *with_all(bool collide) {
  msr_scene *scene = scene_of(block, &example, &(msr_scene_options){.closed_border = true});
  add_force(scene, &msr_force_push, &(msr_push){0, 1, 1});
  add_force(scene, &msr_force_drag, &(msr_drag){0.1});
  add_force(scene, &msr_force_damping, &(msr_damping){0.1});
  add_force(scene, &msr_force_wind, &(msr_wind){.speed = 1, .gust = 1});
  if (collide) must(msr_scene_set_collisions(scene, 0.5, &why));
  return scene;
}

/* Looks come at numbers of steps of their own: one may be missing or beyond. */
static double slack(const msr_effect *effect) {
  return effect->role == MSR_ROLE_STEP && strcmp(effect->name, "integrator") != 0 ? 2 : 0;
}

/* `more`: evaluations of forces that a call of msr_state_step takes beside those of its steps. */
static void check_calls(msr_scene *scene, const msr_plan_options *options, uint64_t iterations,
                        int more) {
  const world w = open_world_with(scene, options);
  size_t n;
  const msr_effect *effect = msr_plan_effects(w.plan, &n);
  uint64_t before[32];
  must(msr_state_step(w.state, 1, &why)); // the first evaluation is beside the steps
  for (size_t e = 0; e < n; e++) before[e] = msr_state_calls(w.state, e);
  must(msr_state_step(w.state, iterations, &why));
  const double steps = (double)iterations * (double)msr_plan_describe(w.plan).substeps;
  assert_int_equal(msr_state_contacts(w.state), 0);
  for (size_t e = 0; e < n; e++) {
    const double calls = (double)(msr_state_calls(w.state, e) - before[e]);
    const bool is_forces = effect[e].force && !effect[e].force->uses_velocity && effect[e].on;
    const double due = effect[e].cost.calls * steps + (is_forces ? more : 0);
    if (isnan(due) ? !(calls > 0) : !(fabs(calls - due) <= slack(&effect[e])))
      fail_msg("%s, %s: %g calls, %g foretold", msr_plan_describe(w.plan).integrator->name,
               effect[e].name, calls, due);
  }
  close_world(w);
}

static void calls_are_foretold(void **unused) {
  (void)unused;
  for (const msr_integrator *const *i = msr_integrators; *i; i++) {
    check_calls(with_all(false), &(msr_plan_options){.integrator = *i, .substeps = 8}, 40, 0);
    check_calls(with_all(true), &(msr_plan_options){.integrator = *i, .substeps = 8}, 40, 0);
  }
  check_calls(nothing_below(), NULL, 40, 1); // leaps and care are not asked of it within 40 steps
}

static msr_scene *in_air(msr_scene *scene) {
  add_force(scene, &msr_force_drag, &(msr_drag){0.1});
  return scene;
}

/* Row by row the end of a call's last step is by itself, and evaluates where it kicks. 24
 * steps are in one stretch: no look of the guard is among them. */
static void row_by_row_a_call_evaluates_once_more(void **unused) {
  (void)unused;
  for (const msr_integrator *const *i = msr_integrators; *i; i++) {
    const bool kicks = *i != &msr_integrator_symplectic_euler && *i != &msr_integrator_pefrl;
    const msr_plan_options options = {.integrator = *i, .substeps = 8};
    check_calls(in_air(nothing_below()), &options, 3, (*i)->splits && kicks);
    check_calls(in_air(floor_below()), &options, 3, (*i)->splits && (*i)->bounces);
  }
}

typedef struct due {
  const char *name;
  double calls, operations, bytes;
  bool at_least;
} due;

static void check_costs(msr_scene *scene, const msr_integrator *integrator, size_t n,
                        const due *row) {
  const world w = open_world(scene, integrator, 1);
  for (size_t i = 0; i < n; i++) {
    const msr_cost *cost = &find(&w, row[i].name, NULL)->cost;
    const double eps = 8 * DBL_EPSILON;
    assert_true(fabs(cost->calls - row[i].calls) <= eps * row[i].calls);
    assert_true(fabs(cost->operations - row[i].operations) <= eps * row[i].operations);
    assert_true(fabs(cost->bytes - row[i].bytes) <= eps * row[i].bytes);
    assert_int_equal(cost->at_least, row[i].at_least);
  }
  close_world(w);
}

/* What can be counted by hand, of 6 masses and 7 springs. */
static void operations_are_those_of_the_loops(void **unused) {
  (void)unused;
  static const due all[] = {
      {"springs", 1, 15 * 7 / 6.0, 48, false},
      {"gravity", 1, 1, 16, false},
      {"push", 1, 2 / 6.0, 32 / 6.0, false},
      {"drag", 2, 2 * 2, 2 * 32, false},
      {"damping", 2, 2 * 21 * 7 / 6.0, 2 * 48, false},
      {"wind", 2, 2 * 4, 2 * 32, false},
      {"supports", 1, 4, 48, true},
      {"border", 1, 0, 0, true},
      {"integrator", 1, 10, 144, false},
      {"guard", 1 + 1 / 16.0 + 1 / 256.0, 4 / 16.0 + (8 + 9 * 7 / 6.0) / 256, 1 + 48 / 256.0,
       false},
      {"leaps", 0, 0, 0, false},
      {"collisions", 0, 0, 0, false},
  };
  check_costs(with_all(false), NULL, LENGTH(all), all);
}

/* Row by row, where forces, kicks and drift are one loop. PEFRL has five drifts in a step, four
 * evaluations and, with air at its ends, five. */
static void so_they_are_row_by_row(void **unused) {
  (void)unused;
  static const due past_supports[] = {
      {"springs", 1, 15 * 7 / 6.0, 64, false},
      {"gravity", 1, 2, 0, false},
      {"drag", 2, 4, 0, false},
      {"supports", 1, 4, 48, true},
      {"integrator", 1, 10, 48, false},
  };
  static const due alone[] = {{"springs", 4, 4 * 15 * 7 / 6.0, 4 * 64, false},
                              {"integrator", 1, 4 * 14 + 4, 4 * 64 + 48, false}};
  static const due air[] = {{"springs", 4, 4 * 15 * 7 / 6.0, 4 * 64, false},
                            {"drag", 2, 4, 32, false},
                            {"integrator", 1, 4 * 14 + 4, 4 * 64 + 48, false}};
  static const due diagonal[] = {{"springs", 1, 15 * 11 / 6.0, 144, false}};
  const msr_scene_options eight = {.neighbours = 8};
  check_costs(in_air(floor_below()), NULL, LENGTH(past_supports), past_supports);
  check_costs(nothing_below(), &msr_integrator_pefrl, LENGTH(alone), alone);
  check_costs(in_air(nothing_below()), &msr_integrator_pefrl, LENGTH(air), air);
  check_costs(scene_of(free_block, &weightless, &eight), NULL, LENGTH(diagonal), diagonal);
}

/* What a method chooses by itself, and forces that don't tell, have no number. */
static void what_nobody_knows_is_no_number(void **unused) {
  (void)unused;
  const msr_integrator *const methods[] = {&msr_integrator_rkf45, &msr_integrator_sdirk2};
  for (size_t i = 0; i < LENGTH(methods); i++) {
    const world w = open_world(with_all(true), methods[i], 1);
    const char *const names[] = {"springs", "drag", "supports", "collisions", "integrator"};
    for (size_t n = 0; n < LENGTH(names); n++)
      assert_true(isnan(find(&w, names[n], NULL)->cost.operations));
    close_world(w);
  }
  const world w = open_world(stiff(), NULL, 0);
  assert_true(isnan(find(&w, "leaps", NULL)->cost.calls));
  close_world(w);
}

/* ---- Times */

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static const double pause = 2e-4; /* [s] */

static void spin(void) {
  for (const double start = now(); now() - start < pause;) continue;
}

static msr_status slow_add(const void *self, void *scratch, const msr_view *s, double *fx,
                           double *fy) {
  (void)self, (void)scratch, (void)s, (void)fx, (void)fy;
  spin();
  return MSR_OK;
}

static msr_status slow_poll(void *data, const msr_state *state) {
  (void)state;
  ++*(int *)data;
  spin();
  return MSR_OK;
}

static const msr_force slow = {.name = "slow", .summary = "takes its time", .add = slow_add};

static double sum_of_seconds(const world *w) {
  size_t n;
  double sum = 0;
  msr_plan_effects(w->plan, &n);
  for (size_t e = 0; e < n; e++) sum += msr_state_seconds(w->state, e);
  return sum;
}

/* Counted twice, in the integrator or the contact too, its time would be more than all the time
 * that there was; the guard, which asks for it as it drives, has its own. */
static void times_are_of_each_effect_alone(void **unused) {
  (void)unused;
  const msr_integrator *const methods[] = {NULL, &msr_integrator_rk4, &msr_integrator_sdirk2,
                                           &msr_integrator_energy_momentum};
  for (size_t i = 0; i < LENGTH(methods); i++) {
    msr_scene *scene = with_all(false);
    add_force(scene, &slow, NULL);
    const world w =
        open_world_with(scene, &(msr_plan_options){.integrator = methods[i], .timed = true});
    size_t of_slow, of_guard;
    find(&w, "slow", &of_slow);
    find(&w, "guard", &of_guard);
    const double start = now();
    must(msr_state_step(w.state, 5, &why));
    must(msr_state_check(w.state, &why));
    const double wall = now() - start, sum = sum_of_seconds(&w);
    const double least = pause * (double)msr_state_calls(w.state, of_slow);
    assert_true(least > 0 && msr_state_seconds(w.state, of_slow) >= least);
    assert_true(msr_state_seconds(w.state, of_guard) >= 5 * pause);
    assert_true(sum <= wall && sum >= least + 5 * pause);
    close_world(w);
  }
}

static msr_status slow_step(const msr_integrator *self, const msr_system *system,
                            const msr_interval *interval, double *q, double *v, msr_workspace *work,
                            msr_error *err) {
  (void)self, (void)err;
  const msr_status status = system->acceleration(system->self, interval->t, q, v, work->vector);
  spin();
  return status;
}

/* What comes after a force, in the same step, is the integrator's again. */
static void an_integrator_has_what_is_left(void **unused) {
  (void)unused;
  static const msr_integrator slow_steps = {
      .name = "slow", .summary = "stands still", .step = slow_step, .vectors = 1};
  const world w = open_world_with(with_all(false),
                                  &(msr_plan_options){.integrator = &slow_steps, .timed = true});
  size_t integrator;
  find(&w, "integrator", &integrator);
  must(msr_state_step(w.state, 10, &why));
  const double steps = (double)msr_state_calls(w.state, integrator);
  assert_true(steps >= 10 && msr_state_seconds(w.state, integrator) >= steps * pause);
  close_world(w);
}

static void callbacks_are_nobodys(void **unused) {
  (void)unused;
  const msr_integrator *const methods[] = {NULL, &msr_integrator_rk4}; // row by row, and not
  for (size_t i = 0; i < LENGTH(methods); i++) {
    msr_conf conf = example;
    conf.iterations = conf.images = 20; // several steps in a go end at a frame
    const world w = open_world_with(scene_of(block, &conf, NULL),
                                    &(msr_plan_options){.integrator = methods[i], .timed = true});
    int polls = 0;
    const msr_run_options options = {.poll = slow_poll, .data = &polls};
    const double start = now();
    must(msr_run(w.state, &options, &why));
    assert_true(polls >= 19);
    assert_true(sum_of_seconds(&w) <= now() - start - polls * pause);
    close_world(w);
  }
}

/* What is on takes time, what is off none; untimed, nothing does, and all bits are the same. Row by
 * row a weight may take none: it's added while springs are divided. */
static void check_times(const msr_integrator *integrator, unsigned threads) {
  const msr_plan_options options = {.integrator = integrator, .timed = true, .threads = threads};
  const bool rows = !integrator || integrator->splits;
  const world timed = open_world_with(floor_below(), &options);
  const world plain = open_world(floor_below(), integrator, 0);
  size_t n;
  const msr_effect *effect = msr_plan_effects(timed.plan, &n);
  must(msr_state_step(timed.state, 300, &why));
  must(msr_state_step(plain.state, 300, &why));
  assert_true(msr_state_hash(timed.state) == msr_state_hash(plain.state));
  for (size_t e = 0; e < n; e++) {
    const double seconds = msr_state_seconds(timed.state, e);
    assert_true(seconds >= 0 && (effect[e].on || seconds == 0));
    assert_true(seconds > 0 || !effect[e].on || (rows && effect[e].force == &msr_force_gravity));
    assert_true(msr_state_seconds(plain.state, e) == 0);
    assert_int_equal(msr_state_calls(timed.state, e), msr_state_calls(plain.state, e));
  }
  assert_true(msr_state_seconds(timed.state, n) == 0);
  close_world(timed);
  close_world(plain);
}

static void only_times_are_added(void **unused) {
  (void)unused;
  check_times(NULL, 1);
  check_times(NULL, 2);
  check_times(&msr_integrator_rk4, 1);
}

/* The sum stays what the clock says, whoever's it is. */
static void times_row_by_row_sum_up(void **unused) {
  (void)unused;
  for (unsigned threads = 1; threads <= 2; threads++) {
    const world w = open_world_with(in_air(floor_below()),
                                    &(msr_plan_options){.timed = true, .threads = threads});
    size_t springs;
    find(&w, "springs", &springs);
    const double start = now();
    must(msr_state_step(w.state, 2000, &why));
    const double wall = now() - start, sum = sum_of_seconds(&w);
    assert_true(sum <= wall && sum >= 0.9 * wall); // all but entering and leaving the call
    assert_true(msr_state_seconds(w.state, springs) > 0);
    close_world(w);
  }
}

/* ---- */

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(steps_say_why),
      cmocka_unit_test(calls_are_foretold),
      cmocka_unit_test(row_by_row_a_call_evaluates_once_more),
      cmocka_unit_test(operations_are_those_of_the_loops),
      cmocka_unit_test(so_they_are_row_by_row),
      cmocka_unit_test(what_nobody_knows_is_no_number),
      cmocka_unit_test(times_are_of_each_effect_alone),
      cmocka_unit_test(an_integrator_has_what_is_left),
      cmocka_unit_test(callbacks_are_nobodys),
      cmocka_unit_test(only_times_are_added),
      cmocka_unit_test(times_row_by_row_sum_up),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
