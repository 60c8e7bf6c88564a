/* factor.c - incomplete factors L D L^T of A = M + c K, by blocks of 2 x 2 in the order of the
 * masses: only D differs from that of A, by what elimination does to the diagonal (Kershaw 1978, J.
 * Comput. Phys. 26, 43; no fill-in). On a lattice of 4 neighbours that is turned but not deformed
 * rows and columns decouple into chains, which have none: there it is exact.
 *
 * Elimination of mass i with pivot d leaves of its tie s to mass j what is left of two springs in a
 * row, s d^-1 (d - s), which is positive where s and d - s are. Springs that push take less than
 * half of a mass. So no pivot vanishes until c k / m nears 1e16, where a number has no room for the
 * mass beside the spring; then no solution is found. */
#include "solvers/stiffness.h"

#include <string.h>

static void start_pivots(msri_stiffness *a) {
  for (size_t i = 0; i < a->graph->n; i++) {
    const double m = a->m[i * a->m_stride];
    a->pivot[i] = (msri_block){m, 0, m};
  }
  for (size_t n = 0; n < a->springs->n_anchors; n++) {
    msri_block *pivot = &a->pivot[a->springs->anchor[n].i];
    *pivot = msri_block_sum(*pivot, a->anchor[n]);
  }
}

static msri_block invert(msri_block d) {
  const double scale = 1 / (d.xx * d.yy - d.xy * d.xy);
  return (msri_block){d.yy * scale, -d.xy * scale, d.xx * scale};
}

/* The symmetric part of s d^-1 (d - s), with l = s d^-1. */
static msri_block in_a_row(msri_square l, msri_block d, msri_block s) {
  const double xx = d.xx - s.xx, xy = d.xy - s.xy, yy = d.yy - s.yy;
  return (msri_block){l.xx * xx + l.xy * xy, (l.xx * xy + l.xy * yy + l.yx * xx + l.yy * xy) / 2,
                      l.yx * xy + l.yy * yy};
}

/* What is held is as heavy as numbers allow: it moves by nothing that counts. */
static msri_block pivot_of(const msri_stiffness *a, size_t i, msri_block d) {
  const double heavy = 1e40 * (d.xx + d.yy);
  if (a->held && a->held[i]) d.xx += heavy;
  if (a->held && a->held[a->graph->n + i]) d.yy += heavy;
  return d;
}

void msri_stiffness_factorise(msri_stiffness *a) {
  const uint32_t *begin = a->graph->begin, *end = a->graph->end;
  start_pivots(a);
  for (size_t i = 0; i < a->graph->n; i++) {
    msri_block d = a->pivot[i];
    for (size_t p = begin[i]; p < begin[i + 1]; p++) d = msri_block_sum(d, a->tie[p]);
    d = pivot_of(a, i, d);
    const msri_block inverse = invert(d);
    for (size_t p = begin[i]; p < begin[i + 1]; p++) {
      msri_block *pivot = &a->pivot[end[p]];
      a->lower[p] = msri_block_product(a->tie[p], inverse);
      *pivot = msri_block_sum(*pivot, in_a_row(a->lower[p], d, a->tie[p]));
    }
    a->pivot[i] = inverse;
  }
}

double msri_stiffness_precondition(const msri_stiffness *a, const msri_vector *r, msri_vector *z) {
  const uint32_t *begin = a->graph->begin, *end = a->graph->end;
  const size_t n = a->graph->n;
  double rz = 0;
  memcpy(z, r, n * sizeof *z);
  for (size_t i = 0; i < n; i++) {
    const msri_vector y = z[i];
    for (size_t p = begin[i]; p < begin[i + 1]; p++)
      z[end[p]] = msri_sum(z[end[p]], msri_square_times(a->lower[p], y));
  }
  for (size_t i = n; i-- > 0;) {
    msri_vector y = msri_block_times(a->pivot[i], z[i]);
    for (size_t p = begin[i]; p < begin[i + 1]; p++)
      y = msri_sum(y, msri_square_times_from_left(a->lower[p], z[end[p]]));
    z[i] = y = msri_stiffness_loose(a, i, y);
    rz += msri_product(r[i], y);
  }
  return rz;
}
