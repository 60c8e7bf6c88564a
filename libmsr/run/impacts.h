/* impacts.h - steps of integrators that don't see themselves to what is in the way. */
#ifndef MSRI_IMPACTS_H
#define MSRI_IMPACTS_H

#include "plan/state.h"

/* Stops and reflects what met something in a step of h from state->before. */
msr_status msri_bounce(msr_state *state, double h);

/* A step that ends at each impact, up to a few, and begins anew from it. What the step returns. */
msr_status msri_step_by_impacts(msr_state *state, const msr_system *system,
                                const msr_interval *interval, msr_error *err);

#endif
