/* near.h - which of some masses may meet as discs of one diameter: O(N) searches over memory that
 * is the state's. Pairs tied by a spring never count. */
#ifndef MSRI_NEAR_H
#define MSRI_NEAR_H

#include "base/base.h"
#include "contacts/ties.h"

#include <math.h>

typedef struct msri_pair {
  uint32_t i, j; /* i < j */
} msri_pair;

/* A search, and its memory. */
typedef struct msri_near {
  size_t n; /* masses */
  double diameter;
  const msri_ties *ties;
  size_t capacity;  /* of pairs */
  size_t found;     /* pairs */
  bool full;        /* there are more of them than there is room for */
  size_t buckets;   /* in use, a power of 2 */
  size_t row;       /* how far the bucket of the cell above is */
  msri_pair *pair;  /* [capacity]: those found */
  uint32_t *bucket; /* [2 n + 17]: where it begins in sorted */
  uint32_t *sorted; /* [n] */
  uint32_t *set;    /* [n]: for the caller */
} msri_near;

/* Straight paths from q0 to q. [2n] */
typedef struct msri_paths {
  const double *q0, *q;
} msri_paths;

/* Reserves an aligned part of a block; `block` may be NULL, to count only. */
void *msri_near_part(char *block, size_t *end, size_t bytes);

/* The parts of a block from *end on, which becomes what is after them. */
msri_near msri_near_place(size_t n, double diameter, const msri_ties *ties, char *block,
                          size_t *end);

/* Lists all pairs of set[members], ascending, that are within `reach` of each other at q [2n]. */
void msri_near_list_at(msri_near *near, const double *q, double reach, const uint32_t *set,
                       size_t members);

/* Lists all pairs of one mass of a and one of b, in no order. */
void msri_near_list_between(msri_near *near, const double *q, double reach, const uint32_t *a,
                            size_t n_a, const uint32_t *b, size_t n_b);

/* Lists those pairs that `meet`, on paths of any length, of set[members], in no order: those
 * shorter than `slow` are found as pairs that rest. Masses whose path isn't finite are left out;
 * what is in the set afterwards is undefined. */
typedef struct msri_meets {
  bool (*meet)(const void *self, const msri_paths *paths, size_t i, size_t j);
  const void *self;
} msri_meets;
void msri_near_list_paths(msri_near *near, const msri_paths *paths, double slow,
                          const msri_meets *meets, uint32_t *set, size_t members);

/* Puts pairs in ascending order; room [n] is for use. */
void msri_near_order(msri_pair *pair, size_t n, msri_pair *room);

#endif
