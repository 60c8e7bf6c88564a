/* care.h - energy that comes from nowhere, and what is done about it. */
#ifndef MSRI_CARE_H
#define MSRI_CARE_H

#include "plan/state.h"

/* Before the first step, and whenever the state was changed from outside. */
msr_status msri_care_begin(msr_state *state, msr_error *err);

/* After an iteration: `went_wrong` if the guard refused the state. `turned` tells whether the state
 * went back to where its energy was sound, to go on with care. */
msr_status msri_care_watch(msr_state *state, bool went_wrong, bool *turned, msr_error *err);

#endif
