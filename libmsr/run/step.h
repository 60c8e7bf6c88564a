/* step.h - stepping a state with a say for whoever watches. */
#ifndef MSRI_STEP_H
#define MSRI_STEP_H

#include "plan/state.h"

/* Called before every substep, if there is one. */
typedef struct msri_poll {
  msr_status (*call)(void *data, const msr_state *state);
  void *data;
  uint64_t most; /* substeps between two calls; 0: as many as suit */
} msri_poll;

/* Calls it; the time that it takes is nobody's. */
static inline msr_status msri_poll_call(const msri_poll *poll, msr_state *state) {
  if (!poll->call) return MSR_OK;
  const size_t was = msri_meter_turn(&state->meter, state->plan->n_effects);
  const msr_status status = poll->call(poll->data, state);
  msri_meter_turn(&state->meter, was);
  return status;
}

/* As msr_state_step. What poll returns, other than MSR_OK, ends it and comes back unchanged. */
msr_status msri_step(msr_state *state, uint64_t iterations, const msri_poll *poll, msr_error *err);

/* A step of the integrator over an interval, begun anew if need be, past whatever it doesn't see to
 * itself. */
msr_status msri_step_once(msr_state *state, const msr_system *system, const msr_interval *interval,
                          msr_error *err);

#endif
