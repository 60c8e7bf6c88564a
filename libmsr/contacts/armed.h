/* armed.h - masses that can't reach a support within the coming steps aren't tested against any.
 *
 * Some masses in a row are told how far each of them can go and meet nothing (the contact's
 * clearance). Each step takes from that the most that any of them may go in it, along either axis:
 * h max |u|. Once what is left doesn't cover a step, they are tested again, in that very step, so
 * that none is missed; and are told anew, or, if it wouldn't last, some steps later.
 *
 * Whoever moves them otherwise than by these drifts, or takes other masses, clears it: all 0.
 *
 * Where rows are swept the same is done by blocks, see sweep/near.h. */
#ifndef MSRI_ARMED_H
#define MSRI_ARMED_H

#include "contacts/flock.h"

typedef struct msri_armed {
  double left;    /* of the path that they can go [px] */
  unsigned waits; /* steps in which they are tested before it pays to ask again */
} msri_armed;

/* Coordinates of what has a clearance are below that [px], and so are clearances. */
#define MSRI_ARMED_LIMIT 0x1p22

/* Of a step: x + h u, below twice the limit, is off by 2^-30 at most, and what is left by 2^-31. */
#define MSRI_ARMED_ROUNDING 0x1p-28

/* Is it known that they must be tested? Then the step's `path` needn't be found. */
static inline bool msri_armed_waits(msri_armed *armed) {
  if (armed->waits == 0) return false;
  armed->waits--;
  return true;
}

/* No mass goes further than `path` along either axis: may the step be taken untested? Not if path
 * is no number. */
static inline bool msri_armed_covers(msri_armed *armed, double path) {
  armed->left -= path + MSRI_ARMED_ROUNDING;
  return armed->left >= 0;
}

/* They have been tested in a step of `path`, after which that is their clearance. */
static inline void msri_armed_earn(msri_armed *armed, double path, double clearance) {
  enum { FEW = 4, REST = 15 };
  const bool lasts = clearance > FEW * path;
  *armed = (msri_armed){lasts ? clearance : 0, lasts ? 0 : REST};
}

/* The contact's drift, which has a clearance, by all that: bits and collisions are the same. */
uint64_t msri_armed_drift(msri_armed *armed, const msri_contact *contact, double h,
                          const msri_flock *flock, msri_debts *debts);

/* What a state keeps of that: `gone` of each row of the objects, and `until` of the blocks in which
 * pieces of it lie. */
typedef struct msri_armed_rows {
  double *gone, *until;
} msri_armed_rows;

#endif
