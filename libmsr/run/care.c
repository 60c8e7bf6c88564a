/* care.c - what a run does when its energy grows.
 *
 * A lattice that is crushed has masses that pass through each other; a spring's force turns round
 * there within a step, and every substep gains or loses some energy, which heats, the more the
 * hotter it is. Steps that are small enough would be too small: half of the error takes half of the
 * step. So a state is kept every 64 iterations; once there is more energy than the scene had to
 * give, by MOST, the state goes back to what was kept, and goes on by steps of energy-momentum,
 * which keep the energy at any step, through elastic impacts too. They cost tens of times more than
 * those of Verlet: only scenes that call for them have them.
 *
 * It looks at iterations that don't depend on how a run is cut in pieces, or how many frames it
 * has, so that the bits don't either; but where the guard would end the run, it doesn't wait. */
#include "run/care.h"

#include "run/guard.h"

static const double most = 0.02; /* of the energy that the scene had to give */

static void keep(msr_state *state) {
  msri_care *care = &state->care;
  msri_state_keep(state, care->kept);
  care->at = state->iteration;
  care->substep = state->substep;
  care->guard = state->guard;
}

static void go_back(msr_state *state) {
  const msri_care *care = &state->care;
  msri_state_put_back(state, care->kept);
  state->iteration = care->at;
  state->substep = care->substep;
  state->guard = care->guard;
  state->guard.stale = true;
  state->failed = NULL;
}

static msr_status take_care(msr_state *state, msr_error *err) {
  const msr_status status = msri_state_make_room(state, err);
  if (status != MSR_OK) return status;
  go_back(state);
  state->care.on = true;
  return msri_guard_resume(state, err);
}

static msr_status begin(msr_state *state, msr_error *err) {
  msri_care *care = &state->care;
  if (care->on) return msri_state_make_room(state, err);
  if (care->begun) return MSR_OK;
  care->lost = 0;
  keep(state);
  const msr_status status = state->plan->careful ? take_care(state, err) : MSR_OK;
  care->begun = status == MSR_OK;
  return status;
}

msr_status msri_care_begin(msr_state *state, msr_error *err) {
  if (!state->plan->cares) return MSR_OK;
  const size_t was = msri_meter_turn(&state->meter, state->plan->row.care);
  const msr_status status = begin(state, err);
  msri_meter_turn(&state->meter, was);
  return status;
}

static bool looks(const msr_state *state) {
  return state->substep == 0 && state->iteration % msri_care_period(&state->plan->figures) == 0;
}

uint64_t msri_care_patience(const msr_state *state) {
  if (!state->plan->cares) return UINT64_MAX;
  const msr_plan_figures *f = &state->plan->figures;
  const uint64_t period = msri_care_period(f);
  return (period - state->iteration % period) * f->substeps - state->substep;
}

/* Keeps the state, or turns to steps with care. */
static msr_status look(msr_state *state, bool went_wrong, bool *turned, msr_error *err) {
  if (!went_wrong && msri_guard_gain(state, &state->care.lost) <= most) {
    keep(state);
    return MSR_OK;
  }
  const msr_status status = take_care(state, err);
  *turned = status == MSR_OK;
  return status;
}

msr_status msri_care_watch(msr_state *state, bool went_wrong, bool *turned, msr_error *err) {
  const msri_care *care = &state->care;
  *turned = false;
  if (!state->plan->cares || care->on || !care->begun) return MSR_OK;
  if (!went_wrong && !looks(state)) return MSR_OK;
  const size_t was = msri_meter_enter(&state->meter, state->plan->row.care);
  const msr_status status = look(state, went_wrong, turned, err);
  msri_meter_turn(&state->meter, was);
  return status;
}
