/* clock.h - a clock that never jumps, for measuring how long something takes. */
#ifndef MSRI_CLOCK_H
#define MSRI_CLOCK_H

#include <time.h>

/* Seconds since some moment. */
static inline double msri_clock_now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#endif
