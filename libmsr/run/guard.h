/* guard.h - watches a state for numbers that can't be true. */
#ifndef MSRI_GUARD_H
#define MSRI_GUARD_H

#include "plan/state.h"

/* Takes the state as the start, if it has none. */
msr_status msri_guard_begin(msr_state *state, msr_error *err);

/* Finds what driving forces do where the state is, if that isn't known. What a force returns. */
msr_status msri_guard_resume(msr_state *state, msr_error *err);

/* Adds what driving forces have done in the last step, of h. What a force returns. */
msr_status msri_guard_follow(msr_state *state, double h);

/* A look: energy from nowhere, or where nothing takes it lost, over what the scene had to give;
 * `lost` is the most that potentials have lost by the looks of who asks. */
double msri_guard_gain(msr_state *state, double *lost);

/* Steps until the next look. */
uint64_t msri_guard_patience(const msr_state *state);

/* After a substep: looks at the state if it is time to, or `fast`, a mass having been seen that was
 * faster than it should. As msr_state_check. */
msr_status msri_guard_watch(msr_state *state, bool fast, msr_error *err);

/* What to say of a state that can't be true: see guard_says.c. `ratio`: energy over what there was
 * to give; NaN: a number or an energy isn't finite. */
msr_status msri_guard_refuse(const msr_state *state, double ratio, msr_error *err);

#endif
