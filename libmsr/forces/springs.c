/* springs.c - linear springs: F_ij = k (|x_ij| - L) x_ij / |x_ij|, U = k (|x_ij| - L)^2 / 2.
 *
 * A run of springs is computed block by block into a buffer, which is then added at one end and
 * taken away at the other: three loops without aliasing, whatever the run's offset, and the same
 * sum in the same order on every machine. These loops are compiled for vectors of several widths;
 * the machine that they run on decides between them, not the one that compiled them. */
#include "forces/springs.h"

#include "base/number.h"
#include "forces/mesh.h"

#include <math.h>

/* Forces on the beginnings of `count` springs; stride is 0 or 1. A spring without length divides by
 * infinity: a choice of quotients, not of divisors, would keep gcc from vectorising the loop. */
MSRI_INLINE void tensions(size_t count, const msri_ends *e, const double *k, const double *L,
                          size_t stride, double *restrict fx, double *restrict fy) {
  const double *xi = e->xi, *yi = e->yi, *xj = e->xj, *yj = e->yj;
  for (size_t s = 0; s < count; s++) {
    const double dx = xj[s] - xi[s], dy = yj[s] - yi[s];
    const double l = sqrt(dx * dx + dy * dy);
    const double f = k[s * stride] * (l - L[s * stride]) / (l > 0 ? l : (double)INFINITY);
    fx[s] = f * dx;
    fy[s] = f * dy;
  }
}

MSRI_INLINE void add_block(const msr_view *s, const msr_run_of_springs *run, size_t from,
                           size_t count, double *fx, double *fy) {
  double bx[MSRI_SPRINGS_BLOCK], by[MSRI_SPRINGS_BLOCK];
  const size_t i = run->first + from, j = i + run->offset;
  const msri_ends e = msri_ends_of(s, i, j);
  if (run->stride)
    tensions(count, &e, run->k + from, run->L + from, 1, bx, by);
  else
    tensions(count, &e, run->k, run->L, 0, bx, by);
  msri_add_to_ends(count, i, j, bx, by, fx, fy);
}

MSRI_INLINE void add_runs(const msr_view *s, double *fx, double *fy) {
  for (size_t r = 0; r < s->springs->n_runs; r++) {
    const msr_run_of_springs *run = &s->springs->run[r];
    for (size_t from = 0; from < run->count; from += MSRI_SPRINGS_BLOCK) {
      const size_t left = run->count - from;
      add_block(s, run, from, left < MSRI_SPRINGS_BLOCK ? left : MSRI_SPRINGS_BLOCK, fx, fy);
    }
  }
}

/* ---- Kernels */

#if MSRI_WIDE
MSRI_AVX512 static void add_avx512(const msr_view *s, double *fx, double *fy) {
  add_runs(s, fx, fy);
}

MSRI_AVX2 static void add_avx2(const msr_view *s, double *fx, double *fy) { add_runs(s, fx, fy); }
#endif

static void add_anywhere(const msr_view *s, double *fx, double *fy) { add_runs(s, fx, fy); }

const msri_springs_kernel msri_springs_kernels[] = {
#if MSRI_WIDE
    {"AVX-512", msri_has_avx512, add_avx512},
    {"AVX2", msri_has_avx2, add_avx2},
#endif
    {"any", NULL, add_anywhere},
};

static const msri_springs_kernel *widest(void) {
  const msri_springs_kernel *kernel = msri_springs_kernels;
  while (kernel->runs_here && !kernel->runs_here()) kernel++;
  return kernel;
}

/* ---- The force */

static void add_anchor(const msr_view *s, const msr_anchor *a, double *fx, double *fy) {
  double bx, by;
  const msri_ends e = msri_ends_of_anchor(s, a);
  tensions(1, &e, &a->k, &a->L, 0, &bx, &by);
  fx[a->i] += bx;
  fy[a->i] += by;
}

static msr_status add(const void *self, void *scratch, const msr_view *s, double *fx, double *fy) {
  (void)self, (void)scratch;
  widest()->add_runs(s, fx, fy);
  for (size_t a = 0; a < s->springs->n_anchors; a++) add_anchor(s, &s->springs->anchor[a], fx, fy);
  return MSR_OK;
}

/* Energies of `count` springs, summed one after the other, whatever the width of vectors. */
MSRI_INLINE double stored(size_t count, const msri_ends *e, const double *k, const double *L,
                          size_t stride) {
  double each[MSRI_SPRINGS_BLOCK], sum = 0;
  for (size_t s = 0; s < count; s++) {
    const double dx = e->xj[s] - e->xi[s], dy = e->yj[s] - e->yi[s];
    const double longer = sqrt(dx * dx + dy * dy) - L[s * stride];
    each[s] = k[s * stride] * longer * longer / 2;
  }
  for (size_t s = 0; s < count; s++) sum += each[s];
  return sum;
}

MSRI_INLINE double stored_in_runs(const msr_view *s) {
  double sum = 0;
  for (size_t r = 0; r < s->springs->n_runs; r++) {
    const msr_run_of_springs *run = &s->springs->run[r];
    for (size_t from = 0; from < run->count; from += MSRI_SPRINGS_BLOCK) {
      const size_t left = run->count - from, i = run->first + from;
      const size_t count = left < MSRI_SPRINGS_BLOCK ? left : MSRI_SPRINGS_BLOCK;
      const msri_ends e = msri_ends_of(s, i, i + run->offset);
      sum += run->stride ? stored(count, &e, run->k + from, run->L + from, 1)
                         : stored(count, &e, run->k, run->L, 0);
    }
  }
  return sum;
}

#if MSRI_WIDE
MSRI_AVX2 static double stored_avx2(const msr_view *s) { return stored_in_runs(s); }
#endif

static double stored_anywhere(const msr_view *s) {
#if MSRI_WIDE
  if (msri_has_avx2()) return stored_avx2(s);
#endif
  return stored_in_runs(s);
}

static double energy(const void *self, const msr_view *s) {
  (void)self;
  double sum = stored_anywhere(s);
  for (size_t n = 0; n < s->springs->n_anchors; n++) {
    const msr_anchor *a = &s->springs->anchor[n];
    const msri_ends e = msri_ends_of_anchor(s, a);
    sum += stored(1, &e, &a->k, &a->L, 0);
  }
  return sum;
}

/* Are all stiffnesses 0? */
static bool slack(const msr_springs *springs) {
  for (size_t r = 0; r < springs->n_runs; r++) {
    const msr_run_of_springs *run = &springs->run[r];
    for (size_t n = 0; n < (run->stride ? run->count : 1); n++)
      if (run->k[n] > 0) return false;
  }
  for (size_t n = 0; n < springs->n_anchors; n++)
    if (springs->anchor[n].k > 0) return false;
  return true;
}

static bool idle(const void *params, const msr_view *s, char *why, size_t size) {
  (void)params;
  const bool none = s->springs->n + s->springs->n_anchors == 0;
  if (!none && !slack(s->springs)) return false;
  msri_format(why, size,
              none ? "no two masses are neighbours" : "every stiffness (TENSION_RESSORT) is 0");
  return true;
}

static void describe(const void *params, const msr_view *s, char *text, size_t size) {
  (void)params;
  const size_t n = s->springs->n, anchors = s->springs->n_anchors;
  msri_format(text, size, "%zu springs between masses, %zu to fixed points", n, anchors);
}

static msr_status rates(const void *self, const msr_view *s, double *omega2, double *gamma) {
  (void)self, (void)gamma;
  return msri_mesh_bound(s, NULL, omega2);
}

const msr_force msr_force_springs = {
    .name = "springs",
    .summary = "F = k (|x_ij| - L) x_ij / |x_ij|",
    .absent = "no two masses are neighbours",
    .conservative = true,
    .ignores_start = true,
    .idle = idle,
    .describe = describe,
    .add = add,
    .energy = energy,
    .between = msri_springs_between,
    .rates = rates,
};
