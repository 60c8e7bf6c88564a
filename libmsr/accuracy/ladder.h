/* ladder.h - the runs of one method, from the largest step that is sensible to ever smaller ones.
 */
#ifndef MSRI_LADDER_H
#define MSRI_LADDER_H

#include "accuracy/trial.h"

#define MSRI_COARSEST_ATOL 0.1 /* [px] */
#define MSRI_FINEST_ATOL   0.5e-13

/* Options of an adaptive run. */
msr_plan_options msri_ladder_tolerance(const msri_setting *setting,
                                       const msr_integrator *integrator, double atol);

typedef struct msri_ladder {
  const msr_integrator *integrator;
  uint64_t stable; /* the fewest substeps that are stable at any stretch */
  bool coarser;    /* still going to larger steps than that */
  bool done;
  msr_plan_options options; /* of the next run */
  double cost;              /* that the next run may have */
} msri_ladder;

/* `iterations`: of a run. As msr_plan_create. */
msr_status msri_ladder_begin(const msri_setting *setting, const msr_integrator *integrator,
                             uint64_t iterations, msri_ladder *ladder, msr_error *err);

/* What follows a run that had this cost. */
void msri_ladder_next(const msri_setting *setting, msri_ladder *ladder, double cost, bool stable);

#endif
