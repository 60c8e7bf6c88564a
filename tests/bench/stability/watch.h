/* watch.h - a solver at work on a problem, watched from outside. */
#ifndef WATCH_H
#define WATCH_H

#include "beside.h"

typedef enum end { WORKING, DONE, STOPPED, NOT_FINITE, RUNAWAY, CRASHED, LATE, DECLINED } end;

/* What was seen of a run. Energies are shares of the scale of the problem. */
typedef struct sight {
  end how;
  char text[128];    /* why it stopped or declined */
  double t, seconds; /* reached [s]; processor time, looks included [s] */
  double start;      /* energy [kg px^2/s^2] */
  double gain, loss; /* the most, above the start and below; over the scale */
  double depth;      /* the deepest a mass was in a support [px] */
  size_t in, out;    /* the most masses in supports by more than 0.01 px; beyond them */
  double speed;      /* largest over the last tenth of the run [px/s] */
} sight;

/* In a process of its own, which is ended after `limit` seconds of the processor. */
sight watch(const solver *by, const problem *p, unsigned limit);

#endif
