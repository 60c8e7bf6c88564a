/* trees.h - union and find: each set is a tree, parent [n], whose root is its least member and its
 * own parent (Galler & Fischer 1964, An improved equivalence algorithm); trees get flatter as they
 * are climbed (Tarjan & van Leeuwen 1984, J. ACM 31, 245: halving). */
#ifndef MSRI_TREES_H
#define MSRI_TREES_H

#include <stddef.h>
#include <stdint.h>

/* Each by itself. */
static inline void msri_trees_plant(size_t n, uint32_t *parent) {
  for (size_t i = 0; i < n; i++) parent[i] = (uint32_t)i;
}

static inline uint32_t msri_trees_root(uint32_t *parent, uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

static inline void msri_trees_join(uint32_t *parent, uint32_t i, uint32_t j) {
  const uint32_t a = msri_trees_root(parent, i), b = msri_trees_root(parent, j);
  parent[a > b ? a : b] = a > b ? b : a;
}

#endif
