/* noise.h - a smooth Ornstein-Uhlenbeck process in two components, as a function of (seed, t). */
#ifndef MSRI_NOISE_H
#define MSRI_NOISE_H

#include "base/base.h"

enum { MSRI_NOISE_BLOCK = 1024, MSRI_NOISE_POINTS = 8 };

/* c[0] + c[1] u + ... */
typedef struct msri_noise_curve {
  double c[MSRI_NOISE_POINTS];
} msri_noise_curve;

typedef struct msri_noise {
  double time;  /* of correlation [s] */
  double scale; /* of the spline through a chain of variance 1 */
  uint64_t seed;
  msri_noise_curve weight[MSRI_NOISE_POINTS]; /* of the points around a cell of the grid */
} msri_noise;

/* The process whose components have this standard deviation and correlation time [s]. */
msri_noise msri_noise_of(double deviation, double time, uint64_t seed);

/* Values on the grid that were drawn last, and the process between the points k and k + 1 of it,
 * where it was asked for last, and then; all zero: none. */
typedef struct msri_noise_cache {
  bool known;
  double k, t, then[2];
  msri_noise_curve at_x, at_y;
  bool filled[2];
  int64_t block[2];
  double x[2][MSRI_NOISE_BLOCK], y[2][MSRI_NOISE_BLOCK];
} msri_noise_cache;

/* The process at time t; beyond 2^48 correlation times it stays as it is there. The cache only
 * saves time: it never changes the values. */
void msri_noise_at(const msri_noise *noise, msri_noise_cache *cache, double t, double *x,
                   double *y);

#endif
