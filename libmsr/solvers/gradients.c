/* gradients.c - preconditioned conjugate gradients for A x = M r (Hestenes & Stiefel 1952, J. Res.
 * Nat. Bur. Stand. 49, 409). Springs act on differences of x, so that a translation feels none of
 * them, however stiff, and sums of forces are 0 but for the last bit. */
#include "base/vector.h"
#include "solvers/stiffness.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* x = 0, residual = M r / size: of order 1, so that no square of it is lost. */
static void start(msri_stiffness *a, const double *r, double size) {
  const size_t n = a->graph->n;
  for (size_t i = 0; i < n; i++) {
    const double m = a->m[i * a->m_stride] / size;
    a->residual[i] = msri_stiffness_loose(a, i, (msri_vector){m * r[i], m * r[n + i]});
  }
  memset(a->x, 0, n * sizeof *a->x);
}

/* y = A p; returns p.y */
static double multiply(const msri_stiffness *a, const msri_vector *p, msri_vector *y) {
  const uint32_t *begin = a->graph->begin, *end = a->graph->end;
  const size_t n = a->graph->n;
  double py = 0;
  for (size_t i = 0; i < n; i++) {
    const double m = a->m[i * a->m_stride];
    y[i] = (msri_vector){m * p[i].x, m * p[i].y};
  }
  for (size_t s = 0; s < a->springs->n_anchors; s++) {
    const size_t i = a->springs->anchor[s].i;
    y[i] = msri_sum(y[i], msri_block_times(a->anchor[s], p[i]));
  }
  for (size_t i = 0; i < n; i++) {
    const msri_vector pi = p[i];
    msri_vector sum = y[i];
    for (size_t s = begin[i]; s < begin[i + 1]; s++) {
      const size_t j = end[s];
      const msri_vector f =
          msri_block_times(a->tie[s], (msri_vector){pi.x - p[j].x, pi.y - p[j].y});
      sum = msri_sum(sum, f);
      y[j] = (msri_vector){y[j].x - f.x, y[j].y - f.y};
    }
    y[i] = sum = msri_stiffness_loose(a, i, sum);
    py += msri_product(pi, sum);
  }
  return py;
}

/* x += w p, residual -= w y. Returns |M^-1 residual|^2 / |x|^2. */
static double advance(msri_stiffness *a, double w) {
  msri_vector *restrict x = a->x, *restrict r = a->residual;
  const msri_vector *restrict p = a->direction, *restrict y = a->image;
  double rr = 0, xx = 0;
  for (size_t i = 0; i < a->graph->n; i++) {
    x[i] = (msri_vector){x[i].x + w * p[i].x, x[i].y + w * p[i].y};
    r[i] = (msri_vector){r[i].x - w * y[i].x, r[i].y - w * y[i].y};
    xx += msri_product(x[i], x[i]);
    rr += a->weight[i * a->m_stride] * msri_product(r[i], r[i]);
  }
  return rr / xx;
}

static void turn(size_t n, double w, const msri_vector *restrict z, msri_vector *restrict p) {
  for (size_t i = 0; i < n; i++) p[i] = (msri_vector){z[i].x + w * p[i].x, z[i].y + w * p[i].y};
}

/* Rounding ends it before the tolerance is met where c k / m is huge: what is rough will still do.
 */
static msr_status iterate(msri_stiffness *a, double tolerance) {
  static const double rough = 0.1;
  const size_t n = a->graph->n;
  double rz = msri_stiffness_precondition(a, a->residual, a->image), error = (double)INFINITY;
  memcpy(a->direction, a->image, n * sizeof *a->direction);
  for (int k = 0; k < a->most; k++) {
    const double curvature = multiply(a, a->direction, a->image);
    a->iterations++;
    if (!(rz > 0 && curvature > 0)) break;
    error = advance(a, rz / curvature);
    if (error <= tolerance * tolerance) return MSR_OK;
    const double next = msri_stiffness_precondition(a, a->residual, a->image);
    turn(n, next / rz, a->image, a->direction);
    rz = next;
  }
  return error <= rough * rough ? MSR_OK : MSR_EUNSTABLE;
}

msr_status msri_stiffness_solve(msri_stiffness *a, const double *r, double tolerance, double *x) {
  const size_t n = a->graph->n;
  const double size = msri_largest(2 * n, r);
  if (!isfinite(size)) return MSR_EUNSTABLE;
  start(a, r, msri_max(size, DBL_MIN));
  const msr_status status = size > DBL_MIN ? iterate(a, tolerance) : MSR_OK;
  for (size_t i = 0; i < n; i++) x[i] = size * a->x[i].x;
  for (size_t i = 0; i < n; i++) x[n + i] = size * a->x[i].y;
  for (size_t i = 0; a->held && i < 2 * n; i++)
    if (a->held[i]) x[i] = r[i];
  return status;
}
