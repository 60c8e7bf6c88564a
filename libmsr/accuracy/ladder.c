/* ladder.c - the runs of one method.
 *
 * Fixed steps: the fewest substeps that are stable at any stretch, then ever larger steps by
 * sqrt(2) until one is unstable or as long as DT, then halved ones. Adaptive methods: tolerances
 * from 0.1 px on, divided by 10; since impacts are located once a substep, to order 2, substeps
 * grow with sqrt(10) where there are supports. */
#include "accuracy/ladder.h"

#include <math.h>

static const double coarsest_atol = 0.1, finest_atol = 0.5e-13, atol_ratio = 10;
static const double most_substeps = 1e9;

static uint64_t adaptive_substeps(const msri_setting *setting, double atol) {
  return setting->contacts ? (uint64_t)ceil(sqrt(coarsest_atol / atol) * (1 - 1e-9)) : 1;
}

/* What a step may take where the method doesn't say. */
static double evaluations_per_step(const msr_integrator *integrator) {
  const double unknown = 20;
  return integrator->evaluations > 0 ? integrator->evaluations : unknown;
}

msr_status msri_ladder_begin(const msri_setting *setting, const msr_integrator *integrator,
                             uint64_t iterations, msri_ladder *ladder, msr_error *err) {
  *ladder = (msri_ladder){.integrator = integrator};
  const msr_status status = msri_setting_stable(setting, integrator, &ladder->stable, err);
  if (status != MSR_OK) return status;
  ladder->done = ladder->stable == 0;
  const uint64_t substeps = integrator->adaptive ? 1 : ladder->stable;
  ladder->coarser = substeps > 1;
  ladder->options = msri_setting_options(setting, integrator, substeps, coarsest_atol);
  ladder->evaluations = (double)iterations * (double)substeps * evaluations_per_step(integrator);
  return MSR_OK;
}

static void next_tolerance(const msri_setting *setting, msri_ladder *ladder,
                           const msr_accuracy_point *measured) {
  const double atol = ladder->options.atol / atol_ratio;
  ladder->done = atol < finest_atol;
  ladder->options.atol = atol;
  ladder->options.substeps = adaptive_substeps(setting, atol);
  ladder->evaluations = 1.5 * (double)measured->evaluations;
}

static void next_step(msri_ladder *ladder, const msr_accuracy_point *measured) {
  const double previous = (double)ladder->options.substeps;
  uint64_t substeps = (uint64_t)(previous / sqrt(2));
  ladder->coarser = ladder->coarser && measured->stable && substeps > 0;
  if (!ladder->coarser) {
    const bool turning = ladder->options.substeps <= ladder->stable;
    substeps = 2 * (turning ? ladder->stable : ladder->options.substeps);
  }
  ladder->done = (double)substeps > most_substeps;
  ladder->options.substeps = substeps;
  ladder->evaluations = (double)measured->evaluations * (double)substeps / previous;
}

void msri_ladder_next(const msri_setting *setting, msri_ladder *ladder,
                      const msr_accuracy_point *measured) {
  if (ladder->integrator->adaptive)
    next_tolerance(setting, ladder, measured);
  else
    next_step(ladder, measured);
}
