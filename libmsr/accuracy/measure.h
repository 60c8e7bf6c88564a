/* measure.h - one run against the reference, and how long it takes. */
#ifndef MSRI_MEASURE_H
#define MSRI_MEASURE_H

#include "accuracy/reference.h"

/* What draws a run and the reference, to compare. */
typedef struct msri_screens {
  msr_renderer *truth, *run;
  msr_state *state; /* holds the reference's positions */
} msri_screens;

/* Leaves all NULL if the scene has no picture. */
msr_status msri_screens_open(const msri_setting *setting, msri_screens *screens, msr_error *err);
void msri_screens_close(msri_screens *screens);

/* Where a run may be ended. */
typedef struct msri_limits {
  double error;  /* largest that is still of interest [px] */
  double wanted; /* largest that is good [px] */
  double cost;   /* the same */
} msri_limits;

typedef struct msri_measured {
  msr_accuracy_point point; /* order and front aside; seconds are those of this one run's steps, as
                             * if it had come to the horizon */
  double cost;              /* as msri_trial_cost counts it */
  double share;             /* of the time up to the horizon that was run */
  double error;             /* largest in that time, also if the run was ended */
  bool sound;               /* it came to its end, or its error ended it: it didn't explode */
  double early;             /* in the first quarter of the time up to the horizon */
  size_t good;              /* instants up to which it is as wanted, */
  double good_error;        /* and the largest there */
} msri_measured;

/* Runs up to the reference's horizon. `screens` NULL: no pixels. MSR_OK, with a point that isn't
 * stable, if the guard or the limits ended it; any status while watch.over: it was stopped. */
msr_status msri_measure(msri_setting *setting, const msri_reference *reference,
                        const msri_screens *screens, const msr_plan_options *options,
                        const msri_limits *limits, msri_measured *measured, msr_error *err);

/* The least processor time of several runs up to the horizon that do nothing else [s], with about
 * `total` [s] for all of them; unchanged if none came to its end. After msri_measure, which warms
 * the machine up. */
msr_status msri_measure_time(msri_setting *setting, const msri_reference *reference,
                             const msr_plan_options *options, double total, double *seconds,
                             msr_error *err);

#endif
