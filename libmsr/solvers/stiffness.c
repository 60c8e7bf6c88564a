/* stiffness.c - A = M + c K of a mesh of springs. A spring of direction n, stiffness k, tension f
 * and length l has the matrix k n n^T + (f / l) (1 - n n^T).
 *
 * - The second term is negative in a compressed spring. It is cut off (Teran et al. 2005, SCA, 181)
 *   only where it would take more than the masses at its ends can spare, so that A stays positive
 *   and Newton's method keeps its order as long as it can.
 * - The tension is the one that the place before foretells to first order in the displacements, not
 *   the actual one, which is off by k times their square while the iteration is under way: so the
 *   iteration takes as many steps for stiff springs as for soft ones (Magisano, Leonetti & Garcea
 *   2017, Comput. Methods Appl. Mech. Eng. 313, 986).
 * - The mean force between two places, -k ((l0 + l1)/2 - L) (x0 + x1)/(l0 + l1), has twice the
 *   derivative by x1 of k n n1^T + ..., n along x0 + x1; n takes the place of n1, for symmetry. */
#include "solvers/stiffness.h"

#include <math.h>
#include <string.h>

enum { BLOCK = 256 };

/* ---- Memory */

static size_t weights(size_t n, size_t m_stride) { return m_stride ? n : 1; }

size_t msri_stiffness_bytes(const msri_graph *graph, size_t anchors, size_t m_stride) {
  return graph->pairs * (sizeof(msri_block) + sizeof(msri_square)) +
         (anchors + graph->n) * sizeof(msri_block) + 4 * graph->n * sizeof(msri_vector) +
         weights(graph->n, m_stride) * sizeof(double);
}

/* The mass that each spring may take from its ends, so that a tenth of every mass is left: a matrix
 * [[m, -f], [-f, m]] + f is positive for f > -m/2. `degree` [n] is overwritten. */
static double spare(const msr_view *s, double *degree) {
  const msr_springs *springs = s->springs;
  for (size_t i = 0; i < s->n; i++) degree[i] = 0;
  for (size_t r = 0; r < springs->n_runs; r++) {
    const msr_run_of_springs *run = &springs->run[r];
    for (size_t n = 0; n < run->count; n++) degree[run->first + n]++;
    for (size_t n = 0; n < run->count; n++) degree[run->first + run->offset + n]++;
  }
  for (size_t n = 0; n < springs->n_anchors; n++) degree[springs->anchor[n].i]++;
  double least = INFINITY;
  for (size_t i = 0; i < s->n; i++)
    least = msri_min(least, 0.45 * msr_view_mass(s, i) / msri_max(1, degree[i]));
  return least;
}

msri_stiffness msri_stiffness_place(const msri_graph *graph, const msr_view *s, void *memory) {
  msri_stiffness a = {
      .graph = graph, .springs = s->springs, .m = s->m, .m_stride = s->m_stride, .x = memory};
  a.residual = a.x + s->n;
  a.direction = a.residual + s->n;
  a.image = a.direction + s->n;
  a.lower = (msri_square *)(a.image + s->n);
  a.tie = (msri_block *)(a.lower + graph->pairs);
  a.anchor = a.tie + graph->pairs;
  a.pivot = a.anchor + s->springs->n_anchors;
  a.weight = (double *)(a.pivot + s->n);
  for (size_t i = 0; i < weights(s->n, s->m_stride); i++) a.weight[i] = 1 / (s->m[i] * s->m[i]);
  a.least = -spare(s, (double *)a.x);
  return a;
}

/* ---- Springs */

/* The vectors along springs, from xi, yi to xj, yj [count]. */
typedef struct ends {
  const double *xi, *yi, *xj, *yj;
} ends;

/* Where springs are: q0 (NULL: the same as q), the place before, q. */
typedef struct places {
  const ends *start, *from, *at;
} places;

typedef struct blocks {
  double xx[BLOCK], xy[BLOCK], yy[BLOCK];
} blocks;

static inline double length(double x, double y) { return sqrt(x * x + y * y); }

/* c K of `count` springs. One without a length has no direction: it resists along any. */
static inline void stiffen(size_t count, const places *p, const double *k, const double *L,
                           size_t stride, double c, double least, blocks *restrict b) {
  const ends *from = p->from, *at = p->at, *start = p->start;
  for (size_t s = 0; s < count; s++) {
    double dx = at->xj[s] - at->xi[s], dy = at->yj[s] - at->yi[s], rest = L[s * stride];
    const double fx = from->xj[s] - from->xi[s], fy = from->yj[s] - from->yi[s];
    const double lf = length(fx, fy);
    double l = length(dx, dy), foretold = lf > 0 ? (fx * dx + fy * dy) / lf : l;
    if (start) {
      const double x0 = start->xj[s] - start->xi[s], y0 = start->yj[s] - start->yi[s];
      const double l0 = length(x0, y0);
      dx += x0, dy += y0, rest *= 2, l += l0, foretold += l0;
    }
    const double ck = c * k[s * stride], tension = ck * (foretold - rest) / l;
    const double cut = tension > least ? tension : least;
    const double across = l > 0 ? cut : ck, along = l > 0 ? (ck - across) / (l * l) : 0;
    b->xx[s] = across + along * dx * dx;
    b->xy[s] = along * dx * dy;
    b->yy[s] = across + along * dy * dy;
  }
}

static ends ends_of(const double *q, size_t n, size_t i, size_t j) {
  return (ends){q + i, q + n + i, q + j, q + n + j};
}

/* Springs from + 0 .. count - 1 of a run, whose pairs are given. */
static void add_block(msri_stiffness *a, const double *q0, const double *from, const double *q,
                      double c, const msr_run_of_springs *run, size_t first, size_t count,
                      const uint32_t *pair) {
  blocks b;
  const size_t n = a->graph->n, i = run->first + first, j = i + run->offset;
  const double *k = run->k + first * run->stride, *L = run->L + first * run->stride;
  const ends start = ends_of(q0 ? q0 : q, n, i, j), before = ends_of(from, n, i, j),
             at = ends_of(q, n, i, j);
  if (q0)
    stiffen(count, &(places){&start, &before, &at}, k, L, run->stride, c, a->least, &b);
  else
    stiffen(count, &(places){NULL, &before, &at}, k, L, run->stride, c, a->least, &b);
  for (size_t s = 0; s < count; s++) {
    msri_block *tie = &a->tie[pair[s]];
    *tie = msri_block_sum(*tie, (msri_block){b.xx[s], b.xy[s], b.yy[s]});
  }
}

static ends ends_of_anchor(const double *q, size_t n, const msr_anchor *a) {
  return (ends){q + a->i, q + n + a->i, &a->x, &a->y};
}

static msri_block stiffness_of_anchor(const msri_stiffness *a, const double *q0, const double *from,
                                      const double *q, double c, const msr_anchor *to) {
  blocks b;
  const size_t n = a->graph->n;
  const ends start = ends_of_anchor(q0 ? q0 : q, n, to), before = ends_of_anchor(from, n, to),
             at = ends_of_anchor(q, n, to);
  const places p = {q0 ? &start : NULL, &before, &at};
  stiffen(1, &p, &to->k, &to->L, 0, c, a->least, &b);
  return (msri_block){b.xx[0], b.xy[0], b.yy[0]};
}

void msri_stiffness_linearise(msri_stiffness *a, const double *q0, const double *from,
                              const double *q, double c) {
  const msr_springs *springs = a->springs;
  const uint32_t *pair = a->graph->pair;
  memset(a->tie, 0, a->graph->pairs * sizeof *a->tie);
  for (size_t r = 0; r < springs->n_runs; r++) {
    const msr_run_of_springs *run = &springs->run[r];
    for (size_t s = 0; s < run->count; s += BLOCK) {
      const size_t left = run->count - s;
      add_block(a, q0, from, q, c, run, s, left < BLOCK ? left : BLOCK, pair + s);
    }
    pair += run->count;
  }
  for (size_t n = 0; n < springs->n_anchors; n++)
    a->anchor[n] = stiffness_of_anchor(a, q0, from, q, c, &springs->anchor[n]);
  msri_stiffness_factorise(a);
}
