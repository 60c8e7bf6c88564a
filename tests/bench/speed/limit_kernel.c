/* limit_kernel.c - see limit_kernel.h. One source, compiled for vectors of several widths. */
#include "limit_kernel.h"

#include "speed.h"

#include <string.h>

#define INLINE static inline __attribute__((always_inline))

enum { LANES = 8 };
typedef double lanes __attribute__((vector_size(8 * LANES)));

INLINE lanes load(const double *from) {
  lanes v;
  memcpy(&v, from, sizeof v);
  return v;
}

INLINE void store(double *to, lanes v) { memcpy(to, &v, sizeof v); }

INLINE lanes roots(lanes v) {
  return (lanes){sqrt(v[0]), sqrt(v[1]), sqrt(v[2]), sqrt(v[3]),
                 sqrt(v[4]), sqrt(v[5]), sqrt(v[6]), sqrt(v[7])};
}

/* Of the force over the length, times h/m. */
INLINE lanes factor(lanes dx, lanes dy) {
  const double k = step / mass * stiffness;
  return k - k * rest / roots(dx * dx + dy * dy);
}

/* One lane to the right; the first is the last of `before`. */
INLINE lanes shifted(lanes before, lanes v) {
  return __builtin_shufflevector(before, v, 7, 8, 9, 10, 11, 12, 13, 14);
}

/* The last mass of a row, and what is beside it, has no spring to its right. */
INLINE void cut(lanes *v, size_t springs) {
  for (size_t i = 0; i < LANES; i++)
    if (i >= springs) (*v)[i] = 0;
}

INLINE void edge(const lattice *g, size_t row, forces f) {
  const double *x = g->x + row * g->pitch, *y = g->y + row * g->pitch;
  for (size_t c = 0; c < g->n; c += LANES) {
    const lanes dx = load(x + g->pitch + c) - load(x + c),
                dy = load(y + g->pitch + c) - load(y + c);
    const lanes q = factor(dx, dy);
    store(f.x + c, q * dx);
    store(f.y + c, q * dy);
  }
}

enum { BELOW_NONE, BELOW_KNOWN, BELOW_NEW };

INLINE void step_row(const lattice *g, size_t row, forces f, const forces *known, int below) {
  const size_t at = row * g->pitch;
  double *x = g->x + at, *y = g->y + at, *u = g->u + at, *v = g->v + at;
  const double *under_x = x + g->pitch, *under_y = y + g->pitch;
  lanes left_x = {0}, left_y = {0};
  for (size_t c = 0; c < g->n; c += LANES) {
    const lanes xc = load(x + c), yc = load(y + c);
    const lanes dx = load(x + c + 1) - xc, dy = load(y + c + 1) - yc;
    lanes q = factor(dx, dy), down_x = {0}, down_y = {0};
    if (c + LANES >= g->n) cut(&q, g->n - 1 - c);
    const lanes right_x = q * dx, right_y = q * dy;
    if (below == BELOW_KNOWN) down_x = load(known->x + c), down_y = load(known->y + c);
    if (below == BELOW_NEW) {
      const lanes ex = load(under_x + c) - xc, ey = load(under_y + c) - yc;
      q = factor(ex, ey);
      down_x = q * ex, down_y = q * ey;
    }
    const lanes across_x = right_x - shifted(left_x, right_x);
    const lanes across_y = right_y - shifted(left_y, right_y);
    const lanes new_u = load(u + c) + (across_x + (down_x - load(f.x + c)));
    const lanes new_v = load(v + c) + (across_y + (down_y - load(f.y + c)));
    store(f.x + c, down_x), store(f.y + c, down_y);
    store(u + c, new_u), store(v + c, new_v);
    store(x + c, xc + step * new_u), store(y + c, yc + step * new_v);
    left_x = right_x, left_y = right_y;
  }
}

INLINE void step_any_row(const lattice *g, size_t row, forces f, const forces *known) {
  if (known)
    step_row(g, row, f, known, BELOW_KNOWN);
  else if (row + 1 < g->rows)
    step_row(g, row, f, NULL, BELOW_NEW);
  else
    step_row(g, row, f, NULL, BELOW_NONE);
}

/* ---- Kernels */

#if defined(__x86_64__) && defined(__GNUC__)
#define WIDE 1
__attribute__((target("avx512f"))) static void edge_avx512(const lattice *g, size_t row, forces f) {
  edge(g, row, f);
}

__attribute__((target("avx512f"))) static void step_avx512(const lattice *g, size_t row, forces f,
                                                           const forces *known) {
  step_any_row(g, row, f, known);
}

__attribute__((target("avx2"))) static void edge_avx2(const lattice *g, size_t row, forces f) {
  edge(g, row, f);
}

__attribute__((target("avx2"))) static void step_avx2(const lattice *g, size_t row, forces f,
                                                      const forces *known) {
  step_any_row(g, row, f, known);
}

static int has_avx512(void) { return __builtin_cpu_supports("avx512f"); }

static int has_avx2(void) { return __builtin_cpu_supports("avx2"); }
#endif

static void edge_anywhere(const lattice *g, size_t row, forces f) { edge(g, row, f); }

static void step_anywhere(const lattice *g, size_t row, forces f, const forces *known) {
  step_any_row(g, row, f, known);
}

static const limit_kernel kernels[] = {
#ifdef WIDE
    {"AVX-512", has_avx512, edge_avx512, step_avx512},
    {"AVX2", has_avx2, edge_avx2, step_avx2},
#endif
    {"plain", NULL, edge_anywhere, step_anywhere},
};

const limit_kernel *limit_kernel_here(void) {
  const limit_kernel *k = kernels;
  while (k->runs_here && !k->runs_here()) k++;
  return k;
}
