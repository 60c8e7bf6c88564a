/* sweep.h - steps of a picture's objects, several at a time, row by row while rows are in cache. */
#ifndef MSRI_SWEEP_H
#define MSRI_SWEEP_H

#include "base/team.h"
#include "plan/plan.h"
#include "sweep/stage.h"

typedef struct msri_sweep msri_sweep;

/* Memory and threads for it. MSR_ENOMEM. */
msr_status msri_sweep_create(const msr_plan *plan, msri_sweep **sweep, msr_error *err);
void msri_sweep_free(msri_sweep *sweep);
size_t msri_sweep_bytes(const msr_plan *plan);

/* That it steps with, of those of the plan. */
unsigned msri_sweep_threads(const msr_plan *plan);

/* Objects that are left out, as steps don't change them; and all are stepped again, as something
 * else may have. */
size_t msri_sweep_resting(const msri_sweep *sweep);
void msri_sweep_wake(msri_sweep *sweep);

/* What became of a run of steps. */
typedef struct msri_progress {
  uint64_t steps, evaluations, met; /* done; collisions */
  bool known;                       /* it ended with an evaluation, which the next begins with */
  bool fast;                        /* a mass moved faster than it should: steps ended early */
} msri_progress;

/* Takes the steps of a course or, once a mass moves faster than `fastest` along an axis, fewer.
 * `known`: the evaluation that it begins with has been counted. */
msri_progress msri_sweep_run(msri_sweep *sweep, const msri_swept *state, msri_course course,
                             double fastest, bool known);

/* Of a plan that is timed: moves what such a run spent [s] from the integrator's seconds [effects]
 * to those of all effects, by what each is measured to take. */
void msri_sweep_split(msri_sweep *sweep, double spent, double *seconds);

#endif
