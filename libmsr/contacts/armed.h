/* armed.h - masses that can't reach a support within the coming steps aren't tested against any.
 *
 * Some masses in a row are told how far each of them can go and meet nothing (the contact's
 * clearance). Each step takes from that the most that any of them may go in it, along either axis:
 * h max |u|. Once what is left doesn't cover a step, they are tested again, in that very step, so
 * that none is missed; and are told anew, or, if it wouldn't last, some steps later.
 *
 * Whoever moves them otherwise than by these drifts, or takes other masses, clears it: all 0. */
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

/* ---- Rows of blocks, of which it's known who has left a pixel */

/* How far masses of a row have gone [px], and in how many steps; until they have gone so far none
 * of them can come to a support. Beyond MSRI_ARMED_LIMIT all that is counted so begins anew: a step
 * adds to `gone` with an error of 2^-30 at most, and `until` has one such. */
typedef struct msri_armed_row {
  double gone, until;
  uint64_t steps;
} msri_armed_row;

/* The same of a block: how far, counted as the row's, and from which step on it pays to ask again.
 */
typedef struct msri_armed_block {
  double until;
  uint64_t asks;
} msri_armed_block;

/* Those of a state, in the order of the objects' rows and blocks. */
typedef struct msri_armed_rows {
  msri_armed_row *row;
  msri_armed_block *block;
} msri_armed_rows;

/* A step in which none of a row goes further than `path`: may one have come to a support? */
static inline bool msri_armed_row_goes(msri_armed_row *row, double path) {
  row->steps++;
  row->gone += path + MSRI_ARMED_ROUNDING;
  return !(row->gone <= row->until);
}

/* Some masses of the row have been looked at in a step of `path`, after which that is their
 * clearance. */
static inline void msri_armed_block_earn(msri_armed_block *block, const msri_armed_row *row,
                                         double path, double clearance) {
  enum { FEW = 4, REST = 15 };
  if (clearance > FEW * path)
    block->until = row->gone + clearance;
  else
    block->asks = row->steps + REST;
}

#endif
