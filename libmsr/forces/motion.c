/* motion.c - see motion.h. A weight is always added: sums of forces begin with 0, and are never -0,
 * which adding 0 would change. */
#include "forces/motion.h"

#include "base/machine.h"
#include "base/vector.h"

#include <string.h>

/* One axis of msri_motion. */
typedef struct axis {
  double w, weight, kick[2], drift, keep[2], push[2];
} axis;

/* Numbers without sign are in the order of their bits; what is no number comes last. */
MSRI_INLINE int64_t bits_of_size(double x) {
  int64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits & INT64_MAX;
}

MSRI_INLINE int64_t move(size_t n, axis p, bool air, bool push, double *restrict q,
                         double *restrict v, double *restrict f, double *restrict next) {
  int64_t most = 0;
  for (size_t i = 0; i < n; i++) {
    const double a = (f[i] + p.weight) * p.w;
    double u = v[i] + p.kick[0] * a;
    for (int half = 0; half < 2 && air; half++)
      u = push ? p.keep[half] * u + p.push[half] : p.keep[half] * u;
    u = u + p.kick[1] * a;
    v[i] = u;
    q[i] += p.drift * u;
    f[i] = next ? next[i] : 0;
    if (next) next[i] = 0;
    const int64_t size = bits_of_size(u);
    most = size > most ? size : most;
  }
  return most;
}

/* Compiled for all that there may be, so that the loop asks nothing. */
MSRI_INLINE int64_t move_in(const msri_moved *m, const axis *p, bool air, bool push) {
  return m->next ? move(m->n, *p, air, push, m->q, m->v, m->f, m->next)
                 : move(m->n, *p, air, push, m->q, m->v, m->f, NULL);
}

MSRI_INLINE int64_t move_all(const msri_moved *m, const axis *p, int besides) {
  if (!(besides & MSRI_WITH_AIR)) return move_in(m, p, false, false);
  return besides & MSRI_WITH_PUSH ? move_in(m, p, true, true) : move_in(m, p, true, false);
}

#if MSRI_WIDE
MSRI_AVX512 static int64_t move_avx512(const msri_moved *m, const axis *p, int besides) {
  return move_all(m, p, besides);
}

MSRI_AVX2 static int64_t move_avx2(const msri_moved *m, const axis *p, int besides) {
  return move_all(m, p, besides);
}
#endif

static int64_t move_by_widest(const msri_moved *m, const axis *p, int besides) {
#if MSRI_WIDE
  if (msri_has_avx512()) return move_avx512(m, p, besides);
  if (msri_has_avx2()) return move_avx2(m, p, besides);
#endif
  return move_all(m, p, besides);
}

static axis axis_of(const msri_motion *m, int n) {
  return (axis){.w = m->w,
                .weight = m->weight[n],
                .kick = {m->kick[0], m->kick[1]},
                .drift = m->drift,
                .keep = {m->keep[0], m->keep[1]},
                .push = {m->push[0][n], m->push[1][n]}};
}

double msri_move(const msri_moved *moved, const msri_motion *m, int n, int besides) {
  const axis p = axis_of(m, n);
  const int64_t most = move_by_widest(moved, &p, besides);
  double found;
  memcpy(&found, &most, sizeof found);
  return found;
}

MSRI_INLINE void relax(size_t n, const axis *p, bool push, double *restrict v) {
  const double keep[2] = {p->keep[0], p->keep[1]}, by[2] = {p->push[0], p->push[1]};
  for (size_t i = 0; i < n; i++)
    for (int half = 0; half < 2; half++)
      v[i] = push ? keep[half] * v[i] + by[half] : keep[half] * v[i];
}

void msri_coast(size_t n, const msri_motion *m, int which, double *v, double *q) {
  const axis p = axis_of(m, which);
  if (m->pushes)
    relax(n, &p, true, v);
  else if (m->relaxes)
    relax(n, &p, false, v);
  msri_add_scaled(n, m->drift, v, q);
}
