/* contest.c - all contestants on one work: they must come to the same positions; then they are
 * timed in turn, round after round, so that what else the machine does hits them alike. */
#include "speed.h"

#include <float.h>
#include <stdlib.h>

static const double sample = 0.04; /* that one lasts, about [s] */
enum { FIRST_STEPS = 32, ROWS = 7, LIMITS = 3 };

/* The limit stands beside libmsr in time, too. */
static const contestant *const contestants[ROWS] = {&library, &limit_1, &limit_8,   &limit_16,
                                                    &numba,   &lammps,  &assignment};

/* With 1 or 2 threads. */
typedef struct seat {
  entry e;
  size_t steps;
  double rate[ROUNDS]; /* springs [10^6/s], in the order of rounds */
  spread s;
} seat;

typedef struct table {
  const work *w;
  seat seat[ROWS][MOST_THREADS];
  double *x, *y, *other_x, *other_y; /* [n] */
} table;

static void for_seats(table *t, void (*visit)(table *t, const contestant *c, seat *s)) {
  for (size_t k = 0; k < ROWS; k++)
    for (int i = 0; i < MOST_THREADS; i++)
      if (!t->seat[k][i].e.missing) visit(t, contestants[k], &t->seat[k][i]);
}

static void open_seat(table *t, const contestant *c, seat *s) {
  const int threads = 1 + (int)(s - t->seat[0]) % MOST_THREADS;
  s->e = threads <= c->threads ? c->open(c, t->w, threads) : (entry){.missing = "one thread only"};
}

/* ---- Positions */

/* A step rounds each coordinate once, to half an eps of the width at most; what that does to the
 * velocities doesn't grow, since the steps are stable. The rest is for forces whose terms are
 * added in another order. */
static double tolerance(const work *w) { return 4 * DBL_EPSILON * (double)w->height * FIRST_STEPS; }

static double difference(const table *t) {
  double most = 0;
  for (size_t i = 0; i < t->w->n; i++) {
    const double far = fmax(fabs(t->x[i] - t->other_x[i]), fabs(t->y[i] - t->other_y[i]));
    if (!(far <= most)) most = far;
  }
  return most;
}

static void begin_seat(table *t, const contestant *c, seat *s) {
  const double seconds = c->run(s->e.self, FIRST_STEPS);
  const double grains = sample * FIRST_STEPS / seconds / (double)c->grain;
  s->steps = c->grain * (size_t)fmax(1, round(grains));
  if (!s->e.alike) return;
  const bool first = s == &t->seat[0][0];
  c->read(s->e.self, first ? t->x : t->other_x, first ? t->y : t->other_y);
  if (first) return;
  const double d = difference(t);
  if (!(d <= tolerance(t->w)))
    bench_fail("%s: %s is %.2g px away from libmsr after %d steps, where rounding explains %.2g",
               t->w->name, c->name, d, FIRST_STEPS, tolerance(t->w));
}

/* ---- Rounds */

static int round_now;

static void time_seat(table *t, const contestant *c, seat *s) {
  (void)t;
  const double springs = (double)s->e.springs * (double)s->steps;
  s->rate[round_now] = springs / c->run(s->e.self, s->steps) / 1e6;
}

static void close_seat(table *t, const contestant *c, seat *s) {
  (void)t;
  double sorted[ROUNDS];
  for (int i = 0; i < ROUNDS; i++) sorted[i] = s->rate[i];
  s->s = spread_of(sorted, ROUNDS);
  c->close(s->e.self);
}

/* The median over the rounds. */
static double ratio(const seat *a, const seat *b) {
  double each[ROUNDS];
  for (int i = 0; i < ROUNDS; i++) each[i] = a->rate[i] / b->rate[i];
  return spread_of(each, ROUNDS).median;
}

/* ---- Printing */

static void print_seat(const seat *s) {
  char text[48] = "-";
  if (!s->e.missing)
    snprintf(text, sizeof text, "%6.0f (%.0f..%.0f)", s->s.median, s->s.low, s->s.high);
  printf("  %-22s", text);
}

static void print_bytes(const table *t, const seat *s) {
  if (s->e.missing)
    printf(" %8s", "-");
  else
    printf(" %8.1f", s->e.bytes / (s->e.alike ? (double)t->w->n : (double)s->e.springs / 2));
}

static void print_row(const table *t, size_t k) {
  const seat *s = t->seat[k], *own = t->seat[0];
  printf("%-24s", contestants[k]->name);
  for (int i = 0; i < MOST_THREADS; i++) print_seat(&s[i]);
  print_bytes(t, s);
  for (int i = 0; i < MOST_THREADS; i++)
    if (k == 0 || s[i].e.missing || own[i].e.missing)
      printf(" %8s", k == 0 ? "" : "-");
    else
      printf(" %8.2f", ratio(&own[i], &s[i]));
  printf("%s%s\n", s[0].e.missing ? "  " : "", s[0].e.missing ? s[0].e.missing : "");
}

static void print_table(const table *t) {
  const work *w = t->w;
  printf("\n== %s: %zu masses, %zu springs\n", w->name, w->n, w->n_springs);
  printf("%-24s  %-22s  %-22s %8s %17s\n", "M springs/s", "1 thread", "2 threads", "B/mass",
         "libmsr / this");
  for (size_t k = 0; k < ROWS; k++)
    if (w->drawn || k == 0 || k > LIMITS) print_row(t, k);
}

/* ---- Bars */

static const seat *best_limit(const table *t, int i) {
  const seat *best = &t->seat[1][i];
  for (size_t k = 2; k <= LIMITS; k++)
    if (t->seat[k][i].s.median > best->s.median) best = &t->seat[k][i];
  return best;
}

static void hold(const seat *own, const seat *s, double bar, const char *what, const work *w,
                 int threads) {
  if (own->e.missing || s->e.missing) return;
  bar_at_least(ratio(own, s), bar, "%s: libmsr / %s, %d thread%s", w->name, what, threads,
               threads > 1 ? "s" : "");
}

static void hold_all(const table *t) {
  const work *w = t->w;
  const seat *own = t->seat[0];
  for (int i = 0; i < MOST_THREADS; i++) {
    if (w->drawn) hold(&own[i], best_limit(t, i), w->full ? 0.7 : 0.5, "limit", w, i + 1);
    if (w->full) hold(&own[i], &t->seat[5][i], 10, "LAMMPS", w, i + 1);
    if (w->full) hold(&own[i], &t->seat[4][i], 1.5, "Numba", w, i + 1);
  }
  if (w->full) bar_at_most(own->e.bytes / (double)w->n, 48, "%s: bytes per mass", w->name);
  if (w->full && w->n >= 1000000 && !own[1].e.missing)
    bar_at_least(ratio(&own[1], &own[0]), 1.8, "%s: 2 threads / 1", w->name);
}

void contest(const work *w) {
  table *t = need(1, sizeof *t);
  double *all = need(4 * w->n, sizeof *all);
  t->w = w;
  t->x = all, t->y = all + w->n, t->other_x = all + 2 * w->n, t->other_y = all + 3 * w->n;
  for_seats(t, open_seat);
  for_seats(t, begin_seat);
  for (round_now = 0; round_now < ROUNDS; round_now++) for_seats(t, time_seat);
  for_seats(t, close_seat);
  print_table(t);
  hold_all(t);
  fflush(stdout);
  free(all);
  free(t);
}
