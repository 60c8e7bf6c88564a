/* test_wind.c - random wind: an Ornstein-Uhlenbeck process by its statistics, smooth, and a
 * function of (seed, t) alone, whoever asks and in whatever order. Without gusts nothing is drawn.
 *
 * link: --wrap=gsl_rng_set */
#include "scenes.h"

#include <gsl/gsl_rng.h>

static size_t seedings; /* calls of gsl_rng_set so far */
void __real_gsl_rng_set(const gsl_rng *rng, unsigned long seed);
void __wrap_gsl_rng_set(const gsl_rng *rng, unsigned long seed);
void __wrap_gsl_rng_set(const gsl_rng *rng, unsigned long seed) {
  seedings++;
  __real_gsl_rng_set(rng, seed);
}

/* The grid that the process is drawn on: 16 points per correlation time, 1024 points per block. */
static const double gust_time = 0.8, spacing = 0.8 / 16, block = 0.8 / 16 * 1024;
static const msr_wind gusty = {.c = 1, .speed = 5, .gust = 2, .gust_time = 0.8, .seed = 42};

/* ---- The air: what wind does to a mass at rest, at c = 1 */

static const double at_rest[1], one = 1;
static const msr_springs no_springs;
static const msr_view alone = {.n = 1,
                               .x = at_rest,
                               .y = at_rest,
                               .vx = at_rest,
                               .vy = at_rest,
                               .m = &one,
                               .springs = &no_springs};

static actor air_of(const msr_wind *wind) { return prepare(&msr_force_wind, wind, &alone); }

typedef struct vector {
  double x, y;
} vector;

static vector air(const actor *a, double t) {
  msr_view s = alone;
  double f[2];
  s.t = t;
  act(a, &s, f);
  return (vector){f[0], f[1]};
}

/* Gusts over their deviation. */
static vector gust(const actor *a, double t) {
  const vector w = air(a, t);
  return (vector){(w.x - gusty.speed) / gusty.gust, w.y / gusty.gust};
}

/* ---- Statistics */

enum { SAMPLES = 1 << 18, LAGS = 7, PER_TIME = 4 };

/* Samples 4 to a correlation time, over T = 65536 of them. The mean and, for any lag, the
 * covariance of such a run are off by a standard error of sqrt(2 tau / T) at most (Priestley 1981,
 * Spectral Analysis and Time Series, 5.3: variances 2 tau / T and (tau / T) (1 + e^(-2s) (1 + 2s))
 * for lags of s tau), 0.55 %; they must be within 4 of them. */
static const double sampling = 4 * 0.005525;

static void sample(vector *w) {
  actor a = air_of(&gusty);
  for (size_t n = 0; n < SAMPLES; n++) w[n] = gust(&a, (double)n * gust_time / PER_TIME);
  dismiss(&a);
}

static double mean_product(const double *a, const double *b, size_t n) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += a[2 * i] * b[2 * i];
  return sum / (double)n;
}

static void gusts_have_their_statistics(void **state) {
  (void)state;
  vector *w = zeroed(SAMPLES, sizeof *w);
  double *unit = zeroed(2 * SAMPLES, sizeof *unit);
  for (size_t i = 0; i < 2 * SAMPLES; i++) unit[i] = 1;
  sample(w);
  const double *component[] = {&w->x, &w->y};
  for (size_t c = 0; c < 2; c++) {
    assert_true(fabs(mean_product(component[c], unit, SAMPLES)) < sampling);
    for (size_t lag = 0; lag < LAGS; lag++) {
      /* smoothing over one spacing, tau/16, may leave up to that much more */
      const double known = exp(-(double)lag / PER_TIME), smoothing = lag ? known / 16 : 0;
      const double found =
          mean_product(component[c], component[c] + 2 * lag, SAMPLES - lag) - known;
      if (!(found > -sampling && found < smoothing + sampling))
        fail_msg("covariance at %g tau: %g, off by %g", (double)lag / PER_TIME, known, found);
    }
  }
  for (size_t lag = 0; lag < LAGS; lag++) /* x and y know nothing of each other */
    assert_true(fabs(mean_product(&w->x, &w->y + 2 * lag, SAMPLES - lag)) < sampling);
  free(unit);
  free(w);
}

/* Different seeds, neighbours too, have nothing in common. */
static void seeds_give_unrelated_winds(void **state) {
  (void)state;
  const uint64_t seeds[] = {43, 0, 42 + (1ull << 32), UINT64_MAX};
  enum { N = 8192 };
  vector *w = zeroed(SAMPLES, sizeof *w), *other = zeroed(SAMPLES, sizeof *other);
  sample(w);
  for (size_t s = 0; s < LENGTH(seeds); s++) {
    msr_wind wind = gusty;
    wind.seed = seeds[s];
    actor a = air_of(&wind);
    for (size_t n = 0; n < N; n++) other[n] = gust(&a, (double)n * gust_time / PER_TIME);
    /* a run 32 times shorter: an error sqrt(32) times larger */
    assert_true(fabs(mean_product(&w->x, &other->x, N)) < sampling * sqrt(32));
    assert_true(fabs(mean_product(&w->x, &other->y, N)) < sampling * sqrt(32));
    dismiss(&a);
  }
  free(w);
  free(other);
}

/* Blocks go on where the one before ended: the mean square of a change over one spacing is the same
 * across their borders as in their midst, within 4 standard errors for 2 N values. */
static double mean_square_change(const actor *a, double from, size_t n) {
  double sum = 0;
  for (size_t k = 0; k < n; k++) {
    const double t = from + (double)k * block;
    const vector before = gust(a, t - spacing), after = gust(a, t);
    sum += pow(after.x - before.x, 2) + pow(after.y - before.y, 2);
  }
  return sum / (double)(2 * n);
}

static void blocks_join(void **state) {
  (void)state;
  enum { N = 400 };
  actor a = air_of(&gusty);
  const double inside = mean_square_change(&a, block / 2, N);
  for (int shift = -1; shift <= 1; shift++) { /* the spline reaches 4 points to each side */
    const double across = mean_square_change(&a, (0.5 + 4 * shift) * spacing, N);
    if (!(fabs(across / inside - 1) < 4 * sqrt(2 * 2.0 / (2 * N))))
      fail_msg("changes of %g across borders, of %g elsewhere", across, inside);
  }
  dismiss(&a);
}

/* ---- Smoothness */

/* Largest difference of order 8, of steps d, around the borders of cells from `first` on. */
static double eighth_difference(const actor *a, double first, double d) {
  static const double choose[] = {1, -8, 28, -56, 70, -56, 28, -8, 1};
  double worst = 0;
  for (int cell = 0; cell < 8; cell++)
    for (double shift = -5; shift <= 5; shift += 0.5) {
      vector sum = {0, 0};
      for (int k = 0; k < 9; k++) {
        const vector w = gust(a, first + cell * spacing + (k - 4 + shift) * d);
        sum.x += choose[k] * w.x;
        sum.y += choose[k] * w.y;
      }
      worst = fmax(worst, fmax(fabs(sum.x), fabs(sum.y)));
    }
  return worst;
}

/* A function with a jump in its p-th derivative, and polynomial on both sides, has an eighth
 * difference of order d^p: 7 for a spline of degree 7, smooth to the 6th derivative. */
static void wind_is_smooth_to_the_sixth_derivative(void **state) {
  (void)state;
  const double places[] = {0, 3 * block, -2 * block, 3.5 * block};
  actor a = air_of(&gusty);
  for (size_t p = 0; p < LENGTH(places); p++) {
    const double first = places[p] - 4 * spacing;
    const double coarse = eighth_difference(&a, first, spacing / 12);
    const double fine = eighth_difference(&a, first, spacing / 24);
    const double order = log2(coarse / fine);
    if (!(fabs(order - 7) < 0.2)) fail_msg("at %g s: of order %g (%g)", places[p], order, fine);
  }
  dismiss(&a);
}

/* ---- A function of (seed, t) */

static const double times[] = {0,   1e-9, 0.3,    51.2,  51.2000001, 51.19, -0.001, -51.2,
                               700, -1e5, 1.7e10, 0.301, 1.7e10,     1e14,  -1e14,  3e5};

static void check_same_air(const vector *a, const vector *b, double t) {
  if (memcmp(a, b, sizeof *a) != 0)
    fail_msg("at %g s: (%g, %g), (%g, %g)", t, a->x, a->y, b->x, b->y);
}

static void air_does_not_depend_on_who_asks_when(void **state) {
  (void)state;
  actor one_after_another = air_of(&gusty);
  vector first[LENGTH(times)];
  for (size_t n = 0; n < LENGTH(times); n++) {
    actor fresh = air_of(&gusty);
    first[n] = air(&fresh, times[n]);
    assert_true(isfinite(first[n].x) && isfinite(first[n].y));
    dismiss(&fresh);
  }
  uint64_t dice = 5;
  for (int ask = 0; ask < 300; ask++) {
    const size_t n = random_below(&dice, LENGTH(times));
    const vector w = air(&one_after_another, times[n]);
    check_same_air(&w, &first[n], times[n]);
  }
  dismiss(&one_after_another);
}

/* Within a spacing of the grid, on either side of it and across blocks, back and forth: whatever
 * was asked before. */
static void air_does_not_depend_on_what_was_asked_before(void **state) {
  (void)state;
  const double borders[] = {0, 5 * spacing, block, -block};
  actor old = air_of(&gusty);
  uint64_t dice = 7;
  for (int ask = 0; ask < 400; ask++) {
    const double t =
        borders[random_below(&dice, LENGTH(borders))] + uniform(&dice, -2 * spacing, 2 * spacing);
    actor fresh = air_of(&gusty);
    const vector is = air(&old, t), due = air(&fresh, t), again = air(&old, t);
    check_same_air(&is, &due, t);
    check_same_air(&again, &due, t);
    dismiss(&fresh);
  }
  dismiss(&old);
}

/* What a flow does to velocities: by both of its ways, after others of other times and steps. */
static void relaxing_is_flowing(void **state) {
  (void)state;
  const msr_drag drag = {0.3};
  actor winds[] = {air_of(&gusty), prepare(&msr_force_drag, &drag, &alone)};
  const double masses[] = {1, 0.2};
  uint64_t dice = 3;
  for (int ask = 0; ask < 200; ask++) {
    const actor *a = &winds[ask % 2];
    const double h = ask % 5 ? 0.01 : uniform(&dice, -0.5, 0.5), before = uniform(&dice, -9, 9);
    double vx = before, vy = -before, push[2];
    msr_view s = alone;
    s.t = uniform(&dice, 0, 1);
    s.m = &masses[random_below(&dice, 2)];
    const double keep = a->force->relax(a->self, a->scratch, &s, h, push);
    must(a->force->flow(a->self, a->scratch, &s, h, false, &vx, &vy));
    assert_true(vx == keep * before + push[0] && vy == keep * -before + push[1]);
  }
  for (size_t n = 0; n < LENGTH(winds); n++) dismiss(&winds[n]);
}

/* Far away it still varies: it isn't one value held, nor periodic with the blocks. */
static void air_varies_everywhere(void **state) {
  (void)state;
  actor a = air_of(&gusty);
  for (size_t n = 0; n < LENGTH(times); n++) {
    const vector here = gust(&a, times[n]), later = gust(&a, times[n] + gust_time);
    const vector next = gust(&a, times[n] + block), far = gust(&a, times[n] + 2 * block);
    assert_true(fabs(here.x - later.x) > 1e-6 && fabs(here.y - later.y) > 1e-6);
    assert_true(fabs(here.x - next.x) > 1e-6 && fabs(here.x - far.x) > 1e-6);
    assert_true(fabs(here.x) < 6 && fabs(here.y) < 6); /* deviations: 1 in 10^9 is above */
  }
  dismiss(&a);
}

/* The air that a state feels after a second, from F = c (w - v). */
static vector felt(const msr_integrator *integrator, uint64_t substeps) {
  msr_scene *scene = empty_scene(0.1);
  add_mass(scene, 0, 0, 3, 1, 0.7);
  add_force(scene, &msr_force_wind, &gusty);
  world w = open_world(scene, integrator, substeps);
  vector f;
  advance(&w, 10);
  must(msr_state_forces(w.state, &f.x, &f.y, &why));
  const msr_view s = msr_state_view(w.state);
  const vector found = {f.x + s.vx[0], f.y + s.vy[0]};
  close_world(w);
  return found;
}

/* To the rounding of adding v again. */
static void all_integrators_feel_one_wind(void **state) {
  (void)state;
  const uint64_t substeps[] = {1, 2, 17};
  actor a = air_of(&gusty);
  const vector w = air(&a, 1);
  for (const msr_integrator *const *i = msr_integrators; *i; i++)
    for (size_t n = 0; n < LENGTH(substeps); n++) {
      const vector found = felt(*i, substeps[n]);
      assert_true(hypot(found.x - w.x, found.y - w.y) < 8 * DBL_EPSILON * 10);
    }
  dismiss(&a);
}

/* ---- What is off costs nothing */

static vector run_in(const msr_wind *wind, size_t *drawn) {
  msr_scene *scene = empty_scene(0.01);
  add_mass(scene, 0, 0, 3, 1, 0.7);
  if (wind) add_force(scene, &msr_force_wind, wind);
  const size_t before = seedings;
  world w = open_world(scene, NULL, 0);
  advance(&w, 100);
  *drawn = seedings - before;
  const msr_view s = msr_state_view(w.state);
  const vector v = {s.vx[0], s.vy[0]};
  close_world(w);
  return v;
}

/* Steady wind draws nothing, and v tends to it: v = w + (v0 - w) exp(-c t / m), in 100 steps. */
static void steady_wind_draws_nothing(void **state) {
  (void)state;
  msr_wind steady = gusty;
  size_t drawn;
  steady.gust = 0;
  const vector v = run_in(&steady, &drawn);
  assert_int_equal(drawn, 0);
  assert_true(fabs(v.x - 5 - (3 - 5) * exp(-1 / 0.7)) < 400 * DBL_EPSILON * 5);
  assert_true(fabs(v.y - exp(-1 / 0.7)) < 400 * DBL_EPSILON);
  run_in(NULL, &drawn);
  assert_int_equal(drawn, 0);
  run_in(&gusty, &drawn); /* 1 s, from -4 to 24 points of the grid: blocks -1 and 0, each after */
  assert_int_equal(drawn, 4); /* the one before it */
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(gusts_have_their_statistics),
      cmocka_unit_test(seeds_give_unrelated_winds),
      cmocka_unit_test(blocks_join),
      cmocka_unit_test(wind_is_smooth_to_the_sixth_derivative),
      cmocka_unit_test(air_does_not_depend_on_who_asks_when),
      cmocka_unit_test(air_does_not_depend_on_what_was_asked_before),
      cmocka_unit_test(relaxing_is_flowing),
      cmocka_unit_test(air_varies_everywhere),
      cmocka_unit_test(all_integrators_feel_one_wind),
      cmocka_unit_test(steady_wind_draws_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
