/* test_resume.c - runs that are stopped, changed, saved or refused in mid-iteration, and go on:
 * with substeps, with leaps, and with care. */
#include "files.h"
#include "scenes.h"

#include "plan/state.h"
#include "run/step.h"

/* ---- Scenes */

static const msr_plan_options automatic = {0};
static const msr_plan_options seven = {.integrator = &msr_integrator_verlet, .substeps = 7};

/* A user's force that drives and doesn't tell its power. */
static msr_status add_shove(const void *self, void *scratch, const msr_view *s, double *fx,
                            double *fy) {
  (void)self, (void)scratch;
  for (size_t i = 0; i < s->n; i++) {
    fx[i] += 3 * cos(9 * s->t) * msr_view_mass(s, i);
    fy[i] -= 0.1 * sin(7 * s->t);
  }
  return MSR_OK;
}
static const msr_force shove = {
    .name = "shove", .summary = "t", .uses_time = true, .add = add_shove};

static void blow(msr_scene *scene) {
  add_force(scene, &msr_force_wind, &(msr_wind){.c = 1e-3, .speed = 5, .gust = 5, .seed = 3});
  add_force(scene, &shove, NULL);
}

static void throw(const world *w, double v) {
  const msr_arrays s = msr_state_edit(w->state);
  for (size_t i = 0; i < msr_plan_describe(w->plan).masses; i++) s.vx[i] = v / 5, s.vy[i] = -v;
}

/* A block above pegs and a floor, by substeps. */
static world plain(void) {
  msr_scene *scene = scene_of(pegs, &example, NULL);
  blow(scene);
  world w = open_world_with(scene, &seven);
  throw(&w, 60);
  return w;
}

/* The same, so stiff that an iteration is worth a leap. */
static msr_scene *stiff_pegs(void) {
  const msr_conf conf = {0.005, 9.8, 0.1, 5e4 * 0.1 / (0.005 * 0.005), 20000, 1};
  return scene_of(pegs, &conf, NULL);
}

static world leaping(void) {
  msr_scene *scene = stiff_pegs();
  blow(scene);
  world w = open_world_with(scene, &automatic);
  throw(&w, 60);
  return w;
}

/* Springs on one place: with care from the start. */
static msr_scene *crushed_springs(void) {
  msr_scene *scene = empty_scene(0.005);
  for (int i = 0; i < 9; i++) add_mass(scene, 5, 5 + 1e-3 * i, 0, 0, 0.1);
  for (size_t i = 1; i < 9; i++) must(msr_scene_add_spring(scene, i - 1, i, 1500, 1, &why));
  return scene;
}

static world crushed(void) {
  msr_scene *scene = crushed_springs();
  blow(scene);
  return open_world_with(scene, &automatic);
}

static const msr_conf short_run = {0.005, 9.8, 0.1, 1500, 60, 6};

static const char room[] = "............\n"
                           "...oooooo...\n"
                           "...oooooo...\n"
                           "...oooooo...\n"
                           "...oooooo...\n"
                           "............\n"
                           "............\n"
                           "............\n"
                           "............\n"
                           "............\n"
                           "............\n"
                           "............\n";

/* A block that heats where it's thrown at a wall. */
static world closed(bool blows) {
  msr_scene *scene = scene_of(room, &short_run, &(msr_scene_options){.closed_border = true});
  if (blows) blow(scene);
  return open_world_with(scene, &automatic);
}

/* It takes to care within 64 iterations. */
static world heating(void) {
  world w = closed(true);
  throw(&w, 300);
  return w;
}

static bool careful(const world *w) { return msr_state_work(w->state).careful != UINT64_MAX; }

/* ---- Runs in slices */

/* Stops after so many calls, and knows the earliest time that it has seen since. */
typedef struct watch {
  int left;
  double earliest;
} watch;

static msr_status look(void *data, const msr_state *state) {
  watch *w = data;
  w->earliest = fmin(w->earliest, msr_state_view(state).t);
  return w->left-- > 0 ? MSR_OK : MSR_EINTR;
}

static msr_status run_slice(msr_state *state, uint64_t end, int polls) {
  watch w = {polls, INFINITE};
  return msri_step(state, end - msr_state_iteration(state), &(msri_poll){look, &w, 1}, &why);
}

static void reload(world *w) {
  msr_state *other;
  must(msr_state_create(w->plan, &other, &why));
  must(msr_state_save(w->state, path_of("state"), &why));
  must(msr_state_load(other, path_of("state"), &why));
  remove(path_of("state"));
  msr_state_free(w->state);
  w->state = other;
}

/* With slices of so many polls; none takes more of them than there are substeps. */
static void check_slices(const char *name, world (*open)(void), const world *whole, int polls,
                         bool reloads) {
  world w = open();
  const uint64_t end = msr_state_iteration(whole->state);
  const uint64_t most = 65 * end * msr_plan_describe(w.plan).substeps;
  uint64_t slices = 0;
  while (run_slice(w.state, end, polls) == MSR_EINTR) {
    if (++slices > most) fail_msg("%s, %d polls: it doesn't advance", name, polls);
    if (reloads) reload(&w);
  }
  assert_true(slices > 0 && msr_state_iteration(w.state) == end);
  if (msr_state_hash(w.state) != msr_state_hash(whole->state))
    fail_msg("%s, %d polls, reloads %d: other bits", name, polls, reloads);
  if (w.state->guard.work != whole->state->guard.work)
    fail_msg("%s, %d polls, reloads %d: driven by %.17g, not %.17g", name, polls, reloads,
             w.state->guard.work, whole->state->guard.work);
  close_world(w);
}

/* What moves, and what the guard knows of driving forces. */
static void slices_have_the_same_bits(void **unused) {
  (void)unused;
  static const struct {
    const char *name;
    world (*open)(void);
    uint64_t iterations;
    bool leaps, cares;
  } rows[] = {{"plain", plain, 12, false, false},
              {"leaping", leaping, 10, true, false},
              {"crushed", crushed, 24, false, true},
              {"heating", heating, 258, false, true}};
  for (size_t i = 0; i < LENGTH(rows); i++) {
    world whole = rows[i].open();
    advance(&whole, rows[i].iterations);
    if ((msr_state_work(whole.state).leapt > 0) != (rows[i].leaps || rows[i].cares) ||
        careful(&whole) != rows[i].cares || !(whole.state->guard.work > 0))
      fail_msg("%s: not as it should be: %d %d", rows[i].name,
               (int)msr_state_work(whole.state).leapt, careful(&whole));
    for (int polls = 1; polls <= 8; polls++)
      for (int reloads = 0; reloads <= 1; reloads++)
        check_slices(rows[i].name, rows[i].open, &whole, polls, reloads);
    close_world(whole);
  }
}

/* As many iterations as there are numbers, from one that isn't the first. */
static void endless_runs_go_on_until_they_are_stopped(void **unused) {
  (void)unused;
  world w = plain();
  advance(&w, 3);
  watch until = {5, INFINITE};
  assert_int_equal(msri_step(w.state, UINT64_MAX, &(msri_poll){look, &until, 1}, &why), MSR_EINTR);
  assert_true(w.state->iteration == 3 && w.state->substep == 5);
  close_world(w);
}

/* ---- Changes in mid-iteration */

/* What it goes back to is the change, and not the beginning of its iteration; through a file too.
 */
static void care_goes_back_to_a_change_at_most(void **unused) {
  (void)unused;
  for (int reloads = 0; reloads <= 1; reloads++) {
    world w = closed(false);
    advance(&w, 5);
    assert_int_equal(run_slice(w.state, 6, 1), MSR_EINTR);
    const double changed = msr_state_view(w.state).t;
    assert_true(w.state->substep > 0);
    throw(&w, 300);
    const double given = msr_state_energy(w.state).total;
    advance(&w, 10);
    if (reloads) reload(&w);
    watch since = {INT32_MAX, INFINITE};
    must(msri_step(w.state, 50, &(msri_poll){look, &since, 1}, &why));
    assert_int_equal(msr_state_work(w.state).careful, 5);
    if (since.earliest != changed)
      fail_msg("changed at %.17g, then back at %.17g", changed, since.earliest);
    /* to the tolerance of the equations, 1e-10 and less a step */
    assert_true(fabs(msr_state_energy(w.state).total / given - 1) < 1e-8);
    close_world(w);
  }
}

/* ---- Statuses */

/* Refuses the n-th call, once. */
typedef struct refusal {
  int *calls, n;
} refusal;

static msr_status count(const void *self) {
  const refusal *r = self;
  return ++*r->calls == r->n ? MSR_EUNSTABLE : MSR_OK;
}

static msr_status refuse(const void *self, void *scratch, const msr_view *s, double *fx,
                         double *fy) {
  (void)scratch, (void)s, (void)fx, (void)fy;
  return count(self);
}

static msr_status refuse_between(const void *self, void *scratch, const msr_view *s,
                                 const msr_view *to, double *fx, double *fy) {
  (void)scratch, (void)s, (void)to, (void)fx, (void)fy;
  return count(self);
}

static const msr_force refusing[] = {{.name = "refusing",
                                      .summary = "0",
                                      .conservative = true,
                                      .params_size = sizeof(refusal),
                                      .add = refuse,
                                      .energy = no_energy},
                                     {.name = "refusing",
                                      .summary = "0",
                                      .conservative = true,
                                      .params_size = sizeof(refusal),
                                      .add = add_nothing,
                                      .energy = no_energy,
                                      .between = refuse_between}};

/* It's the force's word, not a step that can't be made: nothing is tried after it. */
static void what_a_force_says_comes_back_at_once(void **unused) {
  (void)unused;
  for (size_t f = 0; f < LENGTH(refusing); f++)
    for (int care = 0; care <= 1; care++)
      for (int n = 1; n <= 6; n++) {
        int calls = 0;
        msr_scene *scene = care ? crushed_springs() : stiff_pegs();
        add_force(scene, &refusing[f], &(refusal){&calls, n});
        world w = open_world_with(scene, &automatic);
        msr_status status = MSR_OK;
        for (int i = 0; i < 4 && status == MSR_OK; i++) status = msr_state_step(w.state, 1, &why);
        if (status != MSR_EUNSTABLE || calls != n || !strstr(why.message, "refusing"))
          fail_msg("force %zu, care %d, call %d: %s after %d", f, care, n, msr_status_text(status),
                   calls);
        advance(&w, 4 - msr_state_iteration(w.state));
        assert_true(msr_state_work(w.state).leaps > 0);
        close_world(w);
      }
}

static const msr_force driving = {.name = "refusing",
                                  .summary = "0",
                                  .uses_time = true,
                                  .params_size = sizeof(refusal),
                                  .add = refuse};

/* Nor is it what the guard says of a state: asked anew after a load, before a frame. */
static void what_a_force_says_of_a_frame_comes_back(void **unused) {
  (void)unused;
  int calls = 0;
  msr_scene *scene = scene_of(room, &short_run, &(msr_scene_options){.closed_border = true});
  add_force(scene, &driving, &(refusal){&calls, 1000});
  world w = open_world_with(scene, &automatic);
  throw(&w, 5);
  advance(&w, 10); /* a frame's iteration */
  reload(&w);
  calls = 999;
  assert_int_equal(msr_run(w.state, NULL, &why), MSR_EUNSTABLE);
  assert_non_null(strstr(why.message, "refusing"));
  assert_true(calls == 1000 && msr_state_iteration(w.state) == 10 && !careful(&w));
  must(msr_run(w.state, NULL, &why));
  close_world(w);
}

/* What the guard refuses is mended by care: then nothing was wrong. */
static void nothing_is_said_of_what_was_mended(void **unused) {
  (void)unused;
  for (int run = 0; run <= 1; run++) {
    world w = closed(false);
    throw(&w, 5);
    advance(&w, 10);
    for (size_t i = 0; i < 48; i++) w.state->v[i] *= 100; /* unknown to the state */
    msr_error said;
    memset(&said, 'x', sizeof said);
    const msr_error before = said;
    must(run ? msr_run(w.state, NULL, &said) : msr_state_step(w.state, 50, &said));
    assert_int_equal(msr_state_work(w.state).careful, 0);
    assert_memory_equal(&said, &before, sizeof said);
    close_world(w);
  }
}

/* ---- Files of another plan */

static void files_of_plans_that_care_are_told_from_others(void **unused) {
  (void)unused;
  world own = closed(false);
  const msr_plan_options same = {.integrator = &msr_integrator_verlet,
                                 .substeps = msr_plan_describe(own.plan).substeps};
  msr_scene *scene = scene_of(room, &example, &(msr_scene_options){.closed_border = true});
  world asked = open_world_with(scene, &same);
  const world *from[] = {&own, &asked}, *to[] = {&asked, &own};
  static const char *const chosen[] = {"by itself", "as it was told"};
  for (int i = 0; i < 2; i++) {
    must(msr_state_save(from[i]->state, path_of("state"), &why));
    assert_int_equal(msr_state_load(to[i]->state, path_of("state"), &why), MSR_EINPUT);
    assert_non_null(strstr(why.message, "chose its integrator or substeps"));
    assert_non_null(strstr(why.message, chosen[i]));
    assert_null(strstr(why.message, "damaged"));
  }
  remove(path_of("state"));
  close_world(own);
  close_world(asked);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(slices_have_the_same_bits),
      cmocka_unit_test(endless_runs_go_on_until_they_are_stopped),
      cmocka_unit_test(care_goes_back_to_a_change_at_most),
      cmocka_unit_test(what_a_force_says_comes_back_at_once),
      cmocka_unit_test(what_a_force_says_of_a_frame_comes_back),
      cmocka_unit_test(nothing_is_said_of_what_was_mended),
      cmocka_unit_test(files_of_plans_that_care_are_told_from_others),
  };
  return cmocka_run_group_tests_name("resume", tests, make_directory, remove_directory);
}
