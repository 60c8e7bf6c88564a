/* factor.c - incomplete factors L D L^T of A = M + c K, by blocks of 2 x 2 in the order of the
 * graph: only D differs from that of A, by what elimination does to the diagonal (Kershaw 1978, J.
 * Comput. Phys. 26, 43; no fill-in). On a lattice of 4 neighbours that is turned but not deformed
 * rows and columns decouple into chains, which have none: there it is exact.
 *
 * Elimination of mass i with pivot d leaves of its tie s to mass j what is left of two springs in a
 * row, s d^-1 (d - s), which is positive where s and d - s are. Springs that push take less than
 * half of a mass. So no pivot vanishes until c k / m nears 1e16, where a number has no room for the
 * mass beside the spring; then no solution is found. */
#include "solvers/lanes.h"
#include "solvers/stiffness.h"

#include <string.h>

/* Pivots of a block of masses. */
typedef struct pivots {
  double xx[MSRI_GRAPH_BLOCK], xy[MSRI_GRAPH_BLOCK], yy[MSRI_GRAPH_BLOCK];
} pivots;

/* L of a strip's pairs: [count] each, one after the other, all in one stream of memory. */
typedef struct lowers {
  float *xx, *xy, *yx, *yy;
} lowers;

MSRI_INLINE lowers lowers_of(const msri_stiffness *a, size_t pair, size_t count) {
  float *xx = a->lower + 4 * pair;
  return (lowers){xx, xx + count, xx + 2 * count, xx + 3 * count};
}

/* A block of masses, first .. first + count - 1, and its strips. */
typedef struct part {
  size_t first, count, pair;
  const msri_strip *strip, *end;
} part;

MSRI_INLINE part part_of(const msri_graph *g, size_t b) {
  const msri_block_end none = {0}, before = b > 0 ? g->block[b - 1] : none, to = g->block[b];
  return (part){before.mass, to.mass - before.mass, before.pair, g->strip + before.strip,
                g->strip + to.strip};
}

static void start_pivots(msri_stiffness *a) {
  const size_t n = a->graph->n;
  for (size_t i = 0; i < n; i++) a->pivot.xx[i] = a->pivot.yy[i] = a->m[i * a->m_stride];
  memset(a->pivot.xy, 0, n * sizeof *a->pivot.xy);
  for (size_t s = 0; s < a->springs->n_anchors; s++) {
    a->pivot.xx[a->place[s]] += a->anchor.xx[s];
    a->pivot.xy[a->place[s]] += a->anchor.xy[s];
    a->pivot.yy[a->place[s]] += a->anchor.yy[s];
  }
}

/* What is held is as heavy as numbers allow: it moves by nothing that counts. */
static void weigh_down(const msri_stiffness *a, const part *b, pivots *d) {
  const uint32_t *order = a->graph->order + b->first;
  for (size_t s = 0; s < b->count; s++) {
    const double heavy = 1e60 * (d->xx[s] + d->yy[s]);
    if (a->held[order[s]]) d->xx[s] += heavy;
    if (a->held[a->graph->n + order[s]]) d->yy[s] += heavy;
  }
}

/* Pivots with all pairs that begin at the block. */
MSRI_INLINE void gather(const msri_stiffness *a, const part *b, pivots *restrict d) {
  memcpy(d->xx, a->pivot.xx + b->first, b->count * sizeof *d->xx);
  memcpy(d->xy, a->pivot.xy + b->first, b->count * sizeof *d->xy);
  memcpy(d->yy, a->pivot.yy + b->first, b->count * sizeof *d->yy);
  size_t pair = b->pair;
  for (const msri_strip *t = b->strip; t < b->end; pair += t->count, t++) {
    const double *xx = a->tie.xx + pair, *xy = a->tie.xy + pair, *yy = a->tie.yy + pair;
    const size_t at = t->first - b->first;
    for (size_t s = 0; s < t->count; s++) {
      d->xx[at + s] += xx[s];
      d->xy[at + s] += xy[s];
      d->yy[at + s] += yy[s];
    }
  }
}

MSRI_INLINE void invert(const msri_stiffness *a, const part *b, const pivots *restrict d) {
  double *restrict ixx = a->pivot.xx + b->first, *restrict ixy = a->pivot.xy + b->first;
  double *restrict iyy = a->pivot.yy + b->first;
  for (size_t s = 0; s < b->count; s++) {
    const double scale = 1 / (d->xx[s] * d->yy[s] - d->xy[s] * d->xy[s]);
    ixx[s] = d->yy[s] * scale;
    ixy[s] = -d->xy[s] * scale;
    iyy[s] = d->xx[s] * scale;
  }
}

/* L of a strip's pairs, s d^-1, and the symmetric part of s d^-1 (d - s). */
MSRI_INLINE void eliminate(const msri_stiffness *a, const msri_strip *t, size_t pair, size_t at,
                           const pivots *restrict d, pivots *restrict left) {
  const lowers l = lowers_of(a, pair, t->count);
  const double *xx = a->tie.xx + pair, *xy = a->tie.xy + pair, *yy = a->tie.yy + pair;
  const double *ixx = a->pivot.xx + t->first, *ixy = a->pivot.xy + t->first;
  const double *iyy = a->pivot.yy + t->first;
  for (size_t s = 0; s < t->count; s++) {
    const double lxx = xx[s] * ixx[s] + xy[s] * ixy[s], lxy = xx[s] * ixy[s] + xy[s] * iyy[s];
    const double lyx = xy[s] * ixx[s] + yy[s] * ixy[s], lyy = xy[s] * ixy[s] + yy[s] * iyy[s];
    const double rxx = d->xx[at + s] - xx[s], rxy = d->xy[at + s] - xy[s];
    const double ryy = d->yy[at + s] - yy[s];
    l.xx[s] = (float)lxx, l.xy[s] = (float)lxy;
    l.yx[s] = (float)lyx, l.yy[s] = (float)lyy;
    left->xx[s] = lxx * rxx + lxy * rxy;
    left->xy[s] = (lxx * rxy + lxy * ryy + lyx * rxx + lyy * rxy) / 2;
    left->yy[s] = lyx * rxy + lyy * ryy;
  }
}

MSRI_INLINE void add(size_t n, const double *restrict x, double *restrict y) {
  for (size_t i = 0; i < n; i++) y[i] += x[i];
}

MSRI_INLINE void subtract(size_t n, const double *restrict x, double *restrict y) {
  for (size_t i = 0; i < n; i++) y[i] -= x[i];
}

MSRI_INLINE void factorise(msri_stiffness *a) {
  for (size_t n = 0; n < a->graph->blocks; n++) {
    const part b = part_of(a->graph, n);
    pivots d;
    gather(a, &b, &d);
    if (a->held) weigh_down(a, &b, &d);
    invert(a, &b, &d);
    size_t pair = b.pair;
    for (const msri_strip *t = b.strip; t < b.end; pair += t->count, t++) {
      pivots left;
      eliminate(a, t, pair, t->first - b.first, &d, &left);
      add(t->count, left.xx, a->pivot.xx + t->second);
      add(t->count, left.xy, a->pivot.xy + t->second);
      add(t->count, left.yy, a->pivot.yy + t->second);
    }
  }
}

/* ---- Solving with them */

/* Vectors of a block of masses, or what they are summed up to. */
typedef struct vectors {
  double x[MSRI_GRAPH_BLOCK], y[MSRI_GRAPH_BLOCK];
} vectors;

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

/* zj += l zi for the pairs of a strip. */
MSRI_INLINE void push(const msri_stiffness *a, const msri_strip *t, size_t pair, double *z) {
  const lowers l = lowers_of(a, pair, t->count);
  const size_t n = a->graph->n;
  const double *xi = z + t->first, *yi = xi + n;
  double *restrict xj = z + t->second, *restrict yj = z + n + t->second;
  for (size_t s = 0; s < t->count; s++) {
    xj[s] += (double)l.xx[s] * xi[s] + (double)l.xy[s] * yi[s];
    yj[s] += (double)l.yx[s] * xi[s] + (double)l.yy[s] * yi[s];
  }
}

MSRI_INLINE void forward(const msri_stiffness *a, size_t from, size_t to, double *z) {
  for (size_t i = from; i < to; i++) {
    const part b = part_of(a->graph, i);
    size_t pair = b.pair;
    for (const msri_strip *t = b.strip; t < b.end; pair += t->count, t++) push(a, t, pair, z);
  }
}

/* zi += l^T zj. */
MSRI_INLINE void fetch(const msri_stiffness *a, const msri_strip *t, size_t pair, double *z) {
  const lowers l = lowers_of(a, pair, t->count);
  const size_t n = a->graph->n;
  const double *xj = z + t->second, *yj = xj + n;
  double *restrict xi = z + t->first, *restrict yi = z + n + t->first;
  for (size_t s = 0; s < t->count; s++) {
    xi[s] += (double)l.xx[s] * xj[s] + (double)l.yx[s] * yj[s];
    yi[s] += (double)l.xy[s] * xj[s] + (double)l.yy[s] * yj[s];
  }
}

/* z of a block from that of all later ones. */
MSRI_INLINE void substitute(const msri_stiffness *a, const part *b, double *z, msri_lanes *rz) {
  const size_t n = a->graph->n;
  double *zx = z + b->first, *zy = zx + n, product[MSRI_GRAPH_BLOCK];
  vectors d;
  divide(a, b, zx, zy, &d, product);
  msri_lanes_add(b->count, product, rz);
  memcpy(zx, d.x, b->count * sizeof *zx);
  memcpy(zy, d.y, b->count * sizeof *zy);
  size_t pair = b->pair;
  for (const msri_strip *t = b->strip; t < b->end; pair += t->count, t++) fetch(a, t, pair, z);
  if (a->held) msri_stiffness_loosen(a, b->first, b->first + b->count, z);
}

/* Springs act on differences of z, so that a translation feels none of them, however stiff. */
MSRI_INLINE void pull(const msri_stiffness *a, const msri_strip *t, size_t pair, const double *z,
                      vectors *restrict f, double *restrict product) {
  const size_t n = a->graph->n;
  const double *xx = a->tie.xx + pair, *xy = a->tie.xy + pair, *yy = a->tie.yy + pair;
  const double *xi = z + t->first, *yi = xi + n, *xj = z + t->second, *yj = xj + n;
  for (size_t s = 0; s < t->count; s++) {
    const double dx = xi[s] - xj[s], dy = yi[s] - yj[s];
    const double fx = xx[s] * dx + xy[s] * dy, fy = xy[s] * dx + yy[s] * dy;
    f->x[s] = fx;
    f->y[s] = fy;
    product[s] = dx * fx + dy * fy;
  }
}

/* y = M z, and z y of each mass. */
MSRI_INLINE void weigh(const msri_stiffness *a, const part *b, const double *z, double *y,
                       double *restrict product) {
  const size_t n = a->graph->n, stride = a->m_stride;
  const double *m = a->m + b->first * stride, *zx = z + b->first, *zy = zx + n;
  double *restrict yx = y + b->first, *restrict yy = yx + n;
  for (size_t s = 0; s < b->count; s++) {
    yx[s] = m[s * stride] * zx[s];
    yy[s] = m[s * stride] * zy[s];
    product[s] = zx[s] * yx[s] + zy[s] * yy[s];
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
  for (size_t k = 0; k < 3; k++) msri_foresee(pairs * sizeof(double), ties[k] + b.pair);
  msri_foresee(4 * pairs * sizeof(float), a->lower + 4 * b.pair);
}

MSRI_INLINE double backward(const msri_stiffness *a, double *z, double *y, double *rz) {
  const size_t n = a->graph->n;
  msri_lanes zy = {{0}}, other = {{0}};
  for (size_t i = a->graph->blocks; i-- > 0;) {
    const part b = part_of(a->graph, i);
    double product[MSRI_GRAPH_BLOCK];
    foresee(a, i, z, y);
    substitute(a, &b, z, &other);
    weigh(a, &b, z, y, product);
    msri_lanes_add(b.count, product, &zy);
    size_t pair = b.pair;
    for (const msri_strip *t = b.strip; t < b.end; pair += t->count, t++) {
      vectors f;
      pull(a, t, pair, z, &f, product);
      msri_lanes_add(t->count, product, &zy);
      add(t->count, f.x, y + t->first);
      add(t->count, f.y, y + n + t->first);
      subtract(t->count, f.x, y + t->second);
      subtract(t->count, f.y, y + n + t->second);
    }
  }
  *rz = msri_lanes_sum(&other);
  return msri_lanes_sum(&zy);
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
MSRI_AVX2 static void factorise_avx2(msri_stiffness *a) { factorise(a); }

MSRI_AVX2 static void forward_avx2(const msri_stiffness *a, size_t from, size_t to, double *z) {
  forward(a, from, to, z);
}

MSRI_AVX2 static double backward_avx2(const msri_stiffness *a, double *z, double *y, double *rz) {
  return backward(a, z, y, rz);
}
#endif

void msri_stiffness_factorise(msri_stiffness *a) {
  start_pivots(a);
#if MSRI_WIDE
  if (msri_has_avx2()) {
    factorise_avx2(a);
    return;
  }
#endif
  factorise(a);
}

void msri_stiffness_forward(const msri_stiffness *a, size_t from, size_t to, double *z) {
#if MSRI_WIDE
  if (msri_has_avx2()) {
    forward_avx2(a, from, to, z);
    return;
  }
#endif
  forward(a, from, to, z);
}

double msri_stiffness_backward(const msri_stiffness *a, double *z, double *y, double *rz) {
#if MSRI_WIDE
  if (msri_has_avx2()) return backward_avx2(a, z, y, rz) + pull_anchors(a, z, y);
#endif
  return backward(a, z, y, rz) + pull_anchors(a, z, y);
}
