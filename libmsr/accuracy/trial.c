/* trial.c - a run under way. */
#include "accuracy/trial.h"

/* Measured on lattices of 10^2 to 10^4 masses, in calls of the springs: an outer potential
 * (gravity, a push), and what a step does beside its calls; an adaptive one of order p has p^2 / 12
 * operations of GSL's on vectors; an implicit one makes and factorises a matrix for each
 * evaluation, and solves by iterations. */
static const double outer_cost = 0.1, step_cost = 0.3, matrix_cost = 16, iteration_cost = 6;

static double cost_of(const msr_effect *effect) {
  if (effect->role == MSR_ROLE_STEP) return 0;
  return effect->force && msri_force_is_outer(effect->force) ? outer_cost : 1;
}

double msri_trial_cost(const msr_state *state) {
  const msr_plan *plan = state->plan;
  const msr_integrator *integrator = plan->figures.integrator;
  const double order = integrator->order, steps = (double)state->work.steps;
  double cost = step_cost * steps;
  for (size_t e = 0; e < plan->n_effects && plan->effect[e].on; e++)
    cost += cost_of(&plan->effect[e]) * (double)state->meter.calls[e];
  if (integrator->adaptive) cost += order * order / 12 * steps;
  if (integrator->implicit)
    cost += matrix_cost * (double)state->evaluations +
            iteration_cost * (double)state->stiffness.iterations;
  return cost;
}

/* Calls of an effect in a step. */
static double calls_of(const msr_effect *effect, const msr_integrator *integrator,
                       double per_step) {
  return effect->force ? msri_force_calls(effect->force, integrator, per_step) : 1;
}

/* An adaptive method takes steps of about Verlet's, of some ten evaluations; an implicit one
 * iterates some three times. */
double msri_trial_foretell(const msri_setting *setting, const msr_integrator *integrator,
                           uint64_t iterations, uint64_t substeps) {
  const msr_plan *plan = setting->plan;
  const msr_plan_figures *verlet = &plan->figures;
  const double order = integrator->order, declared = integrator->evaluations;
  const double per_step = declared > 0 ? declared : integrator->implicit ? 3 : 10;
  double cost = step_cost;
  for (size_t e = 0; e < plan->n_effects && plan->effect[e].on; e++)
    cost += cost_of(&plan->effect[e]) * calls_of(&plan->effect[e], integrator, per_step);
  if (integrator->adaptive) cost += order * order / 12;
  if (integrator->implicit) cost += per_step * (matrix_cost + 2 * iteration_cost);
  const double steps =
      integrator->adaptive ? msri_max(1, verlet->dt / verlet->stable_step) : (double)substeps;
  return cost * steps * (double)iterations;
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
