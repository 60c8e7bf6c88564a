/* deal.h - which thread steps which objects of a plan, in passes of how many stages, and the memory
 * that it needs for that. */
#ifndef MSRI_DEAL_H
#define MSRI_DEAL_H

#include "plan/plan.h"

typedef struct msri_deal {
  unsigned threads;          /* that have something to do */
  size_t share;              /* objects that follow each other and are the same thread's */
  int depth;                 /* most stages of a pass */
  size_t patch, rows, parts; /* doubles of a thread: for small objects, large ones, parts of such */
} msri_deal;

msri_deal msri_deal_of(const msr_plan *plan);

/* Whose is an object that isn't shared? */
static inline unsigned msri_deal_owner(const msri_deal *deal, size_t object) {
  return (unsigned)(object / deal->share % deal->threads);
}

/* Does it go through a pass by itself, in a patch? */
bool msri_deal_is_small(const msr_plan *plan, const msri_object *object);

/* Parts of a large one: 1, if it isn't shared. */
unsigned msri_deal_parts(const msr_plan *plan, const msri_object *object, int depth);

/* Of springs that begin at a cell. */
int msri_deal_ways(const msr_plan *plan);

#endif
