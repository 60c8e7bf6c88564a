/* strips.h - what goes through the graph block by block: the masses and strips of a block, and
 * where L of a strip lies. */
#ifndef MSRI_STRIPS_H
#define MSRI_STRIPS_H

#include "base/machine.h"
#include "solvers/stiffness.h"

/* A block of masses, first .. first + count - 1, and its strips. */
typedef struct part {
  size_t first, count, pair;
  const msri_strip *strip, *end;
} part;

MSRI_INLINE part part_of(const msri_graph *g, size_t b) {
  const msri_block_end none = {0}, before = b > 0 ? g->block[b - 1] : none, to = g->block[b];
  return (part){before.mass, to.mass - before.mass, before.pair, g->strip + before.strip,
                g->strip + to.strip};
}

/* L of a strip's pairs: [count] each, one after the other, all in one stream of memory. */
typedef struct lowers {
  float *xx, *xy, *yx, *yy;
} lowers;

MSRI_INLINE lowers lowers_of(const msri_stiffness *a, size_t pair, size_t count) {
  float *xx = a->lower + 4 * pair;
  return (lowers){xx, xx + count, xx + 2 * count, xx + 3 * count};
}

#endif
