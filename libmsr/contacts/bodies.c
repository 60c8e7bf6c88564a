/* bodies.c - bodies by union and find: a tree for each, the root being its first mass. */
#include "contacts/bodies.h"

#include "base/trees.h"

#include <stdlib.h>

enum { FEW = 16 };

static const uint32_t none = UINT32_MAX;

/* ---- Trees */

static void grow_trees(size_t n, const msri_ties *ties, uint32_t *parent) {
  msri_trees_plant(n, parent);
  for (size_t i = 0; i < n; i++)
    for (size_t p = ties->first[i]; p < ties->first[i + 1]; p++)
      msri_trees_join(parent, (uint32_t)i, ties->partner[p]);
}

/* of[i]: the root of i becomes the number of its body. `number` [n] is zeroed at first. */
static size_t count_bodies(size_t n, uint32_t *of, uint32_t *number) {
  uint32_t bodies = 0, rest = none;
  for (size_t i = 0; i < n; i++) of[i] = msri_trees_root(of, (uint32_t)i), number[of[i]]++;
  for (size_t i = 0; i < n; i++) {
    if (of[i] != i) continue;
    const bool few = number[i] < FEW;
    if (few && rest == none) rest = bodies++;
    number[i] = few ? rest : bodies++;
  }
  for (size_t i = 0; i < n; i++) of[i] = number[of[i]];
  return bodies;
}

/* ---- Stretches */

static bool begins(const uint32_t *of, size_t i) { return i == 0 || of[i] != of[i - 1]; }

/* `first` has room for n + 2, zeroed: counted one body further, it is the end of each once filled.
 */
static void fill(msri_bodies *b) {
  size_t *const next = b->first + 1;
  for (size_t i = 0; i < b->n_masses; i++)
    if (begins(b->of, i)) next[b->of[i] + 1]++;
  for (size_t k = 0; k < b->n; k++) next[k + 1] += next[k];
  for (size_t i = 0, end; i < b->n_masses; i = end) {
    for (end = i + 1; end < b->n_masses && !begins(b->of, end);) end++;
    b->stretch[next[b->of[i]]++] = (msri_stretch){i, end};
  }
}

size_t msri_bodies_masses(const msri_bodies *bodies, size_t body, uint32_t *set) {
  size_t n = 0;
  for (size_t s = bodies->first[body]; s < bodies->first[body + 1]; s++)
    for (size_t i = bodies->stretch[s].begin; i < bodies->stretch[s].end; i++)
      set[n++] = (uint32_t)i;
  return n;
}

size_t msri_bodies_bytes(const msri_bodies *b) {
  return b->n_masses * sizeof *b->of + (b->n + 2) * sizeof *b->first +
         b->first[b->n] * sizeof *b->stretch;
}

/* ---- Creation */

static msr_status allocate(msri_bodies *b, msr_error *err) {
  size_t stretches = 0;
  for (size_t i = 0; i < b->n_masses; i++) stretches += begins(b->of, i);
  b->first = msri_alloc(b->n + 2, sizeof *b->first, "collisions", err);
  b->stretch = msri_alloc(stretches, sizeof *b->stretch, "collisions", err);
  return b->first && b->stretch ? MSR_OK : MSR_ENOMEM;
}

msr_status msri_bodies_create(size_t n_masses, const msri_ties *ties, msri_bodies *bodies,
                              msr_error *err) {
  uint32_t *of = msri_alloc(n_masses, sizeof *of, "collisions", err);
  uint32_t *number = msri_alloc(n_masses, sizeof *number, "collisions", err);
  *bodies = (msri_bodies){.n_masses = n_masses, .of = of};
  msr_status status = of && number ? MSR_OK : MSR_ENOMEM;
  if (status == MSR_OK) {
    grow_trees(n_masses, ties, of);
    bodies->n = count_bodies(n_masses, of, number);
    status = allocate(bodies, err);
  }
  free(number);
  if (status == MSR_OK)
    fill(bodies);
  else
    msri_bodies_clear(bodies);
  return status;
}

void msri_bodies_clear(msri_bodies *bodies) {
  free(bodies->of);
  free(bodies->first);
  free(bodies->stretch);
  *bodies = (msri_bodies){0};
}
