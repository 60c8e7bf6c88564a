/* pairs.h - the pairs of masses that springs tie, in the order of the masses. */
#ifndef MSRI_PAIRS_H
#define MSRI_PAIRS_H

#include "base/base.h"

/* Pairs p = begin[i] .. begin[i+1]-1 are those of mass i, with j = end[p] > i rising; spring s,
 * counted along the runs, belongs to pair pair[s]. */
typedef struct msri_pairs {
  size_t n, count;
  uint32_t *begin, *end, *pair; /* [n+1], [count], [springs] */
} msri_pairs;

/* Words of memory that they take, and that sorting takes beside. */
static inline size_t msri_pairs_words(size_t n, size_t springs) { return n + 1 + 2 * springs; }
static inline size_t msri_pairs_desk(size_t n, size_t springs) { return n + 1 + 4 * springs; }

/* Of n masses, in memory of that size, by a desk of that size. */
msri_pairs msri_pairs_sort(size_t n, const msr_springs *springs, uint32_t *memory, uint32_t *desk);

#endif
