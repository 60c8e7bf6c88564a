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

#if MSRI_WIDE
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

double msri_largest(size_t n, const double *x) {
  double most = 0, sound = 0;
  for (size_t i = 0; i < n; i++) {
    const double size = fabs(x[i]);
    most = size > most ? size : most;
    sound += 0 * size;
  }
  return most + sound;
}
