/* mesh.c - properties of a mesh of springs: the Gershgorin bound and the longest spring.
 *
 * Row i of M^-1 K has the diagonal (sum of w)/m_i and, spring by spring, w/m_i beside it, so that
 * no eigenvalue is above max_i (2 sum of w over its springs + sum over its anchors)/m_i, whatever
 * the directions and stretches of the springs (a stretched spring is never stiffer than w along any
 * direction). */
#include "forces/mesh.h"

#include <math.h>
#include <stdlib.h>

static void add_rows(const msr_springs *springs, const double *weight, double *row) {
  for (size_t r = 0; r < springs->n_runs; r++) {
    const msr_run_of_springs *run = &springs->run[r];
    for (size_t s = 0; s < run->count; s++) {
      const size_t i = run->first + s, j = i + run->offset;
      const double w = weight ? *weight : run->k[s * run->stride];
      row[i] += 2 * w;
      row[j] += 2 * w;
    }
  }
  for (size_t a = 0; a < springs->n_anchors; a++)
    row[springs->anchor[a].i] += weight ? *weight : springs->anchor[a].k;
}

msr_status msri_mesh_bound(const msr_view *s, const double *weight, double *bound) {
  double *row = msri_alloc(s->n, sizeof *row, "the stable step", NULL);
  if (!row) return MSR_ENOMEM;
  add_rows(s->springs, weight, row);
  *bound = 0;
  for (size_t i = 0; i < s->n; i++) *bound = msri_max(*bound, row[i] / msr_view_mass(s, i));
  free(row);
  return MSR_OK;
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
