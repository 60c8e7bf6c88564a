/* near.c - neighbours at rest: a list of all pairs within the reach of a skin (Allen & Tildesley
 * 1987, Computer Simulation of Liquids, 5.3: cells and a list with a skin). */
#include "contacts/cells.h"

#include <string.h>

/* ---- Memory */

enum { ALIGNMENT = 16, PAIRS_PER_MASS = 8, LEAST_PAIRS = 4096 };

static size_t buckets_for(size_t n) {
  size_t buckets = 16;
  while (buckets < n) buckets *= 2;
  return buckets;
}

/* Reserves a part of the block; `block` may be NULL, to count only. */
static void *part(char *block, size_t *end, size_t bytes) {
  char *const begin = block ? block + *end : NULL;
  *end += (bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
  return begin;
}

static msri_near place(size_t n, char *block, size_t *end) {
  msri_near near = {.n = n, .buckets = buckets_for(n)};
  near.capacity = PAIRS_PER_MASS * n + LEAST_PAIRS;
  near.row = 1;
  while (near.row * near.row < near.buckets) near.row *= 2;
  near.row += 1; // odd: a column of cells goes through all buckets, too
  near.list = part(block, end, sizeof *near.list);
  near.at = part(block, end, 2 * n * sizeof *near.at);
  near.pair = part(block, end, near.capacity * sizeof *near.pair);
  near.close = part(block, end, near.capacity * sizeof *near.close);
  near.bucket = part(block, end, (near.buckets + 1) * sizeof *near.bucket);
  near.sorted = part(block, end, n * sizeof *near.sorted);
  near.set = part(block, end, n * sizeof *near.set);
  return near;
}

size_t msri_near_bytes(size_t n) {
  size_t end = 0;
  place(n, NULL, &end);
  return end;
}

msri_near msri_near_place(size_t n, double diameter, const msri_ties *ties, void *block) {
  size_t end = 0;
  msri_near near = place(n, block, &end);
  near.diameter = diameter;
  near.ties = ties;
  return near;
}

/* ---- Lists */

/* Puts those from `begin` on in order: a few. */
static void order_few(msri_pair *pair, size_t begin, size_t end) {
  for (size_t k = begin + 1; k < end; k++) {
    const msri_pair moved = pair[k];
    size_t to = k;
    for (; to > begin && msri_pair_precedes(moved, pair[to - 1]); to--) pair[to] = pair[to - 1];
    pair[to] = moved;
  }
}

void msri_near_list_at(msri_near *near, const double *q, double skin) {
  const double reach = near->diameter + 2 * skin;
  const msri_search s = {.q0 = q, .size = reach, .reach = reach};
  *near->list = (msri_near_list){.skin = skin};
  for (size_t i = 0; i < near->n; i++) near->set[i] = (uint32_t)i;
  msri_cells_sort(near, q, s.size, near->set, near->n);
  for (size_t i = 0; i < near->n; i++) {
    const size_t begin = near->list->n;
    msri_cells_look_around(near, &s, i);
    order_few(near->pair, begin, near->list->n);
  }
  memcpy(near->at, q, 2 * near->n * sizeof *q);
  near->list->valid = !near->list->full;
}

void msri_near_choose(msri_near *near, const double *q, double most) {
  const double *x = q, *y = q + near->n, reach = (near->diameter + 2 * most) * (1 + 1e-9);
  size_t n = 0;
  for (size_t k = 0; k < near->list->n; k++) {
    const msri_pair p = near->pair[k];
    near->close[n] = p;
    n += msri_squared(x[p.j] - x[p.i], y[p.j] - y[p.i]) <= reach * reach;
  }
  near->list->n_close = n;
}
