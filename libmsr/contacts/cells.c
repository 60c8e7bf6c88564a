/* cells.c - a uniform grid, sorted by counting.
 *
 * Cells are hashed into as many buckets as there are masses, so that one mass far away costs no
 * memory: (cx + row cy) mod 2^b keeps neighbouring cells side by side, and tells nine that are
 * around one apart. What else is in their buckets is too far away. */
#include "contacts/cells.h"

#include <string.h>

/* Beyond this cells aren't told apart: what is there is far from everything. */
static const double farthest = 0x1p50;

static int64_t cell_of(double at, double size) {
  const double c = at / size;
  const int64_t whole = (int64_t)(c > -farthest ? c < farthest ? c : farthest : -farthest);
  return whole - (c < (double)whole);
}

msri_cell msri_cell_at(const double *q, size_t n, size_t i, double size) {
  return (msri_cell){cell_of(q[i], size), cell_of(q[n + i], size)};
}

static size_t msri_cell_bucket(const msri_near *near, msri_cell c) {
  return (size_t)((uint64_t)c.x + near->row * (uint64_t)c.y) & (near->buckets - 1);
}

/* A column of cells goes through all buckets, too: a row of them is odd. */
static void choose_buckets(msri_near *near, size_t members) {
  near->buckets = 16, near->row = 1;
  while (near->buckets < members) near->buckets *= 2;
  while (near->row * near->row < near->buckets) near->row *= 2;
  near->row += 1;
}

void msri_cells_sort(msri_near *near, const double *q, double size, const uint32_t *set,
                     size_t members) {
  uint32_t *const bucket = near->bucket;
  uint32_t sum = 0;
  choose_buckets(near, members);
  memset(bucket, 0, (near->buckets + 1) * sizeof *bucket);
  for (size_t k = 0; k < members; k++)
    bucket[msri_cell_bucket(near, msri_cell_at(q, near->n, set[k], size))]++;
  for (size_t b = 0; b <= near->buckets; b++) {
    const uint32_t count = bucket[b];
    bucket[b] = sum;
    sum += count;
  }
  for (size_t k = 0; k < members; k++)
    near->sorted[bucket[msri_cell_bucket(near, msri_cell_at(q, near->n, set[k], size))]++] = set[k];
  memmove(bucket + 1, bucket, near->buckets * sizeof *bucket); // each holds where the next begins
  bucket[0] = 0;
}

void msri_cells_append(msri_near *near, size_t a, size_t b) {
  const size_t i = a < b ? a : b, j = a < b ? b : a;
  if (msri_ties_tied(near->ties, i, j)) return;
  near->full |= near->found == near->capacity;
  if (near->full) return;
  near->pair[near->found++] = (msri_pair){(uint32_t)i, (uint32_t)j};
}

msri_three msri_cells_three(const msri_near *near, msri_cell first) {
  const size_t b = msri_cell_bucket(near, first), last = near->buckets,
               over = b + 3 > last ? b + 3 - last : 0;
  return (msri_three){near->bucket[b], near->bucket[b + 3 - over], near->bucket[0],
                      near->bucket[over]};
}

static void look_among(msri_near *near, const msri_search *s, size_t i, uint32_t begin,
                       uint32_t end) {
  const double *x = s->q0, *y = x + near->n, reach2 = s->reach * s->reach;
  for (uint32_t k = begin; k < end; k++) {
    const size_t j = near->sorted[k];
    if ((s->between || j > i) && msri_squared(x[j] - x[i], y[j] - y[i]) <= reach2 &&
        msri_search_wants(s, i, j))
      msri_cells_append(near, i, j);
  }
}

void msri_cells_look_around(msri_near *near, const msri_search *s, size_t i) {
  const msri_cell at = msri_cell_at(s->q0, near->n, i, s->size);
  for (int64_t cy = at.y - 1; cy <= at.y + 1 && !near->full; cy++) {
    const msri_cell first = {at.x - 1, cy};
    const msri_three t = msri_cells_three(near, first);
    look_among(near, s, i, t.begin, t.end);
    look_among(near, s, i, t.begin_again, t.end_again);
  }
}
