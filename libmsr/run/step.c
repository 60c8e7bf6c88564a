/* step.c - steps of an integrator: on any system, and on a state, iteration by iteration.
 * Each step begins at the very time at which the one before ended. */
#include "run/step.h"

#include "run/guard.h"

#include <stdlib.h>

msr_status msr_integrate(const msr_integrator *integrator, const msr_system *system, double t,
                         double h, uint64_t steps, double *q, double *v, msr_error *err) {
  double *work = msri_alloc(integrator->vectors * system->n, sizeof *work, "an integrator", err);
  if (!work) return MSR_ENOMEM;
  msr_status status = MSR_OK;
  if (integrator->begin) status = integrator->begin(integrator, system, t, q, v, work);
  for (uint64_t s = 0; s < steps && status == MSR_OK; s++) {
    const msr_interval interval = {t + (double)s * h, h, t + (double)(s + 1) * h};
    status = integrator->step(integrator, system, &interval, q, v, work);
  }
  free(work);
  return status == MSR_OK
             ? MSR_OK
             : msri_fail(err, status, "%s: %s", integrator->name, msr_status_text(status));
}

/* One substep; the caller has begun the integrator. */
static msr_status substep(msr_state *state, const msr_system *system) {
  const msr_plan_figures *f = &state->plan->figures;
  const msr_interval interval = {msri_state_time(state), f->h,
                                 msri_plan_time(f, state->iteration, state->substep + 1)};
  const msr_status status =
      f->integrator->step(f->integrator, system, &interval, state->q, state->v, state->work);
  if (status != MSR_OK) return status;
  state->substep++;
  return msri_guard_follow(state);
}

static msr_status begin(msr_state *state, const msr_system *system) {
  const msr_integrator *integrator = state->plan->figures.integrator;
  if (state->fresh || !integrator->begin) return MSR_OK;
  const msr_status status = integrator->begin(integrator, system, msri_state_time(state), state->q,
                                              state->v, state->work);
  state->fresh = status == MSR_OK;
  return status;
}

/* One iteration, or what is left of the one that was cut short. */
static msr_status iterate(msr_state *state, const msr_system *system, const msri_poll *poll) {
  msr_status status = begin(state, system);
  while (state->substep < state->plan->figures.substeps && status == MSR_OK) {
    if (poll->call) status = poll->call(poll->data, state);
    if (status == MSR_OK) status = substep(state, system);
  }
  if (status != MSR_OK) return status;
  state->substep = 0;
  state->iteration++;
  return MSR_OK;
}

/* Which iteration a status stopped, and which force if it was one. */
static msr_status explain(const msr_state *state, msr_status status, msr_error *err) {
  return msri_fail(err, status, "iteration %llu: %s%s%s", (unsigned long long)state->iteration,
                   state->failed ? state->failed->name : "", state->failed ? ": " : "",
                   msr_status_text(status));
}

msr_status msri_step(msr_state *state, uint64_t iterations, const msri_poll *poll, msr_error *err) {
  const msr_system system = msri_state_system(state);
  state->failed = NULL;
  msr_status status = msri_guard_begin(state, err);
  if (status != MSR_OK) return status;
  for (uint64_t i = 0; i < iterations; i++) {
    status = iterate(state, &system, poll);
    if (status != MSR_OK) return explain(state, status, err);
    if (state->iteration % MSRI_GUARD_PERIOD == 0) status = msr_state_check(state, err);
    if (status != MSR_OK) return status;
  }
  return MSR_OK;
}

msr_status msr_state_step(msr_state *state, uint64_t iterations, msr_error *err) {
  return msri_step(state, iterations, &(msri_poll){NULL, NULL}, err);
}
