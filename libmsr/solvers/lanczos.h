/* lanczos.h - the largest eigenvalue of a symmetric matrix that is only known by its products. */
#ifndef MSRI_LANCZOS_H
#define MSRI_LANCZOS_H

#include "base/base.h"

typedef struct msri_symmetric {
  size_t n;
  const void *self;
  void (*apply)(const void *self, const double *x, double *y); /* y[n] = A x[n] */
} msri_symmetric;

/* The largest eigenvalue of A, none of which is above 1, from below and to 0.05 % of it; 0 if it is
 * negative. The same bits every time. `iterations`: products taken. Memory: 3 vectors. MSR_ENOMEM.
 */
msr_status msri_lanczos_largest(const msri_symmetric *A, double *value, int *iterations);

/* Fills x[n] with numbers in -1 .. 1, the same every time. */
void msri_fill_at_random(size_t n, double *x);

#endif
