/* rest.h - objects at rest: a whole step maps x, y, vx, vy to themselves, bit by bit. No force
 * depends on time, so every later step would do the same: they are left out, until something else
 * than steps changes the state. */
#ifndef MSRI_REST_H
#define MSRI_REST_H

#include "sweep/stage.h"

/* What is done to an object in a pass. */
enum { MSRI_STEPPED, MSRI_LOOKED_AT, MSRI_LEFT_OUT };

typedef struct msri_rest {
  unsigned char *how; /* [objects] one of those; nobody writes it while a pass is under way */
  bool *same;         /* [objects]: has the step left what was looked at as it was? */
  size_t n;           /* objects that are left out */
  uint64_t met;       /* their collisions in each step */
  uint64_t waits;     /* steps to the next look */
} msri_rest;

/* May an object of the plan ever be left out? */
bool msri_rest_is_known(const msr_plan *plan);

/* All are stepped again. */
void msri_rest_wake(const msr_plan *plan, msri_rest *rest);

/* Is it time to look, and is anything so slow that a drift wouldn't move it? That is to be looked
 * at in the next step. */
bool msri_rest_look(const msr_plan *plan, const msri_swept *state, msri_rest *rest);

/* That step is done; what it left as it was had `met` collisions. */
void msri_rest_leave_out(const msr_plan *plan, uint64_t met, msri_rest *rest);

/* So many steps were taken. */
void msri_rest_wait(msri_rest *rest, uint64_t steps);

#endif
