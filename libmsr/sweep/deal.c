/* deal.c - see deal.h. */
#include "sweep/deal.h"

#include "base/pixel.h"
#include "sweep/bands.h"
#include "sweep/patch.h"
#include "sweep/rows.h"

enum {
  PATCH_CELLS = 12288,            /* of a small object: they fit into a core's cache */
  STRIP_CELLS = 16 * PATCH_CELLS, /* of one narrower than a vector: rows cost more than memory */
  SHARED_MASSES = 8192,           /* of an object that is worth sharing among threads */
  LEAST_STAGES = 4, /* of a pass: fewer would have threads wait for each other too often */
  MOST_SHARED = 32  /* small objects that are one thread's together */
};

int msri_deal_ways(const msr_plan *plan) {
  return msri_has_diagonals(plan->neighbours) ? MSRI_WAYS : MSRI_BELOW + 1;
}

/* ---- Objects */

bool msri_deal_is_small(const msr_plan *plan, const msri_object *object) {
  const msri_group alone = msri_group_of(object, 1);
  const size_t cells = msri_patch_cells(&alone);
  const size_t most = object->width < MSRI_LANES ? STRIP_CELLS : PATCH_CELLS;
  const bool dense = cells <= most && 4 * object->masses >= object->rows * object->width;
  const bool many = plan->objects.n >= 4 * (size_t)plan->threads;
  const bool shared = plan->threads > 1 && !many;
  return dense && (!shared || object->masses < SHARED_MASSES);
}

/* With fewer rows than twice the stages they'd be all wedge. */
unsigned msri_deal_parts(const msr_plan *plan, const msri_object *object, int depth) {
  const size_t most = object->rows / (2 * (size_t)depth);
  if (object->masses < SHARED_MASSES || most < 2) return 1;
  return most < plan->threads ? (unsigned)most : plan->threads;
}

static int depth_for(const msr_plan *plan, const msri_object *object, int ways) {
  const int stages = msri_rows_stages(ways, object->width);
  const size_t shared = object->rows / (2 * (size_t)plan->threads);
  if (plan->threads == 1 || shared >= (size_t)stages) return stages;
  return shared > LEAST_STAGES ? (int)shared : stages < LEAST_STAGES ? stages : LEAST_STAGES;
}

static int depth_of(const msr_plan *plan, int ways) {
  const msri_objects *o = &plan->objects;
  int least = MSRI_MOST_STAGES;
  for (size_t n = 0; n < o->n; n++) {
    const int depth = depth_for(plan, &o->object[n], ways);
    if (!msri_deal_is_small(plan, &o->object[n]) && depth < least) least = depth;
  }
  return least;
}

/* ---- Threads */

/* No more than have an object, or a part of a large one. */
static unsigned threads_of(const msr_plan *plan, int depth) {
  const msri_objects *o = &plan->objects;
  size_t most = o->n;
  for (size_t n = 0; n < o->n; n++) {
    const size_t parts = msri_deal_parts(plan, &o->object[n], depth);
    if (most < parts) most = parts;
  }
  return (unsigned)msri_lesser(most, plan->threads);
}

static size_t share_of(const msr_plan *plan, size_t threads) {
  const size_t n = plan->objects.n, share = threads > 1 ? n / (4 * threads) : n;
  return share < 1 ? 1 : msri_lesser(share, MOST_SHARED);
}

/* ---- Memory */

static void widen(size_t *size, size_t least) {
  least = msri_round_up(least, MSRI_MARGIN);
  if (*size < least) *size = least;
}

static void widen_for(const msr_plan *plan, const msri_object *object, int ways, msri_deal *d) {
  const bool meets = msri_plan_meets(plan);
  const msri_group alone = msri_group_of(object, 1);
  const bool shared = msri_deal_parts(plan, object, d->depth) > 1;
  if (msri_deal_is_small(plan, object))
    widen(&d->patch, msri_patch_size(ways, meets, &alone));
  else
    widen(shared ? &d->parts : &d->rows,
          msri_rows_size(ways, meets, shared, object->width, d->depth));
}

/* A mesh's parts are bands. */
static msri_deal mesh_of(const msr_plan *plan) {
  const unsigned parts = msri_bands_parts(&plan->bands, plan->threads);
  msri_deal d = {.threads = parts, .share = 1, .depth = msri_bands_stages(&plan->bands, parts)};
  widen(&d.parts, msri_bands_size(&plan->bands, parts, d.depth));
  return d;
}

msri_deal msri_deal_of(const msr_plan *plan) {
  const msri_objects *o = &plan->objects;
  const int ways = msri_deal_ways(plan);
  if (plan->bands.n > 0) return mesh_of(plan);
  msri_deal d = {.depth = depth_of(plan, ways)};
  d.threads = threads_of(plan, d.depth);
  d.share = share_of(plan, d.threads);
  for (size_t n = 0; n < o->n; n++) widen_for(plan, &o->object[n], ways, &d);
  if (d.share > 1) widen(&d.patch, msri_patch_most(ways, msri_plan_meets(plan)));
  return d;
}
