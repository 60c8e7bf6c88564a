/* springs_kernels.c - the kernels of springs.h, compiled for several widths: the machine that they
 * run on decides between them, not the one that compiled them. What is left of a run by wide
 * vectors is done by narrower ones, or by a part of one. */
#include "forces/springs.h"

/* Forces where springs begin and where they end. */
typedef struct pulled {
  double *xi, *yi, *xj, *yj;
} pulled;

#define LANES    1
#define NAMED(x) x##_1
#include "forces/springs_kernel.inc"

#if MSRI_WIDE
#define LANES    2
#define NAMED(x) x##_2
#include "forces/springs_kernel.inc"

#define LANES    4
#define NAMED(x) x##_4
#include "forces/springs_kernel.inc"

#define LANES    8
#define NAMED(x) x##_8
#include "forces/springs_kernel.inc"
#endif

/* ---- By width */

MSRI_INLINE void go_narrow(const msri_ends *e, const pulled *f, const msr_run_of_springs *run,
                           size_t n, double left[2]) {
#if MSRI_WIDE
  n = tie_2(e, f, run, n, left);
#endif
  tie_1(e, f, run, n, left);
}

#if MSRI_WIDE
MSRI_INLINE MSRI_AVX2 void go_wide(const msri_ends *e, const pulled *f,
                                   const msr_run_of_springs *run, size_t n, double left[2]) {
  go_narrow(e, f, run, tie_4(e, f, run, n, left), left);
}

MSRI_INLINE MSRI_AVX512 void go_wider(const msri_ends *e, const pulled *f,
                                      const msr_run_of_springs *run, size_t n, double left[2]) {
  go_wide(e, f, run, tie_8(e, f, run, n, left), left);
}
#endif

/* Run r of a bundle, as far as it belongs there. */
MSRI_INLINE msr_run_of_springs run_of(const msri_bundle *b, size_t r) {
  msr_run_of_springs run = b->run[r];
  const size_t from = r == 0 ? b->skip : 0, end = r + 1 == b->n_runs ? b->stop : run.count;
  run.first += from;
  run.count = end - from;
  run.k += from * run.stride;
  run.L += from * run.stride;
  return run;
}

#define ADD(target, width)                                                                         \
  target static void add_##width(const msri_bundle *b, const double *x, const double *y,           \
                                 double *fx, double *fy) {                                         \
    for (size_t r = 0; r < b->n_runs; r++) {                                                       \
      const msr_run_of_springs run = run_of(b, r);                                                 \
      const size_t i = run.first - b->base, j = i + run.offset;                                    \
      const msri_ends e = {x + i, y + i, x + j, y + j};                                            \
      const pulled f = {fx + i, fy + i, fx + j, fy + j};                                           \
      double left[2] = {0, 0};                                                                     \
      width(&e, &f, &run, 0, left);                                                                \
      if (run.offset != 1) continue;                                                               \
      f.xi[run.count] -= left[0];                                                                  \
      f.yi[run.count] -= left[1];                                                                  \
    }                                                                                              \
  }

ADD(, go_narrow)
#if MSRI_WIDE
ADD(MSRI_AVX2, go_wide)
ADD(MSRI_AVX512, go_wider)
#endif

const msri_springs_kernel msri_springs_kernels[] = {
#if MSRI_WIDE
    {"AVX-512", msri_has_avx512, add_go_wider},
    {"AVX2", msri_has_avx2, add_go_wide},
#endif
    {"any", NULL, add_go_narrow},
};

const msri_springs_kernel *msri_springs_widest(void) {
  const msri_springs_kernel *kernel = msri_springs_kernels;
  while (kernel->runs_here && !kernel->runs_here()) kernel++;
  return kernel;
}

msri_bundle msri_bundle_of_all(const msr_springs *s) {
  return (msri_bundle){
      .run = s->run, .n_runs = s->n_runs, .stop = s->n_runs > 0 ? s->run[s->n_runs - 1].count : 0};
}
