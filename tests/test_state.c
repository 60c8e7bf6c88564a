/* test_state.c - states: copied, saved and loaded without losing a bit; forces and energies by
 * hand; and the guard, which tells of every explosion with a step that works, and of nothing else.
 */
#include "msr.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#define LENGTH(array) (sizeof(array) / sizeof *(array))
#define NO_NUMBER     ((double)NAN)
#define INFINITE      ((double)INFINITY)

/* ---- Simulations */

static const msr_conf example = {0.005, 9.8, 0.1, 1500, 20000, 800}; /* the assignment's */
static const msr_conf weightless = {0.005, 0, 0.1, 1500, 20000, 800};

/* '.' air, '#' support, 'o' mass; each row ends in a line feed. */
static msr_picture *paint(const char *art) {
  const size_t width = strcspn(art, "\n"), height = strlen(art) / (width + 1);
  msr_picture *picture;
  assert_int_equal(msr_picture_create(width, height, &picture, NULL), MSR_OK);
  for (size_t p = 0; p < width * height; p++) {
    const char letter = art[p + p / width];
    unsigned char *rgb = picture->rgb + 3 * p;
    if (letter != '.') rgb[1] = rgb[2] = 0;
    if (letter == '#') rgb[0] = 0;
  }
  return picture;
}

static msr_scene *scene_of(const char *art, const msr_conf *conf, msr_scene_options options) {
  msr_picture *picture = paint(art);
  msr_scene *scene;
  assert_int_equal(msr_scene_from_picture("art", picture, conf, &options, &scene, NULL), MSR_OK);
  msr_picture_free(picture);
  return scene;
}

static void add(msr_scene *scene, const msr_force *force, const void *params) {
  assert_int_equal(msr_scene_add_force(scene, force, params, NULL), MSR_OK);
}

typedef struct simulation {
  msr_plan *plan;
  msr_state *state;
} simulation;

/* The scene is freed. */
static simulation simulate(msr_scene *scene, const msr_integrator *integrator, uint64_t substeps) {
  const msr_plan_options options = {integrator, substeps};
  simulation sim;
  assert_int_equal(msr_plan_create(scene, &options, &sim.plan, NULL), MSR_OK);
  assert_int_equal(msr_state_create(sim.plan, &sim.state, NULL), MSR_OK);
  msr_scene_free(scene);
  return sim;
}

static void end(simulation sim) {
  msr_state_free(sim.state);
  msr_plan_free(sim.plan);
}

static void step(msr_state *state, uint64_t iterations) {
  msr_error err = {.message = ""};
  if (msr_state_step(state, iterations, &err) != MSR_OK) fail_msg("%s", err.message);
}

#define FALLING                                                                                    \
  "....................\n"                                                                         \
  "...ooooooooo........\n"                                                                         \
  "...ooooooooo........\n"                                                                         \
  "...ooooooooo........\n"                                                                         \
  "....................\n"                                                                         \
  "....................\n"                                                                         \
  "....................\n"                                                                         \
  "......#.......#.....\n"                                                                         \
  "....................\n"                                                                         \
  "####################\n"

#define FLAG                                                                                       \
  "....................\n"                                                                         \
  "#ooooooooo..........\n"                                                                         \
  "#ooooooooo..........\n"                                                                         \
  "#ooooooooo..........\n"                                                                         \
  "#...................\n"                                                                         \
  "#...................\n"

/* A scene with all there is: wind has a cache in the state, damping a flow, supports contacts. */
static simulation everything(const msr_integrator *integrator) {
  msr_scene *scene = scene_of(FALLING, &example, (msr_scene_options){8, true, true});
  assert_int_equal(msr_scene_set_contact(scene, 0.8, 0.3, NULL), MSR_OK);
  add(scene, &msr_force_drag, &(msr_drag){0.01});
  add(scene, &msr_force_damping, &(msr_damping){0.02});
  add(scene, &msr_force_wind, &(msr_wind){.speed = 5, .gust = 5, .gust_time = 0.1, .seed = 3});
  add(scene, &msr_force_push, &(msr_push){4, 3, 2});
  return simulate(scene, integrator, 7);
}

/* ---- Files */

static char directory[256];

static int make_directory(void **unused) {
  (void)unused;
  const char *root = getenv("TMPDIR");
  snprintf(directory, sizeof directory, "%s/msr-state-XXXXXX", root ? root : "/tmp");
  return mkdtemp(directory) ? 0 : -1;
}

static int remove_directory(void **unused) {
  (void)unused;
  return rmdir(directory);
}

static const char *state_path(void) {
  static char path[300];
  snprintf(path, sizeof path, "%s/state", directory);
  return path;
}

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

/* A run in one piece, in pieces, in a copy, and through a file: all the same. */
static void a_run_may_be_cut(void **unused) {
  (void)unused;
  for (const msr_integrator *const *i = msr_integrators; *i; i++) {
    if ((*i)->stability == 0) continue;
    simulation whole = everything(*i), cut = everything(*i), loaded = everything(*i);
    msr_state *copy;
    assert_int_equal(msr_state_create(cut.plan, &copy, NULL), MSR_OK);
    step(whole.state, 500);
    step(cut.state, 0);
    step(cut.state, 330);
    assert_true(msr_state_contacts(cut.state) > 0);
    msr_state_copy(copy, cut.state);
    assert_same(copy, cut.state);
    assert_int_equal(msr_state_save(cut.state, state_path(), NULL), MSR_OK);
    assert_int_equal(msr_state_load(loaded.state, state_path(), NULL), MSR_OK);
    assert_same(loaded.state, cut.state);
    for (int n = 0; n < 170; n++) {
      step(cut.state, 1);
      step(loaded.state, 1);
    }
    step(copy, 170);
    assert_same(cut.state, whole.state);
    assert_same(copy, whole.state);
    assert_same(loaded.state, whole.state);
    msr_state_free(copy);
    end(whole);
    end(cut);
    end(loaded);
  }
  remove(state_path());
}

/* Times are products, not sums: they are those of the iterations to the bit. */
static void time_is_not_summed(void **unused) {
  (void)unused;
  simulation sim = simulate(scene_of("oo\n", &weightless, (msr_scene_options){0}), NULL, 7);
  for (int i = 1; i <= 3000; i++) {
    step(sim.state, 1);
    assert_true(msr_state_view(sim.state).t == i * 0.005);
  }
  end(sim);
}

/* What a program changes is what the next step begins with, in a state that was fresh too. */
static void edits_are_taken_up(void **unused) {
  (void)unused;
  for (const msr_integrator *const *i = msr_integrators; *i; i++) {
    simulation sim = everything(*i), loaded = everything(*i);
    step(sim.state, 10);
    msr_state_edit(sim.state).x[3] += 0.125;
    assert_int_equal(msr_state_save(sim.state, state_path(), NULL), MSR_OK);
    assert_int_equal(msr_state_load(loaded.state, state_path(), NULL), MSR_OK);
    step(sim.state, 10);
    step(loaded.state, 10);
    assert_same(sim.state, loaded.state);
    end(sim);
    end(loaded);
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
    simulation whole = everything(NULL), cut = everything(NULL), loaded = everything(NULL);
    countdown c = {substeps};
    const msr_run_options run = {.poll = count_down, .data = &c};
    assert_int_equal(msr_run(cut.state, &run, NULL), MSR_EINTR);
    assert_true(msr_state_view(cut.state).t > 0);
    assert_int_equal(msr_state_save(cut.state, state_path(), NULL), MSR_OK);
    assert_int_equal(msr_state_load(loaded.state, state_path(), NULL), MSR_OK);
    assert_same(loaded.state, cut.state);
    step(whole.state, 5);
    step(cut.state, 5 - msr_state_iteration(cut.state));
    step(loaded.state, 5 - msr_state_iteration(loaded.state));
    assert_same(cut.state, whole.state);
    assert_same(loaded.state, whole.state);
    end(whole);
    end(cut);
    end(loaded);
  }
  remove(state_path());
}

/* FNV-1a over 8-byte words, by hand; every number counts. */
static void the_hash_is_of_every_bit(void **unused) {
  (void)unused;
  simulation sim = simulate(scene_of("oo\n", &weightless, (msr_scene_options){0}), NULL, 1);
  const double due[] = {0, 0.5, 1.5, 0.5, 0.5, 0, 0, 0, 0}; // t, x, y, vx, vy
  uint64_t hash = 0xcbf29ce484222325U;
  for (size_t i = 0; i < LENGTH(due); i++) {
    uint64_t word;
    memcpy(&word, &due[i], sizeof word);
    hash = (hash ^ word) * 0x100000001b3U;
  }
  assert_true(msr_state_hash(sim.state) == hash);
  const msr_arrays a = msr_state_edit(sim.state);
  double *const numbers[] = {&a.x[0],  &a.x[1],  &a.y[0],  &a.y[1],
                             &a.vx[0], &a.vx[1], &a.vy[0], &a.vy[1]};
  for (size_t i = 0; i < LENGTH(numbers); i++) {
    const double was = *numbers[i];
    *numbers[i] = nextafter(was, 1);
    assert_true(msr_state_hash(sim.state) != hash);
    *numbers[i] = was;
  }
  a.vx[0] = -0.0;
  assert_true(msr_state_hash(sim.state) != hash);
  end(sim);
}

/* ---- Files that aren't what they should be */

static void assert_refused(simulation *sim, const char *message) {
  msr_error err;
  const uint64_t hash = msr_state_hash(sim->state), iteration = msr_state_iteration(sim->state);
  assert_int_equal(msr_state_load(sim->state, state_path(), &err), MSR_EINPUT);
  if (!strstr(err.message, message)) fail_msg("'%s', not '%s'", err.message, message);
  assert_true(strncmp(err.message, state_path(), strlen(state_path())) == 0);
  assert_true(msr_state_hash(sim->state) == hash);
  assert_true(msr_state_iteration(sim->state) == iteration);
}

/* One bit changed anywhere, any number of bytes missing, or some too many. */
static void damaged_files_are_refused(void **unused) {
  (void)unused;
  unsigned char bytes[MOST_BYTES];
  simulation sim = simulate(scene_of("ooo\n", &example, (msr_scene_options){0}), NULL, 3);
  step(sim.state, 7);
  assert_int_equal(msr_state_save(sim.state, state_path(), NULL), MSR_OK);
  const size_t size = read_state(bytes);
  for (size_t i = 0; i < size; i++) {
    bytes[i] ^= (unsigned char)(1 << i % 8);
    write_state(bytes, size);
    assert_refused(&sim, "");
    bytes[i] ^= (unsigned char)(1 << i % 8);
  }
  for (size_t i = 0; i < size; i++) {
    write_state(bytes, i);
    assert_refused(&sim, i < 40 ? "no state" : i + 96 > size ? "damaged" : "");
  }
  write_state(bytes, size + 1);
  assert_refused(&sim, "damaged");
  write_state(bytes, size);
  assert_int_equal(msr_state_load(sim.state, state_path(), NULL), MSR_OK);
  remove(state_path());
  end(sim);
}

static void foreign_files_are_refused(void **unused) {
  (void)unused;
  simulation three = simulate(scene_of("ooo\n", &example, (msr_scene_options){0}), NULL, 1);
  simulation four = simulate(scene_of("oooo\n", &example, (msr_scene_options){0}), NULL, 1);
  write_state((const unsigned char *)"P6 1 1 255\nABC", 14);
  assert_refused(&three, "this is no state that this machine saved");
  assert_int_equal(msr_state_save(three.state, state_path(), NULL), MSR_OK);
  assert_refused(&four, "it has 3 masses and the scene has 4; load it into a state of the scene "
                        "that it was saved from");
  remove(state_path());
  msr_error err;
  assert_int_equal(msr_state_load(three.state, state_path(), &err), MSR_EIO);
  assert_int_equal(msr_state_load(three.state, directory, &err), MSR_EIO);
  assert_int_equal(msr_state_save(three.state, "/dev/full", &err), MSR_EIO);
  assert_int_equal(msr_state_save(three.state, "/nowhere/at/all", &err), MSR_EIO);
  end(three);
  end(four);
}

/* A big state doesn't fit the stream's buffer, so that it fails while it is written. */
static void a_full_disk_is_told(void **unused) {
  (void)unused;
  msr_scene *scene;
  assert_int_equal(msr_scene_create(&scene, NULL), MSR_OK);
  for (int i = 0; i < 5000; i++)
    assert_int_equal(msr_scene_add_mass(scene, &(msr_mass){.m = 1}, NULL, NULL), MSR_OK);
  simulation sim = simulate(scene, NULL, 1);
  msr_error err;
  assert_int_equal(msr_state_save(sim.state, "/dev/full", &err), MSR_EIO);
  assert_non_null(strstr(err.message, "/dev/full: cannot write it: No space left on device"));
  end(sim);
}

/* ---- Numbers */

/* Two masses and an anchor, all by hand. */
static void forces_and_energies_by_hand(void **unused) {
  (void)unused;
  msr_scene *scene;
  assert_int_equal(msr_scene_create(&scene, NULL), MSR_OK);
  const msr_mass masses[] = {{.x = 0, .y = 0, .vx = 1, .vy = 2, .m = 2},
                             {.x = 3, .y = 4, .vx = -1, .vy = 0, .m = 4}};
  for (int i = 0; i < 2; i++)
    assert_int_equal(msr_scene_add_mass(scene, &masses[i], NULL, NULL), MSR_OK);
  assert_int_equal(msr_scene_add_spring(scene, 1, 0, 10, 2, NULL), MSR_OK);
  assert_int_equal(msr_scene_add_anchor(scene, &(msr_anchor){0, 0, -8, 5, 4}, NULL), MSR_OK);
  add(scene, &msr_force_gravity, &(msr_gravity){3});
  add(scene, &msr_force_push, &(msr_push){1, 7, -9});
  add(scene, &msr_force_drag, &(msr_drag){0.5});
  simulation sim = simulate(scene, NULL, 1);
  double fx[2] = {NO_NUMBER, NO_NUMBER}, fy[2] = {NO_NUMBER, NO_NUMBER};
  assert_int_equal(msr_state_forces(sim.state, fx, fy, NULL), MSR_OK);
  // the spring pulls with 10 * 3 along (0.6, 0.8), the anchor with 5 * 4 down
  const double due[] = {18 - 0.5, 24 - 20 - 6 - 1, -18 + 7 + 0.5, -24 - 12 - 9};
  const double got[] = {fx[0], fy[0], fx[1], fy[1]};
  for (int i = 0; i < 4; i++) assert_true(fabs(got[i] - due[i]) <= 16 * DBL_EPSILON * 64);
  msr_arrays a = msr_state_edit(sim.state);
  a.x[1] += 1, a.x[1] -= 1; // an edit that changes nothing
  const msr_energy e = msr_state_energy(sim.state);
  assert_true(e.kinetic == 7 && e.spring == 45 + 40 && e.gravity == 48);
  assert_true(e.total == 7 + 85 + 48 && e.px == -2 && e.py == 4 && e.longest == 2.5);
  a.x[1] = 4; // the push has done 7 of work
  assert_true(fabs(msr_state_energy(sim.state).total - msr_state_energy(sim.state).kinetic -
                   msr_state_energy(sim.state).spring - 48 + 7) < 1e-12);
  assert_true(msr_state_view(sim.state).x[1] == 4);
  end(sim);
}

/* ---- The guard: what explodes */

typedef struct explosion {
  double dt;
  const msr_integrator *integrator;
  uint64_t substeps;
} explosion;

static simulation explosive(const explosion *e) {
  msr_conf conf = example;
  conf.dt = e->dt;
  return simulate(scene_of(FALLING, &conf, (msr_scene_options){0}), e->integrator, e->substeps);
}

/* The numbers that follow a word of the message. */
static double number_after(const char *message, const char *word) {
  const char *at = strstr(message, word);
  if (!at) fail_msg("no '%s' in '%s'", word, message);
  return strtod(at + strlen(word), NULL);
}

/* Runs as the message says would have worked: with the DT it names, and with the substeps. */
static void assert_advice_works(const explosion *e, const char *message) {
  const double dt = number_after(message, "; DT "), substeps = number_after(message, " or ");
  const double seconds = 100;
  const explosion by_dt = {dt, e->integrator, 1};
  const explosion by_substeps = {e->dt, e->integrator, (uint64_t)substeps};
  simulation sim = explosive(&by_dt);
  step(sim.state, (uint64_t)(seconds / dt));
  end(sim);
  sim = explosive(&by_substeps);
  step(sim.state, (uint64_t)(seconds / e->dt));
  end(sim);
}

/* The assignment's example with a longer DT: told in words that name the place and the way out. */
static void explosions_are_told_with_what_works(void **unused) {
  (void)unused;
  static const explosion explosions[] = {
      {0.008, NULL, 1},
      {0.01, NULL, 1},
      {0.05, NULL, 2},
      {0.01, &msr_integrator_symplectic_euler, 1},
      {0.014, &msr_integrator_rk4, 1},
  };
  for (size_t i = 0; i < LENGTH(explosions); i++) {
    simulation sim = explosive(&explosions[i]);
    msr_error err = {.message = ""};
    assert_int_equal(msr_state_step(sim.state, 20000, &err), MSR_EUNSTABLE);
    assert_int_equal(err.status, MSR_EUNSTABLE);
    const double iteration = number_after(err.message, "unstable at iteration ");
    assert_true(iteration == (double)msr_state_iteration(sim.state));
    assert_true(fabs(number_after(err.message, "t = ") - iteration * explosions[i].dt) <
                1e-3 * iteration * explosions[i].dt);
    assert_non_null(strstr(err.message, "the mass of pixel ("));
    const double ratio = number_after(err.message, "has run away, with ");
    assert_true(ratio > 1 || isnan(ratio));
    assert_advice_works(&explosions[i], err.message);
    end(sim);
  }
}

static void explicit_euler_is_told(void **unused) {
  (void)unused;
  simulation sim = explosive(&(explosion){0.005, &msr_integrator_euler, 0});
  msr_error err;
  assert_int_equal(msr_state_step(sim.state, 20000, &err), MSR_EUNSTABLE);
  assert_true(msr_state_iteration(sim.state) < 2000);
  assert_non_null(strstr(err.message, "euler has no stable step here; use verlet"));
  end(sim);
}

/* What isn't a number is told at once, and its mass named. */
static void numbers_that_are_none_are_told(void **unused) {
  (void)unused;
  static const double odd[] = {NO_NUMBER, INFINITE, -INFINITE, 1e200};
  for (size_t i = 0; i < 4 * LENGTH(odd); i++) {
    simulation sim = simulate(scene_of("oo..oo\n", &weightless, (msr_scene_options){0}), NULL, 0);
    const msr_arrays a = msr_state_edit(sim.state);
    double *const of_mass_2[] = {&a.x[2], &a.y[2], &a.vx[2], &a.vy[2]};
    *of_mass_2[i % 4] = odd[i / 4];
    msr_error err = {.message = ""};
    assert_int_equal(msr_state_check(sim.state, &err), MSR_EUNSTABLE);
    if (i / 4 < 3 || i % 4 > 1) assert_non_null(strstr(err.message, "the mass of pixel (4,0)"));
    assert_int_equal(msr_run(sim.state, NULL, &err), MSR_EUNSTABLE);
    assert_int_equal(msr_state_step(sim.state, 100, &err), MSR_EUNSTABLE);
    end(sim);
  }
  msr_scene *scene;
  assert_int_equal(msr_scene_create(&scene, NULL), MSR_OK);
  for (int i = 0; i < 2; i++)
    assert_int_equal(msr_scene_add_mass(scene, &(msr_mass){.x = i, .m = 1}, NULL, NULL), MSR_OK);
  simulation sim = simulate(scene, NULL, 0);
  msr_state_edit(sim.state).vy[1] = NO_NUMBER;
  msr_error err;
  assert_int_equal(msr_state_check(sim.state, &err), MSR_EUNSTABLE);
  assert_non_null(strstr(err.message, ": mass 1 is no longer finite"));
  end(sim);
}

/* A force of one's own that heats, and says that it doesn't. */
static msr_status heat(const void *self, void *scratch, const msr_view *s, double *fx, double *fy) {
  (void)self, (void)scratch, (void)fy;
  for (size_t i = 0; i < s->n; i++) fx[i] += 5 * s->vx[i] * msr_view_mass(s, i);
  return MSR_OK;
}

/* Told before the energy has grown a hundredfold; the advice goes by the step: halve one that is
 * safe, take a safe one instead of one that isn't. */
static void a_false_declaration_is_told(void **unused) {
  (void)unused;
  static const msr_force liar = {.name = "liar",
                                 .summary = "claims to take energy away",
                                 .dissipative = true,
                                 .uses_velocity = true,
                                 .add = heat};
  static const struct {
    const char *art, *advice;
    double dt;
    uint64_t substeps;
  } rows[] = {
      {"oo\n", "the step is below the limit of stability, 0.0115 s: try 6 substeps", 0.005, 3},
      {"oo..#\n", "; DT 0.00574 or 2 substeps would have worked", 0.008, 1},
  };
  for (size_t i = 0; i < LENGTH(rows); i++) {
    msr_conf conf = weightless;
    conf.dt = rows[i].dt;
    msr_scene *scene = scene_of(rows[i].art, &conf, (msr_scene_options){0});
    add(scene, &liar, NULL);
    simulation sim = simulate(scene, NULL, rows[i].substeps);
    msr_state_edit(sim.state).vx[0] = 10;
    msr_error err;
    assert_int_equal(msr_state_step(sim.state, 20000, &err), MSR_EUNSTABLE);
    assert_non_null(strstr(err.message, rows[i].advice));
    assert_true(number_after(err.message, "has run away, with ") < 100);
    end(sim);
  }
}

/* ---- The guard: what is sound */

static msr_scene *falling(void) { return scene_of(FALLING, &example, (msr_scene_options){0}); }

static msr_scene *heavy_impact(void) {
  msr_conf conf = example;
  conf.gravity = 500;
  return scene_of(FALLING, &conf, (msr_scene_options){.neighbours = 8});
}

static msr_scene *stiff(void) {
  msr_conf conf = example;
  conf.stiffness = 1e7;
  return scene_of(FALLING, &conf, (msr_scene_options){0});
}

static msr_scene *soft(void) {
  msr_conf conf = example;
  conf.stiffness = 1e-6;
  return scene_of(FALLING, &conf, (msr_scene_options){0});
}

static msr_scene *flag_in(msr_wind wind) {
  msr_scene *scene = scene_of(FLAG, &weightless, (msr_scene_options){8, true, false});
  add(scene, &msr_force_wind, &wind);
  return scene;
}

static msr_scene *flag_in_storm(void) {
  return flag_in((msr_wind){.c = 0.5, .speed = 50, .gust = 50, .gust_time = 0.5, .seed = 1});
}

static msr_scene *flag_in_a_buzz(void) {
  return flag_in((msr_wind){.c = 2, .gust = 100, .gust_time = 0.01, .seed = 2});
}

static msr_scene *free_in_wind(void) {
  msr_scene *scene = scene_of("ooo\nooo\n", &weightless, (msr_scene_options){0});
  add(scene, &msr_force_wind, &(msr_wind){.speed = 30, .gust = 10, .seed = 4});
  return scene;
}

static msr_scene *free_fall(void) {
  return scene_of("ooo\nooo\n", &example, (msr_scene_options){0});
}

static msr_scene *upwards(void) {
  msr_conf conf = example;
  conf.gravity = -9.8;
  return scene_of("#####\n.....\n.ooo.\n", &conf, (msr_scene_options){0});
}

static msr_scene *pushed(void) {
  msr_scene *scene = scene_of("ooo.#\nooo.#\n", &weightless, (msr_scene_options){0});
  add(scene, &msr_force_push, &(msr_push){0, 50, 20});
  return scene;
}

static msr_scene *at_rest(void) {
  return scene_of("ooo\nooo\n", &weightless, (msr_scene_options){8, 0, 0});
}

static msr_scene *one_on_the_floor(void) {
  return scene_of("o\n#\n", &example, (msr_scene_options){0});
}

/* Touching the floor, with nothing to fall: every energy is 0 but for one step's weight. */
static msr_scene *one_touching_the_floor(void) {
  msr_scene *scene = scene_of("...\n...\n###\n", &example, (msr_scene_options){0});
  assert_int_equal(msr_scene_add_mass(scene, &(msr_mass){.x = 1.5, .y = 1, .m = 0.1}, NULL, NULL),
                   MSR_OK);
  return scene;
}

static msr_scene *one_thrown_up(void) {
  msr_scene *scene = scene_of("...\n...\n###\n", &example, (msr_scene_options){0});
  assert_int_equal(
      msr_scene_add_mass(scene, &(msr_mass){.x = 1.5, .y = 1, .vy = 20, .m = 0.1}, NULL, NULL),
      MSR_OK);
  return scene;
}

static msr_scene *pair(double radius, double speed) {
  msr_scene *scene;
  assert_int_equal(msr_scene_create(&scene, NULL), MSR_OK);
  for (int i = -1; i < 2; i += 2) {
    const msr_mass mass = {.x = radius * i, .vy = speed * i, .m = 0.1};
    assert_int_equal(msr_scene_add_mass(scene, &mass, NULL, NULL), MSR_OK);
  }
  assert_int_equal(msr_scene_add_spring(scene, 0, 1, 1500, 1, NULL), MSR_OK);
  return scene;
}

static msr_scene *spinning(void) { return pair(1, 40); }

/* Turning at W raises the radial frequency to sqrt(w^2 + 3 W^2): here by 0.1 %. */
static msr_scene *spinning_slowly(void) { return pair(0.5, 2); }

/* Different stiffnesses and masses, pulled apart at first, but not so far that springs invert. */
static msr_scene *pulled_apart(void) {
  msr_scene *scene;
  assert_int_equal(msr_scene_create(&scene, NULL), MSR_OK);
  for (size_t i = 0; i < 10; i++) {
    const msr_mass mass = {.x = 1.2 * (double)i, .m = 1 + (double)(i % 3)};
    assert_int_equal(msr_scene_add_mass(scene, &mass, NULL, NULL), MSR_OK);
    if (i > 0)
      assert_int_equal(msr_scene_add_spring(scene, i - 1, i, 10 + 500 * (double)i, 1, NULL),
                       MSR_OK);
  }
  return scene;
}

/* No method that is stable may be stopped, at the library's own step, over a long time. */
static void sound_scenes_are_left_alone(void **unused) {
  (void)unused;
  static const struct {
    const char *name;
    msr_scene *(*scene)(void);
    uint64_t iterations;
  } rows[] = {
      {"falling", falling, 20000},
      {"heavy impact", heavy_impact, 4000},
      {"stiff", stiff, 400},
      {"soft", soft, 20000},
      {"flag in a storm", flag_in_storm, 10000},
      {"flag in a buzz", flag_in_a_buzz, 10000},
      {"free in wind", free_in_wind, 20000},
      {"free fall", free_fall, 100000},
      {"upwards", upwards, 20000},
      {"pushed", pushed, 20000},
      {"at rest", at_rest, 100000},
      {"one on the floor", one_on_the_floor, 100000},
      {"one touching the floor", one_touching_the_floor, 1000},
      {"one thrown up", one_thrown_up, 100000},
      {"spinning", spinning, 100000},
      {"pulled apart", pulled_apart, 100000},
  };
  int stopped = 0;
  for (size_t i = 0; i < LENGTH(rows); i++)
    for (const msr_integrator *const *method = msr_integrators; *method; method++) {
      if ((*method)->stability == 0) continue;
      simulation sim = simulate(rows[i].scene(), *method, 0);
      msr_error err = {.message = ""};
      if (msr_state_step(sim.state, rows[i].iterations, &err) != MSR_OK) {
        print_error("%s, %s: %s\n", rows[i].name, (*method)->name, err.message);
        stopped++;
      }
      end(sim);
    }
  assert_int_equal(stopped, 0);
}

/* Back at the height that it fell from, a mass has kinetic energy left from what the bounce shifted
 * it, and nothing lost to show for it: looked at after every iteration, at any gravity. */
static void a_mass_alone_may_bounce(void **unused) {
  (void)unused;
  for (double g = 1; g < 20000; g *= 1.7)
    for (const msr_integrator *const *method = msr_integrators; *method; method++) {
      if ((*method)->stability == 0) continue;
      msr_conf conf = example;
      conf.gravity = g;
      simulation sim = simulate(scene_of("o\n.\n#\n", &conf, (msr_scene_options){0}), *method, 0);
      for (int i = 0; i < 1000; i++) {
        msr_error err;
        step(sim.state, 1);
        if (msr_state_check(sim.state, &err) != MSR_OK) fail_msg("gravity %g: %s", g, err.message);
      }
      end(sim);
    }
}

/* Just below the largest step that is stable at any stretch, without contacts. */
static void sound_up_to_the_stable_step(void **unused) {
  (void)unused;
  msr_scene *(*const scenes[])(void) = {free_fall, at_rest, spinning_slowly, pulled_apart};
  for (size_t i = 0; i < LENGTH(scenes); i++)
    for (const msr_integrator *const *method = msr_integrators; *method; method++) {
      if ((*method)->stability == 0) continue;
      msr_scene *scene = scenes[i]();
      msr_plan *plan;
      const msr_plan_options options = {*method, 1};
      assert_int_equal(msr_plan_create(scene, &options, &plan, NULL), MSR_OK);
      const double h = 0.99 * msr_plan_describe(plan).stable_step;
      msr_plan_free(plan);
      assert_int_equal(msr_scene_set_times(scene, h, 1, 1, NULL), MSR_OK);
      simulation sim = simulate(scene, *method, 1);
      step(sim.state, 100000);
      end(sim);
    }
}

/* Nothing moves where nothing pulls: what was at rest for 10^5 steps hasn't gained an ulp. */
static void rest_is_rest(void **unused) {
  (void)unused;
  simulation sim = simulate(scene_of("ooo\nooo\n", &weightless, (msr_scene_options){0}), NULL, 0);
  step(sim.state, 100000);
  assert_true(msr_state_energy(sim.state).total == 0);
  assert_true(msr_state_view(sim.state).x[0] == 0.5);
  end(sim);
}

/* What a program changes isn't an explosion: the guard begins anew. */
static void edits_are_left_alone(void **unused) {
  (void)unused;
  simulation sim = simulate(at_rest(), NULL, 0);
  for (int i = 0; i < 10; i++) {
    step(sim.state, 64);
    msr_arrays a = msr_state_edit(sim.state);
    for (size_t k = 0; k < 6; k++) a.vx[k] += 10 * pow(4, i);
  }
  step(sim.state, 64);
  end(sim);
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
      cmocka_unit_test(a_full_disk_is_told),
      cmocka_unit_test(forces_and_energies_by_hand),
      cmocka_unit_test(explosions_are_told_with_what_works),
      cmocka_unit_test(explicit_euler_is_told),
      cmocka_unit_test(numbers_that_are_none_are_told),
      cmocka_unit_test(a_false_declaration_is_told),
      cmocka_unit_test(sound_scenes_are_left_alone),
      cmocka_unit_test(a_mass_alone_may_bounce),
      cmocka_unit_test(sound_up_to_the_stable_step),
      cmocka_unit_test(rest_is_rest),
      cmocka_unit_test(edits_are_left_alone),
  };
  return cmocka_run_group_tests_name("state", tests, make_directory, remove_directory);
}
