/* limit.c - the stripped kernel on all rows, with one thread or several, one step per pass over the
 * rows or several (temporal blocking): what memory has to move is then moved once for many steps.
 *
 * In a pass stage s steps row R - s right after stage s - 1 has stepped row R - s + 1. Bands are
 * those of threads: stage s of band b takes rows from[b] + s .. from[b + 1] + s - 1, so that a band
 * needs of the next one but the forces at the edge between them, which the next computes as it
 * opens its stages. Two flags a band are all that is waited for. */
#include "limit_kernel.h"
#include "speed.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_STAGES = 16, PATIENCE = 4096 };

/* Counts of passes; apart, so that they don't share a line of the cache. */
typedef struct flags {
  _Atomic size_t opened; /* in so many all edges were known, */
  char between[128];
  _Atomic size_t done; /* in so many all rows were stepped */
  char after[128];
} flags;

typedef struct limit_run {
  const limit_kernel *kernel;
  lattice g;
  size_t stages, threads, from[MOST_THREADS + 1];
  forces carried[MOST_THREADS][MOST_STAGES], edge[MOST_THREADS][MOST_STAGES];
  flags flag[MOST_THREADS];
  double *block;
  size_t steps; /* of this run */
} limit_run;

typedef struct band {
  limit_run *r;
  size_t b, stages, pass;
} band;

/* Whoever is waited for may not be running at all: others use the machine, too. */
static void wait_for(_Atomic size_t *count, size_t least) {
  for (int i = 0; atomic_load_explicit(count, memory_order_acquire) < least; i++)
    if (i >= PATIENCE) sched_yield();
}

/* ---- A pass over a band */

static void open_stage(const band *d, size_t s, size_t row) {
  const limit_run *r = d->r;
  const size_t bytes = r->g.pitch * sizeof(double);
  const forces f = r->carried[d->b][s], e = r->edge[d->b][s];
  if (row == 0) {
    memset(f.x, 0, bytes), memset(f.y, 0, bytes);
    return;
  }
  r->kernel->edge(&r->g, row - 1, e);
  memcpy(f.x, e.x, bytes), memcpy(f.y, e.y, bytes);
}

static void step_stage(const band *d, size_t s, size_t row) {
  const limit_run *r = d->r;
  const bool last = d->b + 1 == r->threads;
  const size_t from = d->b > 0 ? r->from[d->b] + s : 0;
  const size_t to = last ? r->g.rows : r->from[d->b + 1] + s;
  if (row >= to) return;
  if (row == from) open_stage(d, s, row);
  const bool known = !last && row + 1 == to;
  r->kernel->step(&r->g, row, r->carried[d->b][s], known ? &r->edge[d->b + 1][s] : NULL);
}

static void pass_over(const band *d) {
  limit_run *r = d->r;
  const bool first = d->b == 0, last = d->b + 1 == r->threads;
  const size_t from = r->from[d->b], to = r->from[d->b + 1];
  const size_t lag = first ? 1 : 2, opening = from + 2 * (d->stages - 1);
  const size_t end = last ? to + d->stages - 1 : to + 2 * d->stages - 1;
  for (size_t head = from; head < end; head++) {
    if (!last && head + 1 == to) wait_for(&r->flag[d->b + 1].opened, d->pass + 1);
    for (size_t s = 0; s < d->stages && head >= from + lag * s; s++) step_stage(d, s, head - s);
    if (!first && head == opening)
      atomic_store_explicit(&r->flag[d->b].opened, d->pass + 1, memory_order_release);
  }
}

static void *step_band(void *arg) {
  band d = *(band *)arg;
  limit_run *r = d.r;
  for (size_t left = r->steps; left > 0; left -= d.stages, d.pass++) {
    d.stages = left < r->stages ? left : r->stages;
    if (d.b > 0) wait_for(&r->flag[d.b - 1].done, d.pass);
    if (d.b + 1 < r->threads) wait_for(&r->flag[d.b + 1].done, d.pass);
    pass_over(&d);
    atomic_store_explicit(&r->flag[d.b].done, d.pass + 1, memory_order_release);
  }
  return NULL;
}

/* ---- As a contestant */

static forces carve(limit_run *r, double **at) {
  const forces f = {*at, *at + r->g.pitch};
  *at += 2 * r->g.pitch;
  return f;
}

/* The skew gives the first band more: its edge is that much lower. */
static void share_out(limit_run *r) {
  for (size_t b = 1; b < r->threads; b++)
    r->from[b] = b * r->g.rows / r->threads - (r->stages - 1) / 2;
  r->from[r->threads] = r->g.rows;
}

static size_t carve_all(limit_run *r) {
  const size_t plane = (r->g.rows + 1) * r->g.pitch;
  const size_t count = 4 * plane + 4 * r->threads * r->stages * r->g.pitch;
  r->block = aligned_alloc(64, (count * sizeof(double) + 63) / 64 * 64);
  if (!r->block) bench_fail("there is no memory");
  memset(r->block, 0, count * sizeof(double));
  double *at = r->block + 4 * plane;
  r->g.x = r->block, r->g.y = r->g.x + plane, r->g.u = r->g.y + plane, r->g.v = r->g.u + plane;
  for (size_t b = 0; b < r->threads; b++)
    for (size_t s = 0; s < r->stages; s++) {
      r->carried[b][s] = carve(r, &at);
      r->edge[b][s] = carve(r, &at);
    }
  return count * sizeof(double);
}

/* What is beside and below the masses is far enough away that nothing overflows. */
static void fill(limit_run *r, const work *w) {
  for (size_t i = 0; i < (r->g.rows + 1) * r->g.pitch; i++) {
    const size_t c = i % r->g.pitch, row = i / r->g.pitch, from = row * w->width + c;
    const bool is_mass = c < w->width && row < w->height;
    r->g.x[i] = is_mass ? w->x[from] : (double)c;
    r->g.y[i] = is_mass ? w->y[from] : -(double)row;
    r->g.u[i] = is_mass ? w->u[from] : 0;
    r->g.v[i] = is_mass ? w->v[from] : 0;
  }
}

/* For pictures with holes, on the block around them. */
static entry open_limit(const contestant *c, const work *w, int threads) {
  if (!w->drawn) return (entry){.missing = "the kernel is for pictures"};
  limit_run *r = need(2, sizeof *r);
  work block = w->full ? *w : work_drawn("", w->width, draw_block);
  r->kernel = limit_kernel_here();
  r->g = (lattice){.n = w->width, .rows = w->height, .pitch = (w->width + 7) / 8 * 8 + 8};
  r->stages = (size_t)c->parameter;
  r->threads = (size_t)threads;
  share_out(r);
  const size_t bytes = carve_all(r);
  fill(r, &block);
  const entry e = {r, block.n_springs, (double)bytes, w->full, NULL};
  if (!w->full) work_free(&block);
  return e;
}

static double run_limit(void *self, size_t steps) {
  limit_run *r = self;
  pthread_t other[MOST_THREADS];
  band bands[MOST_THREADS];
  r->steps = steps;
  memset(r->flag, 0, sizeof r->flag);
  const double begin = seconds_now();
  for (size_t b = r->threads; b-- > 0;) {
    bands[b] = (band){.r = r, .b = b};
    if (b == 0)
      step_band(&bands[0]);
    else if (pthread_create(&other[b], NULL, step_band, &bands[b]) != 0)
      bench_fail("there is no thread");
  }
  for (size_t b = 1; b < r->threads; b++) pthread_join(other[b], NULL);
  return seconds_now() - begin;
}

static void read_limit(void *self, double *x, double *y) {
  const limit_run *r = self;
  for (size_t row = 0; row < r->g.rows; row++) {
    memcpy(x + row * r->g.n, r->g.x + row * r->g.pitch, r->g.n * sizeof *x);
    memcpy(y + row * r->g.n, r->g.y + row * r->g.pitch, r->g.n * sizeof *y);
  }
}

static void close_limit(void *self) {
  limit_run *r = self;
  free(r->block);
  free(r);
}

const char *limit_vectors(void) { return limit_kernel_here()->vectors; }

#define LIMIT(text, steps)                                                                         \
  {                                                                                                \
    .name = text, .grain = 16, .parameter = steps, .threads = MOST_THREADS, .open = open_limit,    \
    .run = run_limit, .read = read_limit, .close = close_limit                                     \
  }
const contestant limit_1 = LIMIT("limit, 1 step a pass", 1);
const contestant limit_8 = LIMIT("limit, 8 steps a pass", 8);
const contestant limit_16 = LIMIT("limit, 16 steps a pass", 16);
