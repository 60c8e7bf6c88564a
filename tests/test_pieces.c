/* test_pieces.c - a run has the same bits however it is cut in pieces: into calls, by copies, by
 * files, or into substeps. Where a method that remembers begins anew it agrees within errors. */
#include "files.h"
#include "systems.h"

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
  const char *path = path_of("state");
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
  bool anew; /* the method begins anew on the way */
} ways[] = {{"at once", at_once, false}, {"one at a time", one_at_a_time, false},
            {"touched", touched, true},  {"copied", copied, true},
            {"forked", forked, true},    {"saved and loaded", saved_and_loaded, true}};

/* At the default atol of 1e-6, as much as test_integrators.c grants. */
static const double most_errors = 40e-6;

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
      const bool same = n == 0 || memcmp(z, first, sizeof z) == 0, anew = ways[n].anew;
      const bool near = n == 0 || distance(4 * MASSES, z, first) < most_errors;
      const bool equal = same && hash == msr_state_hash(w.state);
      if (integrator->remembers && anew ? !near : !equal)
        fail_msg("%s, %s, %s: other bits", integrator->name, media[m].name, ways[n].name);
      close_world(w);
    }
  }
}

static void a_run_in_pieces_has_the_same_bits(void **state) {
  (void)state;
  on_all(check_ways);
}

static msr_status stiffen(void *self, double t, const double *q, const double *v, double *a) {
  (void)self, (void)t, (void)v;
  a[0] = -q[0] * q[0] * q[0];
  return MSR_OK;
}

/* Where a doesn't depend on t. */
static void check_plain_pieces(const msr_integrator *integrator) {
  const msr_system system = {.n = 1, .acceleration = stiffen};
  double whole[] = {1, 0.5}, pieces[] = {1, 0.5};
  must(msr_integrate(integrator, &system, 0, 0.1, 20, whole, whole + 1, &why));
  for (int n = 0; n < 4; n++)
    must(msr_integrate(integrator, &system, 0, 0.1, 5, pieces, pieces + 1, &why));
  if (!integrator->remembers) assert_memory_equal(whole, pieces, sizeof whole);
  assert_true(distance(2, whole, pieces) < most_errors);
}

static void a_plain_run_in_pieces_has_the_same_bits(void **state) {
  (void)state;
  on_all(check_plain_pieces);
}

/* 4 substeps are 4 iterations of a quarter of DT: the same bits where nothing depends on t, and
 * where something does, to the rounding of t, 1e-16 s times rates of 100 a second. Rounding may
 * decide whether an adaptive method takes a step back. */
static void check_substeps(const msr_integrator *integrator) {
  for (size_t m = 0; m < LENGTH(media); m++) {
    double few[4 * MASSES], many[4 * MASSES];
    bool uses_time = false;
    for (size_t f = 0; f < MOST_FORCES && media[m].force[f]; f++)
      uses_time |= media[m].force[f]->uses_time;
    world w = deformed(&media[m], integrator, 0.01, 4);
    advance(&w, 20);
    read_world(&w, few);
    close_world(w);
    w = deformed(&media[m], integrator, 0.0025, 1);
    advance(&w, 80);
    read_world(&w, many);
    close_world(w);
    const double apart = distance(4 * MASSES, few, many);
    const double rounding = integrator->adaptive ? most_errors : uses_time ? 1e-12 : 0;
    if (!(apart <= rounding)) fail_msg("%s, %s: %g apart", integrator->name, media[m].name, apart);
  }
}

static void substeps_are_smaller_iterations(void **state) {
  (void)state;
  on_all(check_substeps);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_run_in_pieces_has_the_same_bits),
      cmocka_unit_test(a_plain_run_in_pieces_has_the_same_bits),
      cmocka_unit_test(substeps_are_smaller_iterations),
  };
  return cmocka_run_group_tests(tests, make_directory, remove_directory);
}
