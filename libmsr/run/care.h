/* care.h - energy that comes from nowhere, and what is done about it. */
#ifndef MSRI_CARE_H
#define MSRI_CARE_H

#include "plan/state.h"

/* Keeps what there is to go back to, before the first step and whenever the state was changed from
 * outside, and sees to it that steps with care have their memory. MSR_ENOMEM, what a force returns.
 */
msr_status msri_care_begin(msr_state *state, msr_error *err);

/* Steps until the next look. */
uint64_t msri_care_patience(const msr_state *state);

/* After every step: looks at the energy if it's time to, or if `went_wrong`, the guard having
 * refused the state. `turned` tells whether the state went back to where its energy was sound, to
 * go on with care. MSR_ENOMEM, what a force returns: then it didn't. */
msr_status msri_care_watch(msr_state *state, bool went_wrong, bool *turned, msr_error *err);

#endif
