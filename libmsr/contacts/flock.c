/* flock.c - masses that stay in their pixel, for vectors of several widths: what is left by wide
 * ones is done by narrower ones. */
#include "contacts/flock.h"

#define LANES    1
#define NAMED(x) x##_1
#include "contacts/flock_kernel.inc"

#if MSRI_WIDE
#define LANES    4
#define NAMED(x) x##_4
#include "contacts/flock_kernel.inc"

#define LANES    8
#define NAMED(x) x##_8
#include "contacts/flock_kernel.inc"
#endif

static void glide_any(const msri_flock *f, double h) { glide_1(f, h, 0); }

static uint64_t leave_any(const msri_flock *f, const msri_places *from) {
  uint64_t left = 0;
  leave_1(f, from, 0, &left);
  return left;
}

#if MSRI_WIDE
MSRI_AVX2 static void glide_avx2(const msri_flock *f, double h) { glide_1(f, h, glide_4(f, h, 0)); }

MSRI_AVX2 static uint64_t leave_avx2(const msri_flock *f, const msri_places *from) {
  uint64_t left = 0;
  leave_1(f, from, leave_4(f, from, 0, &left), &left);
  return left;
}

MSRI_AVX512 static void glide_avx512(const msri_flock *f, double h) { glide_8(f, h, 0); }

MSRI_AVX512 static uint64_t leave_avx512(const msri_flock *f, const msri_places *from) {
  uint64_t left = 0;
  leave_8(f, from, 0, &left);
  return left;
}
#endif

const msri_flock_kernel msri_flock_kernels[] = {
#if MSRI_WIDE
    {msri_has_avx512, glide_avx512, leave_avx512},
    {msri_has_avx2, glide_avx2, leave_avx2},
#endif
    {NULL, glide_any, leave_any},
};

const msri_flock_kernel *msri_flock_widest(void) {
  const msri_flock_kernel *kernel = msri_flock_kernels;
  while (kernel->runs_here && !kernel->runs_here()) kernel++;
  return kernel;
}
