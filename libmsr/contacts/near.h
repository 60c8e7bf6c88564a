/* near.h - which masses may meet as discs of one diameter: O(N) searches over memory that is the
 * state's. Pairs tied by a spring never count. */
#ifndef MSRI_NEAR_H
#define MSRI_NEAR_H

#include "base/base.h"
#include "contacts/ties.h"

#include <math.h>

typedef struct msri_pair {
  uint32_t i, j; /* i < j */
} msri_pair;

/* What is kept from one step to the next: the pairs within reach of each other where masses were
 * when they were listed. */
typedef struct msri_near_list {
  bool valid;
  size_t n;
} msri_near_list;

typedef struct msri_near {
  size_t n; /* masses */
  double diameter;
  const msri_ties *ties;
  size_t buckets;  /* a power of 2 */
  size_t row;      /* how far the bucket of the cell above is */
  size_t capacity; /* of pairs */
  msri_near_list *list;
  double *at;       /* [2n]: where masses were */
  msri_pair *pair;  /* [capacity]; in ascending order */
  uint32_t *bucket; /* [buckets + 1]: where it begins in sorted */
  uint32_t *sorted; /* [n] */
  uint32_t *set;    /* [n] */
} msri_near;

/* Straight ways from q0 to q. [2n] */
typedef struct msri_ways {
  const double *q0, *q;
} msri_ways;

/* The list is of pairs closer than 1 + 2 `msri_near_skin` diameters: less than a square's diagonal,
 * so that a lattice at rest has none. A mass that moves further in a step than `msri_near_slow` is
 * searched for along its way. In diameters. */
static const double msri_near_skin = 0.2, msri_near_slow = 0.1;

/* Bytes for so many masses; and the parts of such a block, aligned as malloc's, zeroed at first. */
size_t msri_near_bytes(size_t n);
msri_near msri_near_place(size_t n, double diameter, const msri_ties *ties, void *block);

/* Lists all pairs within reach, masses being at q [2n]. */
void msri_near_list_at(msri_near *near, const double *q);

/* Makes a list, which won't last, of those pairs on fast ways that `meet`. */
typedef struct msri_meets {
  bool (*meet)(const void *self, const msri_ways *ways, size_t i, size_t j);
  const void *self;
} msri_meets;
void msri_near_list_ways(msri_near *near, const msri_ways *ways, const msri_meets *meets);

#endif
