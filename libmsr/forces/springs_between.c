/* springs_between.c - the mean force of springs between two places, with x0, x1 a spring's vector
 * before and after and l0, l1 its length: F = k ((l0 + l1)/2 - L) (x0 + x1) / (l0 + l1), whose work
 * is exactly what the spring loses (Simo & Tarnow 1992, Z. angew. Math. Phys. 43, 757). */
#include "forces/springs.h"

#include <math.h>

MSRI_INLINE void mean_tensions(size_t count, const msri_ends *e, const msri_ends *to,
                               const double *k, const double *L, size_t stride, double *restrict fx,
                               double *restrict fy) {
  const double *xi = e->xi, *yi = e->yi, *xj = e->xj, *yj = e->yj;
  const double *Xi = to->xi, *Yi = to->yi, *Xj = to->xj, *Yj = to->yj;
  for (size_t s = 0; s < count; s++) {
    const double dx0 = xj[s] - xi[s], dy0 = yj[s] - yi[s];
    const double dx1 = Xj[s] - Xi[s], dy1 = Yj[s] - Yi[s];
    const double l = sqrt(dx0 * dx0 + dy0 * dy0) + sqrt(dx1 * dx1 + dy1 * dy1);
    const double f = k[s * stride] * (l / 2 - L[s * stride]) / (l > 0 ? l : (double)INFINITY);
    fx[s] = f * (dx0 + dx1);
    fy[s] = f * (dy0 + dy1);
  }
}

MSRI_INLINE void add_block(const msr_view *s, const msr_view *to, const msr_run_of_springs *run,
                           size_t from, size_t count, double *fx, double *fy) {
  double bx[MSRI_SPRINGS_BLOCK], by[MSRI_SPRINGS_BLOCK];
  const size_t i = run->first + from, j = i + run->offset;
  const msri_ends e = msri_ends_of(s, i, j), then = msri_ends_of(to, i, j);
  if (run->stride)
    mean_tensions(count, &e, &then, run->k + from, run->L + from, 1, bx, by);
  else
    mean_tensions(count, &e, &then, run->k, run->L, 0, bx, by);
  msri_add_to_ends(count, i, j, bx, by, fx, fy);
}

MSRI_INLINE void add_runs(const msr_view *s, const msr_view *to, double *fx, double *fy) {
  for (size_t r = 0; r < s->springs->n_runs; r++) {
    const msr_run_of_springs *run = &s->springs->run[r];
    for (size_t from = 0; from < run->count; from += MSRI_SPRINGS_BLOCK) {
      const size_t left = run->count - from;
      add_block(s, to, run, from, left < MSRI_SPRINGS_BLOCK ? left : MSRI_SPRINGS_BLOCK, fx, fy);
    }
  }
}

#if MSRI_WIDE
MSRI_AVX2 static void add_runs_avx2(const msr_view *s, const msr_view *to, double *fx, double *fy) {
  add_runs(s, to, fx, fy);
}
#endif

static void add_all_runs(const msr_view *s, const msr_view *to, double *fx, double *fy) {
#if MSRI_WIDE
  if (msri_has_avx2()) {
    add_runs_avx2(s, to, fx, fy);
    return;
  }
#endif
  add_runs(s, to, fx, fy);
}

static void add_anchor(const msr_view *s, const msr_view *to, const msr_anchor *a, double *fx,
                       double *fy) {
  double bx, by;
  const msri_ends e = msri_ends_of_anchor(s, a), then = msri_ends_of_anchor(to, a);
  mean_tensions(1, &e, &then, &a->k, &a->L, 0, &bx, &by);
  fx[a->i] += bx;
  fy[a->i] += by;
}

msr_status msri_springs_between(const void *self, void *scratch, const msr_view *s,
                                const msr_view *to, double *fx, double *fy) {
  (void)self, (void)scratch;
  add_all_runs(s, to, fx, fy);
  for (size_t a = 0; a < s->springs->n_anchors; a++)
    add_anchor(s, to, &s->springs->anchor[a], fx, fy);
  return MSR_OK;
}
