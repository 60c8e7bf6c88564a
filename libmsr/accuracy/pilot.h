/* pilot.h - runs of a scene, by which the cheapest that is accurate enough is found. */
#ifndef MSRI_PILOT_H
#define MSRI_PILOT_H

#include "accuracy/aim.h"

typedef struct msri_pilot {
  msri_setting setting;
  msri_reference reference;
  size_t all;            /* instants of the whole; setting.n are those of the stage under way */
  double error;          /* asked for */
  double wanted;         /* of a run, in the stage under way */
  msri_aim *aim;         /* [setting.n_methods]; NULL: not begun */
  msri_measured best;    /* as accurate as wanted; integrator NULL: none yet */
  msri_measured longest; /* for the longest time, the same */
} msri_pilot;

/* Tries methods and steps up to the reference's horizon, until none can be cheaper than the best,
 * or setting.watch.over. MSR_ENOMEM, and what a force returns. */
msr_status msri_pilot_run(msri_pilot *pilot, msr_error *err);

#endif
