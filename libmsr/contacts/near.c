/* near.c - neighbours at rest, by cells (Allen & Tildesley 1987, Computer Simulation of Liquids,
 * 5.3), and the order of pairs. */
#include "contacts/cells.h"

#include <string.h>

/* ---- Memory */

enum { ALIGNMENT = 16, PAIRS_PER_MASS = 8, LEAST_PAIRS = 4096, MORE_BUCKETS = 17 };

void *msri_near_part(char *block, size_t *end, size_t bytes) {
  char *const begin = block ? block + *end : NULL;
  *end += msri_round_up(bytes, ALIGNMENT);
  return begin;
}

msri_near msri_near_place(size_t n, double diameter, const msri_ties *ties, char *block,
                          size_t *end) {
  msri_near near = {.n = n, .diameter = diameter, .ties = ties};
  near.capacity = PAIRS_PER_MASS * n + LEAST_PAIRS;
  near.pair = msri_near_part(block, end, near.capacity * sizeof *near.pair);
  near.bucket = msri_near_part(block, end, (2 * n + MORE_BUCKETS) * sizeof *near.bucket);
  near.sorted = msri_near_part(block, end, n * sizeof *near.sorted);
  near.set = msri_near_part(block, end, n * sizeof *near.set);
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

void msri_near_list_at(msri_near *near, const double *q, double reach, const uint32_t *set,
                       size_t members) {
  const msri_search s = {.q0 = q, .size = reach, .reach = reach};
  near->found = 0, near->full = false;
  msri_cells_sort(near, q, s.size, set, members);
  for (size_t k = 0; k < members; k++) {
    const size_t begin = near->found;
    msri_cells_look_around(near, &s, set[k]);
    order_few(near->pair, begin, near->found);
  }
}

void msri_near_list_between(msri_near *near, const double *q, double reach, const uint32_t *a,
                            size_t n_a, const uint32_t *b, size_t n_b) {
  const msri_search s = {.q0 = q, .size = reach, .reach = reach, .between = true};
  near->found = 0, near->full = false;
  msri_cells_sort(near, q, s.size, a, n_a);
  for (size_t k = 0; k < n_b; k++) msri_cells_look_around(near, &s, b[k]);
}

/* ---- Order: merges of what is ascending by itself (Knuth, The Art of Computer Programming 3,
 * 5.2.4) */

static size_t ascending_from(const msri_pair *pair, size_t at, size_t n) {
  while (at + 1 < n && !msri_pair_precedes(pair[at + 1], pair[at])) at++;
  return at + 1;
}

static void merge(const msri_pair *from, size_t begin, size_t middle, size_t end, msri_pair *to) {
  size_t a = begin, b = middle;
  for (size_t k = begin; k < end; k++) {
    const bool second = a == middle || (b < end && msri_pair_precedes(from[b], from[a]));
    to[k] = from[second ? b++ : a++];
  }
}

void msri_near_order(msri_pair *pair, size_t n, msri_pair *room) {
  for (bool done = n == 0; !done;) {
    for (size_t begin = 0; begin < n;) {
      const size_t middle = ascending_from(pair, begin, n);
      const size_t end = middle < n ? ascending_from(pair, middle, n) : n;
      done = begin == 0 && end == n;
      merge(pair, begin, middle, end, room);
      begin = end;
    }
    memcpy(pair, room, n * sizeof *pair);
  }
}
