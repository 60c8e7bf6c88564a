/* displacement.c - see displacement.h. Least and largest values are gathered in eight lanes: their
 * order doesn't matter.
 *
 * How a body went without a change of its form is found from some of its masses, by the closed form
 * of the best rotation in a plane (Umeyama 1991, Least-squares estimation of transformation
 * parameters, IEEE PAMI 13, 376); a worse one would only make the change look larger. */
#include "contacts/displacement.h"

#include "base/machine.h"

#include <math.h>
#include <string.h>
#if MSRI_WIDE
#include <immintrin.h>
#endif

/* ---- Lanes */

enum { LANES = 8 };

/* What is no number is left out: it meets nothing. */
typedef struct lanes {
  double low[LANES], high[LANES];
} lanes;

static void clear(lanes *l) {
  for (int k = 0; k < LANES; k++) l->low[k] = (double)INFINITY, l->high[k] = -(double)INFINITY;
}

static void gather(const lanes *l, double *low, double *high) {
  *low = (double)INFINITY, *high = -(double)INFINITY;
  for (int k = 0; k < LANES; k++)
    *low = msri_min(*low, l->low[k]), *high = msri_max(*high, l->high[k]);
}

static void take(size_t n, const double *x0, const double *x, lanes *l) {
  for (size_t i = 0; i < n; i++) {
    const double d = x[i] - x0[i];
    l->low[0] = msri_min(d, l->low[0]), l->high[0] = msri_max(d, l->high[0]);
  }
}

#if MSRI_WIDE
/* The same; gcc doesn't make vectors of such a loop. */
MSRI_AVX2 static void take_avx2(size_t n, const double *x0, const double *x, lanes *l) {
  __m256d low[2], high[2];
  const size_t whole = n / LANES * LANES;
  for (size_t k = 0; k < 2; k++)
    low[k] = _mm256_loadu_pd(l->low + 4 * k), high[k] = _mm256_loadu_pd(l->high + 4 * k);
  for (size_t i = 0; i < whole; i += LANES)
    for (size_t k = 0; k < 2; k++) {
      const __m256d from = _mm256_loadu_pd(x0 + i + 4 * k), to = _mm256_loadu_pd(x + i + 4 * k);
      const __m256d d = _mm256_sub_pd(to, from);
      low[k] = _mm256_min_pd(d, low[k]), high[k] = _mm256_max_pd(d, high[k]);
    }
  for (size_t k = 0; k < 2; k++)
    _mm256_storeu_pd(l->low + 4 * k, low[k]), _mm256_storeu_pd(l->high + 4 * k, high[k]);
  take(n - whole, x0 + whole, x + whole, l);
}
#endif

typedef void taking(size_t n, const double *x0, const double *x, lanes *l);

static taking *widest(void) {
#if MSRI_WIDE
  if (msri_has_avx2()) return take_avx2;
#endif
  return take;
}

/* ---- All bodies */

typedef struct task {
  const msri_bodies *bodies;
  taking *take;
  const double *q0, *q; /* q0 NULL: 0 */
} task;

enum { BLOCK = 512 };

static const double zeros[BLOCK];

static void do_stretch(const task *t, msri_stretch s, lanes *x, lanes *y) {
  const size_t all = t->bodies->n_masses;
  for (size_t i = s.begin; i < s.end; i += BLOCK) {
    const size_t n = s.end - i < BLOCK ? s.end - i : BLOCK;
    t->take(n, t->q0 ? t->q0 + i : zeros, t->q + i, x);
    t->take(n, t->q0 ? t->q0 + all + i : zeros, t->q + all + i, y);
  }
}

static void do_all(const task *t, msri_box *box) {
  const msri_bodies *b = t->bodies;
  for (size_t k = 0; k < b->n; k++) {
    lanes x, y;
    clear(&x), clear(&y);
    for (size_t s = b->first[k]; s < b->first[k + 1]; s++) do_stretch(t, b->stretch[s], &x, &y);
    gather(&x, &box[k].low[0], &box[k].high[0]);
    gather(&y, &box[k].low[1], &box[k].high[1]);
  }
}

void msri_displacement_measure(const msri_bodies *bodies, const double *q0, const double *q,
                               msri_box *box) {
  do_all(&(task){bodies, widest(), q0, q}, box);
}

msri_displacement msri_displacement_of(const msri_box *paths) {
  msri_displacement m;
  double half[2];
  for (int d = 0; d < 2; d++) {
    m.path[d] = paths->low[d] / 2 + paths->high[d] / 2;
    half[d] = paths->high[d] / 2 - paths->low[d] / 2;
  }
  // with more than rounding can have taken
  m.spread = sqrt(half[0] * half[0] + half[1] * half[1]) * (1 + 1e-12) +
             1e-15 * (fabs(m.path[0]) + fabs(m.path[1]));
  if (m.spread < (double)INFINITY) return m;
  return (msri_displacement){{0, 0}, (double)INFINITY};
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

static bool is_finite(const turn *t) {
  return isfinite(t->c + t->s) && isfinite(t->from[0] + t->from[1] + t->to[0] + t->to[1]);
}

/* The largest square of a distance. */
static double farthest(const turn *t, size_t n, msri_stretch r, const double *at, const double *q) {
  const double *px = at + r.begin, *py = px + n, *x = q + r.begin, *y = x + n;
  double square[BLOCK], most = 0;
  for (size_t begin = r.begin; begin < r.end; begin += BLOCK) {
    const size_t count = r.end - begin < BLOCK ? r.end - begin : BLOCK;
    for (size_t k = 0; k < count; k++) {
      const double ax = px[k] - t->from[0], ay = py[k] - t->from[1];
      const double dx = x[k] - t->to[0] - (t->c * ax - t->s * ay);
      const double dy = y[k] - t->to[1] - (t->s * ax + t->c * ay);
      square[k] = dx * dx + dy * dy;
    }
    for (size_t k = 0; k < count; k++) most = msri_max(square[k], most);
    px += count, py += count, x += count, y += count;
  }
  return most;
}

double msri_displacement_change(const msri_bodies *b, size_t body, const double *at,
                                const double *q) {
  size_t some[SOME + 1];
  const size_t chosen = choose_some(b, body, some);
  const turn t = best_turn(b->n_masses, at, q, some, chosen);
  double most = 0;
  if (!is_finite(&t)) return (double)INFINITY;
  for (size_t s = b->first[body]; s < b->first[body + 1]; s++)
    most = msri_max(most, farthest(&t, b->n_masses, b->stretch[s], at, q));
  return sqrt(most);
}
