/* tally.h - what a thread of a sweep takes note of: collisions and, in a state that is timed, how
 * long it works, and how long it drifts past what is in the way. */
#ifndef MSRI_TALLY_H
#define MSRI_TALLY_H

#include "base/clock.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct msri_tally {
  uint64_t met;             /* collisions */
  double working, drifting; /* [s] if timed */
  double clock;             /* that reading the clock takes [s] */
  uint32_t turn;
  bool timed;
} msri_tally;

/* One of so many drifts is timed, since a clock takes as long as a short row. */
enum { MSRI_TALLY_EACH = 16 };

/* Is it this one's turn? Multiples of the golden ratio are even in any regular choice of them, such
 * as each stage's last row. */
static inline bool msri_tally_is_turn(msri_tally *t) {
  t->turn += UINT32_C(0x9e3779b9);
  return t->turn < UINT32_MAX / MSRI_TALLY_EACH;
}

/* A drift that was timed, for all that weren't. */
static inline void msri_tally_drift(msri_tally *t, double start) {
  const double took = msri_clock_now() - start - t->clock;
  if (took > 0) t->drifting += MSRI_TALLY_EACH * took;
}

#endif
