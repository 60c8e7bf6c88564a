/* test_sweep.c - steps row by row have the same bits as steps of all masses at once, which a force
 * of one's own that does nothing brings back: whatever the shape, method, threads and pieces.
 *
 * link: --wrap=pthread_create --wrap=msri_processors */
#include "plan/plan.h"
#include "sweep/sweep.h"

#include "files.h"
#include "processors.h"
#include "shapes.h"

#include <errno.h>
#include <pthread.h>

/* ---- The same scene by both ways */

enum { STILL, DRAG, WIND, AIRS };

typedef struct trial {
  const shape *shape;
  size_t width, height, parameter;
  int neighbours, air;
  double gravity, dt;
  const msr_integrator *integrator;
  uint64_t substeps, seed;
} trial;

static msr_scene *scene_by(const trial *t) {
  static const msr_wind wind = {.c = 0.05, .speed = 2, .gust = 3, .gust_time = 0.02, .seed = 5};
  const msr_conf conf = {.dt = t->dt,
                         .gravity = t->gravity,
                         .mass = 0.1,
                         .stiffness = 30,
                         .iterations = 600,
                         .images = 1};
  msr_scene *scene = scene_from(draw(t->shape, t->width, t->height, t->parameter), &conf,
                                &(msr_scene_options){.neighbours = t->neighbours});
  if (t->air == DRAG) add_force(scene, &msr_force_drag, &(msr_drag){0.2});
  if (t->air == WIND) add_force(scene, &msr_force_wind, &wind);
  return scene;
}

static void stir(const world *w, uint64_t seed) {
  const size_t n = msr_plan_describe(w->plan).masses;
  const msr_arrays s = msr_state_edit(w->state);
  for (size_t i = 0; i < n; i++) {
    s.x[i] += uniform(&seed, -0.2, 0.2), s.y[i] += uniform(&seed, -0.2, 0.2);
    s.vx[i] = uniform(&seed, -2, 2), s.vy[i] = uniform(&seed, -2, 2);
  }
}

/* By all threads, or, with 0, all masses at once. */
static world open_by(const trial *t, unsigned threads) {
  msr_scene *scene = scene_by(t);
  if (threads == 0) add_force(scene, &nothing, NULL);
  world w = open_world_with(scene, &(msr_plan_options){.integrator = t->integrator,
                                                       .substeps = t->substeps,
                                                       .threads = threads});
  stir(&w, t->seed);
  return w;
}

static void advance_in_pieces(const world *w, uint64_t steps, uint64_t dice, size_t most) {
  while (steps > 0) {
    const uint64_t piece = 1 + random_below(&dice, steps < most ? steps : most);
    advance(w, piece);
    steps -= piece;
  }
}

/* 32 stages go into a pass: more than one, and an odd rest. */
enum { STEPS = 37 };

static void try(const trial *t, unsigned threads, size_t most, uint64_t expected) {
  world w = open_by(t, threads);
  const bool springs = msr_plan_describe(w.plan).springs > 0;
  assert_true(msri_plan_sweeps(w.plan) == springs);
  advance_in_pieces(&w, STEPS, t->seed, most);
  if (msr_state_hash(w.state) != expected)
    fail_msg("%s %zu x %zu (%zu), %d neighbours, %s, air %d, gravity %g, %u threads, up to %zu "
             "steps a piece, seed %llu: other bits",
             t->shape->name, t->width, t->height, t->parameter, t->neighbours, t->integrator->name,
             t->air, t->gravity, threads, most, (unsigned long long)t->seed);
  close_world(w);
}

static uint64_t expected_of(const trial *t) {
  world w = open_by(t, 0);
  assert_false(msri_plan_sweeps(w.plan));
  advance(&w, STEPS);
  const uint64_t hash = msr_state_hash(w.state);
  close_world(w);
  return hash;
}

static void same_bits(const trial *t, unsigned threads) {
  const uint64_t expected = expected_of(t);
  try(t, 1, STEPS, expected);
  try(t, threads, STEPS, expected);
  try(t, 1 + threads % 5, 9, expected);
}

static const msr_integrator *splitting(uint64_t n) {
  static const msr_integrator *const all[] = {
      &msr_integrator_verlet,    &msr_integrator_symplectic_euler,
      &msr_integrator_pefrl,     &msr_integrator_srkn4,
      &msr_integrator_srkn6,     &msr_integrator_kahan_li_6,
      &msr_integrator_kahan_li_8};
  return all[n % LENGTH(all)];
}

static trial trial_of(uint64_t seed) {
  uint64_t dice = seed;
  return (trial){.shape = &shapes[random_below(&dice, LENGTH(shapes))],
                 .width = 1 + random_below(&dice, random_below(&dice, 3) ? 120 : 20),
                 .height = 1 + random_below(&dice, random_below(&dice, 3) ? 120 : 20),
                 .parameter = 1 + random_below(&dice, random_below(&dice, 2) ? 4 : 40),
                 .neighbours = random_below(&dice, 2) ? 8 : 4,
                 .air = (int)random_below(&dice, AIRS),
                 .gravity = random_below(&dice, 2) ? 9.8 : 0,
                 .dt = 0.01,
                 .integrator = splitting(random_below(&dice, 3) ? 0 : random_below(&dice, 7)),
                 .substeps = 1 + random_below(&dice, 2),
                 .seed = seed};
}

static void shapes_have_the_same_bits(void **state) {
  (void)state;
  for (uint64_t seed = 1; seed <= 40; seed++) {
    const trial t = trial_of(seed);
    same_bits(&t, 1 + (unsigned)(seed % 5));
  }
}

/* ---- Each way to go through an object: see libmsr/sweep/sweep.c */

/* One thread has patches of up to 12288 cells; rows of larger ones are in a ring.
 * More threads share what has 8192 masses if there are few objects, and rows enough. */
static void large_objects_have_the_same_bits(void **state) {
  (void)state;
  const trial trials[] = {
      {&shapes[0], 119, 113, 1, 4, STILL, 9.8, 0.01, &msr_integrator_verlet, 1, 1},
      {&shapes[0], 119, 113, 1, 8, WIND, 9.8, 0.01, &msr_integrator_verlet, 2, 2},
      {&shapes[0], 12400, 1, 1, 4, DRAG, 0, 0.01, &msr_integrator_verlet, 1, 3},
      {&shapes[0], 1, 12400, 1, 8, STILL, 9.8, 0.01, &msr_integrator_pefrl, 1, 4},
      {&shapes[0], 2, 6300, 1, 8, STILL, 0, 0.01, &msr_integrator_symplectic_euler, 1, 5},
      {&shapes[0], 6300, 2, 1, 8, DRAG, 9.8, 0.01, &msr_integrator_verlet, 1, 6},
      {shape_named("blocks"), 250, 150, 90, 4, WIND, 9.8, 0.01, &msr_integrator_verlet, 1, 7},
      {shape_named("blocks"), 210, 11, 100, 8, DRAG, 9.8, 0.01, &msr_integrator_verlet, 1, 12},
      {shape_named("bridge"), 900, 40, 7, 4, DRAG, 9.8, 0.01, &msr_integrator_verlet, 1, 8},
      {shape_named("rake"), 700, 60, 15, 8, STILL, 9.8, 0.01, &msr_integrator_verlet, 1, 9},
      {shape_named("comb"), 400, 45, 16, 4, WIND, 9.8, 0.01, &msr_integrator_srkn4, 1, 10},
      {shape_named("triangle"), 130, 130, 1, 8, DRAG, 9.8, 0.01, &msr_integrator_verlet, 1, 11},
  };
  for (size_t n = 0; n < LENGTH(trials); n++) same_bits(&trials[n], 2 + (unsigned)(n % 4));
}

static void rectangles_have_the_same_bits(void **state) {
  (void)state;
  for (size_t width = 1; width <= 40; width++) {
    const trial t = {&shapes[0],
                     width,
                     40,
                     1,
                     width % 2 ? 8 : 4,
                     (int)(width % AIRS),
                     9.8,
                     0.01,
                     &msr_integrator_verlet,
                     1,
                     width};
    same_bits(&t, 1 + (unsigned)(width % 5));
  }
}

static void methods_have_the_same_bits(void **state) {
  (void)state;
  for (uint64_t n = 0; n < 7; n++)
    for (int air = STILL; air < AIRS; air++) {
      const trial small = {&shapes[0], 9, 8, 1, 8, air, 9.8, 0.01, splitting(n), 3, n};
      const trial rings = {shape_named("rings"), 30, 35, 20, 4, air, 9.8, 0.01, splitting(n), 1, n};
      const trial shared = {&shapes[0], 13, 40, 1, 4, air, 0, 0.01, splitting(n), 1, n};
      same_bits(&small, 3);
      if (n % AIRS != (uint64_t)air) continue;
      same_bits(&rings, 2);
      same_bits(&shared, 3);
    }
}

/* Iterations end between two looks of the guard. */
static void many_substeps_have_the_same_bits(void **state) {
  (void)state;
  const trial t = {shape_named("noise"),   12, 9, 6, 8, WIND, 9.8, 0.2,
                   &msr_integrator_verlet, 40, 1};
  same_bits(&t, 2);
}

/* ---- Runs that are cut */

/* Through a file and copies, from one number of threads to another. */
static void runs_may_be_cut(void **state) {
  (void)state;
  for (uint64_t seed = 1; seed < 12; seed++) {
    trial t = trial_of(seed);
    t.width = 2 + t.width % 40, t.height = 2 + t.height % 60;
    const uint64_t expected = expected_of(&t);
    world a = open_by(&t, 1), b = open_by(&t, 3);
    msr_state *copy;
    must(msr_state_create(b.plan, &copy, &why));
    advance(&a, 11);
    must(msr_state_save(a.state, path_of("state"), &why));
    must(msr_state_load(b.state, path_of("state"), &why));
    remove(path_of("state"));
    advance(&b, 7);
    msr_state_copy(copy, b.state);
    advance(&b, 5); /* goes its own way */
    must(msr_state_step(copy, STEPS - 18, &why));
    assert_true(msr_state_hash(copy) == expected);
    advance(&b, STEPS - 23);
    assert_true(msr_state_hash(b.state) == expected);
    msr_state_free(copy);
    close_world(a);
    close_world(b);
  }
}

/* Two states of a plan, one ahead of the other and then put back, in gusts: what their forces
 * remember shows in neither. */
static void states_of_a_plan_know_nothing_of_each_other(void **state) {
  (void)state;
  for (uint64_t n = 0; n < 7; n++)
    for (unsigned threads = 0; threads < 2; threads++) {
      const trial t = {&shapes[0], 9, 7, 1, 4, WIND, 9.8, 0.01, splitting(n), 1, n};
      world w = open_by(&t, threads), alone = open_by(&t, threads);
      msr_state *ahead;
      must(msr_state_create(w.plan, &ahead, &why));
      msr_state_copy(ahead, w.state);
      advance(&alone, STEPS);
      for (int turn = 0; turn < 2; turn++) {
        must(msr_state_step(ahead, 30, &why));
        advance(&w, 1);
        msr_state_copy(ahead, w.state);
      }
      must(msr_state_step(ahead, STEPS - 2, &why));
      for (int step = 2; step < STEPS; step++) advance(&w, 1);
      assert_true(msr_state_hash(ahead) == msr_state_hash(alone.state));
      assert_true(msr_state_hash(w.state) == msr_state_hash(alone.state));
      msr_state_free(ahead);
      close_world(w);
      close_world(alone);
    }
}

/* ---- What is counted */

static uint64_t calls_of(const world *w, const char *name) {
  size_t n;
  const msr_effect *effect = msr_plan_effects(w->plan, &n);
  for (size_t i = 0; i < n; i++)
    if (effect[i].on && strcmp(effect[i].name, name) == 0) return msr_state_calls(w->state, i);
  return UINT64_MAX;
}

/* As many steps as were asked for, and evaluations as those take; a call more for each call of
 * ours, where the last one of a step would serve the next, and for each look. Energies are those of
 * the places. */
static void work_is_counted(void **state) {
  (void)state;
  for (uint64_t n = 0; n < 14; n++) {
    const int air = n % 2 ? DRAG : STILL;
    const trial t = {&shapes[0], 20, 30, 1, 4, air, 9.8, 0.01, splitting(n / 2), 2, n};
    world is = open_by(&t, 2), due = open_by(&t, 0);
    for (int call = 0; call < 3; call++) advance(&is, 10), advance(&due, 10);
    const msr_work work = msr_state_work(is.state), wanted = msr_state_work(due.state);
    assert_true(work.steps == 60 && wanted.steps == 60);
    if (work.evaluations != wanted.evaluations)
      fail_msg("%s: %llu evaluations, not %llu", t.integrator->name,
               (unsigned long long)work.evaluations, (unsigned long long)wanted.evaluations);
    const uint64_t springs = calls_of(&is, "springs");
    assert_in_range(springs, work.evaluations, work.evaluations + 4);
    assert_true(calls_of(&is, "gravity") == springs);
    const msr_energy a = msr_state_energy(is.state), b = msr_state_energy(due.state);
    assert_true(a.total == b.total && a.spring == b.spring && a.longest == b.longest);
    close_world(is);
    close_world(due);
  }
}

/* ---- What goes wrong */

/* Put back by a program, both go the same way; whether a step that's too long is told at once, too,
 * isn't asked. */
static void assert_starts_anew(const trial *t, const world *is, const world *due) {
  const size_t n = msr_plan_describe(is->plan).masses;
  double *z = zeroed(4 * n, sizeof *z), *wanted = zeroed(4 * n, sizeof *z);
  const world fresh = open_by(t, 0);
  read_world(&fresh, z);
  write_world(is, z), write_world(due, z);
  msr_state_step(is->state, 1, NULL), msr_state_step(due->state, 1, NULL);
  read_world(is, z), read_world(due, wanted);
  assert_memory_equal(z, wanted, 4 * n * sizeof *z);
  close_world(fresh);
  free(z), free(wanted);
}

/* Three times the stable step: both ways see it, at most a pass of 32 stages, the step under way
 * and a glance of 16 steps apart. */
static void explode(const trial *t, unsigned threads) {
  enum { APART = 32 + 1 + 16 };
  world is = open_by(t, threads), due = open_by(t, 0);
  assert_int_equal(msr_state_step(is.state, 600, &why), MSR_EUNSTABLE);
  assert_int_equal(msr_state_step(due.state, 600, &why), MSR_EUNSTABLE);
  const uint64_t a = msr_state_iteration(is.state), b = msr_state_iteration(due.state);
  if (a > b + APART || b > a + APART)
    fail_msg("%s, %zu x %zu: at %llu, not %llu", t->integrator->name, t->width, t->height,
             (unsigned long long)a, (unsigned long long)b);
  assert_starts_anew(t, &is, &due);
  close_world(is);
  close_world(due);
}

static void explosions_are_told(void **state) {
  (void)state;
  static const size_t sizes[][2] = {{6, 5}, {40, 60}, {130, 100}};
  for (size_t i = 0; i < LENGTH(sizes); i++)
    for (uint64_t n = 0; n < 7; n++) {
      const double limit = splitting(n)->stability / sqrt(8 * 30 / 0.1);
      const size_t w = sizes[i][0], h = sizes[i][1];
      explode(&(trial){&shapes[0], w, h, 1, 4, STILL, 9.8, 3 * limit, splitting(n), 1, n},
              1 + (unsigned)(n % 3));
    }
}

static world crushed(unsigned threads) {
  world w = open_by(&(trial){&shapes[0], 12, 10, 1, 4, STILL, 0, 0.01, NULL, 0, 3}, threads);
  assert_true(msri_plan_sweeps(w.plan) == (threads > 0));
  const msr_arrays s = msr_state_edit(w.state);
  for (size_t i = 0; i < 120; i++) s.vx[i] = 4 * (6 - s.x[i]), s.vy[i] = 4 * (5 - s.y[i]);
  return w;
}

/* What is crushed goes back to where it was sound, and on by steps of energy-momentum. */
static void crushes_go_on_with_care(void **state) {
  (void)state;
  world due = crushed(0);
  advance(&due, 560);
  assert_true(msr_state_work(due.state).careful == 256);
  for (unsigned threads = 1; threads < 4; threads++) {
    world w = crushed(threads);
    advance_in_pieces(&w, 560, threads, threads == 1 ? 560 : 30);
    assert_true(msr_state_work(w.state).careful == 256);
    assert_true(msr_state_hash(w.state) == msr_state_hash(due.state));
    close_world(w);
  }
  close_world(due);
}

/* ---- Threads that the system doesn't give */

typedef void *thread_function(void *self);
int __real_pthread_create(pthread_t *thread, const pthread_attr_t *attr, thread_function *function,
                          void *self);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attr, thread_function *function,
                          void *self);

static bool refused;

int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attr, thread_function *function,
                          void *self) {
  return refused ? EAGAIN : __real_pthread_create(thread, attr, function, self);
}

/* A state needs them, a plan doesn't; one that has no use for them doesn't ask. */
static void threads_may_be_refused(void **state) {
  (void)state;
  const trial t = {&shapes[0], 130, 130, 1, 4, STILL, 0, 0.01, &msr_integrator_verlet, 1, 1};
  const trial small = {&shapes[0], 13, 13, 1, 4, STILL, 0, 0.01, &msr_integrator_verlet, 1, 1};
  world w = open_by(&t, 3);
  msr_state *none = NULL;
  refused = true;
  close_world(open_by(&small, 3));
  assert_int_equal(msr_state_create(w.plan, &none, &why), MSR_ENOMEM);
  assert_null(none);
  assert_non_null(strstr(why.message, "threads"));
  msr_scene *scene = scene_by(&t);
  add_force(scene, &nothing, NULL);
  world alone = open_world_with(scene, &(msr_plan_options){.threads = 3});
  refused = false;
  close_world(alone);
  close_world(w);
}

/* ---- What is seen between steps */

typedef struct witness {
  world *other;
  uint64_t looks, end;
} witness;

static msr_status compare(void *data, const msr_state *state) {
  witness *w = data;
  w->looks++;
  const uint64_t now = msr_state_iteration(state);
  advance(w->other, now - msr_state_iteration(w->other->state));
  if (msr_state_hash(state) != msr_state_hash(w->other->state))
    fail_msg("%s: other bits at iteration %llu", msr_plan_describe(w->other->plan).integrator->name,
             (unsigned long long)now);
  return now >= w->end ? MSR_EINTR : MSR_OK;
}

/* At rest: there's so little energy that a fall soon is faster than the guard expects. */
static void rest(const world *w) {
  const size_t n = msr_plan_describe(w->plan).masses;
  const msr_arrays s = msr_state_edit(w->state);
  memset(s.vx, 0, n * sizeof *s.vx), memset(s.vy, 0, n * sizeof *s.vy);
  for (size_t i = 0; i < n; i++) s.x[i] = 0.5 + (double)i, s.y[i] = 5;
}

/* Whenever poll is asked the state is whole, and after an interrupt it may be changed and go on. */
static void see_whole_states(const trial *t) {
  world is = open_by(t, 1), due = open_by(t, 0);
  if (t->height == 1) rest(&is), rest(&due);
  witness w = {.other = &due, .end = 300};
  const msr_run_options options = {.poll = compare, .data = &w};
  assert_int_equal(msr_run(is.state, &options, &why), MSR_EINTR);
  assert_true(w.looks > 1);
  stir(&is, 9), stir(&due, 9);
  advance(&is, 40), advance(&due, 40);
  assert_true(msr_state_hash(is.state) == msr_state_hash(due.state));
  close_world(is);
  close_world(due);
}

static void polls_see_whole_states(void **state) {
  (void)state;
  static const size_t sizes[][2] = {{2, 1}, {5, 1}, {4, 4}, {30, 20}};
  for (uint64_t n = 0; n < 7; n++)
    for (size_t i = 0; i < LENGTH(sizes); i++)
      see_whole_states(&(trial){.shape = &shapes[0],
                                .width = sizes[i][0],
                                .height = sizes[i][1],
                                .neighbours = 4,
                                .gravity = 9.8,
                                .dt = 0.01,
                                .integrator = splitting(n),
                                .substeps = 1,
                                .seed = n});
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shapes_have_the_same_bits),
      cmocka_unit_test(large_objects_have_the_same_bits),
      cmocka_unit_test(rectangles_have_the_same_bits),
      cmocka_unit_test(methods_have_the_same_bits),
      cmocka_unit_test(many_substeps_have_the_same_bits),
      cmocka_unit_test(runs_may_be_cut),
      cmocka_unit_test(states_of_a_plan_know_nothing_of_each_other),
      cmocka_unit_test(work_is_counted),
      cmocka_unit_test(explosions_are_told),
      cmocka_unit_test(crushes_go_on_with_care),
      cmocka_unit_test(threads_may_be_refused),
      cmocka_unit_test(polls_see_whole_states),
  };
  return cmocka_run_group_tests(tests, make_directory, remove_directory);
}
