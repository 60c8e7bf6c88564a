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
#include <string.h>

enum { GRID = 16, POINTS = MSRI_NOISE_POINTS, DEGREE = POINTS - 1 };

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

/* Weights of the grid points k-3 .. k+4 at k+u, 0 <= u < 1, by de Boor's recurrence
 *
 *     w[j] of degree d = ((u + d - j) w[j-1] + (j + 1 - u) w[j]) / d of degree d - 1. */
static void find_weights(msri_noise_curve *w) {
  memset(w, 0, POINTS * sizeof *w);
  w[0].c[0] = 1;
  for (int d = 1; d <= DEGREE; d++)
    for (int j = d; j >= 0; j--)
      for (int i = d; i >= 0; i--) {
        double sum = (j + 1) * w[j].c[i] - (i > 0 ? w[j].c[i - 1] : 0);
        if (j > 0) sum += (d - j) * w[j - 1].c[i] + (i > 0 ? w[j - 1].c[i - 1] : 0);
        w[j].c[i] = sum / d;
      }
}

static double value(const msri_noise_curve *curve, double u) {
  double sum = curve->c[DEGREE];
  for (int i = DEGREE - 1; i >= 0; i--) sum = sum * u + curve->c[i];
  return sum;
}

/* The interpolated chain's own variance is a little below 1: averaged over a cell. */
static double spline_variance(const msri_noise_curve *weight) {
  enum { SAMPLES = 32 };
  double sum = 0, w[POINTS];
  for (int s = 0; s < SAMPLES; s++) {
    for (int i = 0; i < POINTS; i++) w[i] = value(&weight[i], (s + 0.5) / SAMPLES);
    for (int i = 0; i < POINTS; i++)
      for (int j = 0; j < POINTS; j++) sum += w[i] * w[j] * exp(-fabs((double)(i - j)) / GRID);
  }
  return sum / SAMPLES;
}

msri_noise msri_noise_of(double deviation, double time, uint64_t seed) {
  msri_noise noise = {.time = time, .seed = seed};
  find_weights(noise.weight);
  noise.scale = deviation / sqrt(spline_variance(noise.weight));
  return noise;
}

static void open_cell(const msri_noise *noise, msri_noise_cache *cache, double k) {
  msri_noise_curve *const at_x = &cache->at_x, *const at_y = &cache->at_y;
  memset(at_x, 0, sizeof *at_x);
  memset(at_y, 0, sizeof *at_y);
  for (int j = 0; j < POINTS; j++) {
    double x, y;
    grid_point(noise, cache, (int64_t)k + j - DEGREE / 2, &x, &y);
    for (int i = 0; i < POINTS; i++) {
      at_x->c[i] += noise->scale * x * noise->weight[j].c[i];
      at_y->c[i] += noise->scale * y * noise->weight[j].c[i];
    }
  }
  cache->known = true;
  cache->k = k;
}

static void look_at(const msri_noise *noise, msri_noise_cache *cache, double t) {
  const double most = 0x1p52, asked = t / noise->time * GRID;
  const double at = msri_max(-most, msri_min(asked, most)), k = floor(at);
  if (!cache->known || cache->k != k) open_cell(noise, cache, k);
  cache->t = t;
  cache->then[0] = value(&cache->at_x, at - k);
  cache->then[1] = value(&cache->at_y, at - k);
}

void msri_noise_at(const msri_noise *noise, msri_noise_cache *cache, double t, double *x,
                   double *y) {
  if (!cache->known || cache->t != t) look_at(noise, cache, t);
  *x = cache->then[0];
  *y = cache->then[1];
}
