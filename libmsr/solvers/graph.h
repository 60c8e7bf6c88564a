/* graph.h - which masses are tied by springs: the pattern of a matrix of 2 x 2 blocks. */
#ifndef MSRI_GRAPH_H
#define MSRI_GRAPH_H

#include "base/base.h"

/* Pairs that lie side by side: masses first + s and second + s, s < count; so do their numbers,
 * those of all strips before them coming first. */
typedef struct msri_strip {
  uint32_t first, second, count;
} msri_strip;

/* Masses of which no two are tied, and the strips that begin there: each up to the ends given. */
typedef struct msri_block_end {
  uint32_t mass, strip, pair;
} msri_block_end;

enum { MSRI_GRAPH_BLOCK = 128 }; /* masses of a block, at most */

/* The pairs of masses that runs of springs tie, in one block of memory that free takes.
 *
 * Masses have an order of their own here: the i-th is order[i]. Windows of some rows of a picture
 * stay together, but in each of them masses are sorted by how many of its masses come before, one
 * tied to the other; where i < j are tied, i comes before j still. So blocks of masses don't
 * depend on each other, and of a picture their pairs are strips: what goes through masses one after
 * the other does so by vectors. Where strips would be too short for that the order is the masses'
 * own, each strip is one pair, and masses of a block may be tied: `single`. Spring s, counted along
 * the runs, belongs to pair pair[s]. */
typedef struct msri_graph {
  size_t n, pairs, blocks, strips, bytes; /* n: masses; bytes: of this block of memory */
  size_t reach;                           /* the largest distance of a pair in that order */
  uint32_t *order, *pair;                 /* [n], [springs] */
  msri_block_end *block;                  /* [blocks] */
  msri_strip *strip;                      /* [strips] */
  bool single;
} msri_graph;

/* MSR_EUSAGE if there are UINT32_MAX masses or springs or more, MSR_ENOMEM. */
msr_status msri_graph_create(size_t n, const msr_springs *springs, msri_graph **graph,
                             msr_error *err);

#endif
