/* trial.c - a run under way. */
#include "accuracy/trial.h"

double msri_trial_cost(const msr_state *state) {
  const msr_plan *plan = state->plan;
  const double order = plan->figures.integrator->order;
  double cost = 0;
  for (size_t e = 0; e < plan->n_effects && plan->effect[e].on; e++) {
    const msr_force *force = plan->effect[e].force;
    const bool outer = force && force->conservative && force != &msr_force_springs;
    if (!outer) cost += (double)state->calls[e];
  }
  if (plan->figures.integrator->adaptive) cost += order * order / 12 * (double)state->work.steps;
  return cost;
}

msr_status msri_trial_open(msri_setting *setting, const msr_plan_options *options,
                           msri_trial *trial, msr_error *err) {
  *trial = (msri_trial){0};
  msr_status status = msr_plan_create(setting->scene, options, &trial->plan, err);
  if (status == MSR_OK) status = msr_state_create(trial->plan, &trial->state, err);
  if (status != MSR_OK) msri_trial_close(setting, trial);
  return status;
}

void msri_trial_close(msri_setting *setting, msri_trial *trial) {
  if (trial->state) setting->cost += msri_trial_cost(trial->state);
  msr_state_free(trial->state);
  msr_plan_free(trial->plan);
  *trial = (msri_trial){0};
}

msr_status msri_trial_step(msri_setting *setting, msri_trial *trial, uint64_t iteration,
                           msr_error *err) {
  const msri_poll poll = msri_watch_poll(&setting->watch);
  const double start = msri_thread_seconds();
  msr_status status = msri_step(trial->state, iteration - trial->state->iteration, &poll, err);
  trial->seconds += msri_thread_seconds() - start;
  return status == MSR_OK ? msr_state_check(trial->state, err) : status;
}
