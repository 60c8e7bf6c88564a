/* trial.h - a run under way, and what it costs. */
#ifndef MSRI_TRIAL_H
#define MSRI_TRIAL_H

#include "accuracy/setting.h"

/* What a run has cost so far, in calls of a force on all masses at once: of each force that is on,
 * and of contacts. Deterministic, and within a factor of 2 or so of what a clock would say: choices
 * and plans don't depend on one. */
double msri_trial_cost(const msr_state *state);

/* The same of a run that hasn't been made, about. */
double msri_trial_foretell(const msri_setting *setting, const msr_integrator *integrator,
                           uint64_t iterations, uint64_t substeps);

/* A run under way. */
typedef struct msri_trial {
  msr_plan *plan;
  msr_state *state;
  double seconds; /* processor time spent in steps */
} msri_trial;

/* MSR_EUSAGE if the method doesn't take the scene; as msr_plan_create, msr_state_create. */
msr_status msri_trial_open(msri_setting *setting, const msr_plan_options *options,
                           msri_trial *trial, msr_error *err);
void msri_trial_close(msri_setting *setting, msri_trial *trial);

/* Steps up to an iteration. MSR_EUNSTABLE if the guard says so, then too; any status if
 * setting->watch.over is true. */
msr_status msri_trial_step(msri_setting *setting, msri_trial *trial, uint64_t iteration,
                           msr_error *err);

#endif
