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

#include "forces/springs.h"

#include <math.h>
#include <string.h>

/* ---- Memory */

enum { VECTORS = 6 }; /* of conjugate gradients */

static size_t weights(size_t n, size_t m_stride) { return m_stride ? n : 1; }

size_t msri_stiffness_bytes(const msri_graph *graph, size_t anchors, size_t m_stride) {
  const size_t n = graph->n, matrices = graph->pairs + anchors + n;
  return (3 * matrices + VECTORS * 2 * n + 2 * weights(n, m_stride)) * sizeof(double) +
         4 * graph->pairs * sizeof(float) + anchors * sizeof(uint32_t);
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
  double least = (double)INFINITY;
  for (size_t i = 0; i < s->n; i++)
    least = msri_min(least, 0.45 * msr_view_mass(s, i) / msri_max(1, degree[i]));
  return least;
}

static double *take(double **memory, size_t n) {
  double *taken = *memory;
  *memory += n;
  return taken;
}

static msri_matrices take_matrices(double **memory, size_t n) {
  double *xx = take(memory, n), *xy = take(memory, n);
  return (msri_matrices){xx, xy, take(memory, n)};
}

/* Where each mass is in the order goes to place [n]. */
static void find_anchors(msri_stiffness *a, uint32_t *place) {
  for (size_t i = 0; i < a->graph->n; i++) place[a->graph->order[i]] = (uint32_t)i;
  for (size_t s = 0; s < a->springs->n_anchors; s++) a->place[s] = place[a->springs->anchor[s].i];
}

msri_stiffness msri_stiffness_place(const msri_graph *graph, const msr_view *s, void *memory) {
  const size_t n = s->n, anchors = s->springs->n_anchors, masses = weights(n, s->m_stride);
  double *rest = memory;
  msri_stiffness a = {
      .graph = graph, .springs = s->springs, .m_stride = s->m_stride, .most = MSRI_MOST_ITERATIONS};
  a.tie = take_matrices(&rest, graph->pairs);
  a.pivot = take_matrices(&rest, n);
  a.anchor = take_matrices(&rest, anchors);
  a.m = take(&rest, masses);
  a.weight = take(&rest, masses);
  double **vector[VECTORS] = {&a.x, &a.residual, &a.direction, &a.image, &a.z, &a.product};
  for (size_t v = 0; v < VECTORS; v++) *vector[v] = take(&rest, 2 * n);
  a.lower = (void *)rest;
  a.place = (void *)(a.lower + 4 * graph->pairs);
  for (size_t i = 0; i < masses; i++) a.m[i] = s->m[s->m_stride ? graph->order[i] : 0];
  for (size_t i = 0; i < masses; i++) a.weight[i] = 1 / (a.m[i] * a.m[i]);
  a.least = -spare(s, a.x);
  find_anchors(&a, (void *)a.x);
  return a;
}

/* ---- Springs */

/* Where the matrix is asked for, as linearise() is given it. */
typedef struct place {
  msr_view start, from, now; /* of which only x and y */
  bool mean;
  double c;
} place;

/* Springs [count] at the start (if `mean`), at the place before, and now. */
typedef struct strands {
  size_t count;
  msri_ends start, from, now;
  const double *k, *L;
  double c, least;
} strands;

typedef struct blocks {
  double xx[MSRI_SPRINGS_BLOCK], xy[MSRI_SPRINGS_BLOCK], yy[MSRI_SPRINGS_BLOCK];
} blocks;

MSRI_INLINE double length(double x, double y) { return sqrt(x * x + y * y); }

/* A spring's vector, its length (infinite if it has none), and the tension foretold. */
typedef struct geometry {
  double dx[MSRI_SPRINGS_BLOCK], dy[MSRI_SPRINGS_BLOCK], l[MSRI_SPRINGS_BLOCK],
      tension[MSRI_SPRINGS_BLOCK];
} geometry;

/* The sum of both vectors and lengths if `mean`. Divisors are chosen, not quotients, and nothing
 * after a quotient, or gcc would not vectorise. */
MSRI_INLINE void measure(const strands *s, size_t stride, bool mean, geometry *restrict g) {
  const msri_ends start = s->start, from = s->from, now = s->now;
  const double *k = s->k, *L = s->L, c = s->c, none = (double)INFINITY;
  for (size_t n = 0; n < s->count; n++) {
    double dx = now.xj[n] - now.xi[n], dy = now.yj[n] - now.yi[n], rest = L[n * stride];
    const double fx = from.xj[n] - from.xi[n], fy = from.yj[n] - from.yi[n], lf = length(fx, fy);
    double l = length(dx, dy), foretold = (fx * dx + fy * dy) / (lf > 0 ? lf : none);
    if (mean) {
      const double x0 = start.xj[n] - start.xi[n], y0 = start.yj[n] - start.yi[n];
      const double l0 = length(x0, y0);
      dx += x0, dy += y0, rest *= 2, l += l0, foretold += l0;
    }
    g->dx[n] = dx;
    g->dy[n] = dy;
    g->l[n] = l > 0 ? l : none;
    g->tension[n] = c * k[n * stride] * (foretold - rest) / (l > 0 ? l : none);
  }
}

/* c K of each spring. One without a length has no direction: it resists along any. */
MSRI_INLINE void stiffen(const strands *s, size_t stride, bool mean, blocks *restrict b) {
  geometry g;
  const double *k = s->k, c = s->c, least = s->least, none = (double)INFINITY;
  measure(s, stride, mean, &g);
  for (size_t n = 0; n < s->count; n++) {
    const double ck = c * k[n * stride], floor = g.l[n] < none ? least : ck;
    const double across = g.tension[n] > floor ? g.tension[n] : floor;
    const double along = (ck - across) / (g.l[n] * g.l[n]);
    b->xx[n] = across + along * g.dx[n] * g.dx[n];
    b->xy[n] = along * g.dx[n] * g.dy[n];
    b->yy[n] = across + along * g.dy[n] * g.dy[n];
  }
}

MSRI_INLINE void stiffen_any(const strands *s, size_t stride, bool mean, blocks *b) {
  if (stride && mean) stiffen(s, 1, true, b);
  if (stride && !mean) stiffen(s, 1, false, b);
  if (!stride && mean) stiffen(s, 0, true, b);
  if (!stride && !mean) stiffen(s, 0, false, b);
}

#if MSRI_WIDE
MSRI_AVX2 static void stiffen_avx2(const strands *s, size_t stride, bool mean, blocks *b) {
  stiffen_any(s, stride, mean, b);
}
#endif

static void stiffen_here(const strands *s, size_t stride, bool mean, blocks *b) {
#if MSRI_WIDE
  if (msri_has_avx2()) {
    stiffen_avx2(s, stride, mean, b);
    return;
  }
#endif
  stiffen_any(s, stride, mean, b);
}

/* Springs first .. first + count - 1 of a run, which belong to the pairs given. */
static void add_block(msri_stiffness *a, const place *at, const msr_run_of_springs *run,
                      size_t first, size_t count, const uint32_t *pair) {
  blocks b;
  const size_t i = run->first + first, j = i + run->offset;
  const strands s = {.count = count,
                     .start = msri_ends_of(&at->start, i, j),
                     .from = msri_ends_of(&at->from, i, j),
                     .now = msri_ends_of(&at->now, i, j),
                     .k = run->k + first * run->stride,
                     .L = run->L + first * run->stride,
                     .c = at->c,
                     .least = a->least};
  stiffen_here(&s, run->stride, at->mean, &b);
  for (size_t m = 0; m < count; m++) {
    a->tie.xx[pair[m]] += b.xx[m];
    a->tie.xy[pair[m]] += b.xy[m];
    a->tie.yy[pair[m]] += b.yy[m];
  }
}

static void stiffen_anchor(const msri_stiffness *a, const place *at, size_t anchor) {
  const msr_anchor *to = &a->springs->anchor[anchor];
  blocks b;
  const strands s = {.count = 1,
                     .start = msri_ends_of_anchor(&at->start, to),
                     .from = msri_ends_of_anchor(&at->from, to),
                     .now = msri_ends_of_anchor(&at->now, to),
                     .k = &to->k,
                     .L = &to->L,
                     .c = at->c,
                     .least = a->least};
  stiffen_any(&s, 0, at->mean, &b);
  a->anchor.xx[anchor] = b.xx[0];
  a->anchor.xy[anchor] = b.xy[0];
  a->anchor.yy[anchor] = b.yy[0];
}

static msr_view view_of(const double *q, size_t n) { return (msr_view){.x = q, .y = q + n}; }

void msri_stiffness_linearise(msri_stiffness *a, const double *q0, const double *from,
                              const double *q, double c, const bool *held) {
  const size_t masses = a->graph->n;
  const place at = {.start = view_of(q0 ? q0 : q, masses),
                    .from = view_of(from, masses),
                    .now = view_of(q, masses),
                    .mean = q0 != NULL,
                    .c = c};
  const msr_springs *springs = a->springs;
  const uint32_t *pair = a->graph->pair;
  a->held = held;
  memset(a->tie.xx, 0, 3 * a->graph->pairs * sizeof *a->tie.xx);
  for (size_t r = 0; r < springs->n_runs; r++) {
    const msr_run_of_springs *run = &springs->run[r];
    for (size_t s = 0; s < run->count; s += MSRI_SPRINGS_BLOCK) {
      const size_t left = run->count - s;
      add_block(a, &at, run, s, left < MSRI_SPRINGS_BLOCK ? left : MSRI_SPRINGS_BLOCK, pair + s);
    }
    pair += run->count;
  }
  for (size_t n = 0; n < springs->n_anchors; n++) stiffen_anchor(a, &at, n);
  msri_stiffness_factorise(a);
}
