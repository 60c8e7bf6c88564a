/* motion.c - see motion.h. Least and largest values are gathered in eight lanes: their order
 * doesn't matter, and vectors of every width take part.
 *
 * How a body went without a change of its form is found from some of its masses, by the closed form
 * of the best rotation in a plane (Umeyama 1991, Least-squares estimation of transformation
 * parameters, IEEE PAMI 13, 376); a worse one would only make the change look larger. */
#include "contacts/motion.h"

#include "base/machine.h"

#include <math.h>

/* ---- Lanes */

enum { LANES = 8 };

typedef struct lanes {
  double low[LANES], high[LANES], odd[LANES]; /* odd: 0, or no number once a value wasn't finite */
} lanes;

MSRI_INLINE void clear(lanes *l) {
  for (int k = 0; k < LANES; k++)
    l->low[k] = (double)INFINITY, l->high[k] = -(double)INFINITY, l->odd[k] = 0;
}

MSRI_INLINE void take(lanes *l, size_t k, double d) {
  l->low[k] = d < l->low[k] ? d : l->low[k];
  l->high[k] = d > l->high[k] ? d : l->high[k];
  l->odd[k] += d - d;
}

MSRI_INLINE void gather(const lanes *l, double *low, double *high) {
  double odd = 0;
  *low = (double)INFINITY, *high = -(double)INFINITY;
  for (int k = 0; k < LANES; k++) {
    *low = msri_min(*low, l->low[k]), *high = msri_max(*high, l->high[k]);
    odd += l->odd[k];
  }
  if (odd != 0) *low = -(double)INFINITY, *high = (double)INFINITY;
}

/* ---- One coordinate of a stretch */

MSRI_INLINE void drift(size_t n, double h, const double *restrict u, double *restrict x0,
                       double *restrict x, lanes *all) {
  lanes l = *all;
  double d[LANES];
  size_t i = 0;
  for (; i + LANES <= n; i += LANES) {
    for (size_t k = 0; k < LANES; k++) {
      const double from = x[i + k], to = from + h * u[i + k];
      x0[i + k] = from, x[i + k] = to, d[k] = to - from;
    }
    for (size_t k = 0; k < LANES; k++) take(&l, k, d[k]);
  }
  for (; i < n; i++) {
    const double from = x[i], to = from + h * u[i];
    x0[i] = from, x[i] = to;
    take(&l, 0, to - from);
  }
  *all = l;
}

MSRI_INLINE void measure(size_t n, const double *x0, const double *x, lanes *all) {
  lanes l = *all;
  size_t i = 0;
  for (; i + LANES <= n; i += LANES)
    for (size_t k = 0; k < LANES; k++) take(&l, k, x0 ? x[i + k] - x0[i + k] : x[i + k]);
  for (; i < n; i++) take(&l, 0, x0 ? x[i] - x0[i] : x[i]);
  *all = l;
}

/* ---- All bodies */

typedef struct task {
  const msri_bodies *bodies;
  double h;
  const double *u; /* x += h u, x0 being kept; NULL: q is measured, from q0 or, that NULL, alone */
  double *x0, *x;
  const double *q0, *q;
} task;

MSRI_INLINE void do_stretch(const task *t, msri_stretch s, size_t from, lanes *l) {
  const size_t i = s.begin + from, n = s.end - s.begin;
  if (t->u)
    drift(n, t->h, t->u + i, t->x0 + i, t->x + i, l);
  else if (t->q0)
    measure(n, t->q0 + i, t->q + i, l);
  else
    measure(n, NULL, t->q + i, l);
}

MSRI_INLINE void do_all(const task *t, msri_box *box) {
  const msri_bodies *b = t->bodies;
  for (size_t k = 0; k < b->n; k++) {
    lanes x, y;
    clear(&x), clear(&y);
    for (size_t s = b->first[k]; s < b->first[k + 1]; s++) {
      do_stretch(t, b->stretch[s], 0, &x);
      do_stretch(t, b->stretch[s], b->n_masses, &y);
    }
    gather(&x, &box[k].low[0], &box[k].high[0]);
    gather(&y, &box[k].low[1], &box[k].high[1]);
  }
}

#if MSRI_WIDE
MSRI_AVX2 static void do_all_avx2(const task *t, msri_box *box) { do_all(t, box); }
#endif

static void do_task(const task *t, msri_box *box) {
#if MSRI_WIDE
  if (msri_has_avx2()) {
    do_all_avx2(t, box);
    return;
  }
#endif
  do_all(t, box);
}

void msri_motion_measure(const msri_bodies *bodies, const double *q0, const double *q,
                         msri_box *box) {
  do_task(&(task){.bodies = bodies, .q0 = q0, .q = q}, box);
}

void msri_motion_drift(const msri_bodies *bodies, double h, const double *u, double *q0, double *q,
                       msri_box *box) {
  do_task(&(task){.bodies = bodies, .h = h, .u = u, .x0 = q0, .x = q}, box);
}

msri_motion msri_motion_of(const msri_box *ways) {
  msri_motion m;
  double half[2];
  for (int d = 0; d < 2; d++) {
    m.way[d] = ways->low[d] / 2 + ways->high[d] / 2;
    half[d] = ways->high[d] / 2 - ways->low[d] / 2;
  }
  // with more than rounding can have taken
  m.spread = sqrt(half[0] * half[0] + half[1] * half[1]) * (1 + 1e-12) +
             1e-15 * (fabs(m.way[0]) + fabs(m.way[1]));
  if (m.spread < (double)INFINITY) return m;
  return (msri_motion){{0, 0}, (double)INFINITY};
}

/* ---- Change of form */

/* A turn by the angle of (c, s) about `from`, which goes to `to`. */
typedef struct turn {
  double c, s, from[2], to[2];
} turn;

enum { SOME = 64 };

/* Some masses of a body, evenly among all. Returns their number. */
static size_t choose_some(const msri_bodies *b, size_t body, size_t *some) {
  size_t n = 0, masses = 0, before = 0, chosen = 0;
  for (size_t s = b->first[body]; s < b->first[body + 1]; s++)
    masses += b->stretch[s].end - b->stretch[s].begin;
  const size_t every = masses / SOME + 1;
  for (size_t s = b->first[body]; s < b->first[body + 1]; s++) {
    const msri_stretch r = b->stretch[s];
    for (; n < before + (r.end - r.begin); n += every) some[chosen++] = r.begin + (n - before);
    before += r.end - r.begin;
  }
  return chosen;
}

static turn best_turn(size_t n, const double *at, const double *q, const size_t *some,
                      size_t chosen) {
  turn t = {.c = 0};
  for (size_t k = 0; k < chosen; k++)
    for (size_t d = 0; d < 2; d++) {
      t.from[d] += at[some[k] + d * n] / (double)chosen;
      t.to[d] += q[some[k] + d * n] / (double)chosen;
    }
  for (size_t k = 0; k < chosen; k++) {
    const size_t i = some[k];
    const double px = at[i] - t.from[0], py = at[i + n] - t.from[1];
    const double x = q[i] - t.to[0], y = q[i + n] - t.to[1];
    t.c += px * x + py * y, t.s += px * y - py * x;
  }
  const double size = sqrt(t.c * t.c + t.s * t.s);
  t.c = size > 0 ? t.c / size : 1, t.s = size > 0 ? t.s / size : 0;
  return t;
}

/* The largest square of a distance, or more; infinite if one isn't finite. */
static double farthest(const turn *t, size_t n, msri_stretch r, const double *at, const double *q) {
  double most = 0, odd = 0;
  for (size_t i = r.begin; i < r.end; i++) {
    const double px = at[i] - t->from[0], py = at[i + n] - t->from[1];
    const double x = q[i] - t->to[0] - (t->c * px - t->s * py);
    const double y = q[i + n] - t->to[1] - (t->s * px + t->c * py), r2 = x * x + y * y;
    most = r2 > most ? r2 : most;
    odd += r2 - r2;
  }
  return odd == 0 ? most : (double)INFINITY;
}

double msri_motion_change(const msri_bodies *b, size_t body, const double *at, const double *q) {
  size_t some[SOME + 1];
  const size_t chosen = choose_some(b, body, some);
  const turn t = best_turn(b->n_masses, at, q, some, chosen);
  double most = 0;
  for (size_t s = b->first[body]; s < b->first[body + 1]; s++)
    most = msri_max(most, farthest(&t, b->n_masses, b->stretch[s], at, q));
  return sqrt(most);
}
