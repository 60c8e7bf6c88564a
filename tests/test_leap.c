/* test_leap.c - long implicit steps: impacts that are held inside an implicit step, and steps that
 * take the place of substeps where they cost less. */
#include "files.h"
#include "scenes.h"

#include "plan/state.h"

/* ---- Helpers */

static msr_conf stiff(double dt, double K) {
  const double m = 0.1;
  return (msr_conf){dt, 9.8, m, K * m / (0.005 * 0.005), 20000, 1};
}

/* Masses inside a black pixel of the art. */
static size_t inside(const char *art, const msr_view *s) {
  const size_t width = strcspn(art, "\n"), height = strlen(art) / (width + 1);
  size_t n = 0;
  for (size_t i = 0; i < s->n; i++) {
    const double x = floor(s->x[i]), y = floor(s->y[i]);
    if (!(x >= 0 && y >= 0 && x < (double)width && y < (double)height)) continue;
    n += art[(height - 1 - (size_t)y) * (width + 1) + (size_t)x] == '#';
  }
  return n;
}

static double energy(const world *w) { return msr_state_energy(w->state).total; }

/* The block above the pegs, that comes down at 6 px/s. */
static world falling(const msr_conf *conf, const msr_plan_options *options) {
  world w = open_world_with(scene_of(pegs, conf, NULL), options);
  const msr_arrays a = msr_state_edit(w.state);
  for (size_t i = 0; i < msr_plan_describe(w.plan).masses; i++) a.vy[i] = -6;
  return w;
}

static const msr_plan_options one_implicit = {.integrator = &msr_integrator_energy_momentum,
                                              .substeps = 1};
static const msr_plan_options automatic = {0};
static const msr_plan_options explicitly = {.integrator = &msr_integrator_verlet};

/* ---- Impacts held inside a step */

/* Through elastic impacts, to rounding of the energy of springs, K eps times their stretch: small
 * beside 1e-10 of all. The first ones only: later a stiff block vibrates so much that no solution
 * is found for steps of this length. */
static void energy_is_kept_through_impacts(void **state) {
  (void)state;
  for (double K = 1; K < 2e8; K *= 100) {
    const msr_conf conf = stiff(0.005, K);
    world w = falling(&conf, &one_implicit);
    const double e0 = energy(&w);
    for (int i = 0; i < 200 && msr_state_contacts(w.state) < 8; i++) {
      advance(&w, 1);
      const msr_view s = msr_state_view(w.state);
      if (!(fabs(energy(&w) / e0 - 1) < 1e-10) || inside(pegs, &s) > 0)
        fail_msg("K %g, step %d: energy off by %g, %zu inside", K, i, energy(&w) / e0 - 1,
                 inside(pegs, &s));
    }
    if (msr_state_contacts(w.state) < 8) fail_msg("K %g: nothing was met", K);
    close_world(w);
  }
}

static const char one_mass[] = "......\n"
                               "......\n"
                               ".o....\n"
                               "......\n"
                               "######\n";

static world thrown(double restitution, double friction, double vx, double vy) {
  const msr_conf conf = {0.01, 0, 0.1, 1, 1000, 1};
  msr_scene *scene = scene_of(one_mass, &conf, NULL);
  must(msr_scene_set_contact(scene, restitution, friction, &why));
  world w = open_world_with(scene, &one_implicit);
  const msr_arrays a = msr_state_edit(w.state);
  a.vx[0] = vx, a.vy[0] = vy;
  return w;
}

/* At an angle on the floor: the normal speed comes back times the restitution, and friction takes
 * its coefficient times the change of it, or all. */
static void restitution_and_friction_are_respected(void **state) {
  (void)state;
  const double rows[][3] = {{1, 0, 2},   {0.5, 0, 2},   {0, 0, 2},
                            {1, 0.1, 2}, {0.5, 0.2, 2}, {0.5, 0.8, 2}};
  for (size_t i = 0; i < LENGTH(rows); i++) {
    const double e = rows[i][0], mu = rows[i][1], vx = rows[i][2], vy = -4;
    world w = thrown(e, mu, vx, vy);
    advance(&w, 60);
    const msr_view s = msr_state_view(w.state);
    const double along = fmax(0, vx - mu * (1 + e) * -vy);
    if (!(fabs(s.vy[0] + e * vy) < 1e-12 && fabs(s.vx[0] - along) < 1e-12))
      fail_msg("restitution %g, friction %g: %g, %g", e, mu, s.vx[0], s.vy[0]);
    assert_int_equal(msr_state_contacts(w.state), 1);
    close_world(w);
  }
}

/* With weight, restitution 0.5 and friction a mass comes to rest, and stays. */
static void a_mass_comes_to_rest(void **state) {
  (void)state;
  const msr_conf conf = {0.01, 9.8, 0.1, 1, 1000, 1};
  msr_scene *scene = scene_of(one_mass, &conf, NULL);
  must(msr_scene_set_contact(scene, 0.5, 0.3, &why));
  world w = open_world_with(scene, &one_implicit);
  msr_state_edit(w.state).vx[0] = 1;
  advance(&w, 600);
  const msr_view s = msr_state_view(w.state);
  const double x = s.x[0], y = s.y[0];
  assert_true(fabs(s.vx[0]) < 1e-12 && fabs(s.vy[0]) < 1e-12 && y < 1 + 0.1);
  advance(&w, 600);
  assert_true(msr_state_view(w.state).x[0] == x && msr_state_view(w.state).y[0] == y);
  close_world(w);
}

/* The same through differences, without the library's matrix. */
static msr_status step_without(const msr_integrator *self, const msr_system *system,
                               const msr_interval *interval, double *q, double *v,
                               msr_workspace *work, msr_error *err) {
  const msr_integrator *of = self->coefficients;
  msr_system without = *system;
  without.linearise = NULL, without.solve = NULL;
  return of->step(of, &without, interval, q, v, work, err);
}

static msr_status open_without(const msr_integrator *self, const msr_system *system, void **object,
                               msr_error *err) {
  const msr_integrator *of = self->coefficients;
  msr_system without = *system;
  without.linearise = NULL, without.solve = NULL;
  return of->open(of, &without, object, err);
}

static void differences_hold_too(void **state) {
  (void)state;
  msr_integrator without = msr_integrator_energy_momentum;
  without.open = open_without, without.step = step_without;
  without.coefficients = &msr_integrator_energy_momentum;
  const msr_conf conf = stiff(0.005, 10);
  double z[2][4 * 27];
  for (int own = 0; own < 2; own++) {
    world w =
        falling(&conf, &(msr_plan_options){.integrator = own ? &without : one_implicit.integrator,
                                           .substeps = 1});
    advance(&w, 110);
    assert_true(msr_state_contacts(w.state) > 0);
    read_world(&w, z[own]);
    close_world(w);
  }
  assert_true(distance(4 * 27, z[0], z[1]) < 1e-8); /* impacts multiply what rounding left */
}

/* ---- Leaps */

/* A second and a half, through impacts. An iteration that leaps alone keeps the energy; one of
 * substeps as Verlet does, whose energy swings by (h omega)^2 / 8, at most 1/8, of what is in
 * vibrations, here a quarter. */
static void check_run(double k_times, double dt_times) {
  const double dt = 0.005 * dt_times, seconds = 1.5;
  const msr_conf conf = stiff(dt, k_times);
  world w = falling(&conf, &automatic);
  const msr_plan_figures f = msr_plan_describe(w.plan);
  const double e0 = energy(&w), u = w.plan->leaping.substep;
  assert_ptr_equal(f.integrator, &msr_integrator_verlet);
  assert_ptr_equal(f.leaps, &msr_integrator_energy_momentum);
  for (int i = 0; i < (int)ceil(seconds / dt); i++) {
    const msr_work before = msr_state_work(w.state);
    const double spent = w.state->leap.spent, e1 = energy(&w);
    advance(&w, 1);
    const msr_view s = msr_state_view(w.state);
    const double all = u * (double)f.substeps;
    const double cost = w.state->leap.spent - spent + all -
                        u * (double)(msr_state_work(w.state).leapt - before.leapt);
    /* a limit is found to be passed by one more matrix and mean force */
    const double stretches = ceil((double)f.substeps / (double)w.plan->leaping.stretch);
    if (!(cost <= 1.25 * all + 14 * stretches)) fail_msg("K %g: cost %g of %g", k_times, cost, all);
    const double off = energy(&w) / e1 - 1;
    if (msr_state_work(w.state).leapt - before.leapt == f.substeps && !(fabs(off) < 1e-10))
      fail_msg("K %g: a leap changes the energy by %g", k_times, off);
    if (!(fabs(energy(&w) / e0 - 1) < 0.04) || inside(pegs, &s) > 0)
      fail_msg("K %g, DT x%g, %d: energy off by %g, %zu inside", k_times, dt_times, i,
               energy(&w) / e0 - 1, inside(pegs, &s));
  }
  assert_true(msr_state_work(w.state).leaps > 0 && msr_state_contacts(w.state) > 0);
  close_world(w);
}

static void leaps_are_sound_and_bounded(void **state) {
  (void)state;
  check_run(5e4, 1);
  check_run(1e6, 1);
  check_run(1e6, 10);
  check_run(1e6, 300);
}

/* Falling freely an iteration is one leap, of two evaluations. */
static void a_free_fall_is_one_leap(void **state) {
  (void)state;
  const msr_conf conf = stiff(0.005, 1e8);
  world w = open_world_with(scene_of(pegs, &conf, NULL), &automatic);
  assert_true(msr_plan_describe(w.plan).substeps > 10000);
  advance(&w, 10);
  const msr_work work = msr_state_work(w.state);
  assert_int_equal(work.leaps, 10);
  assert_int_equal(work.leapt, 10 * msr_plan_describe(w.plan).substeps);
  assert_true(work.evaluations <= 40);
  close_world(w);
}

/* A force that has no mean between two places: no leap succeeds. */
static msr_status no_mean(const void *self, void *scratch, const msr_view *s, const msr_view *to,
                          double *fx, double *fy) {
  (void)self, (void)scratch, (void)s, (void)to, (void)fy;
  fx[0] = (double)NAN;
  return MSR_OK;
}

static const msr_force stubborn = {.name = "stubborn",
                                   .summary = "none",
                                   .conservative = true,
                                   .add = add_nothing,
                                   .energy = no_energy,
                                   .between = no_mean};

/* A block that vibrates by `size`, in air, after 3 iterations without a leap. */
static uint64_t shaken(double size, bool leaps, const msr_force *force, double *spent) {
  const msr_conf conf = stiff(0.005, 1e6);
  msr_scene *scene = scene_of(pegs, &conf, NULL);
  add_force(scene, &msr_force_drag, &(msr_drag){0.1});
  if (force) add_force(scene, force, NULL);
  world w = open_world_with(scene, leaps ? &automatic : &explicitly);
  const msr_arrays a = msr_state_edit(w.state);
  for (size_t i = 0; i < 27; i++) a.x[i] += size * sin(2 * (double)i);
  advance(&w, 3);
  assert_int_equal(msr_state_work(w.state).leaps, 0);
  *spent = w.state->leap.spent;
  const uint64_t hash = msr_state_hash(w.state);
  close_world(w);
  return hash;
}

/* The same bits as without leaps where none is made: nothing is tried where springs buckle many
 * times over, and where a try fails the state is as it was. */
static void without_a_leap_bits_are_verlets(void **state) {
  (void)state;
  double tried, none;
  assert_true(shaken(1e-3, true, NULL, &tried) == shaken(1e-3, false, NULL, &none));
  assert_true(tried == 0 && none == 0);
  assert_true(shaken(0, true, &stubborn, &tried) == shaken(0, false, &stubborn, &none));
  assert_true(tried > 0 && none == 0);
}

/* Two masses on a stiff spring at 900 px/s, 4.5 px an iteration, against a wall at x = 16: one leap
 * for an iteration doesn't stop them farther from it than a pixel. */
static void fast_masses_reach_the_wall(void **state) {
  (void)state;
  static const char wall[] = "................#\n"
                             ".oo.............#\n"
                             "................#\n";
  msr_conf conf = stiff(0.005, 1e6);
  conf.gravity = 0;
  for (double shift = 0; shift < 4.5; shift += 0.5) {
    world w = open_world_with(scene_of(wall, &conf, NULL), &automatic);
    const msr_arrays a = msr_state_edit(w.state);
    a.x[0] += shift, a.x[1] += shift, a.vx[0] = a.vx[1] = 900;
    while (msr_state_contacts(w.state) == 0) {
      const msr_work before = msr_state_work(w.state);
      const double x = msr_state_view(w.state).x[1];
      advance(&w, 1);
      const msr_work after = msr_state_work(w.state);
      const bool alone = after.leaps == before.leaps + 1 &&
                         after.leapt == before.leapt + msr_plan_describe(w.plan).substeps;
      const bool met = msr_state_contacts(w.state) > 0;
      if (met && alone && x < 15) fail_msg("stopped at %g", x);
      assert_true(met || alone);
    }
    close_world(w);
  }
}

/* ---- Bits */

/* Interrupted before any step, saved, loaded elsewhere, and run on: the same bits as in one go. */
static void interrupted_runs_have_the_same_bits(void **state) {
  (void)state;
  msr_conf conf = stiff(0.05, 1e5);
  conf.iterations = 10;
  world whole = falling(&conf, &automatic);
  interruption never = {0, 0};
  must(msr_run(whole.state, &(msr_run_options){.poll = interrupt, .poll_steps = 1, .data = &never},
               &why));
  const msr_work work = msr_state_work(whole.state);
  assert_true(work.leaps > 0 && work.leapt < 10 * msr_plan_describe(whole.plan).substeps);
  assert_true(msr_state_contacts(whole.state) > 0);
  for (uint64_t at = 1; at < never.calls; at += at < 120 ? 1 : never.calls / 10) {
    interruption s = {0, at};
    world cut = falling(&conf, &automatic), other = falling(&conf, &automatic);
    const msr_run_options options = {.poll = interrupt, .poll_steps = 1, .data = &s};
    assert_int_equal(msr_run(cut.state, &options, &why), MSR_EINTR);
    must(msr_state_save(cut.state, path_of("state"), &why));
    must(msr_state_load(other.state, path_of("state"), &why));
    must(msr_run(other.state, NULL, &why));
    must(msr_run(cut.state, &options, &why));
    if (msr_state_hash(cut.state) != msr_state_hash(whole.state) ||
        msr_state_hash(other.state) != msr_state_hash(whole.state))
      fail_msg("stopped at %llu", (unsigned long long)at);
    assert_int_equal(msr_state_contacts(cut.state), msr_state_contacts(whole.state));
    close_world(cut);
    close_world(other);
  }
  close_world(whole);
  remove(path_of("state"));
}

/* With damping along its springs a block soon leaps again after an impact; a state that is saved
 * and loaded after every iteration goes the same way, bit by bit. */
static void leaps_come_back(void **state) {
  (void)state;
  const msr_conf conf = stiff(0.005, 1e7);
  world w[2];
  for (int i = 0; i < 2; i++) {
    msr_scene *scene = scene_of(pegs, &conf, NULL);
    add_force(scene, &msr_force_damping, &(msr_damping){300});
    w[i] = open_world_with(scene, &automatic);
    const msr_arrays a = msr_state_edit(w[i].state);
    for (size_t m = 0; m < 27; m++) a.vy[m] = -6;
  }
  const uint64_t whole = msr_plan_describe(w[0].plan).substeps;
  int changes = 0;
  bool leapt = true;
  for (int i = 0; i < 130; i++) {
    const uint64_t before = msr_state_work(w[0].state).leapt;
    const char *path = path_of("state");
    advance(&w[0], 1);
    advance(&w[1], 1);
    must(msr_state_save(w[1].state, path, &why));
    must(msr_state_load(w[1].state, path, &why));
    remove(path);
    assert_true(msr_state_hash(w[0].state) == msr_state_hash(w[1].state));
    const bool leaps = msr_state_work(w[0].state).leapt == before + whole;
    changes += leaps != leapt;
    leapt = leaps;
  }
  if (changes < 3) fail_msg("%d changes", changes);
  for (int i = 0; i < 2; i++) close_world(w[i]);
}

/* ---- The choice */

static const msr_integrator *leaps_of(double dt, double k, const msr_plan_options *options) {
  msr_conf conf = example;
  conf.dt = dt, conf.stiffness = k;
  world w = open_world_with(scene_of(pegs, &conf, NULL), options);
  const msr_plan_figures f = msr_plan_describe(w.plan);
  close_world(w);
  return f.leaps;
}

/* Soft springs never leap, whatever DT: a stretch has no more substeps. Nor does what was asked for
 * by name, or has its impacts located. */
static void leaps_are_for_stiff_springs(void **state) {
  (void)state;
  const msr_plan_options located = {.impacts = MSR_IMPACTS_LOCATED}, fixed = {.substeps = 5000};
  for (double times = 1; times <= 1000; times *= 10) {
    assert_null(leaps_of(0.005 * times, 1500, &automatic));
    assert_null(leaps_of(0.005 * times, 1e10, &explicitly));
    assert_null(leaps_of(0.005 * times, 1e10, &fixed));
    assert_null(leaps_of(0.005 * times, 1e10, &located));
    assert_ptr_equal(leaps_of(0.005 * times, 1e10, &automatic), &msr_integrator_energy_momentum);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(energy_is_kept_through_impacts),
      cmocka_unit_test(restitution_and_friction_are_respected),
      cmocka_unit_test(a_mass_comes_to_rest),
      cmocka_unit_test(differences_hold_too),
      cmocka_unit_test(leaps_are_sound_and_bounded),
      cmocka_unit_test(a_free_fall_is_one_leap),
      cmocka_unit_test(without_a_leap_bits_are_verlets),
      cmocka_unit_test(fast_masses_reach_the_wall),
      cmocka_unit_test(interrupted_runs_have_the_same_bits),
      cmocka_unit_test(leaps_come_back),
      cmocka_unit_test(leaps_are_for_stiff_springs),
  };
  return cmocka_run_group_tests(tests, make_directory, remove_directory);
}
