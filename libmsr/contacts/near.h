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
  bool full; /* there are more pairs than there is room for */
  size_t n, n_close;
  double skin; /* pairs closer than the diameter and twice this are listed [px] */
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
  msri_pair *close; /* [capacity]; some of them */
  uint32_t *bucket; /* [buckets + 1]: where it begins in sorted */
  uint32_t *sorted; /* [n] */
  uint32_t *set;    /* [n] */
} msri_near;

/* Straight ways from q0 to q. [2n] */
typedef struct msri_ways {
  const double *q0, *q;
} msri_ways;

/* Half of what is left of a square's diagonal, in diameters: with less skin than this a lattice at
 * rest has no pairs. */
static const double msri_near_skin = 0.2;

/* Bytes for so many masses; and the parts of such a block, aligned as malloc's, zeroed at first. */
size_t msri_near_bytes(size_t n);
msri_near msri_near_place(size_t n, double diameter, const msri_ties *ties, void *block);

/* Lists all pairs within reach, masses being at q [2n]: none is missing for straight ways that
 * begin and end within the skin of q. */
void msri_near_list_at(msri_near *near, const double *q, double skin);

/* Chooses from the list those pairs that may meet in ways no longer than `most` from q [2n]. */
void msri_near_choose(msri_near *near, const double *q, double most);

/* Makes a list, which won't last, of those pairs that `meet`, on ways of any length: those shorter
 * than `slow` are found as pairs that rest. */
typedef struct msri_meets {
  bool (*meet)(const void *self, const msri_ways *ways, size_t i, size_t j);
  const void *self;
} msri_meets;
void msri_near_list_ways(msri_near *near, const msri_ways *ways, double slow,
                         const msri_meets *meets);

#endif
