/* test_exact.c - scenes whose motion is known: springs that swing, spin and hang, waves along a
 * chain, falls, bounces, drag. Where a method isn't exact, its error is of order (omega h)^2, that
 * of Verlet, and shown as such. */
#include "scenes.h"

static const double pi = 3.14159265358979323846;

static double x_of(const world *w, size_t i) { return msr_state_view(w->state).x[i]; }
static double y_of(const world *w, size_t i) { return msr_state_view(w->state).y[i]; }

/* ---- Springs */

/* Two masses apart by 1.2 L swing with the period 2 pi sqrt(m / 2k), and Verlet's own frequency
 * is higher by (omega h)^2 / 24 (Hairer, Lubich & Wanner 2003): after ten periods the phase is off
 * by 20 pi (omega h)^2 / 24, and the length, at its extreme, by that squared. */
static void a_pair_swings_with_its_period(void **state) {
  (void)state;
  const double m = 0.5, k = 40, L = 2, period = 2 * pi * sqrt(m / (2 * k));
  const double h = period / 400, phase = 20 * pi * pow(2 * pi / 400, 2) / 24;
  msr_scene *scene = empty_scene(h);
  add_mass(scene, 0, 0, 0, 0, m);
  add_mass(scene, 0, 1.2 * L, 0, 0, m);
  must(msr_scene_add_spring(scene, 0, 1, k, L, &why));
  world w = open_world(scene, NULL, 1);
  advance(&w, 3900); /* 9.75 periods: at the rest length, as fast as it gets */
  assert_true(fabs(y_of(&w, 1) - y_of(&w, 0) - L) < 0.2 * L * phase);
  advance(&w, 100);
  assert_true(fabs(y_of(&w, 1) - y_of(&w, 0) - 1.2 * L) < 0.2 * L * phase * phase);
  close_world(w);
}

/* n masses on a ring of radius R turning by omega: m omega^2 R = 2 k (l - L) sin(pi/n), where
 * l = 2 R sin(pi/n). A pair is a ring of two with one spring. */
static double ring_speed(size_t n, double k, double m, double L, double R) {
  const double s = sin(pi / (double)n), springs = n == 2 ? 1 : 2;
  return sqrt(springs * k * (2 * R * s - L) * s / (m * R));
}

static world ring(size_t n, double h, double *omega) {
  const double k = 30, m = 0.4, R = 2, L = 1.6 * sin(pi / (double)n) * R;
  *omega = ring_speed(n, k, m, L, R);
  msr_scene *scene = empty_scene(h);
  for (size_t i = 0; i < n; i++) {
    const double at = 2 * pi * (double)i / (double)n, v = *omega * R;
    add_mass(scene, R * cos(at), R * sin(at), -v * sin(at), v * cos(at), m);
  }
  for (size_t i = 0; i < (n == 2 ? 1 : n); i++)
    must(msr_scene_add_spring(scene, i, (i + 1) % n, k, L, &why));
  return open_world(scene, NULL, 1);
}

/* Largest change of the radius in 3 s. */
static double ring_error(size_t n, double h) {
  double omega, worst = 0;
  world w = ring(n, h, &omega);
  for (int step = 0; step < 300; step++) {
    advance(&w, (uint64_t)lround(0.01 / h));
    for (size_t i = 0; i < n; i++) worst = fmax(worst, fabs(hypot(x_of(&w, i), y_of(&w, i)) - 2));
  }
  close_world(w);
  return worst;
}

static void a_spinning_ring_keeps_its_radius(void **state) {
  (void)state;
  const size_t sizes[] = {2, 3, 7};
  for (size_t n = 0; n < LENGTH(sizes); n++) {
    const double coarse = ring_error(sizes[n], 0.001), fine = ring_error(sizes[n], 0.0005);
    if (!(coarse < 1e-3 && fabs(coarse / fine - 4) < 0.2))
      fail_msg("ring of %d: radius off by %g, %g", (int)sizes[n], coarse, fine);
  }
}

/* A straight chain of N, free, moving along itself is linear: mode j, with displacements
 * cos(j pi (i + 1/2) / N), swings at 2 sqrt(k/m) sin(j pi / 2N). From that shape at rest Verlet is
 * at cos(omega' t), sin(omega' h / 2) = omega h / 2, to rounding. */
static void check_mode(size_t N, size_t j) {
  const double k = 20, m = 0.3, h = 0.02, a = 0.1;
  msr_scene *scene = empty_scene(h);
  double shape[16];
  for (size_t i = 0; i < N; i++) {
    shape[i] = a * cos((double)j * pi * ((double)i + 0.5) / (double)N);
    add_mass(scene, 2 * (double)i + shape[i], 5, 0, 0, m);
    if (i > 0) must(msr_scene_add_spring(scene, i - 1, i, k, 2, &why));
  }
  world w = open_world(scene, NULL, 1);
  const double omega = 2 * sqrt(k / m) * sin((double)j * pi / (2 * (double)N));
  const double turn = 2 * asin(omega * h / 2);
  for (int n = 1; n <= 300; n++) {
    advance(&w, 1);
    for (size_t i = 0; i < N; i++) {
      const double error = x_of(&w, i) - 2 * (double)i - shape[i] * cos(n * turn);
      if (!(fabs(error) < 1e-11)) fail_msg("mode %d of %d: %g", (int)j, (int)N, error);
      assert_true(fabs(y_of(&w, i) - 5) < DBL_EPSILON);
    }
  }
  close_world(w);
}

static void chains_have_their_modes(void **state) {
  (void)state;
  for (size_t N = 2; N <= 12; N += 5)
    for (size_t j = 1; j < N; j++) check_mode(N, j);
}

/* A chain under an anchor comes to rest with each spring pulled by the masses below it:
 * l_i = L + m g (masses below) / k. */
static void a_hanging_chain_bears_its_weight(void **state) {
  (void)state;
  enum { N = 6 };
  const double k = 50, m = 0.2, g = 9.8, L = 1, top = 40;
  msr_scene *scene = empty_scene(0.02);
  for (size_t i = 0; i < N; i++) {
    add_mass(scene, 3, top - L * (double)(i + 1), 0, 0, m);
    if (i > 0) must(msr_scene_add_spring(scene, i - 1, i, k, L, &why));
  }
  must(msr_scene_add_anchor(scene, &(msr_anchor){0, 3, top, k, L}, &why));
  add_force(scene, &msr_force_gravity, &(msr_gravity){g});
  add_force(scene, &msr_force_drag, &(msr_drag){1});
  add_force(scene, &msr_force_damping, &(msr_damping){1});
  world w = open_world(scene, NULL, 0);
  advance(&w, 2000);
  double above = top;
  for (size_t i = 0; i < N; i++) {
    const double l = L + m * g * (double)(N - i) / k;
    assert_true(fabs(above - y_of(&w, i) - l) < 1e-11); /* roundings of 40 px, over k/m */
    above = y_of(&w, i);
  }
  assert_true(msr_state_energy(w.state).kinetic < 1e-24);
  close_world(w);
}

/* An anchor at rest length 0 makes a harmonic orbit: an ellipse, at its start again after
 * 2 pi sqrt(m/k) but for Verlet's phase, 2 pi (omega h)^2 / 24. */
static void an_anchored_mass_goes_round_its_ellipse(void **state) {
  (void)state;
  const double m = 0.5, k = 8, period = 2 * pi * sqrt(m / k), phase = 2 * pi * 4 * pi * pi / 24e6;
  msr_scene *scene = empty_scene(period / 1000);
  add_mass(scene, 4, 1, 0, 3, m);
  must(msr_scene_add_anchor(scene, &(msr_anchor){0, 1, 1, k, 0}, &why));
  world w = open_world(scene, NULL, 1);
  advance(&w, 250);
  assert_true(fabs(x_of(&w, 0) - 1) < 3 * phase);
  assert_true(fabs(y_of(&w, 0) - 1 - 3 * sqrt(m / k)) < 4e-6); /* (omega h)^2 / 8 of it */
  advance(&w, 750);
  assert_true(fabs(x_of(&w, 0) - 4) < 3e-9 && fabs(y_of(&w, 0) - 1) < 3 * phase);
  close_world(w);
}

/* ---- Falls and bounces */

/* Verlet is exact in a uniform field: what is left is the rounding of 300 steps. */
static void a_fall_is_exact(void **state) {
  (void)state;
  msr_scene *scene = empty_scene(0.01);
  add_mass(scene, 2, 50, 1.5, 4, 0.3);
  add_force(scene, &msr_force_gravity, &(msr_gravity){9.8});
  world w = open_world(scene, NULL, 1);
  for (int n = 1; n <= 300; n++) {
    advance(&w, 1);
    const double t = 0.01 * n, rounding = 300 * DBL_EPSILON * 50;
    assert_true(fabs(x_of(&w, 0) - 2 - 1.5 * t) < rounding);
    assert_true(fabs(y_of(&w, 0) - 50 - 4 * t + 4.9 * t * t) < rounding);
    assert_true(fabs(msr_state_view(w.state).vy[0] - 4 + 9.8 * t) < rounding);
  }
  close_world(w);
}

/* Heights of the first three apexes above the floor's top, over the height of the fall. */
static void measure_apexes(double h, double e, double *apex) {
  const msr_conf conf = {h, 9.8, 1, 0, 1, 1};
  msr_scene *scene = scene_of("o\n.\n.\n.\n.\n.\n.\n.\n.\n#\n", &conf, NULL);
  must(msr_scene_set_contact(scene, e, 0, &why));
  world w = open_world(scene, NULL, 0);
  const double fall = y_of(&w, 0) - 1;
  for (uint64_t bounces = 1; bounces <= 4;) {
    advance(&w, 1);
    const uint64_t contacts = msr_state_contacts(w.state);
    if (contacts == bounces && contacts < 4)
      apex[contacts - 1] = fmax(apex[contacts - 1], (y_of(&w, 0) - 1) / fall);
    if (contacts > bounces) bounces = contacts;
  }
  close_world(w);
}

/* Apex n is e^(2n) of the fall. A bounce is off by up to the motion of one step, v h / fall with
 * v = 12.2 px/s and 8.5 px, and so is each after it. */
static void bounces_lose_by_the_restitution(void **state) {
  (void)state;
  const double restitution[] = {0.9, 0.7, 0.5}, h = 1e-4;
  for (size_t r = 0; r < LENGTH(restitution); r++) {
    const double e = restitution[r];
    double apex[3] = {0};
    measure_apexes(h, e, apex);
    for (int n = 1; n <= 3; n++)
      if (!(fabs(apex[n - 1] - pow(e, 2 * n)) < n * 12.2 * h / 8.5))
        fail_msg("e = %g: apex %d at %g of the fall", e, n, apex[n - 1]);
  }
}

/* ---- Drag */

/* v = v_inf (1 - exp(-c t / m)), v_inf = -m g / c: order 2 by splitting, the error of v being at
 * most g h (c h / m) / 12 over the time m / c that it lasts, g (m/c) (c h / m)^2 / 12. */
static void a_fall_in_air_reaches_its_speed(void **state) {
  (void)state;
  const double c = 0.2, m = 0.1, g = 9.8, h = 0.01, final = -m * g / c;
  msr_scene *scene = empty_scene(h);
  add_mass(scene, 0, 0, 0, 0, m);
  add_force(scene, &msr_force_gravity, &(msr_gravity){g});
  add_force(scene, &msr_force_drag, &(msr_drag){c});
  world w = open_world(scene, NULL, 0);
  const double error = -final * pow(c * h / m, 2) / 12;
  for (int n = 1; n <= 2000; n++) {
    advance(&w, 1);
    const double v = final * (1 - exp(-c * h * n / m));
    assert_true(fabs(msr_state_view(w.state).vy[0] - v) < error);
  }
  close_world(w);
}

/* Without weight, v decays exactly for any step. */
static void drag_alone_is_exact(void **state) {
  (void)state;
  msr_scene *scene = empty_scene(0.7);
  add_mass(scene, 0, 0, 4, -3, 0.5);
  add_mass(scene, 9, 0, 1, 2, 2);
  add_force(scene, &msr_force_drag, &(msr_drag){0.8});
  world w = open_world(scene, NULL, 1);
  advance(&w, 10);
  const msr_view s = msr_state_view(w.state);
  assert_true(fabs(s.vx[0] - 4 * exp(-0.8 * 7 / 0.5)) < 40 * DBL_EPSILON);
  assert_true(fabs(s.vy[0] + 3 * exp(-0.8 * 7 / 0.5)) < 40 * DBL_EPSILON);
  assert_true(fabs(s.vx[1] - 1 * exp(-0.8 * 7 / 2)) < 40 * DBL_EPSILON);
  close_world(w);
}

/* c h / m = 10^6: explicit drag would need a million substeps; here one will do, and nothing is
 * ever given. Damping along the springs likewise. */
static void extreme_damping_is_stable(void **state) {
  (void)state;
  const struct {
    const msr_force *force;
    const void *params;
  } brakes[] = {{&msr_force_drag, &(msr_drag){1e7}}, {&msr_force_damping, &(msr_damping){1e7}}};
  for (size_t b = 0; b < LENGTH(brakes); b++) {
    msr_scene *scene = lattice(5, 4, 8, &(msr_conf){0.01, 9.8, 0.1, 100, 1, 1});
    add_force(scene, brakes[b].force, brakes[b].params);
    world w = open_world(scene, NULL, 0);
    assert_int_equal(msr_plan_describe(w.plan).substeps, 1);
    const msr_arrays s = msr_state_edit(w.state);
    for (size_t i = 0; i < 20; i++)
      s.vx[i] = sin(3.0 * (double)i), s.x[i] += 0.2 * sin(7.0 * (double)i);
    double before = msr_state_energy(w.state).total;
    for (int n = 0; n < 1000; n++) {
      advance(&w, 1);
      const double now = msr_state_energy(w.state).total;
      if (!(now < before + 1e-9)) fail_msg("%s: %g after %g", brakes[b].force->name, now, before);
      before = now;
    }
    close_world(w);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_pair_swings_with_its_period),
      cmocka_unit_test(a_spinning_ring_keeps_its_radius),
      cmocka_unit_test(chains_have_their_modes),
      cmocka_unit_test(a_hanging_chain_bears_its_weight),
      cmocka_unit_test(an_anchored_mass_goes_round_its_ellipse),
      cmocka_unit_test(a_fall_is_exact),
      cmocka_unit_test(bounces_lose_by_the_restitution),
      cmocka_unit_test(a_fall_in_air_reaches_its_speed),
      cmocka_unit_test(drag_alone_is_exact),
      cmocka_unit_test(extreme_damping_is_stable),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
