/* vector.c - see vector.h. Wider vectors than AVX2's would hardly be faster: memory is the limit.
 */
#include "base/vector.h"

#include "base/machine.h"

#include <math.h>

MSRI_INLINE void add_scaled(size_t n, double c, const double *restrict x, double *restrict y) {
  for (size_t i = 0; i < n; i++) y[i] += c * x[i];
}

MSRI_INLINE void scale(size_t n, double c, double *y) {
  for (size_t i = 0; i < n; i++) y[i] *= c;
}

/* Eight sums side by side, the same on every machine. */
MSRI_INLINE double sum_squares(size_t n, const double *w, const double *x) {
  double sum[8] = {0}, rest = 0;
  size_t i = 0;
  for (; i + 8 <= n; i += 8)
    for (size_t k = 0; k < 8; k++) sum[k] += (w ? w[i + k] : 1) * x[i + k] * x[i + k];
  for (; i < n; i++) rest += (w ? w[i] : 1) * x[i] * x[i];
  for (size_t k = 0; k < 8; k++) rest += sum[k];
  return rest;
}

#if MSRI_WIDE
MSRI_AVX2 static double sum_squares_avx2(size_t n, const double *w, const double *x) {
  return w ? sum_squares(n, w, x) : sum_squares(n, NULL, x);
}

MSRI_AVX2 static void add_scaled_avx2(size_t n, double c, const double *restrict x,
                                      double *restrict y) {
  add_scaled(n, c, x, y);
}

MSRI_AVX2 static void scale_avx2(size_t n, double c, double *y) { scale(n, c, y); }
#endif

void msri_add_scaled(size_t n, double c, const double *restrict x, double *restrict y) {
#if MSRI_WIDE
  if (msri_has_avx2()) {
    add_scaled_avx2(n, c, x, y);
    return;
  }
#endif
  add_scaled(n, c, x, y);
}

void msri_scale(size_t n, double c, double *y) {
#if MSRI_WIDE
  if (msri_has_avx2()) {
    scale_avx2(n, c, y);
    return;
  }
#endif
  scale(n, c, y);
}

/* The largest |x[i]|, whatever the order, and 0 or no number, side by side. */
MSRI_INLINE double largest(size_t n, const double *x) {
  double most[8] = {0}, sound[8] = {0};
  size_t i = 0;
  for (; i + 8 <= n; i += 8)
    for (size_t k = 0; k < 8; k++) {
      const double size = fabs(x[i + k]);
      most[k] = size > most[k] ? size : most[k];
      sound[k] += 0 * size;
    }
  for (size_t k = 0; i + k < n; k++) {
    const double size = fabs(x[i + k]);
    most[k] = size > most[k] ? size : most[k];
    sound[k] += 0 * size;
  }
  for (size_t k = 1; k < 8; k++) {
    most[0] = most[k] > most[0] ? most[k] : most[0];
    sound[0] += sound[k];
  }
  return most[0] + sound[0];
}

#if MSRI_WIDE
MSRI_AVX2 static double largest_avx2(size_t n, const double *x) { return largest(n, x); }
#endif

double msri_largest(size_t n, const double *x) {
#if MSRI_WIDE
  if (msri_has_avx2()) return largest_avx2(n, x);
#endif
  return largest(n, x);
}

double msri_dot(size_t n, const double *x, const double *y) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += x[i] * y[i];
  return sum;
}

double msri_sum_squares(size_t n, const double *w, const double *x) {
#if MSRI_WIDE
  if (msri_has_avx2()) return sum_squares_avx2(n, w, x);
#endif
  return w ? sum_squares(n, w, x) : sum_squares(n, NULL, x);
}
