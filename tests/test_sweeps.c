/* test_sweeps.c - a plan tells whether its states step row by row, why they don't, and by how many
 * threads: no more than there are processors, or than have something to do.
 *
 * link: --wrap=msri_processors */
#include "processors.h"
#include "scenes.h"

#include "plan/plan.h"

static const char net[] = "ooo\n"
                          "o.o\n"
                          "ooo\n";

/* ---- Why not */

static msr_scene *plain(void) { return scene_of(net, &example, NULL); }

static msr_scene *beside(const msr_force *force) {
  msr_scene *scene = plain();
  add_force(scene, force, trial_params(force));
  return scene;
}

static msr_scene *in_air(void) { return beside(&msr_force_wind); }
static msr_scene *pushed(void) { return beside(&msr_force_push); }
static msr_scene *damped(void) { return beside(&msr_force_damping); }
static msr_scene *alien(void) { return beside(&nothing); }
static msr_scene *heavier(void) { return beside(&msr_force_gravity); }
static msr_scene *alone(void) { return scene_of("o.o\n", &example, NULL); }
static msr_scene *no_mass(void) { return scene_of(".#.\n", &example, NULL); }
static msr_scene *above_pegs(void) { return scene_of(pegs, &example, NULL); }

static msr_scene *colliding(void) {
  msr_scene *scene = plain();
  must(msr_scene_set_collisions(scene, 0.5, &why));
  return scene;
}

static msr_scene *attached(void) {
  return scene_of("#o\n.o\n", &example, &(msr_scene_options){.attach = true});
}

static msr_scene *stiff(void) {
  return scene_of(net, &(msr_conf){0.005, 9.8, 0.1, 1e10, 100, 1}, NULL);
}

/* A triangle that a program builds, its last mass of `m` kg. */
static msr_scene *built(double m) {
  msr_scene *scene = empty_scene(0.001);
  for (size_t i = 0; i < 3; i++) add_mass(scene, (double)i, (double)(i % 2), 0, 0, i < 2 ? 1 : m);
  for (size_t i = 0; i < 3; i++) must(msr_scene_add_spring(scene, i, (i + 1) % 3, 100, 1, &why));
  return scene;
}

static msr_scene *of_a_program(void) { return built(1); }
static msr_scene *uneven(void) { return built(2); }

static msr_scene *one_more(void) {
  msr_scene *scene = plain();
  add_mass(scene, 5, 5, 0, 0, 0.1);
  return scene;
}

static msr_scene *over_pegs(void) {
  msr_scene *scene = scene_of("...\n###\n", &example, NULL);
  for (size_t i = 0; i < 2; i++) add_mass(scene, (double)i, 1.5, 0, 0, 1);
  must(msr_scene_add_spring(scene, 0, 1, 100, 1, &why));
  return scene;
}

static void plans_say_why_they_step_by_vectors(void **unused) {
  (void)unused;
  static const struct {
    msr_scene *(*scene)(void);
    msr_plan_options options;
    const char *reason;
  } cases[] = {
      {plain, {0}, NULL},
      {in_air, {0}, NULL},
      {above_pegs, {0}, NULL},
      {above_pegs, {.impacts = MSR_IMPACTS_LOCATED}, NULL},
      {of_a_program, {0}, NULL},
      {plain, {.integrator = &msr_integrator_srkn6}, NULL},
      {plain, {.integrator = &msr_integrator_rk4}, "its method isn't made of kicks and drifts"},
      {above_pegs,
       {.integrator = &msr_integrator_pefrl, .impacts = MSR_IMPACTS_LOCATED},
       "supports are seen to after each step"},
      {stiff, {0}, "long implicit steps may take the place of substeps"},
      {no_mass, {0}, "there is no mass"},
      {alone, {0}, "no spring pulls"},
      {attached, {0}, "springs tie masses to fixed points"},
      {colliding, {0}, "masses collide"},
      {pushed, {0}, "push isn't a weight or air"},
      {damped, {0}, "damping isn't a weight or air"},
      {alien, {0}, "nothing isn't a weight or air"},
      {heavier, {0}, "gravity is the second of its kind"},
      {one_more, {0}, "a program has added masses or springs to those of the picture"},
      {uneven, {0}, "the masses that a program has added differ"},
      {over_pegs, {0}, "supports are in the way of what a program has added"},
  };
  for (size_t i = 0; i < LENGTH(cases); i++) {
    const world w = open_world_with(cases[i].scene(), &cases[i].options);
    const char *reason = msr_plan_describe(w.plan).by_vectors;
    assert_true(msri_plan_sweeps(w.plan) == !cases[i].reason);
    if (cases[i].reason)
      assert_string_equal(reason ? reason : "none", cases[i].reason);
    else
      assert_null(reason);
    close_world(w);
  }
}

/* ---- How many threads */

static unsigned threads_of(msr_scene *scene, unsigned asked) {
  const world w = open_world_with(scene, &(msr_plan_options){.threads = asked});
  const unsigned threads = msr_plan_describe(w.plan).threads;
  advance(&w, 2);
  close_world(w);
  return threads;
}

static msr_scene *block(size_t side) { return lattice(side, side, 4, &weightless); }

/* Four objects, side by side. */
static msr_scene *apart(void) { return scene_of("oo.oo.oo.oo\n", &weightless, NULL); }

static void threads_are_those_that_can_run(void **unused) {
  (void)unused;
  for (processors = 1; processors <= 4; processors++) {
    assert_int_equal(threads_of(block(300), 0), 1);
    assert_int_equal(threads_of(block(300), 1), 1);
    assert_int_equal(threads_of(block(300), 2), processors < 2 ? 1 : 2);
    assert_int_equal(threads_of(block(300), 256), processors);
    assert_int_equal(threads_of(apart(), 256), processors);
  }
  processors = 256;
}

static void threads_are_those_with_something_to_do(void **unused) {
  (void)unused;
  assert_int_equal(threads_of(apart(), 256), 4);
  assert_int_equal(threads_of(block(20), 256), 1);
  assert_int_equal(threads_of(pushed(), 256), 1);
  assert_int_equal(threads_of(of_a_program(), 256), 1);
  assert_in_range(threads_of(block(100), 256), 2, 50); // each has two rows at least
}

/* This machine's own. */
static void there_is_a_processor(void **unused) {
  (void)unused;
  assert_in_range(__real_msri_processors(), 1, 1 << 16);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(plans_say_why_they_step_by_vectors),
      cmocka_unit_test(threads_are_those_that_can_run),
      cmocka_unit_test(threads_are_those_with_something_to_do),
      cmocka_unit_test(there_is_a_processor),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
