/* test_collide.c - masses that collide as discs: momentum and restitution of two; no disc ever
 * inside another or beyond it, at any speed; energy that never grows; bodies that come to rest; and
 * the pairs that the search finds against all pairs there are. */
#include "contacts/near.h"
#include "files.h"
#include "scenes.h"

#include <pthread.h>

/* ---- Scenes of discs */

static msr_scene *discs(double dt, double diameter, double restitution) {
  msr_scene *scene = empty_scene(dt);
  must(msr_scene_set_contact(scene, restitution, 0, &why));
  must(msr_scene_set_collisions(scene, diameter, &why));
  return scene;
}

static double gap_of(const msr_view *s, size_t i, size_t j) {
  return hypot(s->x[j] - s->x[i], s->y[j] - s->y[i]);
}

/* The least distance of two masses that aren't next to each other by number. */
static double least_gap(const msr_view *s, size_t apart) {
  double least = INFINITE;
  for (size_t i = 0; i < s->n; i++)
    for (size_t j = i + apart; j < s->n; j++) least = fmin(least, gap_of(s, i, j));
  return least;
}

typedef struct moment {
  double px, py, spin, kinetic, size;
} moment;

static moment moment_of(const world *w) {
  const msr_view s = msr_state_view(w->state);
  moment m = {0};
  for (size_t i = 0; i < s.n; i++) {
    const double mass = msr_view_mass(&s, i), v2 = s.vx[i] * s.vx[i] + s.vy[i] * s.vy[i];
    m.px += mass * s.vx[i], m.py += mass * s.vy[i];
    m.spin += mass * (s.x[i] * s.vy[i] - s.y[i] * s.vx[i]);
    m.kinetic += mass * v2 / 2;
    m.size += mass * sqrt(v2) * (1 + hypot(s.x[i], s.y[i]));
  }
  return m;
}

/* A step moves places by less than this in rounding: what two free places may lack. */
static const double rounding = 1e-11;

/* ---- Two discs */

/* Head on, at any ratio of masses: the velocities of the textbook, to rounding. */
static void two_part_with_the_restitution(void **unused) {
  (void)unused;
  const double ratios[] = {1, 3, 1e-6, 1e6}, restitutions[] = {1, 0.5, 0};
  for (size_t r = 0; r < LENGTH(ratios); r++)
    for (size_t e = 0; e < LENGTH(restitutions); e++) {
      msr_scene *scene = discs(0.01, 1, restitutions[e]);
      const double m[] = {1, ratios[r]}, u[] = {3, -2},
                   middle = (m[0] * u[0] + m[1] * u[1]) / (m[0] + m[1]);
      add_mass(scene, 0, 0, u[0], 0, m[0]);
      add_mass(scene, 2, 0, u[1], 0, m[1]);
      const world w = open_world(scene, NULL, 1);
      advance(&w, 100);
      const msr_view s = msr_state_view(w.state);
      for (size_t i = 0; i < 2; i++) {
        const double wanted = middle - restitutions[e] * (u[i] - middle);
        if (!(fabs(s.vx[i] - wanted) <= 16 * DBL_EPSILON * 5))
          fail_msg("ratio %g, e %g: %g, not %g", ratios[r], restitutions[e], s.vx[i], wanted);
      }
      assert_int_equal(msr_state_contacts(w.state), 1);
      assert_true(gap_of(&s, 0, 1) >= 1 - rounding);
      close_world(w);
    }
}

/* Aslant, in every direction and at every speed up to a fifth of a diameter a step: momentum,
 * angular momentum, and energy if elastic. */
static void two_keep_momentum_and_spin(void **unused) {
  (void)unused;
  uint64_t dice = 5;
  size_t met = 0;
  for (int trial = 0; trial < 2000; trial++) {
    const double e = trial % 2 ? 1 : 0.6;
    msr_scene *scene = discs(0.01, 1, e);
    for (int i = 0; i < 2; i++) { // one draw after the other: arguments have no order
      const double x = 1.5 * i + uniform(&dice, -0.1, 0.1), y = uniform(&dice, -0.4, 0.4);
      const double vx = (i ? -1 : 1) * uniform(&dice, 0, 10), vy = uniform(&dice, -5, 5);
      add_mass(scene, x, y, vx, vy, uniform(&dice, 0.1, 10));
    }
    const world w = open_world(scene, NULL, 1);
    const moment before = moment_of(&w);
    advance(&w, 40);
    const moment after = moment_of(&w);
    const double most = 400 * DBL_EPSILON * before.size; // each of 40 steps rounds some sums
    assert_true(fabs(after.px - before.px) <= most && fabs(after.py - before.py) <= most);
    assert_true(fabs(after.spin - before.spin) <= most);
    // a collision rounds each speed a few times, and the lighter one's may be 100 times the other's
    assert_true(after.kinetic <= before.kinetic * (1 + 1000 * DBL_EPSILON));
    if (e == 1) assert_true(after.kinetic >= before.kinetic * (1 - 1000 * DBL_EPSILON));
    met += msr_state_contacts(w.state) > 0;
    close_world(w);
  }
  assert_true(met > 500);
}

/* Elastic collisions are reversible: with velocities turned round, all come back. */
static void elastic_collisions_are_reversible(void **unused) {
  (void)unused;
  msr_scene *scene = discs(0.01, 1, 1);
  add_mass(scene, 0, 0, 5, 1, 1);
  add_mass(scene, 2, 0.3, -4, 0, 2);
  const world w = open_world(scene, NULL, 1);
  double start[8], z[8];
  read_world(&w, start);
  advance(&w, 60);
  assert_int_equal(msr_state_contacts(w.state), 1);
  read_world(&w, z);
  for (int k = 4; k < 8; k++) z[k] = -z[k];
  write_world(&w, z);
  advance(&w, 60);
  read_world(&w, z);
  for (int k = 4; k < 8; k++) z[k] = -z[k];
  assert_true(distance(8, start, z) <= 1e-13); // 120 steps of rounding
  close_world(w);
}

/* A ball meets a row of balls: the last one leaves with its velocity. */
static void the_cradle_hands_on(void **unused) {
  (void)unused;
  for (int left = 0; left < 2; left++) {
    msr_scene *scene = discs(0.01, 1, 1);
    for (int i = 0; i < 5; i++) add_mass(scene, 1.05 * i, 0, 0, 0, 2);
    add_mass(scene, left ? -2 : 6, 0, left ? 4 : -4, 0, 2);
    const world w = open_world(scene, NULL, 1);
    advance(&w, 100);
    const msr_view s = msr_state_view(w.state);
    const size_t last = left ? 4 : 0;
    for (size_t i = 0; i < 6; i++)
      assert_true(fabs(s.vx[i] - (i == last ? left ? 4 : -4 : 0)) <= 1e-13);
    close_world(w);
  }
}

/* ---- Clouds */

static const msr_integrator *const some_integrators[] = {
    &msr_integrator_verlet, &msr_integrator_symplectic_euler, &msr_integrator_pefrl,
    &msr_integrator_rk4,    &msr_integrator_backward_euler,   &msr_integrator_rkf45};

static msr_scene *cloud(size_t n, double side, double speed, double e, uint64_t seed) {
  uint64_t dice = seed;
  msr_scene *scene = discs(0.01, 1, e);
  const size_t row = (size_t)ceil(sqrt((double)n));
  const double cell = side / (double)row, play = (cell - 1) / 2;
  for (size_t i = 0; i < n; i++) {
    const double x = (double)(i % row) * cell + uniform(&dice, -play, play);
    const double y = (double)(i / row) * cell + uniform(&dice, -play, play);
    const double turn = uniform(&dice, 0, 6.283), v = uniform(&dice, 0, speed);
    add_mass(scene, x, y, v * cos(turn) - 4 * (x - side / 2) * speed / side,
             v * sin(turn) - 4 * (y - side / 2) * speed / side, exp(uniform(&dice, -2, 2)));
  }
  return scene;
}

/* A cloud that falls together, by every kind of method and from slow to very fast: momentum to
 * rounding, kinetic energy never more, no two discs ever too near. */
static void clouds_keep_momentum_and_gain_nothing(void **unused) {
  (void)unused;
  const double speeds[] = {0.1, 3, 30, 300, 1e4, 1e6};
  for (size_t k = 0; k < LENGTH(some_integrators); k++)
    for (size_t v = 0; v < LENGTH(speeds); v++)
      for (int e = 0; e <= 1; e++) {
        const world w =
            open_world(cloud(60, 12, speeds[v], e ? 1 : 0.4, k + 1), some_integrators[k], 1);
        const moment before = moment_of(&w);
        double kinetic = before.kinetic;
        for (int step = 0; step < 60; step++) {
          advance(&w, 1);
          const moment now = moment_of(&w);
          const msr_view s = msr_state_view(w.state);
          const double most = 1000 * DBL_EPSILON * before.size; // 60 masses, 60 steps
          assert_true(fabs(now.px - before.px) <= most && fabs(now.py - before.py) <= most);
          if (!(now.kinetic <= kinetic * (1 + 1e-12)))
            fail_msg("%s, %g px/s: %.17g after %.17g", some_integrators[k]->name, speeds[v],
                     now.kinetic, kinetic);
          // places so far out round to more
          const double far = 64 * DBL_EPSILON * (largest(s.n, s.x) + largest(s.n, s.y));
          if (!(least_gap(&s, 1) >= 1 - rounding - far))
            fail_msg("%s, %g px/s: %.17g px in step %d", some_integrators[k]->name, speeds[v],
                     least_gap(&s, 1), step);
          kinetic = now.kinetic;
        }
        assert_true(msr_state_contacts(w.state) > 0 || speeds[v] < 1);
        close_world(w);
      }
}

/* ---- Speed */

/* Shots at a chain of discs, at all speeds: none ever gets past it. */
static void no_speed_passes_a_chain(void **unused) {
  (void)unused;
  uint64_t dice = 11;
  for (double speed = 1; speed <= 1e6; speed *= sqrt(10))
    for (int trial = 0; trial < 6; trial++) {
      msr_scene *scene = discs(0.01, 1, trial % 2 ? 1 : 0.5);
      const size_t n = 41;
      for (size_t i = 0; i < n; i++) add_mass(scene, 1.2 * ((double)i - 20), 0, 0, 0, 1000);
      const double aim = uniform(&dice, -0.3, 0.3), from = uniform(&dice, 2, 5);
      add_mass(scene, aim * from + 3, from, -aim * speed, -speed, 1);
      const world w = open_world(scene, some_integrators[trial % 4], 1);
      const uint64_t steps = (uint64_t)(from / speed / 0.01) + 20;
      for (uint64_t step = 0; step < (steps < 800 ? steps : 800); step++) {
        advance(&w, 1);
        const msr_view s = msr_state_view(w.state);
        double wall = INFINITE;
        for (size_t i = 0; i < n; i++)
          if (fabs(s.x[i] - s.x[n]) < 2) wall = fmin(wall, s.y[i]);
        if (!(s.y[n] > wall || wall == INFINITE))
          fail_msg("%g px/s: it is through after %llu steps", speed, (unsigned long long)step);
        assert_true(least_gap(&s, 1) >= 1 - 1e-9);
      }
      assert_true(msr_state_contacts(w.state) > 0);
      close_world(w);
    }
}

/* ---- Bodies */

static msr_scene *rope_over_a_disc(double e) {
  msr_scene *scene = discs(0.005, 1, e);
  must(msr_scene_set_times(scene, 0.005, 1, 1, &why));
  for (size_t i = 0; i < 40; i++) {
    add_mass(scene, 0.02 * (double)(i % 3), (double)i, 0, 0, 0.1);
    if (i > 0) must(msr_scene_add_spring(scene, i - 1, i, 1000, 1, &why));
  }
  must(msr_scene_add_anchor(scene, &(msr_anchor){0, 0, 0, 1000, 0}, &why));
  add_force(scene, &msr_force_gravity, &(msr_gravity){30});
  add_force(scene, &msr_force_damping, &(msr_damping){0.05});
  return scene;
}

/* A rope that stands on its end falls on itself: it folds, and no part of it goes through another.
 */
static void a_rope_folds_on_itself(void **unused) {
  (void)unused;
  const world w = open_world(rope_over_a_disc(0.5), NULL, 0);
  double least = INFINITE;
  for (int step = 0; step < 1500; step++) {
    advance(&w, 1);
    const msr_view s = msr_state_view(w.state);
    least = fmin(least, least_gap(&s, 2));
  }
  if (!(least >= 1 - rounding)) fail_msg("%.17g px", least);
  assert_true(msr_state_contacts(w.state) > 100);
  close_world(w);
}

static const char two_bodies[] = "..............\n"
                                 "...oooo.......\n"
                                 "...oooo.......\n"
                                 "..............\n"
                                 "..............\n"
                                 "..ggggggg.....\n"
                                 "..ggggggg.....\n"
                                 "..ggggggg.....\n"
                                 "..............\n"
                                 "##############\n";

static double height(const msr_view *s) {
  double sum = 0;
  for (size_t i = 0; i < s->n; i++) sum += msr_view_mass(s, i) * s->y[i];
  return sum;
}

/* After so many steps what fell has `share` of the energy of its fall or less, and keeps to that
 * for `more` times 10^4 steps. */
static void expect_rest(const world *w, double gravity, uint64_t steps, double share, int more) {
  const msr_view start = msr_state_view(w->state);
  const double before = height(&start);
  advance(w, steps);
  for (int parts = 0; parts <= more; parts++) {
    const msr_view s = msr_state_view(w->state);
    const double fall = gravity * (before - height(&s)), kinetic = moment_of(w).kinetic;
    if (!(fall > 0 && kinetic <= share * fall))
      fail_msg("kinetic energy %g of %g after %llu steps", kinetic, fall,
               (unsigned long long)msr_state_iteration(w->state));
    if (parts < more) advance(w, 10000);
  }
}

/* Two bodies fall, one on the other, and stay: all speeds go to nothing. */
static void bodies_come_to_rest_on_each_other(void **unused) {
  (void)unused;
  for (int rough = 0; rough < 2; rough++) {
    msr_scene *scene = scene_of(two_bodies, &(msr_conf){0.0025, 20, 0.1, 1000, 1, 1},
                                &(msr_scene_options){.neighbours = 8});
    must(msr_scene_set_contact(scene, 0.3, rough ? 0.5 : 0, &why));
    must(msr_scene_set_collisions(scene, 1, &why));
    add_force(scene, &msr_force_damping, &(msr_damping){2});
    const world w = open_world(scene, NULL, 0);
    expect_rest(&w, 20, 20000, 1e-20,
                rough ? 10 : 1); // springs round forces of 10 to 1e-15: speeds of 1e-13
    const msr_view s = msr_state_view(w.state);
    for (size_t i = 0; i < 8; i++) // where it can only be if the lower one bears it
      assert_true(s.y[i] > 3 && s.y[i] < 6.5);
    close_world(w);
  }
}

static msr_scene *loose(const char *map, double restitution) {
  msr_picture *picture = paint(map);
  msr_scene *scene = scene_from(picture, &(msr_conf){0.005, 10, 1, 0, 1, 1}, NULL);
  must(msr_scene_set_contact(scene, restitution, 0, &why));
  must(msr_scene_set_collisions(scene, 1, &why));
  return scene;
}

/* A tower of loose discs on a support stands, and is at rest. */
static void a_tower_stands(void **unused) {
  (void)unused;
  const double restitutions[] = {0, 0.5, 0.9};
  for (size_t k = 0; k < LENGTH(restitutions); k++) {
    msr_scene *scene = loose("...\n...\n...\n...\n...\n...\n###\n", restitutions[k]);
    for (int i = 0; i < 5; i++) add_mass(scene, 1.5, 1.25 + 1.01 * i, 0, 0, 1 + i % 2);
    const world w = open_world(scene, NULL, 0);
    expect_rest(&w, 10, 4000, 1e-24, k == 1 ? 10 : 1); // nothing rounds but gravity
    const msr_view s = msr_state_view(w.state);
    for (size_t i = 0; i < 5; i++) assert_true(fabs(s.y[i] - 1.02 - (double)i) < 0.1);
    assert_true(least_gap(&s, 1) >= 1 - 1e-9);
    close_world(w);
  }
}

/* Loose discs fall into a box, and lie there in a heap; none of these is left to slide by itself.
 */
static void a_heap_comes_to_rest(void **unused) {
  (void)unused;
  msr_scene *scene = loose("#........#\n#........#\n#........#\n#........#\n#........#\n"
                           "#........#\n#........#\n##########\n",
                           0.3);
  uint64_t dice = 1;
  for (int i = 0; i < 24; i++)
    add_mass(scene, 1.5 + 1.2 * (i % 6) + uniform(&dice, 0, 0.1), 1.5 + 1.1 * floor(i / 6.), 0, 0,
             1);
  const world w = open_world(scene, NULL, 0);
  expect_rest(&w, 10, 8000, 1e-20, 1);
  const msr_view s = msr_state_view(w.state);
  assert_true(least_gap(&s, 1) >= 1 - 1e-9);
  close_world(w);
}

/* Discs thicker than the lattice is wide leave their own body alone where it is so from the start:
 * nothing pushes against springs, and energy isn't made. Another body they meet. */
static void thick_discs_leave_their_body_alone(void **unused) {
  (void)unused;
  for (double diameter = 1.2; diameter < 4; diameter *= 1.25) {
    msr_scene *scene = scene_of(".......\n.oooo..\n.oooo..\n.oooo..\n.......\n.......\n.......\n"
                                ".......\n.......\n.......\n...ooo.\n...ooo.\n#######\n",
                                &(msr_conf){0.005, 9.8, 0.1, 1500, 1, 1}, NULL);
    must(msr_scene_set_collisions(scene, diameter, &why));
    const world w = open_world(scene, NULL, 0);
    const double start = msr_state_energy(w.state).total;
    for (int n = 0; n < 1000; n++) {
      advance(&w, 1);
      const double now = msr_state_energy(w.state).total;
      // Verlet's own energy swings by a per cent
      if (!(now < 1.01 * start)) fail_msg("diameter %g: %g of %g", diameter, now, start);
    }
    const msr_view s = msr_state_view(w.state);
    for (size_t i = 0; i < 12; i++)
      for (size_t j = 12; j < 18; j++)
        assert_true(hypot(s.x[i] - s.x[j], s.y[i] - s.y[j]) >= diameter * (1 - rounding));
    close_world(w);
  }
  msr_conf conf = {0.005, 9.8, 0.1, 1500, 1, 1};
  msr_scene *scene = lattice(20, 20, 4, &conf);
  msr_plan *plan = NULL;
  must(msr_scene_set_collisions(scene, 1e9, &why));
  assert_int_equal(msr_plan_create(scene, NULL, &plan, &why), MSR_EUSAGE);
  assert_non_null(strstr(why.message, "smaller diameter"));
  msr_scene_free(scene);
}

/* Discs at one place, or overlapping, part, the centre of mass staying where it is. */
static void coincident_discs_part(void **unused) {
  (void)unused;
  msr_scene *scene = discs(0.01, 1, 1);
  uint64_t dice = 3;
  const size_t n = 30;
  for (size_t i = 0; i < n; i++) {
    const bool same = i % 3 > 0;
    add_mass(scene, same ? 0 : uniform(&dice, 0, 3), same ? 0 : uniform(&dice, 0, 3), 0, 0,
             1 + (double)(i % 4));
  }
  const world w = open_world(scene, NULL, 1);
  msr_view s = msr_state_view(w.state);
  double cx = 0, cy = 0, sum = 0, x = 0, y = 0;
  for (size_t i = 0; i < n; i++) {
    const double m = msr_view_mass(&s, i);
    cx += m * s.x[i], cy += m * s.y[i], sum += m;
  }
  advance(&w, 3000);
  s = msr_state_view(w.state);
  for (size_t i = 0; i < n; i++)
    x += msr_view_mass(&s, i) * s.x[i], y += msr_view_mass(&s, i) * s.y[i];
  if (!(least_gap(&s, 1) >= 1 - rounding)) fail_msg("%.17g px", least_gap(&s, 1));
  assert_true(fabs(x - cx) <= 1e-12 * sum * 10 && fabs(y - cy) <= 1e-12 * sum * 10);
  assert_true(moment_of(&w).kinetic == 0);
  close_world(w);
}

/* Overlapping discs that fly together part, also while another one flies past so fast that ways are
 * searched: nobody's speed changes by a bit. */
static void parting_changes_no_speed(void **unused) {
  (void)unused;
  for (int fast = 0; fast < 2; fast++) {
    msr_scene *scene = discs(0.01, 1, 0.5);
    uint64_t dice = 8;
    for (size_t i = 0; i < 12; i++)
      add_mass(scene, uniform(&dice, 0, 2), uniform(&dice, 0, 2), 3, -1, 1 + (double)(i % 3));
    add_mass(scene, 0, 100, fast ? 1e4 : 3, -1, 1);
    const world w = open_world(scene, NULL, 1);
    advance(&w, 3000);
    const msr_view s = msr_state_view(w.state);
    for (size_t i = 0; i < s.n; i++)
      assert_true(s.vx[i] == (fast && i == 12 ? 1e4 : 3) && s.vy[i] == -1);
    if (!(least_gap(&s, 1) >= 1 - rounding)) fail_msg("%.17g px", least_gap(&s, 1));
    close_world(w);
  }
}

/* ---- Many */

/* The least distance of any two, by a grid of its own: the first of each cell, and who is next in
 * it, by place. */
static double least_gap_of_many(const msr_view *s, size_t cells, double side) {
  uint32_t *first = zeroed(cells * cells, sizeof *first), *next = zeroed(s->n + 1, sizeof *next);
  double least = INFINITE;
  for (size_t i = 0; i < s->n; i++) {
    const size_t cx = (size_t)fmin(fmax(s->x[i] / side * (double)cells, 1), (double)cells - 2);
    const size_t cy = (size_t)fmin(fmax(s->y[i] / side * (double)cells, 1), (double)cells - 2);
    for (size_t around = 0; around < 9; around++) {
      const size_t cell = (cy + around / 3 - 1) * cells + cx + around % 3 - 1;
      for (uint32_t j = first[cell]; j > 0; j = next[j]) least = fmin(least, gap_of(s, i, j - 1));
    }
    next[i + 1] = first[cy * cells + cx];
    first[cy * cells + cx] = (uint32_t)i + 1;
  }
  free(first);
  free(next);
  return least;
}

/* 10^5 loose discs, as dense as half of the plane, in a few steps of up to a third of a diameter:
 * none overlap. */
static void many_never_overlap(void **unused) {
  (void)unused;
  enum { SIDE = 316 };
  const double apart = 1.25;
  msr_scene *scene = discs(0.01, 1, 0.9);
  uint64_t dice = 21;
  for (size_t i = 0; i < SIDE * SIDE; i++) {
    const double x = apart * ((double)(i % SIDE) + 2) + uniform(&dice, -0.12, 0.12);
    const double y = apart * ((double)(i / SIDE) + 2) + uniform(&dice, -0.12, 0.12);
    const double vx = uniform(&dice, -20, 20), vy = uniform(&dice, -20, 20);
    add_mass(scene, x, y, vx, vy, 1);
  }
  const world w = open_world(scene, NULL, 1);
  const double energy = moment_of(&w).kinetic;
  const msr_view s = msr_state_view(w.state);
  for (int step = 0; step < 3; step++) {
    advance(&w, 1);
    const double least = least_gap_of_many(&s, SIDE, apart * (SIDE + 4));
    if (!(least >= 1 - rounding)) fail_msg("%.17g px after %d steps", least, step + 1);
  }
  assert_true(msr_state_contacts(w.state) > 50000);
  assert_true(moment_of(&w).kinetic <= energy);
  close_world(w);
}

/* ---- More pairs than there is room for */

static double *gaps_of(const msr_view *s) {
  double *gap = zeroed(s->n * s->n, sizeof *gap);
  for (size_t i = 0; i < s->n; i++)
    for (size_t j = 0; j < i; j++) gap[i * s->n + j] = gap_of(s, i, j);
  return gap;
}

/* No pair that is closer than the diameter comes closer, no other one as close. */
static void expect_no_approach(msr_scene *scene, double diameter) {
  const world w = open_world(scene, NULL, 1);
  const msr_view s = msr_state_view(w.state);
  double kinetic = moment_of(&w).kinetic, *before = gaps_of(&s);
  for (int step = 0; step < 8; step++) {
    advance(&w, 1);
    double *after = gaps_of(&s);
    for (size_t k = 0; k < s.n * s.n; k++)
      if (!(after[k] >= fmin(before[k], diameter) - rounding))
        fail_msg("%.17g px after %.17g in step %d", after[k], before[k], step + 1);
    assert_true(moment_of(&w).kinetic <= kinetic * (1 + 1e-12));
    kinetic = moment_of(&w).kinetic;
    free(before);
    before = after;
  }
  free(before);
  close_world(w);
}

static void too_many_pairs_come_no_nearer(void **unused) {
  (void)unused;
  uint64_t dice = 3;
  enum { SIDE = 18 };
  const double speeds[] = {3, 300};
  for (size_t k = 0; k < LENGTH(speeds); k++) {
    const double v = speeds[k];
    msr_scene *lattice = discs(0.01, 6, 1), *heap_of_one_place = discs(0.01, 1, 1);
    for (size_t i = 0; i < SIDE * SIDE; i++) {
      const double vx = uniform(&dice, -v, v), vy = uniform(&dice, -v, v);
      add_mass(lattice, (double)(i % SIDE), (double)(i / SIDE), vx, vy, 1);
      add_mass(heap_of_one_place, 0, 0, vx, vy, 1);
    }
    expect_no_approach(lattice, 6);
    expect_no_approach(heap_of_one_place, 1);
  }
}

/* ---- Only where they are called for */

static void effect_is(msr_scene *scene, bool on, const char *reason) {
  const world w = open_world(scene, NULL, 1);
  size_t n, found = 0;
  const msr_effect *e = msr_plan_effects(w.plan, &n);
  for (size_t i = 0; i < n; i++) {
    if (strcmp(e[i].name, "collisions") != 0) continue;
    assert_string_equal(e[i].reason, reason);
    assert_int_equal(e[i].on, on);
    assert_null(e[i].force);
    found++;
  }
  assert_int_equal(found, 1);
  advance(&w, 3);
  close_world(w);
}

static void on_only_where_masses_can_meet(void **unused) {
  (void)unused;
  msr_scene *scene = discs(0.01, 0, 1);
  add_mass(scene, 0, 0, 0, 0, 1);
  add_mass(scene, 2, 0, 0, 0, 1);
  effect_is(scene, false, "not asked for");
  effect_is(discs(0.01, 1, 1), false, "fewer than two masses");
  scene = discs(0.01, 1, 1);
  add_mass(scene, 0, 0, 0, 0, 1);
  effect_is(scene, false, "fewer than two masses");
  scene = discs(0.01, 1, 1);
  for (size_t i = 0; i < 3; i++) add_mass(scene, (double)i, 0, 0, 0, 1);
  for (size_t i = 0; i < 3; i++)
    for (int twice = 0; twice < 2; twice++)
      must(msr_scene_add_spring(scene, i, (i + 1) % 3, 1, 1, &why));
  effect_is(scene, false, "no two masses that could meet");
  scene = discs(0.01, 1.5, 0.5);
  for (size_t i = 0; i < 3; i++) add_mass(scene, 2 * (double)i, 0, 0, 0, 1);
  for (size_t i = 0; i < 2; i++) must(msr_scene_add_spring(scene, i, i + 1, 1, 1, &why));
  effect_is(scene, true, "asked for: discs of diameter 1.5 px; restitution 0.5");
}

static void a_diameter_is_checked(void **unused) {
  (void)unused;
  msr_scene *scene = empty_scene(0.01);
  const double bad[] = {-1, INFINITE, NO_NUMBER};
  for (size_t i = 0; i < LENGTH(bad); i++) {
    msr_error err;
    assert_int_equal(msr_scene_set_collisions(scene, bad[i], &err), MSR_EUSAGE);
    assert_non_null(strstr(err.message, "a diameter must be finite and 0 or more, not "));
  }
  msr_scene_free(scene);
}

/* Tied discs pass through each other; and who never meets moves as without collisions, by the bit.
 */
static void nothing_else_changes(void **unused) {
  (void)unused;
  for (size_t k = 0; k < LENGTH(some_integrators); k++) {
    uint64_t hash[2];
    for (int on = 0; on < 2; on++) {
      msr_scene *scene = scene_of(pegs, &example, &(msr_scene_options){.neighbours = 8});
      must(msr_scene_set_collisions(scene, on ? 0.3 : 0, &why));
      add_mass(scene, 1.5, 5, 1, 2, 0.3);
      add_mass(scene, 1.4, 5, -1, 2, 0.3);
      must(msr_scene_add_spring(scene, 27, 28, 10, 2, &why));
      const world w = open_world(scene, some_integrators[k], 0);
      advance(&w, 100);
      hash[on] = msr_state_hash(w.state);
      close_world(w);
    }
    assert_true(hash[0] == hash[1]);
  }
}

/* ---- The same bits */

static msr_scene *heap(void) {
  msr_scene *scene = scene_of(two_bodies, &(msr_conf){0.005, 60, 0.1, 1000, 1, 1}, NULL);
  must(msr_scene_set_contact(scene, 0.7, 0.1, &why));
  must(msr_scene_set_collisions(scene, 0.9, &why));
  uint64_t dice = 1;
  for (int i = 0; i < 12; i++) add_mass(scene, 1 + i, 8.5, uniform(&dice, -200, 200), -80, 0.2);
  return scene;
}

static void copies_and_files_go_on_alike(void **unused) {
  (void)unused;
  for (size_t k = 0; k < 4; k++) {
    const world w = open_world(heap(), some_integrators[k], 0);
    msr_state *copy, *loaded;
    must(msr_state_create(w.plan, &copy, &why));
    must(msr_state_create(w.plan, &loaded, &why));
    for (int cut = 0; cut < 20; cut++) {
      advance(&w, 7);
      msr_state_copy(copy, w.state);
      must(msr_state_save(w.state, path_of("collide"), &why));
      must(msr_state_load(loaded, path_of("collide"), &why));
      advance(&w, 13);
      must(msr_state_step(copy, 13, &why));
      must(msr_state_step(loaded, 13, &why));
      assert_true(msr_state_hash(copy) == msr_state_hash(w.state));
      assert_true(msr_state_hash(loaded) == msr_state_hash(w.state));
      assert_int_equal(msr_state_contacts(loaded), msr_state_contacts(w.state));
    }
    assert_true(msr_state_contacts(w.state) > 50);
    msr_state_free(copy);
    msr_state_free(loaded);
    close_world(w);
  }
}

static void *run_alone(void *plan) {
  msr_state *state;
  uint64_t *hash = malloc(sizeof *hash);
  if (msr_state_create(plan, &state, NULL) != MSR_OK) abort();
  if (msr_state_step(state, 200, NULL) != MSR_OK) abort();
  *hash = msr_state_hash(state);
  msr_state_free(state);
  return hash;
}

static void threads_share_a_plan(void **unused) {
  (void)unused;
  const world w = open_world(heap(), NULL, 0);
  pthread_t thread[4];
  for (size_t i = 0; i < LENGTH(thread); i++)
    assert_int_equal(pthread_create(&thread[i], NULL, run_alone, w.plan), 0);
  advance(&w, 200);
  for (size_t i = 0; i < LENGTH(thread); i++) {
    void *hash;
    assert_int_equal(pthread_join(thread[i], &hash), 0);
    assert_true(*(uint64_t *)hash == msr_state_hash(w.state));
    free(hash);
  }
  close_world(w);
}

/* Two that were far apart when their list was made, and are put, or come out of a file or another
 * state, next to each other: they collide. */
enum { EDITED, LOADED, COPIED, WAYS_TO_MOVE };

static world far_apart(void) {
  msr_scene *scene = discs(0.01, 1, 1);
  for (size_t i = 0; i < 2; i++) add_mass(scene, 20 * (double)i, 0, 0, 0, 1);
  return open_world(scene, NULL, 1);
}

static void moved_discs_are_found(void **unused) {
  (void)unused;
  for (int how = 0; how < WAYS_TO_MOVE; how++) {
    const world w = far_apart();
    msr_state *other;
    must(msr_state_create(w.plan, &other, &why));
    must(msr_state_step(other, 2, &why));
    advance(&w, 2);
    const msr_arrays s = msr_state_edit(how == EDITED ? w.state : other);
    s.x[0] = 18.99, s.vx[0] = 5;
    if (how == COPIED) msr_state_copy(w.state, other);
    if (how == LOADED) {
      must(msr_state_save(other, path_of("collide"), &why));
      must(msr_state_load(w.state, path_of("collide"), &why));
    }
    advance(&w, 2);
    const msr_view now = msr_state_view(w.state);
    assert_true(fabs(now.vx[0]) <= 1e-12 && fabs(now.vx[1] - 5) <= 1e-12);
    msr_state_free(other);
    close_world(w);
  }
}

/* ---- The search */

typedef struct finder {
  size_t n;
  double *q0, *q;
  msri_ties ties;
  msri_near near;
  void *block;
} finder;

static finder finder_of(size_t n, const msr_springs *springs) {
  finder f = {.n = n, .q0 = zeroed(2 * n, sizeof(double)), .q = zeroed(2 * n, sizeof(double))};
  const msr_view start = {.n = n, .x = f.q0, .y = f.q0 + n, .springs = springs};
  must(msri_ties_create(&start, 0, &f.ties, &why)); // nobody is closer than 0
  size_t size = 0, end = 0;
  msri_near_place(n, 1, &f.ties, NULL, &size);
  f.block = zeroed(1, size);
  f.near = msri_near_place(n, 1, &f.ties, f.block, &end);
  return f;
}

static void free_finder(finder *f) {
  msri_ties_clear(&f->ties);
  free(f->q0);
  free(f->q);
  free(f->block);
}

static double distance_of(const double *q, size_t n, size_t i, size_t j) {
  return hypot(q[j] - q[i], q[n + j] - q[n + i]);
}

static bool ways_meet(const void *self, const msri_paths *w, size_t i, size_t j) {
  const size_t n = *(const size_t *)self;
  const double rx = w->q0[j] - w->q0[i], ry = w->q0[n + j] - w->q0[n + i];
  const double dx = w->q[j] - w->q[i] - rx, dy = w->q[n + j] - w->q[n + i] - ry;
  const double dd = dx * dx + dy * dy, t = dd > 0 ? fmin(1, fmax(0, -(rx * dx + ry * dy) / dd)) : 0;
  return hypot(rx + t * dx, ry + t * dy) < 1;
}

/* All masses, to near.set. */
static uint32_t *all_of(finder *f) {
  for (size_t i = 0; i < f->n; i++) f->near.set[i] = (uint32_t)i;
  return f->near.set;
}

static void list_ways(finder *f) {
  const msri_meets meets = {ways_meet, &f->n};
  msri_near_list_paths(&f->near, &(msri_paths){f->q0, f->q}, 0.3, &meets, all_of(f), f->n);
  msri_pair *room = zeroed(f->near.found, sizeof *room);
  msri_near_order(f->near.pair, f->near.found, room);
  free(room);
}

/* The list is that of all pairs, in order. */
static void expect_all(const finder *f, bool ways, double reach) {
  const msri_paths w = {f->q0, f->q};
  size_t k = 0;
  for (size_t i = 0; i < f->n; i++)
    for (size_t j = i + 1; j < f->n; j++) {
      const bool near = ways ? ways_meet(&f->n, &w, i, j) : distance_of(f->q0, f->n, i, j) <= reach;
      if (!near || msri_ties_tied(&f->ties, i, j)) continue;
      assert_true(k < f->near.found);
      assert_true(f->near.pair[k].i == i && f->near.pair[k].j == j);
      k++;
    }
  assert_int_equal(k, f->near.found);
}

/* Against all pairs: scattered, in rows and heaps, far away from each other, at rest and on ways of
 * every length. */
static void the_search_finds_every_pair(void **unused) {
  (void)unused;
  uint64_t dice = 17;
  const double k1 = 1;
  for (int trial = 0; trial < 300; trial++) {
    const size_t n = 2 + random_below(&dice, 150);
    const msr_run_of_springs run = {0, n - 1, 1, &k1, &k1, 0};
    finder f = finder_of(n, &(msr_springs){.n = n - 1, .n_runs = 1, .run = &run});
    f.near.ties = &f.ties;
    const double side = uniform(&dice, sqrt((double)n) / 3, 40),
                 speed = pow(10, uniform(&dice, -2, 6));
    const double common = random_below(&dice, 2) ? speed * 30 : 0;
    for (size_t i = 0; i < 2 * n; i++) {
      const bool rests = i % n % 4 > 0;
      f.q0[i] = uniform(&dice, -side, side);
      if (random_below(&dice, 5) == 0) f.q0[i] = floor(f.q0[i]);
      if (random_below(&dice, 60) == 0) f.q0[i] *= pow(10, uniform(&dice, 0, 300));
      f.q[i] = f.q0[i] + common + (rests ? 0 : uniform(&dice, -speed, speed));
    }
    msri_near_list_at(&f.near, f.q0, 1.4, all_of(&f), n);
    expect_all(&f, false, 1.4);
    list_ways(&f);
    expect_all(&f, true, 0);
    free_finder(&f);
  }
}

/* A body of 10^5 masses: none of its pairs are near at rest, and a fast flight finds none either.
 */
static void a_body_has_few_pairs(void **unused) {
  (void)unused;
  const size_t side = 316, n = side * side;
  finder f = finder_of(n, &(msr_springs){0});
  f.near.ties = &f.ties;
  for (size_t i = 0; i < n; i++) {
    f.q0[i] = (double)(i % side), f.q0[n + i] = (double)(i / side);
    f.q[i] = f.q0[i] + 1e5, f.q[n + i] = f.q0[n + i] - 3e4;
  }
  msri_near_list_at(&f.near, f.q0, 1.38, all_of(&f), n); // sides, no diagonals
  assert_int_equal(f.near.found, 2 * side * (side - 1));
  list_ways(&f);
  assert_int_equal(f.near.found, 0);
  free_finder(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(two_part_with_the_restitution),
      cmocka_unit_test(two_keep_momentum_and_spin),
      cmocka_unit_test(elastic_collisions_are_reversible),
      cmocka_unit_test(the_cradle_hands_on),
      cmocka_unit_test(clouds_keep_momentum_and_gain_nothing),
      cmocka_unit_test(no_speed_passes_a_chain),
      cmocka_unit_test(a_rope_folds_on_itself),
      cmocka_unit_test(bodies_come_to_rest_on_each_other),
      cmocka_unit_test(a_tower_stands),
      cmocka_unit_test(a_heap_comes_to_rest),
      cmocka_unit_test(thick_discs_leave_their_body_alone),
      cmocka_unit_test(coincident_discs_part),
      cmocka_unit_test(parting_changes_no_speed),
      cmocka_unit_test(many_never_overlap),
      cmocka_unit_test(too_many_pairs_come_no_nearer),
      cmocka_unit_test(on_only_where_masses_can_meet),
      cmocka_unit_test(a_diameter_is_checked),
      cmocka_unit_test(nothing_else_changes),
      cmocka_unit_test(copies_and_files_go_on_alike),
      cmocka_unit_test(threads_share_a_plan),
      cmocka_unit_test(moved_discs_are_found),
      cmocka_unit_test(the_search_finds_every_pair),
      cmocka_unit_test(a_body_has_few_pairs),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
