/* test_memory.c - every allocation made to fail in turn, from the scene to the files: the status is
 * MSR_ENOMEM, the message says so, nothing is created, nothing is left behind, and what there was
 * is as it was. Under a leak checker this shows that nothing is lost either.
 * link: --wrap=malloc --wrap=calloc --wrap=realloc */
#include "alloc.h"
#include "art.h"
#include "files.h"

static char ppm[300], conf[300], frames[300], csv[300], npy[300], saved[300];

static int set_up(void **unused) {
  static const char conf_text[] = "DT\n0.002\nGRAVITE\n9.8\nMASSE\n0.1\nTENSION_RESSORT\n1500\n"
                                  "NB_ITERATIONS\n4\nNB_IMAGES\n2\n";
  static const char ppm_text[] = "P3 4 4 255\n"
                                 "255 0 0  255 0 0  255 255 255  0 255 0\n"
                                 "255 0 0  255 0 0  255 255 255  0 255 0\n"
                                 "255 255 255  255 255 255  255 255 255  255 255 255\n"
                                 "0 0 0  0 0 0  0 0 0  0 0 0\nP3 1 1 1 1 1 1\n";
  if (make_directory(unused) != 0) return -1;
  const struct {
    char *path;
    const char *name, *text;
  } files[] = {{ppm, "s.ppm", ppm_text}, {conf, "s.conf", conf_text}, {frames, "frames", NULL},
               {csv, "s.csv", NULL},     {npy, "t.npy", NULL},        {saved, "state", NULL}};
  for (size_t i = 0; i < LENGTH(files); i++) {
    snprintf(files[i].path, sizeof ppm, "%s/%s", directory, files[i].name);
    if (!files[i].text) continue;
    FILE *file = fopen(files[i].path, "w");
    if (!file || fputs(files[i].text, file) < 0 || fclose(file) != 0) return -1;
  }
  return 0;
}

static int tear_down(void **unused) {
  remove(ppm);
  remove(conf);
  return remove_directory(unused);
}

/* ---- Failures must be told as such */

static int wrong; /* failures that weren't told, or were told wrongly */

/* Done? If not, it must be for want of memory, and say so. */
static bool done(msr_status status, const msr_error *err) {
  if (status == MSR_OK) return true;
  const bool told = status == MSR_ENOMEM && err->status == status;
  if (told && strstr(err->message, "out of memory")) return false;
  print_error("allocation %zu: status %d, '%s'\n", alloc_failing, (int)status, err->message);
  wrong++;
  return false;
}

/* What isn't made is left NULL. */
static void made_if(bool success, const void *made) {
  if ((made != NULL) != success) wrong++;
}

static void assert_each_failure_is_told(bool (*attempt)(void), size_t least) {
  wrong = 0;
  const size_t failures = alloc_fail_each(attempt);
  assert_int_equal(wrong, 0);
  if (failures < least) fail_msg("%zu allocations failed, %zu were expected", failures, least);
}

/* ---- Scenes */

static const msr_force mine = {.name = "mine",
                               .summary = "nothing",
                               .uses_velocity = true,
                               .scratch_size = 8,
                               .add = add_nothing};

/* More masses, springs and anchors than fit the first block of each, and every force. */
static bool add_all(msr_scene *scene, msr_error *err) {
  const struct {
    const msr_force *force;
    const void *params;
  } forces[] = {
      {&msr_force_drag, &(msr_drag){0.1}},
      {&msr_force_damping, &(msr_damping){0.1}},
      {&msr_force_wind, &(msr_wind){.speed = 1, .gust = 1, .seed = 1}},
      {&msr_force_push, &(msr_push){1, 1, 1}},
      {&mine, NULL},
  };
  for (size_t i = 0; i < 20; i++) {
    const msr_mass mass = {.x = 0.2 * (double)i, .y = 1.5, .m = 1 + (double)i};
    const size_t before = msr_scene_masses(scene);
    size_t index = 99;
    const bool added = done(msr_scene_add_mass(scene, &mass, &index, err), err);
    if (msr_scene_masses(scene) != before + added || index != (added ? before : 99)) wrong++;
    if (!added) return false;
    if (!done(msr_scene_add_spring(scene, i, before, 10, 1, err), err)) return false;
    if (!done(msr_scene_add_anchor(scene, &(msr_anchor){i, 0, 9, 1, 1}, err), err)) return false;
  }
  for (size_t i = 0; i < LENGTH(forces); i++)
    if (!done(msr_scene_add_force(scene, forces[i].force, forces[i].params, err), err))
      return false;
  return true;
}

static msr_scene *load(msr_error *err) {
  const msr_scene_options options = {8, true, true};
  msr_scene *scene = NULL;
  const bool success = done(msr_scene_load(ppm, conf, &options, &scene, err), err);
  made_if(success, scene);
  if (success && !msr_scene_warning(scene, 0)) wrong++; // the file holds two images
  return scene;
}

static bool make_scenes(void) {
  static const msr_conf usual = {0.005, 9.8, 0.1, 1500, 1, 1};
  msr_error err;
  msr_picture *picture = NULL;
  msr_scene *scene = load(&err), *drawn = NULL, *empty = NULL;
  bool success = scene && add_all(scene, &err);
  success = success && done(msr_picture_create(3, 3, &picture, &err), &err);
  success = success && done(msr_scene_from_picture("p", picture, &usual, NULL, &drawn, &err), &err);
  success = success && done(msr_scene_create(&empty, &err), &err);
  msr_picture_free(picture);
  msr_scene_free(empty);
  msr_scene_free(drawn);
  msr_scene_free(scene);
  return success;
}

static void scenes(void **unused) {
  (void)unused;
  assert_each_failure_is_told(make_scenes, 20);
}

/* What failed can be tried again: the scene is as it was, also when its lists had to grow. */
static void a_scene_survives_failures(void **unused) {
  (void)unused;
  enum { DRAGS = 20 };
  msr_error err;
  msr_scene *survivor = load(&err);
  for (int i = 0; i < DRAGS; i++) {
    msr_status status = MSR_ENOMEM;
    for (size_t failing = 1; status == MSR_ENOMEM; failing++) {
      alloc_calls = 0;
      alloc_failing = failing;
      status = msr_scene_add_force(survivor, &msr_force_drag, &(msr_drag){1}, &err);
      alloc_failing = 0;
    }
    assert_int_equal(status, MSR_OK);
  }
  msr_plan *made;
  assert_int_equal(msr_plan_create(survivor, NULL, &made, &err), MSR_OK);
  size_t n, drags = 0;
  const msr_effect *effects = msr_plan_effects(made, &n);
  for (size_t e = 0; e < n; e++) drags += effects[e].force == &msr_force_drag;
  assert_int_equal(drags, DRAGS);
  msr_plan_free(made);
  msr_scene_free(survivor);
}

/* ---- Plans and states */

static msr_scene *scene; /* made beforehand, with all allocations well */
static msr_plan *plan;

static int make_plan(void **unused) {
  (void)unused;
  msr_error err;
  scene = load(&err);
  const msr_plan_options options = {.substeps = 2};
  return scene && add_all(scene, &err) && msr_plan_create(scene, &options, &plan, &err) == MSR_OK
             ? 0
             : -1;
}

static int free_plan(void **unused) {
  (void)unused;
  msr_plan_free(plan);
  msr_scene_free(scene);
  return 0;
}

static bool make_plans(void) {
  msr_error err;
  msr_plan *made = NULL;
  for (const msr_integrator *const *i = msr_integrators; *i; i++) {
    const msr_plan_options options = {.integrator = *i};
    const bool success = done(msr_plan_create(scene, &options, &made, &err), &err);
    made_if(success, made);
    msr_plan_free(made);
    made = NULL;
    if (!success) return false;
  }
  return true;
}

static void plans(void **unused) {
  (void)unused;
  assert_each_failure_is_told(make_plans, 60);
}

static bool analyse(void) {
  msr_error err = {MSR_OK, ""};
  msr_stability found;
  return done(msr_plan_stability(plan, &found, &err), &err);
}

static void analyses(void **unused) {
  (void)unused;
  assert_each_failure_is_told(analyse, 3);
}

static bool make_and_run_states(void) {
  msr_error err;
  msr_state *state = NULL;
  const bool success = done(msr_state_create(plan, &state, &err), &err);
  made_if(success, state);
  if (!success) return false;
  alloc_largest = 0;
  const size_t before = alloc_calls;
  double fx[64], fy[64];
  bool ran = done(msr_run(state, NULL, &err), &err);
  ran = ran && done(msr_state_forces(state, fx, fy, &err), &err);
  if (alloc_calls != before) wrong++; // no step allocates
  msr_state_free(state);
  return ran;
}

static void states(void **unused) {
  (void)unused;
  assert_each_failure_is_told(make_and_run_states, 1);
}

static bool save_and_load(void) {
  msr_error err;
  msr_state *state = NULL;
  if (!done(msr_state_create(plan, &state, &err), &err)) return false;
  bool success = done(msr_state_save(state, saved, &err), &err);
  if ((access(saved, F_OK) == 0) != success) wrong++;
  success = success && done(msr_state_step(state, 2, &err), &err);
  const uint64_t before = msr_state_hash(state);
  success = success && done(msr_state_load(state, saved, &err), &err);
  if ((msr_state_hash(state) != before) != success) wrong++;
  remove(saved);
  msr_state_free(state);
  return success;
}

static void files_of_states(void **unused) {
  (void)unused;
  assert_each_failure_is_told(save_and_load, 4);
}

/* ---- Outputs */

static bool make_renderer(void) {
  const msr_style style = {.scale = 2, .stripes = 1};
  msr_renderer *renderer = NULL;
  msr_error err;
  const bool success = done(msr_renderer_create(plan, &style, &renderer, &err), &err);
  made_if(success, renderer);
  msr_renderer_free(renderer);
  return success;
}

static void renderers(void **unused) {
  (void)unused;
  assert_each_failure_is_told(make_renderer, 7);
}

static bool open_all(msr_sink sinks[3], msr_error *err) {
  const msr_style style = {.stripes = 1};
  return done(msr_frames_open(plan, frames, &style, false, &sinks[0], err), err) &&
         done(msr_stats_open(plan, csv, &sinks[1], err), err) &&
         done(msr_trajectory_open(plan, npy, &sinks[2], err), err);
}

/* Every sink closes, whatever befell it; then its files are removed. */
static bool run_into_all(void) {
  msr_error err;
  msr_state *state = NULL;
  msr_sink sinks[3] = {{0}, {0}, {0}};
  bool success = done(msr_state_create(plan, &state, &err), &err) && open_all(sinks, &err);
  const msr_run_options options = {.sinks = sinks, .n_sinks = 3};
  success = success && done(msr_run(state, &options, &err), &err);
  for (int s = 0; s < 3; s++)
    if (msr_sink_close(&sinks[s], NULL) != MSR_OK) wrong++;
  msr_state_free(state);
  char path[400];
  for (int i = 0; i < 2; i++) {
    snprintf(path, sizeof path, "%s/frame-%06d.ppm", frames, i);
    if (remove(path) != 0 && success) wrong++;
  }
  if (access(frames, F_OK) == 0 && rmdir(frames) != 0) wrong++;
  if (success && (remove(csv) != 0 || remove(npy) != 0)) wrong++;
  if (!success) (void)remove(csv), (void)remove(npy);
  return success;
}

static void sinks_of_runs(void **unused) {
  (void)unused;
  assert_each_failure_is_told(run_into_all, 12);
}

static bool stream_to_stdout(void) {
  msr_error err;
  msr_sink sink = {0};
  const bool success = done(msr_frames_open(plan, "-", NULL, false, &sink, &err), &err);
  if (!success && sink.close) wrong++;
  if (msr_sink_close(&sink, NULL) != MSR_OK) wrong++;
  return success;
}

static void streams(void **unused) {
  (void)unused;
  assert_each_failure_is_told(stream_to_stdout, 6);
}

/* ---- An integrator alone */

static msr_status pull(void *self, double t, const double *q, const double *v, double *a) {
  (void)self, (void)t, (void)v;
  a[0] = -q[0];
  return MSR_OK;
}

static bool integrate(void) {
  const msr_system system = {.n = 1, .acceleration = pull};
  bool success = true;
  for (const msr_integrator *const *i = msr_integrators; *i && success; i++) {
    msr_error err;
    double q = 1, v = 0;
    success = done(msr_integrate(*i, &system, 0, 0.1, 10, &q, &v, &err), &err);
    if ((q != 1 || v != 0) != success) wrong++;
  }
  return success;
}

static void integrators(void **unused) {
  (void)unused;
  size_t n = 0;
  while (msr_integrators[n]) n++;
  assert_each_failure_is_told(integrate, n);
}

/* Each method on a scene of its own: what open makes is the state's, and no step allocates. */
static bool run_each(void) {
  bool success = true;
  for (const msr_integrator *const *i = msr_integrators; *i && success; i++) {
    msr_error err;
    msr_plan *own = NULL;
    msr_state *state = NULL;
    success = done(msr_plan_create(scene, &(msr_plan_options){.integrator = *i}, &own, &err), &err);
    success = success && done(msr_state_create(own, &state, &err), &err);
    made_if(success, state);
    const size_t before = alloc_calls;
    if (success && msr_state_step(state, 2, &err) != MSR_OK && (*i)->stability > 0) wrong++;
    if (alloc_calls != before) wrong++;
    msr_state_free(state);
    msr_plan_free(own);
  }
  return success;
}

static void states_of_each_method(void **unused) {
  (void)unused;
  assert_each_failure_is_told(run_each, 60);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(scenes),
      cmocka_unit_test(a_scene_survives_failures),
      cmocka_unit_test_setup_teardown(plans, make_plan, free_plan),
      cmocka_unit_test_setup_teardown(analyses, make_plan, free_plan),
      cmocka_unit_test_setup_teardown(states, make_plan, free_plan),
      cmocka_unit_test_setup_teardown(files_of_states, make_plan, free_plan),
      cmocka_unit_test_setup_teardown(renderers, make_plan, free_plan),
      cmocka_unit_test_setup_teardown(sinks_of_runs, make_plan, free_plan),
      cmocka_unit_test_setup_teardown(streams, make_plan, free_plan),
      cmocka_unit_test(integrators),
      cmocka_unit_test_setup_teardown(states_of_each_method, make_plan, free_plan),
  };
  return cmocka_run_group_tests_name("memory", tests, set_up, tear_down);
}
