/* tangent.c - the matrix of springs and anchors, for its eigenvalues.
 *
 * The force between the ends of a spring of length l, direction n, changes with their displacement
 * u by k ((L / l) n (n.u) + (1 - L / l) u). Pulled without limit that is k u: no stretch makes a
 * spring stiffer in any direction, so that the largest eigenvalue over all stretches is the one of
 * the graph's Laplacian with weights k, the same for x and y. */
#include "solvers/tangent.h"

#include "solvers/lanczos.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A spring much shorter than its rest length pushes its ends apart with a stiffness across it that
 * has no bound below; to the largest eigenvalue that is much the same from here on. */
static const double most_negative = -8;

/* One spring's k, and its shares along n and in every direction. */
typedef struct stiffness {
  double nx, ny, along, around;
} stiffness;

static stiffness stiffness_of(double dx, double dy, double k, double L) {
  const double l = sqrt(dx * dx + dy * dy);
  if (!(l > 0)) return (stiffness){0, 0, 0, k};
  const double around = msri_max(1 - L / l, most_negative);
  return (stiffness){dx / l, dy / l, k * (1 - around), k * around};
}

/* The force on one end when the other is displaced by u. */
static inline void pull(const stiffness *s, double ux, double uy, double *fx, double *fy) {
  const double part = s->along * (s->nx * ux + s->ny * uy);
  *fx = part * s->nx + s->around * ux;
  *fy = part * s->ny + s->around * uy;
}

void msri_tangent_product(const msr_view *s, const double *x, double *y) {
  const size_t n = s->n;
  const double *ux = x, *uy = x + n;
  double *fx = y, *fy = y + n, px, py;
  memset(y, 0, 2 * n * sizeof *y);
  for (size_t r = 0; r < s->springs->n_runs; r++) {
    const msr_run_of_springs *run = &s->springs->run[r];
    for (size_t c = 0; c < run->count; c++) {
      const size_t i = run->first + c, j = i + run->offset, at = c * run->stride;
      const stiffness k =
          stiffness_of(s->x[j] - s->x[i], s->y[j] - s->y[i], run->k[at], run->L[at]);
      pull(&k, ux[j] - ux[i], uy[j] - uy[i], &px, &py);
      fx[i] -= px, fy[i] -= py;
      fx[j] += px, fy[j] += py;
    }
  }
  for (size_t c = 0; c < s->springs->n_anchors; c++) {
    const msr_anchor *a = &s->springs->anchor[c];
    const stiffness k = stiffness_of(a->x - s->x[a->i], a->y - s->y[a->i], a->k, a->L);
    pull(&k, ux[a->i], uy[a->i], &px, &py);
    fx[a->i] += px, fy[a->i] += py;
  }
}

/* y[n] = K x[n], of springs without end. */
static void laplacian(const msr_view *s, const double *x, double *y) {
  memset(y, 0, s->n * sizeof *y);
  for (size_t r = 0; r < s->springs->n_runs; r++) {
    const msr_run_of_springs *run = &s->springs->run[r];
    for (size_t c = 0; c < run->count; c++) {
      const size_t i = run->first + c, j = i + run->offset;
      const double f = run->k[c * run->stride] * (x[j] - x[i]);
      y[i] -= f;
      y[j] += f;
    }
  }
  for (size_t c = 0; c < s->springs->n_anchors; c++) {
    const msr_anchor *a = &s->springs->anchor[c];
    y[a->i] += a->k * x[a->i];
  }
}

/* A = W K W with w = 1 / sqrt(m bound): the eigenvalues are those of M^-1 K over the bound. */
typedef struct scaled {
  const msr_view *s;
  void (*product)(const msr_view *s, const double *x, double *y);
  size_t copies; /* of w[n] in a vector */
  double *w, *u; /* [n], [copies n] */
} scaled;

static void weigh(const scaled *A, const double *x, double *y) {
  const size_t n = A->s->n;
  for (size_t c = 0; c < A->copies; c++)
    for (size_t i = 0; i < n; i++) y[c * n + i] = x[c * n + i] * A->w[i];
}

static void apply(const void *self, const double *x, double *y) {
  const scaled *A = self;
  weigh(A, x, A->u);
  A->product(A->s, A->u, y);
  weigh(A, y, y);
}

msr_status msri_tangent_largest(const msr_view *s, msri_stretch stretch, double bound,
                                double *omega2, int *iterations) {
  const bool as_are = stretch == MSRI_AS_THEY_ARE;
  scaled A = {s, as_are ? msri_tangent_product : laplacian, as_are ? 2 : 1, NULL, NULL};
  *omega2 = 0;
  *iterations = 0;
  if (!(bound > 0)) return MSR_OK;
  A.w = msri_alloc((1 + A.copies) * s->n, sizeof *A.w, "the stable step", NULL);
  if (!A.w) return MSR_ENOMEM;
  A.u = A.w + s->n;
  for (size_t i = 0; i < s->n; i++) A.w[i] = 1 / sqrt(msr_view_mass(s, i)) / sqrt(bound);
  double share;
  const msr_status status =
      msri_lanczos_largest(&(msri_symmetric){A.copies * s->n, &A, apply}, &share, iterations);
  free(A.w);
  if (status == MSR_OK) *omega2 = share * bound;
  return status;
}
