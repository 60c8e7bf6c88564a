/* lanes.h - numbers side by side, for kernels that one loop of C can't have vectorised: include it
 * with LANES (1, 2, 4 or 8), and NAMED(x), which makes a name the width's own. Each lane does what
 * a lone double would: same operations, same bits, whatever the width. */
#include "base/machine.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#if MSRI_WIDE
#include <immintrin.h>
#endif

#define lanes         NAMED(lanes)
#define lanes_mask    NAMED(lanes_mask)
#define lanes_all     NAMED(lanes_all)
#define lanes_load    NAMED(lanes_load)
#define lanes_store   NAMED(lanes_store)
#define lanes_root    NAMED(lanes_root)
#define lanes_above0  NAMED(lanes_above0)
#define lanes_keep    NAMED(lanes_keep)
#define lanes_after   NAMED(lanes_after)
#define lanes_larger  NAMED(lanes_larger)
#define lanes_largest NAMED(lanes_largest)
#define lanes_both    NAMED(lanes_both)
#define lanes_last    NAMED(lanes_last)

#if LANES == 8
#define LANES_FN MSRI_INLINE __attribute__((target("avx512f")))
#elif LANES == 4
#define LANES_FN MSRI_INLINE __attribute__((target("avx2")))
#else
#define LANES_FN MSRI_INLINE
#endif

#if LANES == 1

typedef double lanes;
typedef bool lanes_mask;

LANES_FN lanes lanes_root(lanes a) { return sqrt(a); }

/* The larger, of a and the size of b; what is no number may be left out. */
LANES_FN lanes lanes_larger(lanes a, lanes b) {
  const double size = fabs(b);
  return a > size ? a : size;
}

/* Which are above 0? */
LANES_FN lanes_mask lanes_above0(lanes a) { return a > 0; }

LANES_FN lanes_mask lanes_both(lanes_mask a, lanes_mask b) { return a && b; }

/* 0 in place of those that aren't marked. */
LANES_FN lanes lanes_keep(lanes_mask mask, lanes a) { return mask ? a : 0; }

/* All moved by one place, the last of `before` coming first. */
LANES_FN lanes lanes_after(lanes before, lanes a) {
  (void)a;
  return before;
}

LANES_FN double lanes_last(lanes a) { return a; }

LANES_FN double lanes_largest(lanes a) { return a; }

#else

typedef double lanes __attribute__((vector_size(8 * LANES)));
typedef long long lanes_mask __attribute__((vector_size(8 * LANES)));

LANES_FN lanes lanes_root(lanes a) {
#if LANES == 8
  return (lanes)_mm512_sqrt_pd((__m512d)a);
#elif LANES == 4
  return (lanes)_mm256_sqrt_pd((__m256d)a);
#else
  return (lanes)_mm_sqrt_pd((__m128d)a);
#endif
}

LANES_FN lanes lanes_larger(lanes a, lanes b) {
  const lanes size = (lanes)((lanes_mask)b & ((lanes_mask){0} + INT64_MAX));
#if LANES == 8
  return (lanes)_mm512_max_pd((__m512d)a, (__m512d)size);
#elif LANES == 4
  return (lanes)_mm256_max_pd((__m256d)a, (__m256d)size);
#else
  return (lanes)_mm_max_pd((__m128d)a, (__m128d)size);
#endif
}

LANES_FN lanes_mask lanes_above0(lanes a) { return a > (lanes){0}; }

LANES_FN lanes_mask lanes_both(lanes_mask a, lanes_mask b) { return a & b; }

LANES_FN lanes lanes_keep(lanes_mask mask, lanes a) { return (lanes)(mask & (lanes_mask)a); }

LANES_FN lanes lanes_after(lanes before, lanes a) {
#if LANES == 8
  return __builtin_shufflevector(before, a, 7, 8, 9, 10, 11, 12, 13, 14);
#elif LANES == 4
  return __builtin_shufflevector(before, a, 3, 4, 5, 6);
#else
  return __builtin_shufflevector(before, a, 1, 2);
#endif
}

LANES_FN double lanes_last(lanes a) { return a[LANES - 1]; }

LANES_FN double lanes_largest(lanes a) {
  double most = a[0];
  for (int n = 1; n < LANES; n++) most = a[n] > most ? a[n] : most;
  return most;
}

#endif

LANES_FN lanes lanes_all(double a) { return a - (lanes){0}; }

LANES_FN lanes lanes_load(const double *from) {
  lanes a;
  memcpy(&a, from, sizeof a);
  return a;
}

LANES_FN void lanes_store(double *to, lanes a) { memcpy(to, &a, sizeof a); }
