/* test_bands.c - meshes that a program built go through several steps band by band, by several
 * threads: the bits are those of one step after the other on whole vectors, which a force of one's
 * own that does nothing makes the library take.
 * link: --wrap=msri_processors */
#include "integrators/splitting.h"
#include "plan/state.h"
#include "sweep/sweep.h"

#include "processors.h"
#include "scenes.h"

/* ---- Meshes */

/* Masses in rows; each is tied to those `offset` further, where `skips` lets it. */
typedef struct net {
  size_t masses, width;
  size_t offset[10]; /* ended by 0 */
  bool rows;         /* springs of offset 1 end with a row */
  bool differ;       /* in k and L */
  unsigned skips;    /* percent of the springs */
  size_t random;     /* springs, of offsets up to `reach` */
  size_t reach;
  bool coincident; /* pairs of masses begin at one place */
} net;

static void join(msr_scene *scene, const net *m, size_t i, size_t j, uint64_t *dice) {
  if (j >= m->masses || random_below(dice, 100) < m->skips) return;
  const double k = m->differ ? uniform(dice, 10, 100) : 60;
  const double L = m->differ ? uniform(dice, 0, 2) : 1;
  must(msr_scene_add_spring(scene, i, j, k, L, &why));
}

static msr_scene *scene_of_net(const net *m) {
  uint64_t dice = m->masses;
  msr_scene *scene = empty_scene(0.01);
  double x = 0, y = 0;
  for (size_t i = 0; i < m->masses; i++) {
    if (i % 2 == 0 || !m->coincident) {
      x = (double)(i % m->width) + uniform(&dice, -0.2, 0.2);
      y = (double)(i / m->width) + uniform(&dice, -0.2, 0.2);
    }
    add_mass(scene, x, y, uniform(&dice, -1, 1), uniform(&dice, -1, 1), 0.7);
  }
  for (size_t i = 0; i < m->masses; i++)
    for (const size_t *o = m->offset; *o > 0; o++)
      if (*o > 1 || !m->rows || (i + 1) % m->width != 0) join(scene, m, i, i + *o, &dice);
  for (size_t n = 0; n < m->random; n++) {
    const size_t i = random_below(&dice, m->masses - 1);
    join(scene, m, i, i + 1 + random_below(&dice, m->reach), &dice);
  }
  return scene;
}

static const net nets[] = {
    {2, 2, .offset = {1}, .rows = true},
    {32 * 32, 32, .offset = {1, 32}, .rows = true},
    {70 * 70, 70, .offset = {1, 70}, .rows = true},
    {9000, 1000, .offset = {1, 1000}, .rows = true},
    {9000, 90, .offset = {1, 89, 90, 91}, .rows = true},
    {9000, 90, .offset = {1, 90}, .differ = true},
    {9000, 90, .offset = {1, 90}, .skips = 30, .differ = true},
    {9000, 90, .offset = {1, 89, 90, 91}, .coincident = true},
    {12000, 12000, .offset = {1}},
    {5000, 5000, .offset = {1}, .differ = true},
    {12000, 12000, .offset = {1, 2, 3, 5, 7, 8, 9, 13, 1024}},
    {5000, 50, .offset = {4, 6, 1023, 1024, 1025}},
    {12000, 100, .offset = {1, 1500}, .rows = true},
    {6000, 100, .offset = {1, 3500}},
    {1023, 33, .offset = {1, 33}},
    {1024, 33, .offset = {1, 33}, .differ = true},
    {1025, 33, .offset = {1, 33}},
    {4095, 33, .offset = {1, 33, 700}, .skips = 10},
    {4096, 33, .offset = {1, 33, 700}},
    {4097, 33, .offset = {1, 33, 700}},
    {3000, 60, .random = 5000, .reach = 20, .differ = true},
    {9000, 60, .random = 12000, .reach = 900, .differ = true},
    {9000, 60, .random = 12000, .reach = 9000, .skips = 5},
    {9000, 60, .random = 30, .reach = 9000},
    {9000, 60, .random = 300, .reach = 40},
};

/* ---- Runs */

typedef struct course {
  const msr_integrator *integrator;
  uint64_t substeps, iterations[4]; /* cut in pieces; ended by 0 */
  const msr_force *force[3];        /* with trial_params; ended by NULL */
} course;

static world open_net(const net *m, const course *r, unsigned threads) {
  msr_scene *scene = scene_of_net(m);
  for (size_t f = 0; r->force[f]; f++) add_force(scene, r->force[f], trial_params(r->force[f]));
  if (threads == 0) add_force(scene, &nothing, NULL);
  return open_world_with(scene, &(msr_plan_options){.integrator = r->integrator,
                                                    .substeps = r->substeps,
                                                    .threads = threads});
}

/* z [4 masses] after a run; 0 threads: without sweeps. Returns its work. */
static msr_work run_net(const net *m, const course *r, unsigned threads, double *z) {
  const world w = open_net(m, r, threads);
  assert_true(msri_plan_sweeps(w.plan) == (threads > 0));
  for (const uint64_t *n = r->iterations; *n > 0; n++) advance(&w, *n);
  read_world(&w, z);
  const msr_work work = msr_state_work(w.state);
  close_world(w);
  return work;
}

static void compare(const net *m, const course *r, unsigned threads) {
  const size_t size = 4 * m->masses * sizeof(double);
  double *expected = zeroed(1, size), *z = zeroed(1, size);
  const msr_work all = run_net(m, r, 0, expected);
  for (unsigned t = 1; t <= threads; t++) {
    const msr_work work = run_net(m, r, t, z);
    if (memcmp(z, expected, size) != 0)
      fail_msg("%s, %zu masses, offset %zu, %u threads: other bits", r->integrator->name, m->masses,
               m->offset[0], t);
    assert_int_equal(work.steps, all.steps);
  }
  free(expected);
  free(z);
}

static void bits_are_those_of_single_steps(void **unused) {
  (void)unused;
  const course verlet = {
      .integrator = &msr_integrator_verlet, .substeps = 1, .iterations = {25, 1}};
  for (size_t n = 0; n < LENGTH(nets); n++) compare(&nets[n], &verlet, 4);
}

/* Each with what may act beside springs; substeps, iterations and calls end anywhere in a pass. */
static void methods_and_forces_keep_bits(void **unused) {
  (void)unused;
  static const msr_force *const beside[][3] = {{NULL},
                                               {&msr_force_gravity},
                                               {&msr_force_drag},
                                               {&msr_force_wind},
                                               {&msr_force_gravity, &msr_force_wind}};
  static const net *const some[] = {&nets[1], &nets[3], &nets[6], &nets[20]};
  for (const msr_integrator *const *i = msr_integrators; *i; i++) {
    if (msri_splitting_drifts(*i) == 0) continue;
    for (size_t f = 0; f < LENGTH(beside); f++) {
      const course r = {*i, 3, {1, 2}, {beside[f][0], beside[f][1]}};
      compare(some[f % LENGTH(some)], &r, 3);
    }
  }
}

/* More than there are parts for, and a mesh that all of them share. */
static void threads_may_be_many(void **unused) {
  (void)unused;
  const course verlet = {.integrator = &msr_integrator_verlet, .substeps = 1, .iterations = {9}};
  const net large = {40000, 200, .offset = {1, 200}, .rows = true};
  compare(&nets[3], &verlet, 9);
  compare(&large, &verlet, 7);
}

/* ---- Bands */

/* Every spring once, in order, from a mass of its band to one of that or the next. */
static void check_bands(const msr_plan *plan) {
  const msri_bands *bands = &plan->bands;
  const msr_springs *s = &plan->mesh.springs;
  size_t r = 0, next = 0;
  assert_true(bands->n > 0 && bands->n * bands->length >= plan->figures.masses);
  for (size_t b = 0; b < bands->n; b++) {
    const msri_bundle *bundle = &bands->springs[b];
    assert_true(bundle->base == b * bands->length);
    for (size_t n = 0; n < bundle->n_runs; n++) {
      const msr_run_of_springs *run = &bundle->run[n];
      const size_t from = n == 0 ? bundle->skip : 0;
      const size_t end = n + 1 == bundle->n_runs ? bundle->stop : run->count;
      assert_true(run == &s->run[r] && from == next && from < end && end <= run->count);
      assert_true(run->first + from >= bundle->base);
      assert_true(run->first + end <= bundle->base + bands->length);
      assert_true(bands->n == 1 || run->offset <= bands->length);
      next = end < run->count ? end : 0;
      r += end == run->count;
    }
  }
  assert_true(r == s->n_runs && next == 0);
}

static void bands_hold_every_spring_once(void **unused) {
  (void)unused;
  const course verlet = {.integrator = &msr_integrator_verlet, .substeps = 1};
  for (size_t n = 0; n < LENGTH(nets); n++) {
    const world w = open_net(&nets[n], &verlet, 1);
    check_bands(w.plan);
    close_world(w);
  }
}

/* ---- Who doesn't sweep */

static void check_others(msr_scene *scene, const msr_integrator *integrator) {
  const world w = open_world(scene, integrator, 1);
  assert_false(msri_plan_sweeps(w.plan));
  advance(&w, 2);
  close_world(w);
}

static void others_step_as_ever(void **unused) {
  (void)unused;
  const net *m = &nets[1];
  msr_scene *scene = scene_of_net(m);
  add_mass(scene, 0, -5, 0, 0, 0.3); /* another mass than all others */
  check_others(scene, NULL);
  scene = scene_of_net(m);
  must(msr_scene_add_anchor(scene, &(msr_anchor){7, 0, 0, 10, 1}, &why));
  check_others(scene, NULL);
  scene = scene_of_net(m);
  add_force(scene, &msr_force_drag, trial_params(&msr_force_drag));
  add_force(scene, &msr_force_wind, trial_params(&msr_force_wind));
  check_others(scene, NULL);
  scene = scene_of_net(m);
  add_force(scene, &msr_force_damping, trial_params(&msr_force_damping));
  check_others(scene, NULL);
  check_others(scene_of_net(m), &msr_integrator_rk4);
  scene = lattice(5, 5, 4, &weightless); /* springs of a picture, and added ones */
  must(msr_scene_add_spring(scene, 0, 24, 10, 1, &why));
  check_others(scene, NULL);
}

/* Springs between masses of a picture that has none of its own. */
static void masses_of_a_picture_may_be_tied(void **unused) {
  (void)unused;
  double z[2][4 * 4];
  for (int generic = 0; generic < 2; generic++) {
    msr_scene *scene = scene_of("o.o\n...\no.o\n", &weightless, NULL);
    for (size_t i = 0; i < 3; i++) must(msr_scene_add_spring(scene, i, i + 1, 50, 1, &why));
    if (generic) add_force(scene, &nothing, NULL);
    const world w = open_world(scene, &msr_integrator_verlet, 1);
    assert_true(msri_plan_sweeps(w.plan) == !generic);
    advance(&w, 50);
    read_world(&w, z[generic]);
    close_world(w);
  }
  assert_memory_equal(z[0], z[1], sizeof z[0]);
}

/* ---- Physics, and what goes wrong */

static void momentum_and_energy_are_kept(void **unused) {
  (void)unused;
  const net *m = &nets[2];
  const course verlet = {.integrator = &msr_integrator_verlet, .substeps = 1};
  const world w = open_net(m, &verlet, 2);
  const msr_energy before = msr_state_energy(w.state);
  advance(&w, 400);
  const msr_energy after = msr_state_energy(w.state);
  /* each of 400 steps rounds every mass's momentum, 0.7 kg at some px/s */
  const double rounding = 400 * DBL_EPSILON * (double)m->masses;
  assert_true(fabs(after.px - before.px) < rounding && fabs(after.py - before.py) < rounding);
  /* the energy of Verlet is off by (h omega)^2 / 4 of itself at most: h omega is 0.01 * 26 */
  assert_true(fabs(after.total - before.total) < 0.26 * 0.26 / 4 * before.total);
  close_world(w);
}

/* The iteration in which a run ends whose step is too long; 0 threads: without sweeps. */
static uint64_t end_of_explosion(unsigned threads) {
  const course verlet = {.integrator = &msr_integrator_verlet, .substeps = 1};
  const net m = {20000, 100, .offset = {1, 100}};
  msr_scene *scene = scene_of_net(&m);
  must(msr_scene_add_spring(scene, 17, 18, 1e6, 1, &why));
  if (threads == 0) add_force(scene, &nothing, NULL);
  const world w = open_world_with(scene, &(msr_plan_options){.integrator = verlet.integrator,
                                                             .substeps = verlet.substeps,
                                                             .threads = threads});
  assert_true(msri_plan_sweeps(w.plan) == (threads > 0));
  assert_int_equal(msr_state_step(w.state, 5000, &why), MSR_EUNSTABLE);
  const uint64_t end = msr_state_iteration(w.state);
  close_world(w);
  return end;
}

/* Sweeps look at speeds every 64 stages, however many threads there are. */
static void explosions_are_told(void **unused) {
  (void)unused;
  const uint64_t end = end_of_explosion(1);
  assert_true(end <= end_of_explosion(0) + 64);
  for (unsigned threads = 2; threads < 5; threads++)
    assert_int_equal(end_of_explosion(threads), end);
}

/* What a run leaves off another takes up. */
static void copies_go_on_alike(void **unused) {
  (void)unused;
  const course verlet = {.integrator = &msr_integrator_verlet, .substeps = 1};
  const world w = open_net(&nets[3], &verlet, 2);
  msr_state *copy;
  must(msr_state_create(w.plan, &copy, &why));
  advance(&w, 7);
  msr_state_copy(copy, w.state);
  advance(&w, 6);
  must(msr_state_step(copy, 6, &why));
  assert_true(msr_state_hash(copy) == msr_state_hash(w.state));
  msr_state_free(copy);
  close_world(w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bits_are_those_of_single_steps),
      cmocka_unit_test(methods_and_forces_keep_bits),
      cmocka_unit_test(threads_may_be_many),
      cmocka_unit_test(bands_hold_every_spring_once),
      cmocka_unit_test(others_step_as_ever),
      cmocka_unit_test(masses_of_a_picture_may_be_tied),
      cmocka_unit_test(momentum_and_energy_are_kept),
      cmocka_unit_test(explosions_are_told),
      cmocka_unit_test(copies_go_on_alike),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
