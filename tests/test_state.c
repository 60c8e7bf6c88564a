/* test_state.c - states: copied, saved and loaded without losing a bit; files that are refused;
 * forces and energies by hand. */
#include "art.h"
#include "files.h"

/* ---- A scene */

/* A scene with all there is: wind has a cache in the state, damping a flow, supports contacts. */
static world everything(const msr_integrator *integrator) {
  msr_scene *scene = scene_of(pegs, &example, &(msr_scene_options){8, true, true});
  must(msr_scene_set_contact(scene, 0.8, 0.3, &why));
  add_force(scene, &msr_force_drag, &(msr_drag){0.01});
  add_force(scene, &msr_force_damping, &(msr_damping){0.02});
  add_force(scene, &msr_force_wind,
            &(msr_wind){.speed = 5, .gust = 5, .gust_time = 0.1, .seed = 3});
  add_force(scene, &msr_force_push, &(msr_push){4, 3, 2});
  return open_world(scene, integrator, 7);
}

/* ---- Files */

static const char *state_path(void) { return path_of("state"); }

enum { MOST_BYTES = 4096 };

static size_t read_state(unsigned char bytes[MOST_BYTES]) {
  FILE *file = fopen(state_path(), "rb");
  assert_non_null(file);
  const size_t size = fread(bytes, 1, MOST_BYTES, file);
  assert_true(size > 0 && size < MOST_BYTES);
  assert_int_equal(fclose(file), 0);
  return size;
}

static void write_state(const unsigned char *bytes, size_t size) {
  FILE *file = fopen(state_path(), "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(bytes, 1, size, file), size);
  assert_int_equal(fclose(file), 0);
}

/* ---- The same bits */

static void assert_same(const msr_state *a, const msr_state *b) {
  const msr_view p = msr_state_view(a), q = msr_state_view(b);
  assert_true(msr_state_hash(a) == msr_state_hash(b));
  assert_true(p.t == q.t && p.n == q.n);
  assert_memory_equal(p.x, q.x, p.n * sizeof *p.x);
  assert_memory_equal(p.vy, q.vy, p.n * sizeof *p.x);
  assert_true(msr_state_iteration(a) == msr_state_iteration(b));
  assert_true(msr_state_contacts(a) == msr_state_contacts(b));
}

/* The same after some iterations, all bits of it; or, where the method has begun anew in one of the
 * two, to errors that an impact has made larger. */
static void assert_follows(const msr_integrator *integrator, const msr_state *a,
                           const msr_state *b) {
  if (!integrator->remembers) {
    assert_same(a, b);
    return;
  }
  const msr_view p = msr_state_view(a), q = msr_state_view(b);
  assert_true(p.t == q.t && msr_state_iteration(a) == msr_state_iteration(b));
  for (size_t i = 0; i < p.n; i++) assert_true(hypot(p.x[i] - q.x[i], p.y[i] - q.y[i]) < 1e-3);
}

/* A run in one piece, in pieces, in a copy, and through a file: all the same. */
static void a_run_may_be_cut(void **unused) {
  (void)unused;
  for (const msr_integrator *const *i = msr_integrators; *i; i++) {
    if ((*i)->stability == 0) continue;
    const uint64_t more = (*i)->remembers ? 2 : 170; /* before errors grow */
    world whole = everything(*i), cut = everything(*i), loaded = everything(*i);
    msr_state *copy;
    must(msr_state_create(cut.plan, &copy, &why));
    advance(&whole, 330 + more);
    advance(&cut, 0);
    advance(&cut, 330);
    assert_true(msr_state_contacts(cut.state) > 0);
    msr_state_copy(copy, cut.state);
    assert_same(copy, cut.state);
    must(msr_state_save(cut.state, state_path(), &why));
    must(msr_state_load(loaded.state, state_path(), &why));
    assert_same(loaded.state, cut.state);
    for (uint64_t n = 0; n < more; n++) {
      advance(&cut, 1);
      advance(&loaded, 1);
    }
    must(msr_state_step(copy, more, &why));
    assert_same(cut.state, whole.state);
    assert_follows(*i, copy, whole.state);
    assert_follows(*i, loaded.state, whole.state);
    msr_state_free(copy);
    close_world(whole);
    close_world(cut);
    close_world(loaded);
  }
  remove(state_path());
}

/* Times are products, not sums: they are those of the iterations to the bit. */
static void time_is_not_summed(void **unused) {
  (void)unused;
  world w = open_world(scene_of("oo\n", &weightless, NULL), NULL, 7);
  for (int i = 1; i <= 3000; i++) {
    advance(&w, 1);
    assert_true(msr_state_view(w.state).t == i * 0.005);
  }
  close_world(w);
}

/* What a program changes is what the next step begins with, in a state that was fresh too. */
static void edits_are_taken_up(void **unused) {
  (void)unused;
  for (const msr_integrator *const *i = msr_integrators; *i; i++) {
    world w = everything(*i), loaded = everything(*i);
    advance(&w, 10);
    msr_state_edit(w.state).x[3] += 0.125;
    must(msr_state_save(w.state, state_path(), &why));
    must(msr_state_load(loaded.state, state_path(), &why));
    advance(&w, 10);
    advance(&loaded, 10);
    assert_same(w.state, loaded.state);
    close_world(w);
    close_world(loaded);
  }
  remove(state_path());
}

typedef struct countdown {
  int left;
} countdown;

static msr_status count_down(void *data, const msr_state *state) {
  (void)state;
  countdown *c = data;
  return c->left-- > 0 ? MSR_OK : MSR_EINTR;
}

/* Saved between two substeps, it goes on there. */
static void a_run_may_be_cut_within_an_iteration(void **unused) {
  (void)unused;
  for (int substeps = 1; substeps < 20; substeps += 3) {
    world whole = everything(NULL), cut = everything(NULL), loaded = everything(NULL);
    countdown c = {substeps};
    const msr_run_options run = {.poll = count_down, .data = &c};
    assert_int_equal(msr_run(cut.state, &run, NULL), MSR_EINTR);
    assert_true(msr_state_view(cut.state).t > 0);
    must(msr_state_save(cut.state, state_path(), &why));
    must(msr_state_load(loaded.state, state_path(), &why));
    assert_same(loaded.state, cut.state);
    advance(&whole, 5);
    advance(&cut, 5 - msr_state_iteration(cut.state));
    advance(&loaded, 5 - msr_state_iteration(loaded.state));
    assert_same(cut.state, whole.state);
    assert_same(loaded.state, whole.state);
    close_world(whole);
    close_world(cut);
    close_world(loaded);
  }
  remove(state_path());
}

/* FNV-1a over 8-byte words, by hand; every number counts. */
static void the_hash_is_of_every_bit(void **unused) {
  (void)unused;
  world w = open_world(scene_of("oo\n", &weightless, NULL), NULL, 1);
  const double due[] = {0, 0.5, 1.5, 0.5, 0.5, 0, 0, 0, 0}; // t, x, y, vx, vy
  uint64_t hash = 0xcbf29ce484222325U;
  for (size_t i = 0; i < LENGTH(due); i++) {
    uint64_t word;
    memcpy(&word, &due[i], sizeof word);
    hash = (hash ^ word) * 0x100000001b3U;
  }
  assert_true(msr_state_hash(w.state) == hash);
  const msr_arrays a = msr_state_edit(w.state);
  double *const numbers[] = {&a.x[0],  &a.x[1],  &a.y[0],  &a.y[1],
                             &a.vx[0], &a.vx[1], &a.vy[0], &a.vy[1]};
  for (size_t i = 0; i < LENGTH(numbers); i++) {
    const double was = *numbers[i];
    *numbers[i] = nextafter(was, 1);
    assert_true(msr_state_hash(w.state) != hash);
    *numbers[i] = was;
  }
  a.vx[0] = -0.0;
  assert_true(msr_state_hash(w.state) != hash);
  close_world(w);
}

/* ---- Files that aren't what they should be */

static void assert_refused(const world *w, const char *message) {
  msr_error err;
  const uint64_t hash = msr_state_hash(w->state), iteration = msr_state_iteration(w->state);
  assert_int_equal(msr_state_load(w->state, state_path(), &err), MSR_EINPUT);
  if (!strstr(err.message, message)) fail_msg("'%s', not '%s'", err.message, message);
  assert_true(strncmp(err.message, state_path(), strlen(state_path())) == 0);
  assert_true(msr_state_hash(w->state) == hash);
  assert_true(msr_state_iteration(w->state) == iteration);
}

/* One bit changed anywhere, any number of bytes missing, or some too many. */
static void damaged_files_are_refused(void **unused) {
  (void)unused;
  unsigned char bytes[MOST_BYTES] = {0};
  world w = open_world(scene_of("ooo\n", &example, NULL), NULL, 3);
  advance(&w, 7);
  must(msr_state_save(w.state, state_path(), &why));
  const size_t size = read_state(bytes);
  for (size_t i = 0; i < size; i++) {
    bytes[i] ^= (unsigned char)(1 << i % 8);
    write_state(bytes, size);
    assert_refused(&w, "");
    bytes[i] ^= (unsigned char)(1 << i % 8);
  }
  for (size_t i = 0; i < size; i++) {
    write_state(bytes, i);
    assert_refused(&w, i < 40 ? "no state" : i + 96 > size ? "damaged" : "");
  }
  write_state(bytes, size + 1);
  assert_refused(&w, "damaged");
  write_state(bytes, size);
  must(msr_state_load(w.state, state_path(), &why));
  remove(state_path());
  close_world(w);
}

static void foreign_files_are_refused(void **unused) {
  (void)unused;
  world three = open_world(scene_of("ooo\n", &example, NULL), NULL, 1);
  world four = open_world(scene_of("oooo\n", &example, NULL), NULL, 1);
  write_state((const unsigned char *)"P6 1 1 255\nABC", 14);
  assert_refused(&three, "this is no state that this machine saved");
  must(msr_state_save(three.state, state_path(), &why));
  assert_refused(&four, "it has 3 masses and the scene has 4; load it into a state of the scene "
                        "that it was saved from");
  remove(state_path());
  msr_error err;
  assert_int_equal(msr_state_load(three.state, state_path(), &err), MSR_EIO);
  assert_int_equal(msr_state_load(three.state, directory, &err), MSR_EIO);
  assert_int_equal(msr_state_save(three.state, "/dev/full", &err), MSR_EIO);
  assert_int_equal(msr_state_save(three.state, "/nowhere/at/all", &err), MSR_EIO);
  close_world(three);
  close_world(four);
}

/* What a file says is of its own DT and substeps, and of so many masses. */
static void files_of_other_plans_are_refused(void **unused) {
  (void)unused;
  msr_conf longer = example;
  longer.dt = 0.006;
  const struct {
    world w;
    const char *message;
  } others[] = {
      {open_world(scene_of("ooo\n", &longer, NULL), NULL, 2),
       "its iterations are 0.005 s in 2 substeps, those of the plan 0.006 s in 2; load it into a "
       "state of the plan that it was saved from"},
      {open_world(scene_of("ooo\n", &example, NULL), NULL, 3),
       "its iterations are 0.005 s in 2 substeps, those of the plan 0.005 s in 3; load it into a "
       "state of the plan that it was saved from"},
      {open_world(scene_of("o\n", &longer, NULL), NULL, 3), "it has 3 masses and the scene has 1"},
      {open_world(scene_of("o.oo.oo\n", &example, NULL), NULL, 2),
       "it has 3 masses and the scene has 5"},
  };
  const world saved = open_world(scene_of("ooo\n", &example, NULL), NULL, 2);
  advance(&saved, 7);
  must(msr_state_save(saved.state, state_path(), &why));
  for (size_t i = 0; i < LENGTH(others); i++) {
    assert_refused(&others[i].w, others[i].message);
    close_world(others[i].w);
  }
  close_world(saved);
  remove(state_path());
}

/* A big state doesn't fit the stream's buffer, so that it fails while it is written. */
static void a_full_disk_is_told(void **unused) {
  (void)unused;
  msr_scene *scene;
  must(msr_scene_create(&scene, &why));
  for (int i = 0; i < 5000; i++) must(msr_scene_add_mass(scene, &(msr_mass){.m = 1}, NULL, &why));
  world w = open_world(scene, NULL, 1);
  msr_error err;
  assert_int_equal(msr_state_save(w.state, "/dev/full", &err), MSR_EIO);
  assert_non_null(strstr(err.message, "/dev/full: cannot write it: No space left on device"));
  close_world(w);
}

/* ---- Numbers */

/* Two masses and an anchor, all by hand. */
static void forces_and_energies_by_hand(void **unused) {
  (void)unused;
  msr_scene *scene;
  must(msr_scene_create(&scene, &why));
  const msr_mass masses[] = {{.x = 0, .y = 0, .vx = 1, .vy = 2, .m = 2},
                             {.x = 3, .y = 4, .vx = -1, .vy = 0, .m = 4}};
  for (int i = 0; i < 2; i++) must(msr_scene_add_mass(scene, &masses[i], NULL, &why));
  must(msr_scene_add_spring(scene, 1, 0, 10, 2, &why));
  must(msr_scene_add_anchor(scene, &(msr_anchor){0, 0, -8, 5, 4}, &why));
  add_force(scene, &msr_force_gravity, &(msr_gravity){3});
  add_force(scene, &msr_force_push, &(msr_push){1, 7, -9});
  add_force(scene, &msr_force_drag, &(msr_drag){0.5});
  world w = open_world(scene, NULL, 1);
  double fx[2] = {NO_NUMBER, NO_NUMBER}, fy[2] = {NO_NUMBER, NO_NUMBER};
  must(msr_state_forces(w.state, fx, fy, &why));
  // the spring pulls with 10 * 3 along (0.6, 0.8), the anchor with 5 * 4 down
  const double due[] = {18 - 0.5, 24 - 20 - 6 - 1, -18 + 7 + 0.5, -24 - 12 - 9};
  const double got[] = {fx[0], fy[0], fx[1], fy[1]};
  for (int i = 0; i < 4; i++) assert_true(fabs(got[i] - due[i]) <= 16 * DBL_EPSILON * 64);
  msr_arrays a = msr_state_edit(w.state);
  a.x[1] += 1, a.x[1] -= 1; // an edit that changes nothing
  const msr_energy e = msr_state_energy(w.state);
  assert_true(e.kinetic == 7 && e.spring == 45 + 40 && e.gravity == 48);
  assert_true(e.total == 7 + 85 + 48 && e.px == -2 && e.py == 4 && e.longest == 2.5);
  a.x[1] = 4; // the push has done 7 of work
  assert_true(fabs(msr_state_energy(w.state).total - msr_state_energy(w.state).kinetic -
                   msr_state_energy(w.state).spring - 48 + 7) < 1e-12);
  assert_true(msr_state_view(w.state).x[1] == 4);
  close_world(w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_run_may_be_cut),
      cmocka_unit_test(a_run_may_be_cut_within_an_iteration),
      cmocka_unit_test(time_is_not_summed),
      cmocka_unit_test(edits_are_taken_up),
      cmocka_unit_test(the_hash_is_of_every_bit),
      cmocka_unit_test(damaged_files_are_refused),
      cmocka_unit_test(foreign_files_are_refused),
      cmocka_unit_test(files_of_other_plans_are_refused),
      cmocka_unit_test(a_full_disk_is_told),
      cmocka_unit_test(forces_and_energies_by_hand),
  };
  return cmocka_run_group_tests_name("state", tests, make_directory, remove_directory);
}
