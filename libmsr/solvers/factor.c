/* factor.c - incomplete factors L D L^T of A = M + c K, by blocks of 2 x 2 in the order of the
 * graph: only D differs from that of A, by what elimination does to the diagonal (Kershaw 1978, J.
 * Comput. Phys. 26, 43; no fill-in). On a lattice of 4 neighbours that is turned but not deformed
 * rows and columns decouple into chains, which have none: there it is exact.
 *
 * Elimination of mass i with pivot d leaves of its tie s to mass j what is left of two springs in a
 * row, s d^-1 (d - s), which is positive where s and d - s are. Springs that push take less than
 * half of a mass. So no pivot vanishes until c k / m nears 1e16, where a number has no room for the
 * mass beside the spring; then no solution is found. */
#include "solvers/singles.h"
#include "solvers/strips.h"

#include <string.h>

/* Pivots of a block of masses. */
typedef struct pivots {
  double xx[MSRI_GRAPH_BLOCK], xy[MSRI_GRAPH_BLOCK], yy[MSRI_GRAPH_BLOCK];
} pivots;

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

static void weigh_down(const msri_stiffness *a, const part *b, pivots *d) {
  for (size_t s = 0; s < b->count; s++)
    msri_stiffness_weigh_down(a, b->first + s, &d->xx[s], &d->yy[s]);
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

#if MSRI_WIDE
MSRI_AVX2 static void factorise_avx2(msri_stiffness *a) { factorise(a); }
#endif

void msri_stiffness_factorise(msri_stiffness *a) {
  start_pivots(a);
  if (a->graph->single) {
    msri_singles_factorise(a);
    return;
  }
#if MSRI_WIDE
  if (msri_has_avx2()) {
    factorise_avx2(a);
    return;
  }
#endif
  factorise(a);
}
