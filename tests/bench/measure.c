/* measure.c - see measure.h. A scan in factors of sqrt(2) of the number of steps, or sqrt(10) of
 * the tolerance, finds the first knob that reaches an error; bisection makes it as large as can be.
 */
#include "measure.h"

#include <math.h>
#include <stdlib.h>

/* ---- Knobs */

static double run_once(const table *t, const method *m, double knob, double *seconds) {
  problem *p = t->p;
  double *z = need(2 * p->n, sizeof *z), error = (double)INFINITY;
  void *object = m->open(m, p, knob);
  const double begin = clock_now(m->elsewhere);
  p->deadline = clock_now(false) + p->limit;
  if (object && m->run(object, z)) error = largest_distance(z, t->truth);
  *seconds = clock_now(m->elsewhere) - begin;
  if (object) m->close(object);
  free(z);
  return error;
}

/* A scan of one method's knobs, and where it has come to. */
typedef struct scan {
  const table *t;
  const method *m;
  int i;
  double fails;          /* the last knob that failed; 0: none */
  point at;              /* the last one tried */
  double seconds, total; /* that it took, that all took */
  int too_long;          /* runs that were */
} scan;

static double knob_at(const scan *s) {
  if (s->m->by_tolerance) return s->t->loosest * pow(10, -s->i / 2.0);
  return ceil(4 * pow(2, s->i / 2.0));
}

static void try_knob(scan *s, double knob) {
  s->at.knob = knob;
  s->at.error = run_once(s->t, s->m, knob, &s->seconds);
  s->total += s->seconds;
  s->too_long += s->seconds >= s->t->p->limit;
}

/* More steps take longer; what a tolerance takes isn't that regular. */
static bool is_over(const scan *s) {
  const double limit = s->t->p->limit;
  if (!s->m->by_tolerance) return 1.5 * s->seconds > limit;
  return s->too_long > 1 || s->total > 3 * limit || s->at.knob < 1e-15;
}

static point refine(const scan *s, double error) {
  point found = s->at;
  double fails = s->fails, seconds;
  for (int i = 0; i < 3 && fails > 0; i++) {
    const double middle = sqrt(fails * found.knob);
    const double knob = s->m->by_tolerance ? middle : floor(middle);
    if (knob == fails || knob == found.knob) break;
    const double e = run_once(s->t, s->m, knob, &seconds);
    if (e <= error)
      found.knob = knob, found.error = e;
    else
      fails = knob;
  }
  found.reached = true;
  return found;
}

static void search(table *t, size_t k) {
  scan s = {.t = t, .m = &t->method[k]};
  point found = {.error = (double)INFINITY};
  try_knob(&s, knob_at(&s));
  for (size_t e = 0; e < t->n_errors; e++) {
    while (!(s.at.error <= t->error[e])) {
      if (is_over(&s)) return;
      s.fails = s.at.knob;
      s.i++;
      try_knob(&s, knob_at(&s));
    }
    found.repeated = found.error <= t->error[e];
    if (!found.repeated) found = refine(&s, t->error[e]);
    t->point[k][e] = found;
  }
}

void table_search(table *t) {
  for (size_t k = 0; k < t->n_methods; k++) search(t, k);
}

/* ---- Times */

/* Once, or for a millisecond. */
static void time_point(table *t, const method *m, point *x) {
  const double patience = 1e-3, begin = clock_now(m->elsewhere);
  double now = begin;
  do {
    const double then = now;
    t->p->deadline = (double)INFINITY;
    m->run(x->object, t->z);
    now = clock_now(m->elsewhere);
    if (x->repeats < MOST_REPEATS) x->time[x->repeats++] = (float)(now - then);
  } while (now - begin < patience);
  x->spent += now - begin;
}

static int by_size(const void *a, const void *b) {
  const float x = *(const float *)a, y = *(const float *)b;
  return (x > y) - (x < y);
}

/* Calls `visit` for all points that are to be timed, over and over. */
static void for_points(table *t, int rounds, void (*visit)(table *t, const method *m, point *x)) {
  for (int i = 0; i < rounds; i++)
    for (size_t k = 0; k < t->n_methods; k++)
      for (size_t e = 0; e < t->n_errors; e++) {
        point *x = &t->point[k][e];
        if (x->reached && !x->repeated) visit(t, &t->method[k], x);
      }
}

static void open_point(table *t, const method *m, point *x) {
  x->object = m->open(m, t->p, x->knob);
  x->time = need(MOST_REPEATS, sizeof *x->time);
}

/* Those that have had their share of time sit out. */
static void take_turn(table *t, const method *m, point *x) {
  if (x->repeats < 2 || x->spent < t->share) time_point(t, m, x);
}

static void close_point(table *t, const method *m, point *x) {
  (void)t;
  qsort(x->time, x->repeats, sizeof *x->time, by_size);
  x->minimum = (double)x->time[0];
  x->median = (double)x->time[x->repeats / 2];
  free(x->time);
  m->close(x->object);
}

/* A point that is as the one before has its times; what comes within a smaller error comes within
 * this one, too. */
static void settle(size_t n, point *x) {
  for (size_t e = 1; e < n; e++)
    if (x[e].repeated) x[e] = x[e - 1];
  for (size_t e = n - 1; e > 0; e--)
    if (x[e].reached && x[e].minimum < x[e - 1].minimum) x[e - 1] = x[e];
}

void table_time(table *t, int rounds) {
  t->z = need(2 * t->p->n, sizeof *t->z);
  for_points(t, 1, open_point);
  for_points(t, rounds, take_turn);
  for_points(t, 1, close_point);
  free(t->z);
  for (size_t k = 0; k < t->n_methods; k++) settle(t->n_errors, t->point[k]);
}
