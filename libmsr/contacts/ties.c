/* ties.c - the springs of each mass as one sorted array, double ones once. */
#include "contacts/ties.h"

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

msr_status msri_ties_create(size_t n, const msr_springs *springs, msri_ties *ties, msr_error *err) {
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

void msri_ties_clear(msri_ties *ties) {
  free(ties->first);
  free(ties->partner);
  *ties = (msri_ties){0};
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
