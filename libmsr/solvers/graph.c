/* graph.c - the order in which masses are eliminated, and their pairs as strips of it, in time and
 * memory proportional to masses and springs. Sets of equations that don't depend on each other, by
 * longest ways: Anderson & Saad 1989, Int. J. High Speed Comput. 1, 73; here in windows, so that
 * what is near in memory stays so. */
#include "solvers/graph.h"

#include "solvers/pairs.h"

#include <stdlib.h>
#include <string.h>

/* Of a window: so many rows of a picture, but not more masses than that. */
enum { ROWS = 32, FEWEST = 1024, MOST = 131072 };

enum { WORTHWHILE = 8 }; /* pairs of a strip, on average: measured */

static const uint32_t NONE = UINT32_MAX; /* no pair or strip */

/* What is made on the way; [n] each but for `slot`, [pairs]. */
typedef struct desk {
  msri_pairs pairs;
  uint32_t *level, *place; /* of each mass: see climb(); its number in the order */
  uint32_t *count;         /* of masses by level, or where they go */
  uint32_t *slot;          /* of each pair: its number in the strips */
} desk;

static size_t window_of(const msri_pairs *pairs) {
  size_t reach = 0;
  for (size_t i = 0; i < pairs->n; i++) /* ends rise: the last one is the farthest */
    if (pairs->begin[i + 1] > pairs->begin[i] && pairs->end[pairs->begin[i + 1] - 1] - i > reach)
      reach = pairs->end[pairs->begin[i + 1] - 1] - i;
  if (reach > MOST / ROWS) return MOST;
  return ROWS * reach < FEWEST ? FEWEST : ROWS * reach;
}

/* level[i]: the longest way to mass i through lower ones of its window; then as high as those above
 * allow, so that holes don't make levels of their own. Returns the highest. */
static uint32_t climb(const msri_pairs *pairs, size_t from, size_t to, uint32_t *level) {
  uint32_t highest = 0;
  memset(level + from, 0, (to - from) * sizeof *level);
  for (size_t i = from; i < to; i++) {
    highest = level[i] > highest ? level[i] : highest;
    for (size_t p = pairs->begin[i]; p < pairs->begin[i + 1]; p++) {
      const size_t j = pairs->end[p];
      if (j < to && level[j] <= level[i]) level[j] = level[i] + 1;
    }
  }
  for (size_t i = to; i-- > from;) {
    uint32_t next = UINT32_MAX;
    for (size_t p = pairs->begin[i]; p < pairs->begin[i + 1] && pairs->end[p] < to; p++)
      next = level[pairs->end[p]] < next ? level[pairs->end[p]] : next;
    if (next < UINT32_MAX) level[i] = next - 1;
  }
  return highest;
}

/* Sorts a window by level: a stable counting sort. */
static void arrange(msri_graph *g, const desk *d, size_t from, size_t to) {
  const uint32_t highest = climb(&d->pairs, from, to, d->level);
  memset(d->count, 0, (highest + 1) * sizeof *d->count);
  for (size_t i = from; i < to; i++) d->count[d->level[i]]++;
  uint32_t at = (uint32_t)from;
  for (uint32_t l = 0; l <= highest; l++) {
    const uint32_t masses = d->count[l];
    d->count[l] = at;
    at += masses;
  }
  for (size_t i = from; i < to; i++) {
    d->place[i] = d->count[d->level[i]]++;
    g->order[d->place[i]] = (uint32_t)i;
  }
}

/* The end of the block that begins at a mass, within its window. */
static size_t end_of_block(const msri_graph *g, const desk *d, size_t from, size_t to) {
  const uint32_t level = d->level[g->order[from]];
  size_t i = from;
  while (i < to && i - from < MSRI_GRAPH_BLOCK && d->level[g->order[i]] == level) i++;
  return i;
}

/* The pair of mass i with the one that is `second` in the order, if it belongs to no strip yet, or
 * NONE. */
static uint32_t pair_with(const msri_graph *g, const desk *d, size_t i, size_t second) {
  const uint32_t mass = g->order[i];
  for (uint32_t p = d->pairs.begin[mass]; p < d->pairs.begin[mass + 1]; p++)
    if (d->slot[p] == NONE && d->place[d->pairs.end[p]] == second) return p;
  return NONE;
}

/* A strip from pair p of mass i on, as long as there are pairs, up to the end of the block. */
static void add_strip(msri_graph *g, const desk *d, uint32_t p, size_t i, size_t end) {
  const uint32_t first = (uint32_t)i, second = d->place[d->pairs.end[p]];
  if (second - first > g->reach) g->reach = second - first;
  for (; p != NONE; p = ++i < end ? pair_with(g, d, i, second + (i - first)) : NONE)
    d->slot[p] = (uint32_t)g->pairs++;
  g->strip[g->strips++] = (msri_strip){first, second, (uint32_t)i - first};
}

/* The strips of a block. */
static void add_strips(msri_graph *g, const desk *d, size_t from, size_t to) {
  for (size_t i = from; i < to; i++) {
    const uint32_t mass = g->order[i];
    for (uint32_t p = d->pairs.begin[mass]; p < d->pairs.begin[mass + 1]; p++)
      if (d->slot[p] == NONE) add_strip(g, d, p, i, to);
  }
  g->block[g->blocks++] = (msri_block_end){(uint32_t)to, (uint32_t)g->strips, (uint32_t)g->pairs};
}

static void make_strips(msri_graph *g, const desk *d) {
  const size_t window = window_of(&d->pairs);
  for (size_t p = 0; p < d->pairs.count; p++) d->slot[p] = NONE;
  for (size_t from = 0; from < g->n; from += window) {
    const size_t to = g->n - from < window ? g->n : from + window;
    arrange(g, d, from, to);
  }
  for (size_t from = 0; from < g->n; from += window) {
    const size_t to = g->n - from < window ? g->n : from + window;
    for (size_t i = from, end; i < to; i = end) {
      end = end_of_block(g, d, i, to);
      add_strips(g, d, i, end);
    }
  }
}

/* Pairs one by one, as they are. */
static void make_singles(msri_graph *g, const desk *d) {
  g->single = true;
  g->blocks = g->reach = 0;
  g->strips = g->pairs;
  for (uint32_t i = 0; i < g->n; i++) {
    g->order[i] = i;
    for (uint32_t p = d->pairs.begin[i]; p < d->pairs.begin[i + 1]; p++) {
      d->slot[p] = p;
      g->strip[p] = (msri_strip){i, d->pairs.end[p], 1};
      if (d->pairs.end[p] - i > g->reach) g->reach = d->pairs.end[p] - i;
    }
    if ((i + 1) % MSRI_GRAPH_BLOCK > 0 && i + 1 < g->n) continue;
    const uint32_t pairs = d->pairs.begin[i + 1];
    g->block[g->blocks++] = (msri_block_end){i + 1, pairs, pairs};
  }
}

static void fill(msri_graph *g, size_t springs, const desk *d) {
  make_strips(g, d);
  if (g->pairs < WORTHWHILE * g->strips) make_singles(g, d);
  for (size_t s = 0; s < springs; s++) g->pair[s] = d->slot[g->pair[s]];
}

/* In one block of memory, of what there is. */
static msri_graph *copy_of(const msri_graph *g, size_t springs, msr_error *err) {
  const size_t blocks = g->blocks * sizeof *g->block, strips = g->strips * sizeof *g->strip;
  const size_t bytes = sizeof *g + blocks + strips + (g->n + springs) * sizeof *g->order;
  msri_graph *made = msri_alloc(1, bytes, "the springs", err);
  if (!made) return NULL;
  *made = *g;
  made->bytes = bytes;
  made->block = (void *)(made + 1);
  made->strip = (void *)(made->block + g->blocks);
  made->order = (void *)(made->strip + g->strips);
  made->pair = made->order + g->n;
  memcpy(made->block, g->block, blocks);
  memcpy(made->strip, g->strip, strips);
  memcpy(made->order, g->order, g->n * sizeof *g->order);
  memcpy(made->pair, g->pair, springs * sizeof *g->pair);
  return made;
}

/* Takes `words` of the memory. */
static void *take(uint32_t **memory, size_t words) {
  uint32_t *taken = *memory;
  *memory += words;
  return taken;
}

msr_status msri_graph_create(size_t n, const msr_springs *springs, msri_graph **graph,
                             msr_error *err) {
  const size_t m = springs->n;
  if (n >= UINT32_MAX || m >= UINT32_MAX)
    return msri_fail(err, MSR_EUSAGE,
                     "%zu masses and %zu springs are too many for an implicit integrator", n, m);
  const size_t sorting = msri_pairs_words(n, m) + msri_pairs_desk(n, m);
  uint32_t *memory = msri_alloc(sorting + 7 * n + 4 * m, sizeof *memory, "the springs", err);
  if (!memory) return MSR_ENOMEM;
  uint32_t *rest = memory;
  uint32_t *pairs = take(&rest, msri_pairs_words(n, m));
  desk d = {.pairs = msri_pairs_sort(n, springs, pairs, take(&rest, msri_pairs_desk(n, m)))};
  d.level = take(&rest, n);
  d.place = take(&rest, n);
  d.count = take(&rest, n);
  d.slot = take(&rest, m);
  msri_graph g = {.n = n, .order = take(&rest, n), .pair = d.pairs.pair};
  g.block = take(&rest, 3 * n);
  g.strip = take(&rest, 3 * m);
  fill(&g, m, &d);
  msri_graph *made = copy_of(&g, m, err);
  free(memory);
  if (!made) return MSR_ENOMEM;
  *graph = made;
  return MSR_OK;
}
