/* motion.c - see motion.h. A weight is always added: sums of forces begin with 0, and are never -0,
 * which adding 0 would change. */
#include "forces/motion.h"

#include "base/machine.h"

#include <string.h>

/* One axis of msri_motion. */
typedef struct push {
  double w, weight, kick[2], drift, air[2], keep[2];
} push;

/* Numbers without sign are in the order of their bits; what is no number comes last. */
MSRI_INLINE int64_t bits_of_size(double x) {
  int64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits & INT64_MAX;
}

MSRI_INLINE int64_t move(size_t n, push p, bool air, double *restrict q, double *restrict v,
                         double *restrict f, double *restrict next) {
  int64_t most = 0;
  for (size_t i = 0; i < n; i++) {
    const double a = (f[i] + p.weight) * p.w;
    double u = v[i] + p.kick[0] * a;
    if (air) {
      u = p.air[0] + (u - p.air[0]) * p.keep[0];
      u = p.air[1] + (u - p.air[1]) * p.keep[1];
    }
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
MSRI_INLINE int64_t move_all(const msri_moved *m, const push *p, bool air) {
  if (air)
    return m->next ? move(m->n, *p, true, m->q, m->v, m->f, m->next)
                   : move(m->n, *p, true, m->q, m->v, m->f, NULL);
  return m->next ? move(m->n, *p, false, m->q, m->v, m->f, m->next)
                 : move(m->n, *p, false, m->q, m->v, m->f, NULL);
}

#if MSRI_WIDE
MSRI_AVX512 static int64_t move_avx512(const msri_moved *m, const push *p, bool air) {
  return move_all(m, p, air);
}

MSRI_AVX2 static int64_t move_avx2(const msri_moved *m, const push *p, bool air) {
  return move_all(m, p, air);
}
#endif

static int64_t move_by_widest(const msri_moved *m, const push *p, bool air) {
#if MSRI_WIDE
  if (msri_has_avx512()) return move_avx512(m, p, air);
  if (msri_has_avx2()) return move_avx2(m, p, air);
#endif
  return move_all(m, p, air);
}

double msri_move(const msri_moved *moved, const msri_motion *m, int axis, int besides) {
  const push p = {.w = m->w,
                  .weight = m->weight[axis],
                  .kick = {m->kick[0], m->kick[1]},
                  .drift = m->drift,
                  .air = {m->air[0][axis], m->air[1][axis]},
                  .keep = {m->keep[0], m->keep[1]}};
  const int64_t most = move_by_widest(moved, &p, besides & MSRI_WITH_AIR);
  double found;
  memcpy(&found, &most, sizeof found);
  return found;
}
