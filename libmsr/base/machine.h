/* machine.h - loops compiled for vectors of several widths, for the machine that runs them to
 * choose from: element by element their arithmetic is the same, and so are the bits. What such a
 * loop calls must be MSRI_INLINE, to be compiled with it. No ifunc: static libraries, musl,
 * sanitizers and valgrind all take part. */
#ifndef MSRI_MACHINE_H
#define MSRI_MACHINE_H

#include <stdbool.h>

/* With MSRI_NARROW nothing is wider than what the compiler makes of plain C: for tests. */
#if defined(__GNUC__) && defined(__x86_64__) && !defined(MSRI_NARROW)

#define MSRI_WIDE   1
#define MSRI_AVX2   __attribute__((target("avx2")))
#define MSRI_AVX512 __attribute__((target("avx512f")))
#define MSRI_INLINE static inline __attribute__((always_inline))

/* In a loop that waits for another thread. */
static inline void msri_pause(void) { __builtin_ia32_pause(); }

/* Soon to be read and written. */
static inline void msri_prefetch(const void *at) { __builtin_prefetch(at, 1); }

static inline bool msri_has_avx2(void) { return __builtin_cpu_supports("avx2"); }
static inline bool msri_has_avx512(void) { return __builtin_cpu_supports("avx512f"); }

#else

#define MSRI_WIDE   0
#define MSRI_INLINE static inline

static inline void msri_pause(void) {}
static inline void msri_prefetch(const void *at) { (void)at; }

#endif

#endif
