/* noise.c - an Ornstein-Uhlenbeck process drawn on a grid of its own, then interpolated.
 *
 * On the grid, GRID points per correlation time, X[n+1] = r X[n] + sqrt(1 - r^2) xi[n+1] with
 * r = exp(-1 / GRID), exactly (Gillespie 1996, Phys. Rev. E 54, 2084, eq. 1.9). The normal deviates
 * xi come block by block from a generator seeded by (seed, block), and a block starts from 0 one
 * whole block earlier, forgotten by then to exp(-64): any block can be drawn without those before.
 * Between the points a B-spline of degree 7 makes it smooth to the 6th derivative, so that an
 * integrator keeps its order; its variance is restored on average over a cell. */
#include "forces/noise.h"

#include <assert.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>

enum { GRID = 16, DEGREE = 7, POINTS = DEGREE + 1 };

/* SplitMix64's finaliser (Steele, Lea & Flood 2014): neighbouring inputs give unrelated outputs. */
static uint64_t mix(uint64_t z) {
  z += 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31);
}

/* Runs the two chains through a block from (*x, *y), storing them if there is where to. */
static void run_block(uint64_t seed, int64_t block, double *x, double *y, double *xs, double *ys) {
  unsigned long memory[8];
  gsl_rng rng = {gsl_rng_taus2, memory};
  assert(gsl_rng_taus2->size <= sizeof memory);
  gsl_rng_set(&rng, (unsigned long)(mix(seed ^ mix((uint64_t)block)) >> 32));
  const double r = exp(-1.0 / GRID), kick = sqrt(1 - r * r);
  for (size_t n = 0; n < MSRI_NOISE_BLOCK; n++) {
    *x = r * *x + gsl_ran_gaussian_ziggurat(&rng, kick);
    *y = r * *y + gsl_ran_gaussian_ziggurat(&rng, kick);
    if (xs) xs[n] = *x, ys[n] = *y;
  }
}

static void grid_point(const msri_noise *noise, msri_noise_cache *cache, int64_t k, double *x,
                       double *y) {
  const int64_t inside = k & (MSRI_NOISE_BLOCK - 1), block = (k - inside) / MSRI_NOISE_BLOCK;
  const size_t slot = (size_t)(block & 1);
  if (!cache->filled[slot] || cache->block[slot] != block) {
    double at_x = 0, at_y = 0;
    run_block(noise->seed, block - 1, &at_x, &at_y, NULL, NULL);
    run_block(noise->seed, block, &at_x, &at_y, cache->x[slot], cache->y[slot]);
    cache->filled[slot] = true;
    cache->block[slot] = block;
  }
  *x = cache->x[slot][inside];
  *y = cache->y[slot][inside];
}

/* Weights of the grid points k-3 .. k+4 at k+u, 0 <= u < 1 (de Boor's recurrence). */
static void spline(double u, double w[POINTS]) {
  w[0] = 1;
  for (int d = 1; d <= DEGREE; d++) {
    w[d] = u / d * w[d - 1];
    for (int j = d - 1; j > 0; j--) w[j] = ((u + d - j) * w[j - 1] + (j + 1 - u) * w[j]) / d;
    w[0] *= (1 - u) / d;
  }
}

/* The interpolated chain's own variance is a little below 1: averaged over a cell. */
static double spline_variance(void) {
  enum { SAMPLES = 32 };
  double sum = 0, w[POINTS];
  for (int s = 0; s < SAMPLES; s++) {
    spline((s + 0.5) / SAMPLES, w);
    for (int i = 0; i < POINTS; i++)
      for (int j = 0; j < POINTS; j++) sum += w[i] * w[j] * exp(-fabs((double)(i - j)) / GRID);
  }
  return sum / SAMPLES;
}

msri_noise msri_noise_of(double deviation, double time, uint64_t seed) {
  return (msri_noise){time, deviation / sqrt(spline_variance()), seed};
}

static void interpolate(const msri_noise *noise, msri_noise_cache *cache, double t, double *x,
                        double *y) {
  const double most = 0x1p52, asked = t / noise->time * GRID;
  const double at = msri_max(-most, msri_min(asked, most)), k = floor(at);
  double w[POINTS], px, py;
  spline(at - k, w);
  *x = *y = 0;
  for (int j = 0; j < POINTS; j++) {
    grid_point(noise, cache, (int64_t)k + j - DEGREE / 2, &px, &py);
    *x += w[j] * px;
    *y += w[j] * py;
  }
  *x *= noise->scale;
  *y *= noise->scale;
}

void msri_noise_at(const msri_noise *noise, msri_noise_cache *cache, double t, double *x,
                   double *y) {
  if (!cache->known || cache->t != t) interpolate(noise, cache, t, &cache->at_x, &cache->at_y);
  cache->known = true;
  cache->t = t;
  *x = cache->at_x;
  *y = cache->at_y;
}
