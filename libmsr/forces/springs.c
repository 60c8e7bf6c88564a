/* springs.c - linear springs: F_ij = k (|x_ij| - L) x_ij / |x_ij|, U = k (|x_ij| - L)^2 / 2.
 * Forces are found by the kernels of springs_kernels.c. */
#include "forces/springs.h"

#include "base/number.h"
#include "forces/mesh.h"

#include <math.h>

static void add_anchor(const msr_view *s, const msr_anchor *a, double *fx, double *fy) {
  const double dx = a->x - s->x[a->i], dy = a->y - s->y[a->i];
  const double l = sqrt(dx * dx + dy * dy);
  const double f = a->k * (l - a->L) / (l > 0 ? l : (double)INFINITY);
  fx[a->i] += f * dx;
  fy[a->i] += f * dy;
}

static msr_status add(const void *self, void *scratch, const msr_view *s, double *fx, double *fy) {
  (void)self, (void)scratch;
  const msri_bundle all = msri_bundle_of_all(s->springs);
  msri_springs_widest()->add(&all, s->x, s->y, fx, fy);
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
