/* graph.h - which masses are tied by springs: the pattern of a matrix of 2 x 2 blocks. */
#ifndef MSRI_GRAPH_H
#define MSRI_GRAPH_H

#include "base/base.h"

/* The pairs i < j of masses that runs of springs tie, in one block of memory that free takes. Pairs
 * p = begin[i] .. begin[i+1]-1 are those of mass i, with j = end[p] rising; spring s, counted along
 * the runs, belongs to pair pair[s]. */
typedef struct msri_graph {
  size_t n, pairs, bytes;       /* n: masses; bytes: of this block */
  uint32_t *begin, *end, *pair; /* [n+1], [pairs], [springs] */
} msri_graph;

/* MSR_EUSAGE if there are UINT32_MAX masses or springs or more, MSR_ENOMEM. */
msr_status msri_graph_create(size_t n, const msr_springs *springs, msri_graph **graph,
                             msr_error *err);

#endif
