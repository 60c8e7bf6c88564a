/* run.c - a whole run: iterations up to each frame, the guard, then the sinks. */
#include "run/beside.h"
#include "run/care.h"
#include "run/step.h"

static msr_status give(const msr_sink *sink, const msr_state *state, uint64_t frame,
                       msr_error *err) {
  msr_error said = {MSR_OK, ""};
  const msr_status status = sink->write(sink->self, state, frame, &said);
  return msri_beside_hand_on(status, &said, frame, err);
}

static msr_status deliver(msr_state *state, msri_beside *beside, uint64_t frame, msr_error *err) {
  const msr_run_options *options = beside->options;
  msr_status status = msri_beside_wait(beside, err);
  for (size_t s = 0; s < options->n_sinks && status == MSR_OK; s++)
    status = give(&options->sinks[s], state, frame, err);
  if (status == MSR_OK) status = msri_beside_complete(beside, frame, err);
  if (status == MSR_OK) state->frames = frame + 1;
  return status;
}

/* Steps up to an iteration, if it's still to come, and checks the state; again, with care, if it
 * isn't sound. */
static msr_status step_to(msr_state *state, uint64_t iteration, const msri_poll *poll,
                          msr_error *err) {
  msr_status status = MSR_OK;
  for (bool turned = true; turned;) {
    if (state->iteration < iteration)
      status = msri_step(state, iteration - state->iteration, poll, err);
    if (status != MSR_OK) return status;
    msr_error said = {MSR_OK, ""};
    const msr_status verdict = msr_state_check(state, &said);
    const bool wrong = verdict == MSR_EUNSTABLE && !state->failed; /* not a force's word */
    status = msri_care_watch(state, wrong, &turned, err);
    if (status == MSR_OK && !turned && verdict != MSR_OK)
      return msri_fail(err, verdict, "%s", said.message);
  }
  return status;
}

/* The first frame that is still to come: those that the state has passed by itself aren't. */
static uint64_t next_frame(const msr_state *state) {
  uint64_t frame = state->frames;
  const uint64_t images = state->plan->figures.images;
  while (frame < images && msr_plan_frame_iteration(state->plan, frame) < state->iteration) frame++;
  return frame;
}

static msr_status run(msr_state *state, msri_beside *beside, msr_error *err) {
  const msr_plan *plan = state->plan;
  const msri_poll poll = {beside->options->poll, beside->options->data,
                          beside->options->poll_steps};
  msr_status status = MSR_OK;
  for (uint64_t f = next_frame(state); f < plan->figures.images && status == MSR_OK; f++) {
    status = step_to(state, msr_plan_frame_iteration(plan, f), &poll, err);
    if (status == MSR_OK) status = deliver(state, beside, f, err);
  }
  return status == MSR_OK ? step_to(state, plan->figures.iterations, &poll, err) : status;
}

msr_status msr_run(msr_state *state, const msr_run_options *options, msr_error *err) {
  static const msr_run_options none = {0};
  msri_beside beside;
  msri_beside_begin(&beside, options ? options : &none);
  const msr_status status = run(state, &beside, err);
  const msr_status last = msri_beside_end(&beside, status == MSR_OK ? err : NULL);
  if (last != MSR_OK) state->frames = beside.frame;
  return status == MSR_OK ? last : status;
}

msr_status msr_sink_close(msr_sink *sink, msr_error *err) {
  if (!sink->close) return MSR_OK;
  msr_error said = {MSR_OK, ""};
  const msr_status status = sink->close(sink->self, &said);
  *sink = (msr_sink){0};
  if (status == MSR_OK) return MSR_OK;
  return msri_hand_on(err, status, &said, "a sink: %s", msr_status_text(status));
}
