/* lanes.h - sums of many numbers, by eight sums side by side: the same on every machine. */
#ifndef MSRI_LANES_H
#define MSRI_LANES_H

#include "base/machine.h"

#include <stddef.h>

enum { MSRI_LANES = 8 };

typedef struct msri_lanes {
  double sum[MSRI_LANES];
} msri_lanes;

/* Adds x[n]. */
MSRI_INLINE void msri_lanes_add(size_t n, const double *x, msri_lanes *lanes) {
  msri_lanes own = *lanes;
  size_t i = 0;
  for (; i + MSRI_LANES <= n; i += MSRI_LANES)
    for (size_t k = 0; k < MSRI_LANES; k++) own.sum[k] += x[i + k];
  for (size_t k = 0; i + k < n; k++) own.sum[k] += x[i + k];
  *lanes = own;
}

static inline double msri_lanes_sum(const msri_lanes *lanes) {
  double sum = 0;
  for (size_t k = 0; k < MSRI_LANES; k++) sum += lanes->sum[k];
  return sum;
}

/* Asks for memory that is going to be used soon, by lines of the cache. */
MSRI_INLINE void msri_foresee(size_t bytes, const void *memory) {
#if MSRI_WIDE
  for (size_t i = 0; i < bytes; i += 64) __builtin_prefetch((const char *)memory + i);
#else
  (void)bytes, (void)memory;
#endif
}

#endif
