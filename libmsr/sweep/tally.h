/* tally.h - what a thread of a sweep takes note of: collisions and, in a state that is timed, how
 * long kicks before drifts past what is in the way take, and these drifts. */
#ifndef MSRI_TALLY_H
#define MSRI_TALLY_H

#include "base/clock.h"

#include <stdbool.h>
#include <stdint.h>

/* Time of something that is done again and again [s]: of those that were timed, on average of late.
 */
typedef struct msri_sampled {
  double all, usual;
} msri_sampled;

typedef struct msri_tally {
  uint64_t met; /* collisions */
  msri_sampled kicks, drifts;
  double clock; /* that reading the clock takes [s] */
  uint32_t turn;
  bool timed;
} msri_tally;

/* Is it this one's turn to be timed? One in 16 is, since a clock takes as long as a short row.
 * Multiples of the golden ratio are even in any regular choice of them, such as each stage's last
 * row. */
static inline bool msri_tally_is_turn(msri_tally *t) {
  if (!t->timed) return false;
  t->turn += UINT32_C(0x9e3779b9);
  return t->turn < UINT32_MAX / 16;
}

/* Adds the time from `start` on, and returns the time. In what is far longer than usual another
 * process had the processor. */
static inline double msri_tally_add(const msri_tally *t, double start, msri_sampled *s) {
  enum { FAR = 64 };
  const double now = msri_clock_now();
  double took = now - start - t->clock;
  if (took < 0) took = 0;
  if (s->usual > 0 && took > FAR * s->usual) took = FAR * s->usual;
  s->usual += s->usual > 0 ? (took - s->usual) / FAR : took;
  s->all += took;
  return now;
}

#endif
