/* graph.c - the pairs of masses that springs tie, sorted by their first mass, then by their second
 * one, in time and memory proportional to masses and springs: two stable counting sorts. */
#include "solvers/graph.h"

#include <stdlib.h>

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
static void merge(msri_graph *g, size_t springs, const desk *d) {
  size_t at = 0;
  g->pairs = 0;
  for (size_t i = 0; i < g->n; i++) {
    g->begin[i] = (uint32_t)g->pairs;
    for (; at < springs && d->first[d->by_both[at]] == i; at++) {
      const uint32_t spring = d->by_both[at], j = d->second[spring];
      if (g->pairs == g->begin[i] || g->end[g->pairs - 1] != j) g->end[g->pairs++] = j;
      g->pair[spring] = (uint32_t)(g->pairs - 1);
    }
  }
  g->begin[g->n] = (uint32_t)g->pairs;
}

static void fill(msri_graph *g, const msr_springs *springs, uint32_t *memory) {
  const size_t n = springs->n;
  desk d = {memory, memory + n, memory + 2 * n, memory + 3 * n, memory + 4 * n};
  list_ends(springs, &d);
  sort_by(d.second, n, NULL, g->n, d.count, d.by_second);
  sort_by(d.first, n, d.by_second, g->n, d.count, d.by_both);
  merge(g, n, &d);
}

msr_status msri_graph_create(size_t n, const msr_springs *springs, msri_graph **graph,
                             msr_error *err) {
  if (n >= UINT32_MAX || springs->n >= UINT32_MAX)
    return msri_fail(err, MSR_EUSAGE,
                     "%zu masses and %zu springs are too many for an implicit integrator", n,
                     springs->n);
  const size_t words = n + 1 + 2 * springs->n;
  msri_graph *made = msri_alloc(1, sizeof *made + words * sizeof(uint32_t), "the springs", err);
  uint32_t *desk_memory = msri_alloc(4 * springs->n + n + 1, sizeof(uint32_t), "the springs", err);
  if (made && desk_memory) {
    uint32_t *begin = (uint32_t *)(made + 1);
    *made = (msri_graph){.n = n,
                         .bytes = sizeof *made + words * sizeof(uint32_t),
                         .begin = begin,
                         .end = begin + n + 1,
                         .pair = begin + n + 1 + springs->n};
    fill(made, springs, desk_memory);
    *graph = made;
  } else {
    free(made);
  }
  free(desk_memory);
  return made && desk_memory ? MSR_OK : MSR_ENOMEM;
}
