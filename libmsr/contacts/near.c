/* near.c - neighbours by a uniform grid, sorted by counting (Allen & Tildesley 1987, Computer
 * Simulation of Liquids, 5.3: cells and a list with a skin).
 *
 * Cells are hashed into as many buckets as there are masses, so that one mass far away costs no
 * memory: (cx + row cy) mod 2^b keeps neighbouring cells side by side, and tells nine that are
 * around one apart. What else is in their buckets is too far away.
 *
 * Fast ways are sorted into frames: those whose way is near that of one of them are at rest beside
 * it, and are neighbours by the grid; the ways of the others are walked through that grid; then
 * these others are looked at among themselves, in a frame that takes in twice as much. A body that
 * flies is so seen at rest. */
#include "contacts/near.h"

#include <string.h>

/* ---- Memory */

enum { ALIGNMENT = 16, PAIRS_PER_MASS = 8, LEAST_PAIRS = 4096 };

static size_t buckets_for(size_t n) {
  size_t buckets = 16;
  while (buckets < n) buckets *= 2;
  return buckets;
}

/* Reserves a part of the block; `block` may be NULL, to count only. */
static void *part(char *block, size_t *end, size_t bytes) {
  char *const begin = block ? block + *end : NULL;
  *end += (bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
  return begin;
}

static msri_near place(size_t n, char *block, size_t *end) {
  msri_near near = {.n = n, .buckets = buckets_for(n)};
  near.capacity = PAIRS_PER_MASS * n + LEAST_PAIRS;
  near.row = 1;
  while (near.row * near.row < near.buckets) near.row *= 2;
  near.row += 1; // odd: a column of cells goes through all buckets, too
  near.list = part(block, end, sizeof *near.list);
  near.at = part(block, end, 2 * n * sizeof *near.at);
  near.pair = part(block, end, near.capacity * sizeof *near.pair);
  near.close = part(block, end, near.capacity * sizeof *near.close);
  near.bucket = part(block, end, (near.buckets + 1) * sizeof *near.bucket);
  near.sorted = part(block, end, n * sizeof *near.sorted);
  near.set = part(block, end, n * sizeof *near.set);
  return near;
}

size_t msri_near_bytes(size_t n) {
  size_t end = 0;
  place(n, NULL, &end);
  return end;
}

msri_near msri_near_place(size_t n, double diameter, const msri_ties *ties, void *block) {
  size_t end = 0;
  msri_near near = place(n, block, &end);
  near.diameter = diameter;
  near.ties = ties;
  return near;
}

/* ---- Cells */

typedef struct cell {
  int64_t x, y;
} cell;

/* Beyond this cells aren't told apart: what is there is far from everything. */
static const double farthest = 0x1p50;

static int64_t cell_of(double at, double size) {
  const double c = at / size;
  const int64_t whole = (int64_t)(c > -farthest ? c < farthest ? c : farthest : -farthest);
  return whole - (c < (double)whole);
}

static cell cell_at(const double *q, size_t n, size_t i, double size) {
  return (cell){cell_of(q[i], size), cell_of(q[n + i], size)};
}

static size_t bucket_of(const msri_near *near, cell c) {
  return (size_t)((uint64_t)c.x + near->row * (uint64_t)c.y) & (near->buckets - 1);
}

/* Sorts the masses set[0 .. members-1] at q into buckets. */
static void sort(msri_near *near, const double *q, double size, const uint32_t *set,
                 size_t members) {
  uint32_t *const bucket = near->bucket;
  uint32_t sum = 0;
  memset(bucket, 0, (near->buckets + 1) * sizeof *bucket);
  for (size_t k = 0; k < members; k++) bucket[bucket_of(near, cell_at(q, near->n, set[k], size))]++;
  for (size_t b = 0; b <= near->buckets; b++) {
    const uint32_t count = bucket[b];
    bucket[b] = sum;
    sum += count;
  }
  for (size_t k = 0; k < members; k++)
    near->sorted[bucket[bucket_of(near, cell_at(q, near->n, set[k], size))]++] = set[k];
  memmove(bucket + 1, bucket, near->buckets * sizeof *bucket); // each holds where the next begins
  bucket[0] = 0;
}

/* ---- Lists */

static void append(msri_near *near, size_t a, size_t b) {
  const size_t i = a < b ? a : b, j = a < b ? b : a;
  if (msri_ties_tied(near->ties, i, j)) return;
  near->list->full |= near->list->n == near->capacity;
  if (near->list->full) return;
  near->pair[near->list->n++] = (msri_pair){(uint32_t)i, (uint32_t)j};
}

static bool precedes(msri_pair a, msri_pair b) { return a.i != b.i ? a.i < b.i : a.j < b.j; }

/* Puts those from `begin` on in order: a few. */
static void order_few(msri_pair *pair, size_t begin, size_t end) {
  for (size_t k = begin + 1; k < end; k++) {
    const msri_pair moved = pair[k];
    size_t to = k;
    for (; to > begin && precedes(moved, pair[to - 1]); to--) pair[to] = pair[to - 1];
    pair[to] = moved;
  }
}

static double squared(double x, double y) { return x * x + y * y; }

/* Masses of a grid, and how near is near enough. */
typedef struct search {
  const double *q0;
  double size, reach; /* of a cell, of a pair [px] */
  const msri_ways *ways;
  const msri_meets *meets; /* NULL: all within reach */
} search;

static bool wanted(const search *s, size_t i, size_t j) {
  return !s->meets || s->meets->meet(s->meets->self, s->ways, i, j);
}

/* Three cells side by side: buckets b, b + 1 and b + 2, which may go round. */
typedef struct three {
  uint32_t begin, end, begin_again, end_again;
} three;

static three three_from(const msri_near *near, cell first) {
  const size_t b = bucket_of(near, first), last = near->buckets,
               over = b + 3 > last ? b + 3 - last : 0;
  return (three){near->bucket[b], near->bucket[b + 3 - over], near->bucket[0], near->bucket[over]};
}

static void look_among(msri_near *near, const search *s, size_t i, uint32_t begin, uint32_t end) {
  const double *x = s->q0, *y = x + near->n, reach2 = s->reach * s->reach;
  for (uint32_t k = begin; k < end; k++) {
    const size_t j = near->sorted[k];
    if (j > i && squared(x[j] - x[i], y[j] - y[i]) <= reach2 && wanted(s, i, j)) append(near, i, j);
  }
}

/* Appends the pairs of mass i with those of a higher number around it. */
static void look_around(msri_near *near, const search *s, size_t i) {
  const cell at = cell_at(s->q0, near->n, i, s->size);
  for (int64_t cy = at.y - 1; cy <= at.y + 1 && !near->list->full; cy++) {
    const cell first = {at.x - 1, cy};
    const three t = three_from(near, first);
    look_among(near, s, i, t.begin, t.end);
    look_among(near, s, i, t.begin_again, t.end_again);
  }
}

static void begin_list(msri_near *near, double skin) {
  *near->list = (msri_near_list){.skin = skin};
}

void msri_near_list_at(msri_near *near, const double *q, double skin) {
  const double reach = near->diameter + 2 * skin;
  const search s = {.q0 = q, .size = reach, .reach = reach};
  begin_list(near, skin);
  for (size_t i = 0; i < near->n; i++) near->set[i] = (uint32_t)i;
  sort(near, q, s.size, near->set, near->n);
  for (size_t i = 0; i < near->n; i++) {
    const size_t begin = near->list->n;
    look_around(near, &s, i);
    order_few(near->pair, begin, near->list->n);
  }
  memcpy(near->at, q, 2 * near->n * sizeof *q);
  near->list->valid = !near->list->full;
}

void msri_near_choose(msri_near *near, const double *q, double most) {
  const double *x = q, *y = q + near->n, reach = (near->diameter + 2 * most) * (1 + 1e-9);
  size_t n = 0;
  for (size_t k = 0; k < near->list->n; k++) {
    const msri_pair p = near->pair[k];
    near->close[n] = p;
    n += squared(x[p.j] - x[p.i], y[p.j] - y[p.i]) <= reach * reach;
  }
  near->list->n_close = n;
}

/* ---- Fast ways */

/* Masses whose way is within `radius` of (x, y). */
typedef struct frame {
  double x, y, radius;
  double low[2], high[2]; /* where they are, widened by the reach of a walk */
} frame;

static bool rests_in(const frame *f, const msri_ways *w, size_t n, size_t i) {
  const double x = w->q[i] - w->q0[i] - f->x, y = w->q[n + i] - w->q0[n + i] - f->y;
  return squared(x, y) <= f->radius * f->radius;
}

/* Puts those that rest in the frame first, in order. Returns their number. */
static size_t divide(msri_near *near, frame *f, const msri_ways *w, uint32_t *set, size_t members,
                     double reach) {
  size_t rest = 0, others = 0;
  for (int d = 0; d < 2; d++) f->low[d] = (double)INFINITY, f->high[d] = -(double)INFINITY;
  for (size_t k = 0; k < members; k++) {
    const size_t i = set[k];
    if (!rests_in(f, w, near->n, i)) {
      near->sorted[others++] = (uint32_t)i;
      continue;
    }
    set[rest++] = (uint32_t)i;
    for (int d = 0; d < 2; d++) {
      const double at = w->q0[i + (size_t)d * near->n];
      f->low[d] = msri_min(f->low[d], at - reach), f->high[d] = msri_max(f->high[d], at + reach);
    }
  }
  if (others > 0) memcpy(set + rest, near->sorted, others * sizeof *set);
  return rest;
}

/* A way through a frame: p + t u, t from `begin` to `end`, looked at in equal steps. */
typedef struct walk {
  size_t i;
  double p[2], u[2], begin, end, steps;
} walk;

/* Clips the way to where the masses of the frame are; false: it doesn't go there. */
static bool clip(walk *w, const frame *f) {
  for (int d = 0; d < 2; d++) {
    if (w->u[d] == 0) {
      if (w->p[d] < f->low[d] || w->p[d] > f->high[d]) return false;
      continue;
    }
    const double a = (f->low[d] - w->p[d]) / w->u[d], b = (f->high[d] - w->p[d]) / w->u[d];
    w->begin = msri_max(w->begin, msri_min(a, b));
    w->end = msri_min(w->end, msri_max(a, b));
  }
  return w->begin <= w->end;
}

/* Where the way comes closest to a point, as a share of the way. */
static double closest(const walk *w, double x, double y) {
  const double t = ((x - w->p[0]) * w->u[0] + (y - w->p[1]) * w->u[1]) / squared(w->u[0], w->u[1]);
  return msri_min(msri_max(t, w->begin), w->end);
}

/* Which of the walk's steps is nearest. */
static double step_at(const walk *w, double t) {
  return w->steps > 0 ? floor((t - w->begin) / (w->end - w->begin) * w->steps + 0.5) : 0;
}

static void meet_on_way(msri_near *near, const search *s, const walk *w, size_t j, double step) {
  const double x = s->q0[j], y = s->q0[near->n + j], t = closest(w, x, y);
  if (step >= 0 && step_at(w, t) != step) return; // another step sees to it
  const double dx = w->p[0] + t * w->u[0] - x, dy = w->p[1] + t * w->u[1] - y;
  if (!(squared(dx, dy) <= s->reach * s->reach)) return;
  const size_t i = w->i;
  if (i < j ? wanted(s, i, j) : wanted(s, j, i)) append(near, i, j);
}

static void meet_among(msri_near *near, const search *s, const walk *w, double step, uint32_t begin,
                       uint32_t end) {
  for (uint32_t k = begin; k < end; k++) meet_on_way(near, s, w, near->sorted[k], step);
}

/* The nine cells around a step of the walk. */
static void look_from(msri_near *near, const search *s, const walk *w, double step) {
  const double t = w->steps > 0 ? w->begin + (w->end - w->begin) * (step / w->steps) : w->begin;
  const double at[] = {w->p[0] + t * w->u[0], w->p[1] + t * w->u[1]};
  const cell c = cell_at(at, 1, 0, s->size);
  for (int64_t cy = c.y - 1; cy <= c.y + 1; cy++) {
    const cell first = {c.x - 1, cy};
    const three t3 = three_from(near, first);
    meet_among(near, s, w, step, t3.begin, t3.end);
    meet_among(near, s, w, step, t3.begin_again, t3.end_again);
  }
}

/* Appends the pairs of a mass that passes through a frame; where its way has more cells than the
 * frame has masses, `rest` of them, it looks at each of these. */
static void walk_through(msri_near *near, const search *s, const frame *f, size_t i,
                         const uint32_t *set, size_t rest) {
  const size_t n = near->n;
  const double *q0 = s->ways->q0, *q = s->ways->q;
  walk w = {.i = i, .p = {q0[i], q0[n + i]}, .end = 1};
  w.u[0] = q[i] - q0[i] - f->x, w.u[1] = q[n + i] - q0[n + i] - f->y;
  if (!clip(&w, f)) return;
  const double length = (w.end - w.begin) * msri_max(fabs(w.u[0]), fabs(w.u[1]));
  w.steps = ceil(length / s->size);
  if (!(w.steps < (double)rest)) {
    for (size_t k = 0; k < rest; k++) meet_on_way(near, s, &w, set[k], -1);
    return;
  }
  for (double step = 0; step <= w.steps && !near->list->full; step++) look_from(near, s, &w, step);
}

/* Looks at those that rest in a frame among themselves, and at all others on their way through it.
 * Returns how many rest. */
static size_t look_in(msri_near *near, frame *f, const msri_ways *ways, const msri_meets *meets,
                      uint32_t *set, size_t members) {
  const double reach = near->diameter + f->radius;
  const size_t rest = divide(near, f, ways, set, members, reach);
  const search still = {ways->q0, 2 * reach, near->diameter + 2 * f->radius, ways, meets};
  const search passing = {ways->q0, 2 * reach, reach, ways, meets};
  sort(near, ways->q0, still.size, set, rest);
  for (size_t k = 0; k < rest; k++) look_around(near, &still, set[k]);
  for (size_t k = rest; k < members; k++) walk_through(near, &passing, f, set[k], set, rest);
  return rest;
}

/* ---- Order */

static void sink(msri_pair *heap, size_t n, size_t at) {
  for (size_t child; (child = 2 * at + 1) < n; at = child) {
    if (child + 1 < n && precedes(heap[child], heap[child + 1])) child++;
    if (!precedes(heap[at], heap[child])) return;
    const msri_pair swap = heap[at];
    heap[at] = heap[child], heap[child] = swap;
  }
}

static void order(msri_pair *pair, size_t n) {
  for (size_t at = n / 2; at-- > 0;) sink(pair, n, at);
  for (size_t left = n; left-- > 1;) {
    const msri_pair swap = pair[0];
    pair[0] = pair[left], pair[left] = swap;
    sink(pair, left, 0);
  }
}

static bool is_finite(const msri_ways *w, size_t n, size_t i) {
  return isfinite(w->q[i] - w->q0[i]) && isfinite(w->q[n + i] - w->q0[n + i]);
}

void msri_near_list_ways(msri_near *near, const msri_ways *ways, double slow,
                         const msri_meets *meets) {
  const size_t n = near->n;
  uint32_t *set = near->set;
  size_t members = 0;
  for (size_t i = 0; i < n; i++)
    if (is_finite(ways, n, i)) set[members++] = (uint32_t)i;
  begin_list(near, 0);
  frame f = {.radius = slow};
  while (members > 0) {
    const size_t rest = look_in(near, &f, ways, meets, set, members);
    set += rest, members -= rest;
    if (members == 0) break;
    const size_t i = set[members / 2];
    f.x = ways->q[i] - ways->q0[i], f.y = ways->q[n + i] - ways->q0[n + i];
    f.radius *= 2;
  }
  order(near->pair, near->list->n);
}
