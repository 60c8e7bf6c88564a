/* substitute.c - solving with the factors of factor.c: forward, z = L^-1 z, and backward, z = L^-T
 * D^-1 z. On the way back the product of A and z is made as well, while both are at hand: what
 * conjugate gradients take of memory is what they take of time. */
#include "solvers/singles.h"
#include "solvers/strips.h"

#include <string.h>

/* Vectors of a block of masses, or what they are summed up to. */
typedef struct vectors {
  double x[MSRI_GRAPH_BLOCK], y[MSRI_GRAPH_BLOCK];
} vectors;

MSRI_INLINE void copy(size_t n, const double *restrict from, double *restrict to) {
  for (size_t i = 0; i < n; i++) to[i] = from[i];
}

/* d = D^-1 z, and z d of each mass. */
MSRI_INLINE void divide(const msri_stiffness *a, const part *b, const double *x, const double *y,
                        vectors *restrict d, double *restrict product) {
  const double *xx = a->pivot.xx + b->first, *xy = a->pivot.xy + b->first;
  const double *yy = a->pivot.yy + b->first;
  for (size_t s = 0; s < b->count; s++) {
    d->x[s] = xx[s] * x[s] + xy[s] * y[s];
    d->y[s] = xy[s] * x[s] + yy[s] * y[s];
    product[s] = x[s] * d->x[s] + y[s] * d->y[s];
  }
}

/* y += l x for the pairs of a strip. */
MSRI_INLINE void multiply(size_t count, const lowers *l, const double *x, const double *y,
                          double *restrict lx, double *restrict ly) {
  for (size_t s = 0; s < count; s++) {
    lx[s] += (double)l->xx[s] * x[s] + (double)l->xy[s] * y[s];
    ly[s] += (double)l->yx[s] * x[s] + (double)l->yy[s] * y[s];
  }
}

MSRI_INLINE void forward_part(const msri_stiffness *a, const part *b, double *z) {
  const size_t n = a->graph->n;
  size_t pair = b->pair;
  for (const msri_strip *t = b->strip; t < b->end; pair += t->count, t++) {
    const lowers l = lowers_of(a, pair, t->count);
    const double *x = z + t->first;
    multiply(t->count, &l, x, x + n, z + t->second, z + n + t->second);
  }
}

MSRI_INLINE void forward(const msri_stiffness *a, size_t from, size_t to, double *z) {
  for (size_t i = from; i < to; i++) {
    const part b = part_of(a->graph, i);
    forward_part(a, &b, z);
  }
}

/* z of a block from that of all later ones. */
MSRI_INLINE void substitute(const msri_stiffness *a, const part *b, double *z, msri_lanes *rz) {
  const size_t n = a->graph->n;
  double *zx = z + b->first, *zy = zx + n, product[MSRI_GRAPH_BLOCK];
  vectors d;
  divide(a, b, zx, zy, &d, product);
  msri_lanes_add(b->count, product, rz);
  copy(b->count, d.x, zx);
  copy(b->count, d.y, zy);
  size_t pair = b->pair;
  for (const msri_strip *t = b->strip; t < b->end; pair += t->count, t++) {
    const lowers l = lowers_of(a, pair, t->count), transposed = {l.xx, l.yx, l.xy, l.yy};
    const double *x = z + t->second;
    multiply(t->count, &transposed, x, x + n, z + t->first, z + n + t->first);
  }
  if (a->held) msri_stiffness_loosen(a, b->first, b->first + b->count, z);
}

/* What a block of masses msri_sums up on the way up: y = A z, but for what comes before, and z y.
 */
typedef struct image {
  double x[MSRI_GRAPH_BLOCK], y[MSRI_GRAPH_BLOCK], product[MSRI_GRAPH_BLOCK];
} image;

MSRI_INLINE void weigh(const msri_stiffness *a, const part *b, const double *z,
                       image *restrict sum) {
  const size_t stride = a->m_stride;
  const double *m = a->m + b->first * stride, *x = z + b->first, *y = x + a->graph->n;
  for (size_t s = 0; s < b->count; s++) {
    sum->x[s] = m[s * stride] * x[s];
    sum->y[s] = m[s * stride] * y[s];
    sum->product[s] = x[s] * sum->x[s] + y[s] * sum->y[s];
  }
}

/* Springs act on differences of z, so that a translation feels none of them, however stiff. */
MSRI_INLINE void pull(const msri_stiffness *a, const msri_strip *t, size_t pair, const double *z,
                      size_t at, image *restrict sum, double *restrict xj, double *restrict yj) {
  const double *xx = a->tie.xx + pair, *xy = a->tie.xy + pair, *yy = a->tie.yy + pair;
  const double *zi = z + t->first, *zj = z + t->second;
  const size_t n = a->graph->n;
  for (size_t s = 0; s < t->count; s++) {
    const double dx = zi[s] - zj[s], dy = zi[n + s] - zj[n + s];
    const double fx = xx[s] * dx + xy[s] * dy, fy = xy[s] * dx + yy[s] * dy;
    sum->x[at + s] += fx;
    sum->y[at + s] += fy;
    sum->product[at + s] += dx * fx + dy * fy;
    xj[s] -= fx;
    yj[s] -= fy;
  }
}

/* On the way up memory is read in pieces, which no processor foresees. */
MSRI_INLINE void foresee(const msri_stiffness *a, size_t block, const double *z, const double *y) {
  enum { AHEAD = 4 };
  if (block < AHEAD) return;
  const part b = part_of(a->graph, block - AHEAD);
  const size_t n = a->graph->n, pairs = a->graph->block[block - AHEAD].pair - b.pair;
  const double *masses[] = {a->pivot.xx, a->pivot.xy, a->pivot.yy, z, z + n, y, y + n};
  const double *ties[] = {a->tie.xx, a->tie.xy, a->tie.yy};
  for (size_t k = 0; k < 7; k++) msri_foresee(b.count * sizeof(double), masses[k] + b.first);
  for (const msri_strip *t = b.strip; t < b.end; t++)
    for (size_t k = 3; k < 7; k++) msri_foresee(sizeof(double), masses[k] + t->second);
  for (size_t k = 0; k < 3; k++) msri_foresee(pairs * sizeof(double), ties[k] + b.pair);
  msri_foresee(4 * pairs * sizeof(float), a->lower + 4 * b.pair);
}

MSRI_INLINE void backward_part(const msri_stiffness *a, const part *b, double *z, double *y,
                               msri_sums *total) {
  const size_t n = a->graph->n;
  image sum;
  substitute(a, b, z, &total->rz);
  weigh(a, b, z, &sum);
  size_t pair = b->pair;
  for (const msri_strip *t = b->strip; t < b->end; pair += t->count, t++) {
    pull(a, t, pair, z, t->first - b->first, &sum, y + t->second, y + n + t->second);
  }
  msri_lanes_add(b->count, sum.product, &total->zy);
  copy(b->count, sum.x, y + b->first);
  copy(b->count, sum.y, y + n + b->first);
}

MSRI_INLINE msri_sums backward(const msri_stiffness *a, double *z, double *y) {
  msri_sums total = {{{0}}, {{0}}};
  for (size_t i = a->graph->blocks; i-- > 0;) {
    const part b = part_of(a->graph, i);
    foresee(a, i, z, y);
    backward_part(a, &b, z, y, &total);
  }
  return total;
}

/* Adds A z of the anchors to y; returns z y of it. */
static double pull_anchors(const msri_stiffness *a, const double *z, double *y) {
  const size_t n = a->graph->n;
  double zy = 0;
  for (size_t s = 0; s < a->springs->n_anchors; s++) {
    const size_t i = a->place[s];
    const double fx = a->anchor.xx[s] * z[i] + a->anchor.xy[s] * z[n + i];
    const double fy = a->anchor.xy[s] * z[i] + a->anchor.yy[s] * z[n + i];
    y[i] += fx;
    y[n + i] += fy;
    zy += z[i] * fx + z[n + i] * fy;
  }
  return zy;
}

/* ---- By vectors of several widths */

#if MSRI_WIDE
MSRI_AVX2 static void forward_avx2(const msri_stiffness *a, size_t from, size_t to, double *z) {
  forward(a, from, to, z);
}

MSRI_AVX2 static msri_sums backward_avx2(const msri_stiffness *a, double *z, double *y) {
  return backward(a, z, y);
}
#endif

void msri_stiffness_forward(const msri_stiffness *a, size_t from, size_t to, double *z) {
  if (a->graph->single) {
    msri_singles_forward(a, from, to, z);
    return;
  }
#if MSRI_WIDE
  if (msri_has_avx2()) {
    forward_avx2(a, from, to, z);
    return;
  }
#endif
  forward(a, from, to, z);
}

static msri_sums backward_here(const msri_stiffness *a, double *z, double *y) {
  if (a->graph->single) return msri_singles_backward(a, z, y);
#if MSRI_WIDE
  if (msri_has_avx2()) return backward_avx2(a, z, y);
#endif
  return backward(a, z, y);
}

double msri_stiffness_backward(const msri_stiffness *a, double *z, double *y, double *rz) {
  const msri_sums total = backward_here(a, z, y);
  *rz = msri_lanes_sum(&total.rz);
  return msri_lanes_sum(&total.zy) + pull_anchors(a, z, y);
}
