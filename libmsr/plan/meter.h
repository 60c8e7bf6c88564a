/* meter.h - how often each effect was called, and how long it took, by itself: entering an effect
 * stops the time of the one that called it, leaving it goes on with that one. Without `seconds` no
 * clock is read. */
#ifndef MSRI_METER_H
#define MSRI_METER_H

#include "base/clock.h"

#include <stddef.h>
#include <stdint.h>

typedef struct msri_meter {
  uint64_t *calls; /* [effects] */
  double *seconds; /* [effects + 1], the last of what is no effect; NULL: untimed */
  size_t effect;   /* that time goes to now */
  double since;    /* when it began to */
} msri_meter;

/* From here on time goes to an effect; returns the one that it went to. */
static inline size_t msri_meter_turn(msri_meter *m, size_t effect) {
  const size_t was = m->effect;
  if (!m->seconds) return was;
  const double now = msri_clock_now();
  m->seconds[was] += now - m->since;
  m->effect = effect;
  m->since = now;
  return was;
}

/* The same, and counts a call. */
static inline size_t msri_meter_enter(msri_meter *m, size_t effect) {
  m->calls[effect]++;
  return msri_meter_turn(m, effect);
}

#endif
