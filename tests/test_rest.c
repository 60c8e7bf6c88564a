/* test_rest.c - objects at rest are left out of steps, and nothing tells: places, velocities,
 * collisions and energies are, bit by bit, those of plans that leave nothing out, a force that does
 * nothing having them step all masses; whatever else changes a state wakes them.
 * link: --wrap=msri_processors */
#include "files.h"
#include "processors.h"
#include "scenes.h"

#include "plan/state.h"

/* ---- Scenes */

/* Where there's no spring at all, no plan sweeps. */
static const char flat[] = ".........\n"
                           "..o...oo.\n"
                           ".........\n"
                           "#########\n";

/* Single masses come to rest; the block swings on, but in air. */
static const char several[] = "................\n"
                              "...ooooo........\n"
                              "...ooooo........\n"
                              "...ooooo...o....\n"
                              "................\n"
                              ".o.....o........\n"
                              "...........o..o.\n"
                              "################\n";

static const char floating[] = "............................\n"
                               ".oooo..ooo..o.o.o...oooooo..\n"
                               ".oooo..o.o...o.o....o....o..\n"
                               ".oooo..ooo..........oooooo..\n"
                               "............................\n";

static const msr_drag air = {0.05};
static const msr_wind gusts = {.speed = 0.5, .gust = 1, .gust_time = 0.3, .seed = 3};
static const msr_wind breeze = {.speed = 0.5};

/* What it's about, and how many of its objects rest in the end. */
typedef struct kind {
  const char *art;
  double gravity, restitution, friction;
  int neighbours;
  const msr_force *force;
  const void *params;
  double vx; /* of the first mass */
  size_t resting;
} kind;

enum { STEPS = 3000 };

static const kind kinds[] = {
    {flat, 9.8, 0.5, 0, 4, NULL, NULL, 0, 2},
    {flat, 9.8, 0, 0.3, 4, NULL, NULL, 1, 2},
    {several, 9.8, 0.5, 0, 4, NULL, NULL, 0, 5},
    {several, 9.8, 0.5, 0.5, 8, NULL, NULL, 2, 5},
    {several, 9.8, 0.5, 0.2, 4, &msr_force_drag, &air, 1, 6},
    {floating, 0, 1, 0, 4, NULL, NULL, 0, 8},
    {floating, 0, 1, 0, 4, NULL, NULL, 1, 7},
    {floating, 0, 1, 0, 8, NULL, NULL, 1, 3},
    {floating, 0, 1, 0, 4, &msr_force_drag, &air, 1, 7},
    {floating, 0, 1, 0, 4, &msr_force_wind, &gusts, 0, 0},
    {floating, 0, 1, 0, 4, &msr_force_wind, &breeze, 0, 0},
    {several, 9.8, 0.5, 0.2, 4, &msr_force_wind, &gusts, 1, 0},
};

static void push(const world *w, double vx) { msr_state_edit(w->state).vx[0] += vx; }

/* How it's stepped. */
typedef struct way {
  const msr_integrator *integrator;
  msr_impacts impacts;
  unsigned threads;
} way;

static const way verlet = {&msr_integrator_verlet, MSR_IMPACTS_KEPT, 1};

static world world_of(const kind *k, const way *how, bool leaves_out) {
  const msr_conf conf = {0.005, k->gravity, 0.1, 1500, STEPS, 1};
  msr_scene *scene = scene_of(k->art, &conf, &(msr_scene_options){.neighbours = k->neighbours});
  must(msr_scene_set_contact(scene, k->restitution, k->friction, &why));
  if (k->force) add_force(scene, k->force, k->params);
  if (!leaves_out) add_force(scene, &nothing, NULL);
  const world w = open_world_with(scene, &(msr_plan_options){.integrator = how->integrator,
                                                             .substeps = 1,
                                                             .impacts = how->impacts,
                                                             .threads = how->threads});
  push(&w, k->vx);
  return w;
}

static size_t resting(const world *w) { return msr_state_resting(w->state); }

static void check_same(const world *a, const world *b) {
  const msr_energy e = msr_state_energy(a->state), f = msr_state_energy(b->state);
  assert_int_equal(msr_state_hash(a->state), msr_state_hash(b->state));
  assert_int_equal(msr_state_contacts(a->state), msr_state_contacts(b->state));
  assert_memory_equal(&e, &f, sizeof e);
}

/* Both step so far, in calls of so many steps. */
static void go_along(const world *a, const world *b, uint64_t steps, uint64_t call) {
  for (uint64_t n = 0; n < steps; n += call) {
    advance(a, call);
    advance(b, call);
    check_same(a, b);
  }
}

/* ---- Nothing tells */

static void kinds_rest(void **unused) {
  (void)unused;
  for (size_t n = 0; n < LENGTH(kinds); n++) {
    const world w = world_of(&kinds[n], &verlet, true), all = world_of(&kinds[n], &verlet, false);
    assert_non_null(w.state->sweep);
    assert_null(all.state->sweep);
    go_along(&w, &all, STEPS, 100);
    if (resting(&w) != kinds[n].resting)
      fail_msg("kind %zu: %zu of %zu objects rest", n, resting(&w), w.plan->objects.n);
    assert_int_equal(resting(&all), 0);
    close_world(w);
    close_world(all);
  }
}

static void other_ways_rest(void **unused) {
  (void)unused;
  const way ways[] = {{&msr_integrator_symplectic_euler, MSR_IMPACTS_KEPT, 2},
                      {&msr_integrator_verlet, MSR_IMPACTS_LOCATED, 3},
                      {&msr_integrator_pefrl, MSR_IMPACTS_KEPT, 1},
                      {&msr_integrator_kahan_li_8, MSR_IMPACTS_KEPT, 2}};
  for (size_t i = 0; i < LENGTH(ways); i++) {
    size_t most = 0;
    for (size_t n = 0; n < LENGTH(kinds); n++) {
      const world w = world_of(&kinds[n], &ways[i], true),
                  all = world_of(&kinds[n], &ways[i], false);
      go_along(&w, &all, 1000, 500);
      if (resting(&w) > most) most = resting(&w);
      close_world(w);
      close_world(all);
    }
    assert_true(most >= 7);
  }
}

/* Looks come at other steps then. */
static void runs_are_cut_anywhere(void **unused) {
  (void)unused;
  static const uint64_t calls[] = {1, 7, 255, 257, 600};
  for (size_t n = 2; n < LENGTH(kinds); n += 2) {
    for (size_t i = 0; i < LENGTH(calls); i++) {
      const world w = world_of(&kinds[n], &verlet, true), all = world_of(&kinds[n], &verlet, false);
      go_along(&w, &all, 600, calls[i]);
      close_world(w);
      close_world(all);
    }
  }
}

/* ---- Large objects, and threads */

enum { LARGE = 130 };

/* Two that don't fit into a patch, one with holes, and one small. */
static msr_picture *large_ones(void) {
  msr_picture *p;
  must(msr_picture_create(2 * LARGE + 9, LARGE, &p, &why));
  for (size_t row = 0; row < LARGE; row++)
    for (size_t column = 0; column < p->width; column++) {
      const bool whole = column<LARGE, small = column> 2 * LARGE + 3;
      const bool holed = column > LARGE && column <= 2 * LARGE && (row % 5 != 2 || column % 3 != 0);
      const bool mass = whole || holed || (small && row < 4);
      memcpy(p->rgb + 3 * (row * p->width + column), rgb_of(mass ? 'o' : '.'), 3);
    }
  return p;
}

static world large_world(int neighbours, unsigned threads, bool leaves_out) {
  const msr_conf conf = {0.005, 0, 0.1, 1500, 2000, 1};
  msr_scene *scene =
      scene_from(large_ones(), &conf, &(msr_scene_options){.neighbours = neighbours});
  if (!leaves_out) add_force(scene, &nothing, NULL);
  return open_world_with(
      scene,
      &(msr_plan_options){.integrator = &msr_integrator_verlet, .substeps = 1, .threads = threads});
}

/* None of them moves; then one is too slow for that to be seen in a step, and another. */
static void check_large(int neighbours, unsigned threads) {
  const world w = large_world(neighbours, threads, true), all = large_world(neighbours, 1, false);
  const size_t last = msr_plan_describe(w.plan).masses - 1;
  go_along(&w, &all, 20, 20);
  assert_int_equal(resting(&w), 3);
  msr_state_edit(w.state).x[0] += 0x1p-53;
  msr_state_edit(all.state).x[0] += 0x1p-53;
  go_along(&w, &all, 20, 20);
  assert_int_equal(resting(&w), 2);
  msr_state_edit(w.state).x[last] += 0x1p-44;
  msr_state_edit(all.state).x[last] += 0x1p-44;
  go_along(&w, &all, 40, 20);
  assert_int_equal(resting(&w), 1);
  close_world(w);
  close_world(all);
}

static void large_objects_rest(void **unused) {
  (void)unused;
  for (unsigned threads = 1; threads <= 3; threads++) {
    check_large(4, threads);
    check_large(8, threads);
  }
}

/* ---- What isn't at rest */

/* A first step changes no place, and only one velocity, but later ones do. */
static void slow_ones_go_on(void **unused) {
  (void)unused;
  const world w = world_of(&kinds[5], &verlet, true), all = world_of(&kinds[5], &verlet, false);
  const double before = msr_state_edit(w.state).x[0] += 0x1p-52;
  msr_state_edit(all.state).x[0] += 0x1p-52;
  go_along(&w, &all, 1, 1);
  assert_true(msr_state_view(w.state).x[0] == before);
  assert_int_equal(resting(&w), 7);
  go_along(&w, &all, 600, 300);
  assert_int_equal(resting(&w), 7);
  close_world(w);
  close_world(all);
}

/* Air that is still for a second, along both axes. */
static double air_then(const msr_view *s) { return s->t < 1 ? 0 : 2; }

static double blow(const void *self, void *scratch, const msr_view *s, double h, double *push) {
  (void)self, (void)scratch;
  push[0] = push[1] = (1 - exp(-h)) * air_then(s);
  return exp(-h);
}

static msr_status push_later(const void *self, void *scratch, const msr_view *s, double *fx,
                             double *fy) {
  (void)self, (void)scratch;
  for (size_t i = 0; i < s->n; i++) {
    fx[i] += msr_view_mass(s, i) * (air_then(s) - s->vx[i]);
    fy[i] += msr_view_mass(s, i) * (air_then(s) - s->vy[i]);
  }
  return MSR_OK;
}

static msr_status flow_later(const void *self, void *scratch, const msr_view *s, double h,
                             bool backward, double *vx, double *vy) {
  double push[2];
  const double keep = blow(self, scratch, s, h, push);
  (void)backward;
  for (size_t i = 0; i < s->n; i++) {
    vx[i] = keep * vx[i] + push[0];
    vy[i] = keep * vy[i] + push[1];
  }
  return MSR_OK;
}

static const msr_force later = {.name = "later",
                                .summary = "m (u(t) - v)",
                                .uses_velocity = true,
                                .uses_time = true,
                                .add = push_later,
                                .flow = flow_later,
                                .relax = blow};

static void forces_in_time_let_nothing_rest(void **unused) {
  (void)unused;
  const kind k = {floating, 0, 1, 0, 4, &later, NULL, 0, 0};
  const world w = world_of(&k, &verlet, true), all = world_of(&k, &verlet, false);
  assert_non_null(w.state->sweep);
  go_along(&w, &all, 400, 100);
  assert_true(msr_state_view(w.state).vx[0] > 0);
  close_world(w);
  close_world(all);
}

/* 0 and -0 are equal, but their bits aren't. */
static void signs_of_zeros_count(void **unused) {
  (void)unused;
  const world w = world_of(&kinds[5], &verlet, true), all = world_of(&kinds[5], &verlet, false);
  const msr_arrays s = msr_state_edit(w.state), r = msr_state_edit(all.state);
  for (size_t i = 0; i < 30; i++) s.vx[i] = r.vx[i] = -0.0, s.x[i] -= i % 2 ? 0 : s.x[i];
  for (size_t i = 0; i < 30; i++) r.x[i] = s.x[i];
  go_along(&w, &all, 20, 1);
  close_world(w);
  close_world(all);
}

static void no_number_never_rests(void **unused) {
  (void)unused;
  const world w = world_of(&kinds[0], &verlet, true);
  msr_state_edit(w.state).y[0] = NO_NUMBER;
  assert_int_equal(msr_state_step(w.state, 300, &why), MSR_EUNSTABLE);
  assert_int_equal(resting(&w), 0);
  close_world(w);
}

/* ---- What wakes them */

static const kind *const heap = &kinds[2];

/* Both have come to rest but for the block. */
static void settle(world *w, world *all) {
  *w = world_of(heap, &verlet, true);
  *all = world_of(heap, &verlet, false);
  go_along(w, all, STEPS, STEPS);
  assert_int_equal(resting(w), heap->resting);
}

static void edits_wake(void **unused) {
  (void)unused;
  world w, all;
  settle(&w, &all);
  const size_t last = msr_plan_describe(w.plan).masses - 1;
  msr_state_edit(w.state).vy[last] = 9;
  assert_int_equal(resting(&w), 0);
  msr_state_edit(all.state).vy[last] = 9;
  go_along(&w, &all, 100, 20);
  assert_int_equal(resting(&w), heap->resting - 1);
  go_along(&w, &all, STEPS, STEPS);
  assert_int_equal(resting(&w), heap->resting);
  close_world(w);
  close_world(all);
}

static void copies_wake(void **unused) {
  (void)unused;
  world w, all;
  msr_state *early, *same;
  settle(&w, &all);
  must(msr_state_create(w.plan, &early, &why));
  must(msr_state_create(all.plan, &same, &why));
  must(msr_state_step(early, 10, &why));
  must(msr_state_step(same, 10, &why));
  msr_state_copy(w.state, early);
  msr_state_copy(all.state, same);
  assert_int_equal(resting(&w), 0);
  go_along(&w, &all, STEPS, 500);
  assert_int_equal(resting(&w), heap->resting);
  msr_state_free(early);
  msr_state_free(same);
  close_world(w);
  close_world(all);
}

static void loads_wake(void **unused) {
  (void)unused;
  world w, all;
  const char *early = path_of("early"), *same = path_of("same");
  w = world_of(heap, &verlet, true);
  all = world_of(heap, &verlet, false);
  go_along(&w, &all, 10, 10);
  must(msr_state_save(w.state, early, &why));
  must(msr_state_save(all.state, same, &why));
  go_along(&w, &all, STEPS, STEPS);
  assert_int_equal(resting(&w), heap->resting);
  must(msr_state_load(w.state, early, &why));
  must(msr_state_load(all.state, same, &why));
  assert_int_equal(resting(&w), 0);
  go_along(&w, &all, STEPS, 500);
  assert_int_equal(resting(&w), heap->resting);
  assert_int_equal(remove(early), 0);
  assert_int_equal(remove(same), 0);
  close_world(w);
  close_world(all);
}

/* A mass that floats in a closed room, into which a block is thrown that heats: see test_care.c. */
static world crushed(bool leaves_out) {
  static const char room[] = "............\n"
                             "...oooooo...\n"
                             "...oooooo...\n"
                             "...oooooo...\n"
                             "...oooooo...\n"
                             "............\n"
                             "............\n"
                             ".o..........\n"
                             "............\n"
                             "............\n"
                             "............\n"
                             "............\n";
  const msr_conf conf = {0.005, 0, 0.1, 1500, 1000, 1};
  msr_scene *scene = scene_of(room, &conf, &(msr_scene_options){.closed_border = true});
  if (!leaves_out) add_force(scene, &nothing, NULL);
  const world w = open_world_with(scene, &(msr_plan_options){0});
  const msr_arrays s = msr_state_edit(w.state);
  for (size_t i = 0; i < 24; i++) s.vx[i] = 15, s.vy[i] = -75;
  return w;
}

static bool is_careful(const world *w) { return msr_state_work(w->state).careful != UINT64_MAX; }

static void care_wakes(void **unused) {
  (void)unused;
  const world w = crushed(true), all = crushed(false);
  uint64_t steps = 0;
  go_along(&w, &all, 20, 20);
  assert_int_equal(resting(&w), 1);
  for (; steps < 1000 && !is_careful(&w); steps += 20) go_along(&w, &all, 20, 20);
  assert_true(is_careful(&w) && is_careful(&all));
  assert_int_equal(resting(&w), 0);
  go_along(&w, &all, 20, 20);
  push(&w, 0);
  push(&all, 0);
  go_along(&w, &all, 20, 20);
  assert_int_equal(resting(&w), 1);
  close_world(w);
  close_world(all);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(kinds_rest),
      cmocka_unit_test(other_ways_rest),
      cmocka_unit_test(runs_are_cut_anywhere),
      cmocka_unit_test(large_objects_rest),
      cmocka_unit_test(slow_ones_go_on),
      cmocka_unit_test(forces_in_time_let_nothing_rest),
      cmocka_unit_test(signs_of_zeros_count),
      cmocka_unit_test(no_number_never_rests),
      cmocka_unit_test(edits_wake),
      cmocka_unit_test(copies_wake),
      cmocka_unit_test(loads_wake),
      cmocka_unit_test(care_wakes),
  };
  return cmocka_run_group_tests(tests, make_directory, remove_directory);
}
