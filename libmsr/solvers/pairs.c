/* pairs.c - the pairs of masses that springs tie, sorted by their first mass, then by their second
 * one, in time and memory proportional to masses and springs: two stable counting sorts. */
#include "solvers/pairs.h"

/* What sorting takes: [springs] each but for count, [masses + 1]. */
typedef struct desk {
  uint32_t *first, *second; /* the masses of each spring */
  uint32_t *by_second, *by_both;
  uint32_t *count;
} desk;

static void list_ends(const msr_springs *springs, desk *d) {
  size_t spring = 0;
  for (size_t r = 0; r < springs->n_runs; r++) {
    const msr_run_of_springs *run = &springs->run[r];
    for (size_t s = 0; s < run->count; s++, spring++) {
      d->first[spring] = (uint32_t)(run->first + s);
      d->second[spring] = (uint32_t)(run->first + s + run->offset);
    }
  }
}

/* The springs in the order `from` (NULL: their own), sorted by key; count[n + 1]. */
static void sort_by(const uint32_t *key, size_t springs, const uint32_t *from, size_t n,
                    uint32_t *count, uint32_t *sorted) {
  for (size_t i = 0; i <= n; i++) count[i] = 0;
  for (size_t s = 0; s < springs; s++) count[key[s] + 1]++;
  for (size_t i = 0; i < n; i++) count[i + 1] += count[i];
  for (size_t s = 0; s < springs; s++) {
    const uint32_t spring = from ? from[s] : (uint32_t)s;
    sorted[count[key[spring]]++] = spring;
  }
}

/* One pair for all springs between the same masses. */
static void merge(msri_pairs *g, size_t springs, const desk *d) {
  size_t at = 0;
  g->count = 0;
  for (size_t i = 0; i < g->n; i++) {
    g->begin[i] = (uint32_t)g->count;
    for (; at < springs && d->first[d->by_both[at]] == i; at++) {
      const uint32_t spring = d->by_both[at], j = d->second[spring];
      if (g->count == g->begin[i] || g->end[g->count - 1] != j) g->end[g->count++] = j;
      g->pair[spring] = (uint32_t)(g->count - 1);
    }
  }
  g->begin[g->n] = (uint32_t)g->count;
}

msri_pairs msri_pairs_sort(size_t n, const msr_springs *springs, uint32_t *memory,
                           uint32_t *desk_memory) {
  const size_t m = springs->n;
  msri_pairs made = {.n = n, .begin = memory, .end = memory + n + 1, .pair = memory + n + 1 + m};
  desk d = {desk_memory, desk_memory + m, desk_memory + 2 * m, desk_memory + 3 * m,
            desk_memory + 4 * m};
  list_ends(springs, &d);
  sort_by(d.second, m, NULL, n, d.count, d.by_second);
  sort_by(d.first, m, d.by_second, n, d.count, d.by_both);
  merge(&made, m, &d);
  return made;
}
