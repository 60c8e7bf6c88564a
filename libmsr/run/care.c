/* care.c - what a run does when its energy grows.
 *
 * A lattice that is crushed has masses that pass through each other; a spring's force turns round
 * there within a step, and every substep gains or loses some energy, which heats, the more the
 * hotter it is. Steps that are small enough would be too small: half of the error takes half of the
 * step. So a state is kept every PERIOD iterations; once there is more energy than the scene had to
 * give, by MOST, the state goes back to what was kept, and goes on by steps of energy-momentum,
 * which keep the energy at any step, through elastic impacts too. They cost tens of times more than
 * those of Verlet: only scenes that call for them have them.
 *
 * It looks at iterations that don't depend on how a run is cut in pieces, or how many frames it
 * has, so that the bits don't either. */
#include "run/care.h"

#include "run/guard.h"

#include <math.h>
#include <string.h>

enum { PERIOD = 64 };

static const double most = 0.02; /* of the energy that the scene had to give */

static void keep(msr_state *state) {
  const size_t n = 2 * state->plan->figures.masses;
  msri_care *care = &state->care;
  memcpy(care->kept, state->q, n * sizeof *care->kept);
  memcpy(care->kept + n, state->v, n * sizeof *care->kept);
  care->at = state->iteration;
  care->guard = state->guard;
}

static void go_back(msr_state *state) {
  const size_t n = 2 * state->plan->figures.masses;
  const msri_care *care = &state->care;
  memcpy(state->q, care->kept, n * sizeof *care->kept);
  memcpy(state->v, care->kept + n, n * sizeof *care->kept);
  state->iteration = care->at;
  state->substep = 0;
  state->guard = care->guard;
  state->fresh = false;
  state->known.q = NULL;
  state->failed = NULL;
}

static msr_status take_care(msr_state *state, msr_error *err) {
  const msr_status status = msri_state_make_room(state, err);
  if (status != MSR_OK) return status;
  go_back(state);
  state->care.on = true;
  return MSR_OK;
}

msr_status msri_care_begin(msr_state *state, msr_error *err) {
  msri_care *care = &state->care;
  if (!state->plan->cares) return MSR_OK;
  if (care->on) return msri_state_make_room(state, err);
  if (care->begun) return MSR_OK;
  care->begun = true;
  care->lost = 0;
  keep(state);
  return state->plan->careful ? take_care(state, err) : MSR_OK;
}

msr_status msri_care_watch(msr_state *state, bool went_wrong, bool *turned, msr_error *err) {
  msri_care *care = &state->care;
  *turned = false;
  if (!state->plan->cares || care->on || !care->begun) return MSR_OK;
  const bool looks = state->substep == 0 && state->iteration % PERIOD == 0;
  if (!went_wrong && !looks) return MSR_OK;
  *turned = went_wrong || !(msri_guard_gain(state, &care->lost) <= most);
  if (*turned) return take_care(state, err);
  keep(state);
  return MSR_OK;
}
