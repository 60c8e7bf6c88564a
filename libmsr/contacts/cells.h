/* cells.h - a uniform grid of cells, hashed into buckets, and the search of neighbours in it; for
 * near.c and near_paths.c. */
#ifndef MSRI_CELLS_H
#define MSRI_CELLS_H

#include "contacts/near.h"

typedef struct msri_cell {
  int64_t x, y;
} msri_cell;

/* That of mass i at q [2n], cells being of this size. */
msri_cell msri_cell_at(const double *q, size_t n, size_t i, double size);

/* Masses of a grid, and how near is near enough. */
typedef struct msri_search {
  const double *q0;
  double size, reach; /* of a cell, of a pair [px] */
  bool between;       /* of two sets: of a pair either may be the one sorted */
  const msri_paths *paths;
  const msri_meets *meets; /* NULL: all within reach */
} msri_search;

static inline double msri_squared(double x, double y) { return x * x + y * y; }

static inline bool msri_search_wants(const msri_search *s, size_t i, size_t j) {
  return !s->meets || s->meets->meet(s->meets->self, s->paths, i, j);
}

static inline bool msri_pair_precedes(msri_pair a, msri_pair b) {
  return a.i != b.i ? a.i < b.i : a.j < b.j;
}

/* Three cells side by side: buckets b, b + 1 and b + 2, which may go round. */
typedef struct msri_three {
  uint32_t begin, end, begin_again, end_again;
} msri_three;

msri_three msri_cells_three(const msri_near *near, msri_cell first);

/* Sorts the masses set[0 .. members-1] at q into buckets, as many as there are such masses or more.
 */
void msri_cells_sort(msri_near *near, const double *q, double size, const uint32_t *set,
                     size_t members);

/* Appends the pair, if it isn't tied, to the list. */
void msri_cells_append(msri_near *near, size_t a, size_t b);

/* Appends the pairs of mass i with those around it that were sorted: of a higher number only, if
 * not `between`. */
void msri_cells_look_around(msri_near *near, const msri_search *s, size_t i);

#endif
