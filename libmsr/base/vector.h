/* vector.h - what integrators do to vectors in every stage. */
#ifndef MSRI_VECTOR_H
#define MSRI_VECTOR_H

#include <stddef.h>

/* y[n] += c x[n]; x and y don't overlap. */
void msri_add_scaled(size_t n, double c, const double *restrict x, double *restrict y);

/* y[n] *= c. */
void msri_scale(size_t n, double c, double *y);

/* The largest |x[i]|; no finite number if one isn't. */
double msri_largest(size_t n, const double *x);

/* The same of x[n] and y[n]. */
double msri_largest_of_two(size_t n, const double *x, const double *y);

/* Sum of x[i] y[i], in that order. */
double msri_dot(size_t n, const double *x, const double *y);

/* Sum of w[i] x[i]^2; w NULL: all are 1. */
double msri_sum_squares(size_t n, const double *w, const double *x);

#endif
