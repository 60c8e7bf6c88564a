/* ladder.c - the runs of one method.
 *
 * Fixed steps: the fewest substeps that are stable at any stretch, then ever larger steps by
 * sqrt(2) until one is unstable or as long as DT, then halved ones. Adaptive methods: tolerances
 * from 0.1 px on, divided by 10; since impacts are located once a substep, to order 2, substeps
 * grow with sqrt(10) where there are supports. */
#include "accuracy/ladder.h"

#include <math.h>

static const double atol_ratio = 10;

msr_plan_options msri_ladder_tolerance(const msri_setting *setting,
                                       const msr_integrator *integrator, double atol) {
  const double substeps = ceil(sqrt(MSRI_COARSEST_ATOL / atol) * (1 - 1e-9));
  const bool many = setting->contacts && substeps > 1;
  return msri_setting_options(setting, integrator, many ? (uint64_t)substeps : 1, atol);
}

msr_status msri_ladder_begin(const msri_setting *setting, const msr_integrator *integrator,
                             uint64_t iterations, msri_ladder *ladder, msr_error *err) {
  *ladder = (msri_ladder){.integrator = integrator};
  const msr_status status = msri_setting_fewest(setting, integrator, false, &ladder->stable, err);
  if (status != MSR_OK) return status;
  ladder->done = ladder->stable == 0;
  ladder->coarser = !integrator->adaptive && ladder->stable > 1;
  ladder->options = integrator->adaptive
                        ? msri_ladder_tolerance(setting, integrator, MSRI_COARSEST_ATOL)
                        : msri_setting_options(setting, integrator, ladder->stable, 0);
  ladder->cost = msri_trial_foretell(setting, integrator, iterations, ladder->stable);
  return MSR_OK;
}

static void next_tolerance(const msri_setting *setting, msri_ladder *ladder, double cost) {
  const double atol = ladder->options.atol / atol_ratio;
  ladder->done = atol < MSRI_FINEST_ATOL;
  ladder->options = msri_ladder_tolerance(setting, ladder->integrator, atol);
  ladder->cost = 1.5 * cost;
}

static void next_step(msri_ladder *ladder, double cost, bool stable) {
  const double previous = (double)ladder->options.substeps;
  uint64_t substeps = (uint64_t)(previous / sqrt(2));
  ladder->coarser = ladder->coarser && stable && substeps > 0;
  if (!ladder->coarser) {
    const bool turning = ladder->options.substeps <= ladder->stable;
    substeps = 2 * (turning ? ladder->stable : ladder->options.substeps);
  }
  ladder->done = (double)substeps > MSRI_MOST_SUBSTEPS;
  ladder->options.substeps = substeps;
  ladder->cost = cost * (double)substeps / previous;
}

void msri_ladder_next(const msri_setting *setting, msri_ladder *ladder, double cost, bool stable) {
  if (ladder->integrator->adaptive)
    next_tolerance(setting, ladder, cost);
  else
    next_step(ladder, cost, stable);
}
