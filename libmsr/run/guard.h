/* guard.h - watches a state for numbers that can't be true. */
#ifndef MSRI_GUARD_H
#define MSRI_GUARD_H

#include "plan/state.h"

/* Iterations between two looks. */
enum { MSRI_GUARD_PERIOD = 32 };

/* Takes the state as the start, if it has none. */
msr_status msri_guard_begin(msr_state *state, msr_error *err);

/* Adds what driving forces have done in the last step, of h. What a force returns. */
msr_status msri_guard_follow(msr_state *state, double h);

#endif
