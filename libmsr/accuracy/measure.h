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

/* Runs up to the reference's horizon and fills all of the point but its order and front; `seconds`
 * is what the steps of this one run took.
 * `screens` NULL: no pixels. Ends early, unstable, at an error beyond `most`. MSR_OK with a point
 * that isn't stable; a status while watch.over: it was stopped. */
msr_status msri_measure(msri_setting *setting, const msri_reference *reference,
                        const msri_screens *screens, const msr_plan_options *options, double most,
                        msr_accuracy_point *point, msr_error *err);

/* The least processor time of several runs up to the horizon, which together take about `total`
 * [s] if `once`, the time of one, is short. */
msr_status msri_measure_time(msri_setting *setting, const msri_reference *reference,
                             const msr_plan_options *options, double total, double *seconds,
                             msr_error *err);

#endif
