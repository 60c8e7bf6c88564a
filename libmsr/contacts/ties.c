/* ties.c - the springs of each mass as one sorted array, double ones once; and, as if they were
 * tied, masses of one body that are closer than the diameter from the start, since to part them
 * would work against springs for ever (as cloth that is thicker than its mesh is fine; Bridson,
 * Fedkiw & Anderson 2002, ACM Trans. Graph. 21, 594). They are found from mass to mass along the
 * springs. */
#include "contacts/ties.h"

#include <math.h>
#include <stdlib.h>

static int ascending(const void *a, const void *b) {
  const uint32_t p = *(const uint32_t *)a, q = *(const uint32_t *)b;
  return (p > q) - (p < q);
}

/* Puts the partners of every mass in place; next[i] is where the next of mass i goes. */
static void fill(const msr_springs *springs, size_t *next, uint32_t *partner) {
  for (size_t r = 0; r < springs->n_runs; r++) {
    const msr_run_of_springs *run = &springs->run[r];
    for (size_t i = run->first; i < run->first + run->count; i++)
      partner[next[i]++] = (uint32_t)(i + run->offset);
  }
}

/* Sorts those of each mass and drops what is there twice. */
static void tidy(size_t n, msri_ties *ties) {
  size_t kept = 0, begin = 0;
  for (size_t i = 0; i < n; i++) {
    const size_t end = ties->first[i + 1], mine = kept;
    qsort(ties->partner + begin, end - begin, sizeof *ties->partner, ascending);
    for (size_t p = begin; p < end; p++)
      if (kept == mine || ties->partner[kept - 1] != ties->partner[p])
        ties->partner[kept++] = ties->partner[p];
    ties->first[i] = mine;
    begin = end;
  }
  ties->first[n] = kept;
}

static msr_status of_springs(size_t n, const msr_springs *springs, msri_ties *ties,
                             msr_error *err) {
  *ties = (msri_ties){.first = msri_alloc(n + 2, sizeof *ties->first, "collisions", err),
                      .partner = msri_alloc(springs->n, sizeof *ties->partner, "collisions", err)};
  if (!ties->first || !ties->partner) {
    msri_ties_clear(ties);
    return MSR_ENOMEM;
  }
  size_t *const next = ties->first + 1; // counted one mass further, filled, it is the end of each
  for (size_t r = 0; r < springs->n_runs; r++) {
    const msr_run_of_springs *run = &springs->run[r];
    for (size_t i = run->first; i < run->first + run->count; i++) next[i + 1]++;
  }
  for (size_t i = 0; i < n; i++) next[i + 1] += next[i];
  fill(springs, next, ties->partner);
  tidy(n, ties);
  return MSR_OK;
}

bool msri_ties_tied(const msri_ties *ties, size_t i, size_t j) {
  size_t low = ties->first[i], high = ties->first[i + 1];
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (ties->partner[middle] == j) return true;
    if (ties->partner[middle] < j)
      low = middle + 1;
    else
      high = middle;
  }
  return false;
}

/* ---- One body */

/* A walk from mass to mass within reach of the first. */
typedef struct walk {
  const msr_view *s;
  double diameter;
  size_t *first;     /* [n + 1] */
  uint32_t *partner; /* of mass i: partner[first[i]] .. partner[first[i+1]-1], below and above */
  uint32_t *seen;    /* [n]: from which mass last, + 1 */
  uint32_t *queue;   /* [n] */
} walk;

/* Springs of both ends, from those of the lower one. */
static void mirror(const msri_ties *ties, walk *w) {
  const size_t n = w->s->n;
  size_t *const next = w->first + 1;
  for (size_t i = 0; i < n; i++)
    for (size_t p = ties->first[i]; p < ties->first[i + 1]; p++)
      next[i + 1]++, next[ties->partner[p] + 1]++;
  for (size_t i = 0; i < n; i++) next[i + 1] += next[i];
  for (size_t i = 0; i < n; i++)
    for (size_t p = ties->first[i]; p < ties->first[i + 1]; p++) {
      const uint32_t j = ties->partner[p];
      w->partner[next[i]++] = j, w->partner[next[j]++] = (uint32_t)i;
    }
}

static bool are_close(const walk *w, size_t i, size_t j) {
  const double dx = w->s->x[j] - w->s->x[i], dy = w->s->y[j] - w->s->y[i];
  return hypot(dx, dy) < w->diameter;
}

/* Masses of the body of i that are close to it, i the first of them: to queue. */
static size_t look_around(const walk *w, size_t i) {
  size_t found = 1;
  w->queue[0] = (uint32_t)i, w->seen[i] = (uint32_t)i + 1;
  for (size_t k = 0; k < found; k++)
    for (size_t p = w->first[w->queue[k]]; p < w->first[w->queue[k] + 1]; p++) {
      const uint32_t j = w->partner[p];
      if (w->seen[j] == i + 1 || !are_close(w, i, j)) continue;
      w->seen[j] = (uint32_t)i + 1;
      w->queue[found++] = j;
    }
  return found;
}

/* The ties of mass i, and those above it that are close: to `more`. */
static msr_status join(const walk *w, size_t i, const msri_ties *ties, size_t *room,
                       msri_ties *more, msr_error *err) {
  enum { MOST = 64 };
  const size_t found = look_around(w, i), tied = ties->first[i + 1] - ties->first[i];
  size_t end = more->first[i];
  uint32_t *grown =
      msri_grow(more->partner, room, end + found + tied, sizeof *grown, "collisions", err);
  if (!grown) return MSR_ENOMEM;
  more->partner = grown;
  for (size_t p = ties->first[i]; p < ties->first[i + 1]; p++) grown[end++] = ties->partner[p];
  for (size_t k = 1; k < found; k++)
    if (w->queue[k] > i && !msri_ties_tied(ties, i, w->queue[k])) grown[end++] = w->queue[k];
  more->first[i + 1] = end;
  qsort(grown + more->first[i], end - more->first[i], sizeof *grown, ascending);
  if (end <= MOST * (w->s->n + MOST)) return MSR_OK;
  return msri_fail(err, MSR_EUSAGE,
                   "discs of diameter %g px: dozens of masses of one body are closer to each other "
                   "than that; take a smaller diameter",
                   w->diameter);
}

static msr_status join_all(walk *w, const msri_ties *ties, msri_ties *more, msr_error *err) {
  size_t room = 0;
  msr_status status =
      w->first && w->partner && w->seen && w->queue && more->first ? MSR_OK : MSR_ENOMEM;
  if (status == MSR_OK) mirror(ties, w);
  for (size_t i = 0; i < w->s->n && status == MSR_OK; i++)
    status = join(w, i, ties, &room, more, err);
  return status;
}

msr_status msri_ties_create(const msr_view *start, double diameter, msri_ties *ties,
                            msr_error *err) {
  const size_t n = start->n;
  msri_ties direct;
  msr_status status = of_springs(n, start->springs, &direct, err);
  if (status != MSR_OK) return status;
  walk w = {.s = start,
            .diameter = diameter,
            .first = msri_alloc(n + 2, sizeof *w.first, "collisions", err),
            .partner = msri_alloc(2 * direct.first[n], sizeof *w.partner, "collisions", err),
            .seen = msri_alloc(n, sizeof *w.seen, "collisions", err),
            .queue = msri_alloc(n, sizeof *w.queue, "collisions", err)};
  *ties = (msri_ties){.first = msri_alloc(n + 1, sizeof *ties->first, "collisions", err)};
  status = join_all(&w, &direct, ties, err);
  if (status != MSR_OK) msri_ties_clear(ties);
  msri_ties_clear(&direct);
  free(w.first), free(w.partner), free(w.seen), free(w.queue);
  return status;
}

void msri_ties_clear(msri_ties *ties) {
  free(ties->first);
  free(ties->partner);
  *ties = (msri_ties){0};
}
