/* leap.h - long implicit steps in place of many substeps. */
#ifndef MSRI_LEAP_H
#define MSRI_LEAP_H

#include "run/step.h"

/* Does a stretch begin here? */
static inline bool msri_leaps(const msr_state *state) {
  const msri_leaping *plan = &state->plan->leaping;
  if (state->care.on) return true;
  return state->plan->figures.leaps && state->substep % plan->stretch == 0;
}

/* As much of the stretch that begins here as implicit steps do for less than its substeps, or, with
 * care, all of it. `poll` is called once, at its beginning, so that a run which is interrupted has
 * nothing to undo. What poll or a force returns. */
msr_status msri_leap(msr_state *state, const msr_system *system, const msri_poll *poll);

#endif
