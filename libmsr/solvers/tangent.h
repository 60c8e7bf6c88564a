/* tangent.h - the matrix of springs and anchors, for its eigenvalues. */
#ifndef MSRI_TANGENT_H
#define MSRI_TANGENT_H

#include "base/base.h"

/* Of which springs? */
typedef enum msri_stretch {
  MSRI_AS_THEY_ARE, /* 2n coordinates: along a spring k, across it k (1 - L / l) */
  MSRI_WITHOUT_END  /* n coordinates: k in every direction, as of springs pulled without limit */
} msri_stretch;

/* The largest eigenvalue of M^-1 K at the places of s, to 0.1 %; `bound` [1/s^2] is above it.
 * `iterations`: products taken. Memory: 3 vectors of 2n or n doubles and one of n. MSR_ENOMEM. */
msr_status msri_tangent_largest(const msr_view *s, msri_stretch stretch, double bound,
                                double *omega2, int *iterations);

/* y[2n] = K x[2n], of springs as they are. */
void msri_tangent_product(const msr_view *s, const double *x, double *y);

#endif
