/* test_choice.c - the choice by accuracy: what it chooses is as accurate as asked, at little more
 * than the least cost that a study of every method finds.
 * link: --wrap=malloc --wrap=calloc --wrap=realloc */
#include "alloc.h"
#include "exact.h"

#include <time.h>

static msr_accuracy_choice choose(const msr_scene *scene, double error) {
  msr_accuracy_choice choice;
  must(msr_accuracy_choose(scene, error, NULL, &choice, &why));
  return choice;
}

/* ---- Scenes with exact solutions */

static void choices_are_accurate(void **unused) {
  (void)unused;
  for (size_t i = 0; i < LENGTH(exacts); i++)
    for (double asked = 1; asked > 0.9e-8; asked /= 10) {
      msr_scene *scene = exacts[i].make();
      const msr_accuracy_choice choice = choose(scene, asked);
      const double error = exact_error(&exacts[i], &choice.options, choice.horizon);
      const bool impacts = choice.options.impacts == MSR_IMPACTS_LOCATED;
      assert_true(impacts == (strcmp(exacts[i].name, "bounce") == 0));
      /* The reference of the estimate isn't exact. */
      if (error > asked || choice.error > asked || error > 1.1 * choice.error)
        fail_msg("%s: error %g, estimated %g, asked for %g: %s", exacts[i].name, error,
                 choice.error, asked, choice.reason);
      msr_scene_free(scene);
    }
}

/* ---- Ten scenes */

static msr_scene *block_in_motion(int neighbours, double dt, double k, double spin, double bend) {
  msr_scene *scene = empty_scene(dt);
  const size_t n = 4;
  for (size_t i = 0; i < n * n; i++) {
    const double x = (double)(i % n), y = (double)(i / n);
    add_mass(scene, x + bend * sin(x + 2 * y), y + bend * cos(2 * x - y), -spin * (y - 1.5),
             spin * (x - 1.5), 0.1);
    if (i % n > 0) must(msr_scene_add_spring(scene, i - 1, i, k, 1, &why));
    if (i >= n) must(msr_scene_add_spring(scene, i - n, i, k, 1, &why));
    if (neighbours == 8 && i % n > 0 && i >= n) {
      must(msr_scene_add_spring(scene, i - n - 1, i, k, sqrt(2), &why));
      must(msr_scene_add_spring(scene, i - n, i - 1, k, sqrt(2), &why));
    }
  }
  must(msr_scene_set_times(scene, dt, 50, 50, &why));
  return scene;
}

static msr_scene *free_block(void) { return block_in_motion(4, 0.01, 150, 0, 0.1); }

static msr_scene *spinning_block(void) { return block_in_motion(8, 0.01, 150, 2, 0.1); }

static msr_scene *stiff_block(void) { return block_in_motion(4, 0.02, 15000, 1, 0.003); }

static msr_scene *hanging_cloth(void) {
  return scene_of("#...#\n"
                  "ooooo\n"
                  "ooooo\n"
                  "ooooo\n"
                  ".....\n",
                  &(msr_conf){0.02, 9.8, 0.1, 50, 50, 50}, &(msr_scene_options){.attach = true});
}

static msr_scene *bouncing_block(void) {
  return scene_of(".ooo.\n"
                  ".ooo.\n"
                  ".....\n"
                  "#####\n",
                  &(msr_conf){0.01, 9.8, 0.1, 300, 60, 60}, NULL);
}

static msr_scene *flag_in_gusts(void) {
  msr_scene *scene =
      scene_of("#oooo.\n"
               "#oooo.\n"
               "......\n",
               &(msr_conf){0.02, 9.8, 0.1, 80, 50, 50}, &(msr_scene_options){.attach = true});
  add_force(scene, &msr_force_wind,
            &(msr_wind){.c = 0.1, .speed = 10, .gust = 5, .gust_time = 0.5, .seed = 3});
  return scene;
}

static msr_scene *damped_block(void) {
  msr_scene *scene = block_in_motion(4, 0.01, 150, 1, 0.1);
  add_force(scene, &msr_force_drag, &(msr_drag){0.05});
  add_force(scene, &msr_force_damping, &(msr_damping){0.3});
  return scene;
}

static msr_scene *pendulum(void) {
  msr_scene *scene = empty_scene(0.02);
  add_mass(scene, 2, 0, 0, 0, 0.3);
  must(msr_scene_add_anchor(scene, &(msr_anchor){0, 0, 0, 40, 2}, &why));
  add_force(scene, &msr_force_gravity, &(msr_gravity){9.8});
  must(msr_scene_set_times(scene, 0.02, 100, 100, &why));
  return scene;
}

static msr_scene *leaves(void) {
  msr_scene *scene = empty_scene(0.05);
  for (size_t i = 0; i < 5; i++)
    add_mass(scene, (double)i, 10, 1, -(double)i, 0.1 + 0.1 * (double)i);
  add_force(scene, &msr_force_gravity, &(msr_gravity){9.8});
  add_force(scene, &msr_force_wind, &(msr_wind){.c = 0.3, .speed = 4, .gust = 2, .seed = 5});
  must(msr_scene_set_times(scene, 0.05, 40, 40, &why));
  return scene;
}

static msr_scene *pushed_block(void) {
  msr_scene *scene = block_in_motion(4, 0.02, 100, 0, 0.1);
  add_force(scene, &msr_force_push, &(msr_push){0, 3, 1});
  add_force(scene, &msr_force_push, &(msr_push){15, -2, 2});
  return scene;
}

/* `substeps` of RK4 are exact to far less than `finest`. */
static const struct scene {
  const char *name;
  msr_scene *(*make)(void);
  double finest; /* error that is asked for [px] */
  uint64_t substeps;
} scenes[] = {
    {"free block", free_block, 1e-6, 300},
    {"spinning block", spinning_block, 1e-6, 300},
    {"stiff block", stiff_block, 1e-5, 1500},
    {"hanging cloth", hanging_cloth, 1e-6, 300},
    {"bouncing block", bouncing_block, 1e-4, 2000},
    {"flag in gusts", flag_in_gusts, 1e-6, 300},
    {"damped block", damped_block, 1e-6, 300},
    {"pendulum", pendulum, 1e-6, 300},
    {"leaves", leaves, 1e-6, 300},
    {"pushed block", pushed_block, 1e-6, 300},
};

/* A run: positions after every iteration, and what it took. */
typedef struct track {
  double *q; /* [iterations][size]: x, y */
  size_t size;
  double cost;
} track;

/* In calls of springs and of what depends on velocity or stands in the way, on all masses at once.
 * An adaptive step has order^2 / 12 beside, an implicit evaluation a matrix: some 20 calls. */
static double cost_of(const world *w) {
  const msr_integrator *integrator = msr_plan_describe(w->plan).integrator;
  const double order = integrator->order;
  size_t n;
  const msr_effect *effect = msr_plan_effects(w->plan, &n);
  double cost =
      integrator->adaptive ? order * order / 12 * (double)msr_state_work(w->state).steps : 0;
  if (integrator->implicit) cost += 20 * (double)msr_state_work(w->state).evaluations;
  for (size_t e = 0; e < n && effect[e].on; e++)
    if (effect[e].force != &msr_force_gravity && effect[e].force != &msr_force_push)
      cost += (double)msr_state_calls(w->state, e);
  return cost;
}

static track run(const msr_scene *scene, const msr_plan_options *options) {
  world w;
  must(msr_plan_create(scene, options, &w.plan, &why));
  must(msr_state_create(w.plan, &w.state, &why));
  const msr_plan_figures f = msr_plan_describe(w.plan);
  track t = {.size = 2 * f.masses};
  t.q = zeroed(t.size * f.iterations, sizeof *t.q);
  for (uint64_t i = 0; i < f.iterations; i++) {
    advance(&w, 1);
    const msr_view s = msr_state_view(w.state);
    memcpy(t.q + i * t.size, s.x, s.n * sizeof *t.q);
    memcpy(t.q + i * t.size + s.n, s.y, s.n * sizeof *t.q);
  }
  t.cost = cost_of(&w);
  close_world(w);
  return t;
}

/* The largest distance of a mass in the first `iterations`. */
static double apart(const track *a, const track *b, uint64_t iterations) {
  double most = 0;
  const size_t n = a->size / 2;
  for (uint64_t i = 0; i < iterations; i++)
    for (size_t j = 0; j < n; j++) {
      const double *p = a->q + i * a->size + j, *q = b->q + i * a->size + j;
      most = fmax(most, hypot(p[0] - q[0], p[n] - q[n]));
    }
  return most;
}

/* The least that a study found. */
static double least_cost(const msr_scene *scene, const msr_accuracy *study, double error) {
  size_t n;
  const msr_accuracy_point *p = msr_accuracy_points(study, &n);
  const double own = msr_accuracy_describe(study).reference_error;
  double least = INFINITE, fewest = INFINITE;
  for (size_t i = 0; i < n; i++)
    if (p[i].stable && p[i].max + own <= error) fewest = fmin(fewest, (double)p[i].evaluations);
  for (size_t i = 0; i < n; i++) {
    if (!p[i].stable || p[i].max + own > error || (double)p[i].evaluations > 3 * fewest) continue;
    const msr_plan_options options = {.integrator = p[i].integrator,
                                      .substeps = p[i].substeps,
                                      .atol = p[i].atol,
                                      .impacts = MSR_IMPACTS_LOCATED};
    const track t = run(scene, &options);
    least = fmin(least, t.cost);
    free(t.q);
  }
  return least;
}

/* `asked` for on a scene whose true motion is known. At most half is added to the least cost: 3
 * substeps where 2 just do; the second cheapest of what was tried may cost 1.65 times the least. */
static void check_choice(const struct scene *s, const msr_scene *scene, const msr_accuracy *study,
                         const track *truth, double asked) {
  const msr_accuracy_figures figures = msr_accuracy_describe(study);
  const msr_accuracy_choice choice = choose(scene, asked);
  const track t = run(scene, &choice.options);
  const double dt = figures.until / (double)figures.frames;
  const double error = apart(&t, truth, (uint64_t)(choice.horizon / dt + 0.5));
  const double least = least_cost(scene, study, asked);
  free(t.q);
  if (error > asked || choice.error > asked)
    fail_msg("%s: error %g, estimated %g, asked for %g: %s", s->name, error, choice.error, asked,
             choice.reason);
  if (t.cost > 1.55 * least)
    fail_msg("%s: cost %g, least %g, %g px: %s", s->name, t.cost, least, asked, choice.reason);
}

static void choice_is_good(const struct scene *s) {
  msr_scene *scene = s->make();
  const msr_plan_options fine = {
      .integrator = &msr_integrator_rk4, .substeps = s->substeps, .impacts = MSR_IMPACTS_LOCATED};
  const track truth = run(scene, &fine);
  msr_accuracy *study;
  must(msr_accuracy_study(scene, &(msr_accuracy_options){.finest = s->finest}, &study, &why));
  assert_true(msr_accuracy_describe(study).complete);
  for (double asked = 1; asked > 0.9 * s->finest; asked /= 100)
    check_choice(s, scene, study, &truth, asked);
  free(truth.q);
  msr_accuracy_free(study);
  msr_scene_free(scene);
}

static void choices_are_good(void **unused) {
  (void)unused;
  for (size_t i = 0; i < LENGTH(scenes); i++) {
    choice_is_good(&scenes[i]);
  }
}

/* ---- How it goes about it */

static void choices_repeat(void **unused) {
  (void)unused;
  msr_scene *scene = hanging_cloth();
  for (double asked = 0.1; asked > 1e-7; asked /= 10) {
    const msr_accuracy_choice a = choose(scene, asked), b = choose(scene, asked);
    assert_ptr_equal(a.options.integrator, b.options.integrator);
    assert_int_equal(a.options.substeps, b.options.substeps);
    const double x[] = {a.options.atol, a.error, a.horizon};
    const double y[] = {b.options.atol, b.error, b.horizon};
    assert_memory_equal(x, y, sizeof x);
    assert_string_equal(a.reason, b.reason);
  }
  msr_scene_free(scene);
}

/* A run of 14 hours is tried at its beginning, and nothing is said of the rest. */
static void long_runs_have_pilots(void **unused) {
  (void)unused;
  const exact *chain = &exacts[2];
  msr_scene *scene = chain->make();
  must(msr_scene_set_times(scene, 0.05, 1000 * 1000, 1000 * 1000, &why));
  msr_accuracy_choice choice;
  const msr_accuracy_options options = {.budget = 0.5};
  must(msr_accuracy_choose(scene, 1e-3, &options, &choice, &why));
  assert_true(choice.horizon > 0.1 && choice.horizon < 50e3);
  assert_non_null(strstr(choice.reason, "of 5e+04 s"));
  assert_true(exact_error(chain, &choice.options, fmin(choice.horizon, 2)) <= 1e-3);
  msr_scene_free(scene);
}

/* Chaos: as far as the reference goes, and no further. */
static void choices_have_horizons(void **unused) {
  (void)unused;
  msr_scene *scene = pendulum();
  double x = 2;
  for (size_t i = 1; i < 4; i++) {
    add_mass(scene, x += 1, 0, 0, 0, 0.1);
    must(msr_scene_add_spring(scene, i - 1, i, 100, 1, &why));
  }
  must(msr_scene_set_times(scene, 0.02, 2000, 2000, &why));
  const msr_accuracy_choice choice = choose(scene, 0.01);
  assert_true(choice.horizon > 1 && choice.horizon < 30);
  assert_true(choice.error <= 0.01);
  const msr_plan_options fine = {.integrator = &msr_integrator_rk8pd, .atol = 1e-13};
  const track a = run(scene, &choice.options), b = run(scene, &fine);
  assert_true(apart(&a, &b, (uint64_t)(choice.horizon / 0.02 + 0.5)) <= 0.01);
  /* What follows, untried, should at least be stable. */
  const msr_accuracy_choice coarse = choose(scene, 10);
  msr_plan *plan;
  must(msr_plan_create(scene, &coarse.options, &plan, &why));
  const msr_plan_figures f = msr_plan_describe(plan);
  assert_true(coarse.horizon < 40 && f.h <= f.safe_step && f.integrator->order > 1);
  msr_plan_free(plan);
  free(a.q);
  free(b.q);
  msr_scene_free(scene);
}

static void only_what_is_given_is_chosen(void **unused) {
  (void)unused;
  const msr_integrator mine = msr_integrator_rk4;
  const msr_integrator *const list[] = {&msr_integrator_symplectic_euler, &mine};
  msr_scene *scene = free_block();
  msr_accuracy_choice choice;
  must(msr_accuracy_choose(scene, 1e-5,
                           &(msr_accuracy_options){.integrators = list, .n_integrators = 2},
                           &choice, &why));
  assert_ptr_equal(choice.options.integrator, &mine);
  msr_scene_free(scene);
}

/* When time is up, the run that was accurate for longest, and for how long. */
static void time_may_be_up(void **unused) {
  (void)unused;
  static const msr_integrator *const euler[] = {&msr_integrator_euler};
  const msr_accuracy_options options = {.integrators = euler, .n_integrators = 1, .budget = 0.5};
  msr_scene *scene = free_block();
  msr_accuracy_choice choice;
  must(msr_accuracy_choose(scene, 1e-5, &options, &choice, &why));
  assert_true(choice.horizon >= 0.01 && choice.horizon < 0.5);
  const msr_plan_options fine = {.integrator = &msr_integrator_rk8pd, .atol = 1e-13};
  const track a = run(scene, &choice.options), b = run(scene, &fine);
  assert_true(apart(&a, &b, (uint64_t)(choice.horizon / 0.01 + 0.5)) <= 1e-5);
  free(a.q);
  free(b.q);
  msr_scene_free(scene);
}

/* A caller that lets half a second pass once the second stage's first run is under way. */
typedef struct idler {
  bool chooses; /* rather than looking for a reference */
  int stages, looks;
} idler;

static msr_status idle(void *data, const msr_accuracy_progress *progress) {
  idler *s = data;
  const bool chooses = strncmp(progress->text, "choosing", 8) == 0;
  s->stages += chooses && !s->chooses;
  s->chooses = chooses;
  if (chooses && s->stages == 2 && ++s->looks == 6)
    nanosleep(&(struct timespec){0, 500 * 1000 * 1000}, NULL);
  return MSR_OK;
}

/* The first stage goes up to 1488 s. A run of the second that time ends after less takes nothing
 * away from that; on a slow machine there is no second stage. */
static void what_is_known_longest_is_kept(void **unused) {
  (void)unused;
  static const msr_integrator *const only[] = {&msr_integrator_srkn6};
  idler s = {false, 0, 0};
  const msr_accuracy_options options = {
      .integrators = only, .n_integrators = 1, .budget = 0.5, .poll = idle, .data = &s};
  msr_scene *scene = exacts[2].make();
  must(msr_scene_set_times(scene, 0.05, 100 * 1000, 100 * 1000, &why));
  msr_accuracy_choice choice;
  const msr_status status = msr_accuracy_choose(scene, 1e-3, &options, &choice, &why);
  if (s.stages == 2) {
    must(status);
    assert_null(strstr(choice.reason, "when time was up"));
    assert_true(choice.horizon > 1000);
  }
  msr_scene_free(scene);
}

/* ---- What isn't possible */

static void refused(const msr_scene *scene, double error, const msr_accuracy_options *options,
                    msr_status status, const char *word) {
  msr_accuracy_choice choice;
  msr_error err;
  assert_int_equal(msr_accuracy_choose(scene, error, options, &choice, &err), status);
  assert_int_equal(err.status, status);
  if (!strstr(err.message, word)) fail_msg("'%s' isn't in '%s'", word, err.message);
  assert_int_equal(msr_accuracy_choose(scene, error, options, &choice, NULL), status);
}

static msr_status stop(void *data, const msr_accuracy_progress *progress) {
  const char *word = data;
  return strncmp(progress->text, word, strlen(word)) == 0 ? MSR_EIO : MSR_OK;
}

static void what_cannot_be_is_refused(void **unused) {
  (void)unused;
  static char reference[] = "reference", choosing[] = "choosing";
  msr_scene *scene = free_block(), *empty = empty_scene(0.1);
  refused(scene, 0, NULL, MSR_EUSAGE, "above 0");
  refused(scene, NO_NUMBER, NULL, MSR_EUSAGE, "above 0");
  refused(scene, INFINITE, NULL, MSR_EUSAGE, "above 0");
  refused(scene, 1, &(msr_accuracy_options){.budget = -1}, MSR_EUSAGE, "budget");
  refused(empty, 1, NULL, MSR_EINPUT, "no mass");
  refused(scene, 1e-17, NULL, MSR_EUNSTABLE, "no two methods agree within 1e-18 px even at 0.01 s");
  refused(scene, 1e-17, NULL, MSR_EUNSTABLE, "; ask for a larger error");
  refused(scene, 1, &(msr_accuracy_options){.poll = stop, .data = reference}, MSR_EIO, "stopped");
  refused(scene, 1, &(msr_accuracy_options){.poll = stop, .data = choosing}, MSR_EIO, "stopped");
  refused(scene, 1, &(msr_accuracy_options){.budget = 1e-9}, MSR_EUNSTABLE,
          "no two methods got to 0.01 s; raise the budget");
  msr_scene_free(scene);
  msr_scene_free(empty);
}

/* ---- Memory */

static msr_scene *attempted;
static int wrong;

static bool attempt(void) {
  static const msr_integrator *const two[] = {&msr_integrator_verlet, &msr_integrator_rk4};
  msr_accuracy_choice choice;
  msr_error err = {MSR_OK, ""};
  const msr_accuracy_options options = {.integrators = two, .n_integrators = 2};
  const msr_status status = msr_accuracy_choose(attempted, 0.1, &options, &choice, &err);
  wrong += status != MSR_OK && (status != MSR_ENOMEM || !strstr(err.message, "out of memory"));
  return status == MSR_OK;
}

static void memory_may_fail(void **unused) {
  (void)unused;
  attempted = make_pair();
  assert_true(alloc_fail_each(attempt) > 20);
  assert_int_equal(wrong, 0);
  msr_scene_free(attempted);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(choices_are_accurate),  cmocka_unit_test(choices_are_good),
      cmocka_unit_test(choices_repeat),        cmocka_unit_test(long_runs_have_pilots),
      cmocka_unit_test(choices_have_horizons), cmocka_unit_test(only_what_is_given_is_chosen),
      cmocka_unit_test(time_may_be_up),        cmocka_unit_test(what_cannot_be_is_refused),
      cmocka_unit_test(memory_may_fail),       cmocka_unit_test(what_is_known_longest_is_kept),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
