/* gradients.c - preconditioned conjugate gradients for A x = M r (Hestenes & Stiefel 1952, J. Res.
 * Nat. Bur. Stand. 49, 409), in two passes over memory an iteration: with A z instead of A p all
 * vectors advance while the factors are gone through forward, and both sums are known after they
 * were backward (Chronopoulos & Gear 1989, J. Comput. Appl. Math. 25, 153). */
#include "base/vector.h"
#include "solvers/lanes.h"
#include "solvers/stiffness.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* p = z + turn p, A p = A z + turn A p, x += w p, residual -= w A p; z becomes the residual. */
typedef struct course {
  double w, turn;
  bool first; /* there is no p yet, and x is 0 */
} course;

/* |x|^2 and |M^-1 residual|^2. */
typedef struct lengths {
  msri_lanes x, residual;
} lengths;

/* x = 0, residual = M r / size: of order 1, so that no square of it is lost. */
static void start(msri_stiffness *a, const double *r, double size) {
  const size_t n = a->graph->n;
  const uint32_t *order = a->graph->order;
  for (size_t i = 0; i < n; i++) {
    const double m = a->m[i * a->m_stride] / size;
    a->residual[i] = m * r[order[i]];
    a->residual[n + i] = m * r[n + order[i]];
  }
  msri_stiffness_loosen(a, 0, n, a->residual);
  memcpy(a->z, a->residual, 2 * n * sizeof *a->z);
}

/* `count` coordinates from e on, MSRI_LANES at most, and the weights [stride each] of their masses.
 */
MSRI_INLINE void advance_lanes(const msri_stiffness *a, const course *c, bool first, size_t stride,
                               const double *restrict weight, size_t e, size_t count,
                               lengths *sum) {
  double *restrict x = a->x + e, *restrict r = a->residual + e, *restrict p = a->direction + e;
  double *restrict y = a->image + e, *restrict z = a->z + e;
  const double *restrict product = a->product + e;
  for (size_t k = 0; k < count; k++) {
    p[k] = first ? z[k] : z[k] + c->turn * p[k];
    y[k] = first ? product[k] : product[k] + c->turn * y[k];
    x[k] = first ? c->w * p[k] : x[k] + c->w * p[k];
    z[k] = r[k] = r[k] - c->w * y[k];
    sum->x.sum[k] += x[k] * x[k];
    sum->residual.sum[k] += weight[k * stride] * (r[k] * r[k]);
  }
}

MSRI_INLINE void advance(const msri_stiffness *a, const course *c, bool first, size_t stride,
                         size_t from, size_t to, lengths *sum) {
  lengths own = *sum;
  const course by = *c;
  for (size_t axis = 0; axis < 2; axis++) {
    const size_t offset = axis * a->graph->n;
    size_t i = from;
    for (; i + MSRI_LANES <= to; i += MSRI_LANES)
      advance_lanes(a, &by, first, stride, a->weight + i * stride, offset + i, MSRI_LANES, &own);
    advance_lanes(a, &by, first, stride, a->weight + i * stride, offset + i, to - i, &own);
  }
  *sum = own;
}

MSRI_INLINE void advance_any(const msri_stiffness *a, const course *c, size_t from, size_t to,
                             lengths *sum) {
  if (c->first && a->m_stride) advance(a, c, true, 1, from, to, sum);
  if (c->first && !a->m_stride) advance(a, c, true, 0, from, to, sum);
  if (!c->first && a->m_stride) advance(a, c, false, 1, from, to, sum);
  if (!c->first && !a->m_stride) advance(a, c, false, 0, from, to, sum);
}

#if MSRI_WIDE
MSRI_AVX2 static void advance_avx2(const msri_stiffness *a, const course *c, size_t from, size_t to,
                                   lengths *sum) {
  advance_any(a, c, from, to, sum);
}
#endif

/* Masses from .. to - 1. */
static void advance_here(const msri_stiffness *a, const course *c, size_t from, size_t to,
                         lengths *sum) {
  msri_stiffness_loosen(a, from, to, a->product);
#if MSRI_WIDE
  if (msri_has_avx2()) {
    advance_avx2(a, c, from, to, sum);
    return;
  }
#endif
  advance_any(a, c, from, to, sum);
}

/* The way down: advances (unless `c` is NULL) as far ahead of the factors as these reach. Returns
 * |M^-1 residual|^2 / |x|^2. */
static double go_down(const msri_stiffness *a, const course *c) {
  enum { BLOCKS = 64 };
  const msri_graph *g = a->graph;
  lengths sum = {{{0}}, {{0}}};
  for (size_t from = 0, ahead = 0; from < g->blocks; from += BLOCKS) {
    const size_t to = g->blocks - from < BLOCKS ? g->blocks : from + BLOCKS;
    const size_t done = g->block[to - 1].mass;
    const size_t needed = g->n - done < g->reach ? g->n : done + g->reach;
    if (c) advance_here(a, c, ahead, needed, &sum);
    ahead = needed;
    msri_stiffness_forward(a, from, to, a->z);
  }
  return msri_lanes_sum(&sum.residual) / msri_lanes_sum(&sum.x);
}

/* A few iterations are cheaper than what a more exact solution saves: another matrix. */
static bool enough(double tolerance, int iterations, double error) {
  enum { CHEAP = 3 };
  static const double beyond = 0.01;
  const double most = iterations < CHEAP ? beyond * tolerance : tolerance;
  return error <= most * most;
}

/* Rounding ends it before the tolerance is met where c k / m is huge: what is rough will still do.
 * p A p = z A z - turn^2 p A p of the direction before; where half of its digits are lost so is
 * conjugacy, and z begins anew. */
static msr_status iterate(msri_stiffness *a, double tolerance) {
  static const double rough = 0.1, lost = 1e-8;
  double error = (double)INFINITY, curvature = 0, before = 0;
  go_down(a, NULL);
  for (int k = 0; k < a->most; k++) {
    double rz;
    const double own = msri_stiffness_backward(a, a->z, a->product, &rz);
    course c = {.first = k == 0, .turn = k > 0 ? rz / before : 0};
    curvature = own - c.turn * c.turn * curvature;
    if (!(curvature > lost * own)) c.turn = 0, curvature = own;
    a->iterations++;
    if (!(rz > 0 && curvature > 0)) break;
    c.w = rz / curvature;
    before = rz;
    error = go_down(a, &c);
    if (enough(tolerance, k + 1, error)) return MSR_OK;
  }
  return error <= rough * rough ? MSR_OK : MSR_EUNSTABLE;
}

msr_status msri_stiffness_solve(msri_stiffness *a, const double *r, double tolerance, double *x) {
  const size_t n = a->graph->n;
  const double size = msri_largest(2 * n, r);
  if (!isfinite(size)) return MSR_EUNSTABLE;
  start(a, r, msri_max(size, DBL_MIN));
  const bool any = size > DBL_MIN;
  const msr_status status = any ? iterate(a, tolerance) : MSR_OK;
  for (size_t i = 0; i < n; i++) {
    x[a->graph->order[i]] = any ? size * a->x[i] : 0;
    x[n + a->graph->order[i]] = any ? size * a->x[n + i] : 0;
  }
  for (size_t i = 0; a->held && i < 2 * n; i++)
    if (a->held[i]) x[i] = r[i];
  return status;
}
