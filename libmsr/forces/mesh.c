/* mesh.c - properties of a mesh of springs: the Gershgorin bound and the longest spring.
 *
 * Row i of M^-1 K has the diagonal (sum of w)/m_i and, spring by spring, w/m_i beside it, so that
 * no eigenvalue is above max_i (2 sum of w over its springs + sum over its anchors)/m_i, whatever
 * the directions and stretches of the springs (a stretched spring is never stiffer than w along any
 * direction). */
#include "forces/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Row sums of masses base .. base+size-1. Runs that follow the rows of a lattice need those of two
 * rows at a time, which stay in cache, whatever the number of masses. */
typedef struct window {
  const msr_view *s;
  double *sum; /* [size] */
  size_t base, size;
  double bound; /* of the masses before */
} window;

/* The largest of n numbers of 0 or more; four at a time, so that none waits for the one before. */
static double largest(size_t n, const double *a) {
  double most[4] = {0};
  size_t i = 0;
  for (; i + 4 <= n; i += 4)
    for (size_t k = 0; k < 4; k++) most[k] = msri_max(most[k], a[i + k]);
  for (; i < n; i++) most[0] = msri_max(most[0], a[i]);
  return msri_max(msri_max(most[0], most[1]), msri_max(most[2], most[3]));
}

/* Is done with n masses: their sums are whole. */
static void finish(window *w, size_t n) {
  const double *m = w->s->m;
  if (w->s->m_stride == 0 && n > 0) w->bound = msri_max(w->bound, largest(n, w->sum) / *m);
  for (size_t i = 0; i < n && w->s->m_stride; i++)
    w->bound = msri_max(w->bound, w->sum[i] / m[w->base + i]);
}

/* Moves on, if need be, so that masses up to `end` are within, and as many as possible before. */
static void reach(window *w, size_t end) {
  if (end <= w->base + w->size) return;
  const size_t base = end - w->size / 2, ahead = base - w->base;
  const size_t done = ahead < w->size ? ahead : w->size;
  finish(w, done);
  memmove(w->sum, w->sum + done, (w->size - done) * sizeof *w->sum);
  memset(w->sum + w->size - done, 0, done * sizeof *w->sum);
  w->base = base;
}

/* The springs from..from+count-1 of a run; false: the window is beyond some of their masses. */
static bool add_springs(window *w, const msr_run_of_springs *run, size_t from, size_t count,
                        const double *weight) {
  const size_t first = run->first + from;
  reach(w, first + count + run->offset);
  if (first < w->base) return false;
  double *i = w->sum + (first - w->base), *j = i + run->offset;
  if (weight || run->stride == 0) {
    const double twice = 2 * (weight ? *weight : *run->k);
    for (size_t n = 0; n < count; n++) i[n] += twice;
    for (size_t n = 0; n < count; n++) j[n] += twice;
    return true;
  }
  const double *k = run->k + from;
  for (size_t n = 0; n < count; n++) i[n] += 2 * k[n], j[n] += 2 * k[n];
  return true;
}

static bool add_rows(window *w, const double *weight) {
  const msr_springs *springs = w->s->springs;
  for (size_t r = 0; r < springs->n_runs; r++) {
    const msr_run_of_springs *run = &springs->run[r];
    const size_t most = w->size / 4 + 1; // and as much between the ends
    for (size_t from = 0; from < run->count; from += most) {
      const size_t left = run->count - from;
      if (!add_springs(w, run, from, left < most ? left : most, weight)) return false;
    }
  }
  for (size_t n = 0; n < springs->n_anchors; n++) {
    const msr_anchor *a = &springs->anchor[n];
    reach(w, a->i + 1);
    if (a->i < w->base) return false;
    w->sum[a->i - w->base] += weight ? *weight : a->k;
  }
  return true;
}

/* With a window of `size` masses; `done` tells whether it was large enough. */
static msr_status bound_within(const msr_view *s, const double *weight, size_t size, double *bound,
                               bool *done) {
  double *sum = msri_alloc(size, sizeof *sum, "the stable step", NULL);
  if (!sum) return MSR_ENOMEM;
  window w = {s, sum, 0, size, 0};
  *done = add_rows(&w, weight);
  finish(&w, s->n - w.base < size ? s->n - w.base : size);
  *bound = w.bound;
  free(sum);
  return MSR_OK;
}

msr_status msri_mesh_bound(const msr_view *s, const double *weight, double *bound) {
  enum { WINDOW = 1 << 16 };
  bool done = false;
  msr_status status = MSR_OK;
  if (s->n > WINDOW) status = bound_within(s, weight, WINDOW, bound, &done);
  if (status == MSR_OK && !done) status = bound_within(s, weight, s->n, bound, &done);
  return status;
}

static double stretch(double dx, double dy, double L) {
  return L > 0 ? sqrt(dx * dx + dy * dy) / L : 0;
}

double msri_mesh_longest(const msr_view *s) {
  double longest = 0;
  for (size_t r = 0; r < s->springs->n_runs; r++) {
    const msr_run_of_springs *run = &s->springs->run[r];
    for (size_t n = 0; n < run->count; n++) {
      const size_t i = run->first + n, j = i + run->offset;
      longest =
          msri_max(longest, stretch(s->x[j] - s->x[i], s->y[j] - s->y[i], run->L[n * run->stride]));
    }
  }
  for (size_t n = 0; n < s->springs->n_anchors; n++) {
    const msr_anchor *a = &s->springs->anchor[n];
    longest = msri_max(longest, stretch(a->x - s->x[a->i], a->y - s->y[a->i], a->L));
  }
  return longest;
}

double msri_mesh_buckling(const msr_view *s) {
  double most = 0;
  for (size_t r = 0; r < s->springs->n_runs; r++) {
    const msr_run_of_springs *run = &s->springs->run[r];
    for (size_t n = 0; n < run->count; n++) {
      const size_t i = run->first + n, j = i + run->offset;
      const double dx = s->x[j] - s->x[i], dy = s->y[j] - s->y[i], l = sqrt(dx * dx + dy * dy);
      const double push = run->k[n * run->stride] * (run->L[n * run->stride] - l);
      const double m = msri_min(msr_view_mass(s, i), msr_view_mass(s, j));
      if (push > most * l * m) most = push / (l * m);
    }
  }
  return most;
}
