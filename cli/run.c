/* run.c - msr run: simulates, and writes what was asked for. */
#include "commands.h"
#include "report.h"
#include "signals.h"
#include "simulation.h"
#include "steps.h"
#include "watch.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

typedef struct progress {
  char text[80];
} progress;

/* How far a run came that was stopped: "after 1 of 3 frames, which is whole". */
static progress progress_of(const watch *w) {
  progress p = {"before any frame"};
  if (w->frames == 0) return p;
  snprintf(p.text, sizeof p.text, "after %" PRIu64 " of %" PRIu64 " frame%s, which %s whole",
           w->frames, w->plan.images, w->plan.images == 1 ? "" : "s",
           w->frames == 1 ? "is" : "are");
  return p;
}

/* What stopped a run, and how far it had come. */
static msr_status explain(const watch *w, msr_status status, msr_error *err) {
  const size_t length = strlen(err->message);
  if (status == MSR_EINTR) return fail(err, status, "interrupted %s", progress_of(w).text);
  if (status == MSR_EUNSTABLE) {
    snprintf(err->message + length, sizeof err->message - length, " (%s)", progress_of(w).text);
  }
  return status;
}

/* Runs and closes the outputs, whatever happens. */
static msr_status advance(watch *w, msr_state *state, outputs *out, msr_error *err) {
  out->sink[out->n] = watch_sink(w);
  const msr_run_options options = {.sinks = out->sink,
                                   .n_sinks = out->n + 1,
                                   .poll = watch_poll,
                                   .data = w,
                                   .threads = (unsigned)w->s->threads};
  const msr_status status = msr_run(state, &options, err);
  status_line_end(&w->line);
  const msr_status closed = outputs_close(out, status == MSR_OK ? err : NULL);
  signals_end_by_pipe();
  return status == MSR_OK ? closed : explain(w, status, err);
}

/* `list` is told of, if it isn't NULL. */
static msr_status simulate(const settings *s, const msr_plan *plan, const effect_list *list,
                           msr_error *err) {
  watch w;
  outputs out;
  msr_state *state = NULL;
  msr_status status = msr_state_create(plan, &state, err);
  if (status != MSR_OK) return status;
  watch_start(&w, s, plan);
  status = outputs_open(s, plan, &out, err);
  if (status == MSR_OK) status = advance(&w, state, &out, err);
  if (status == MSR_OK) watch_print_summary(&w, state, list, &out);
  msr_state_free(state);
  return status;
}

msr_status run_command(const settings *s, msr_error *err) {
  msr_plan *plan = NULL;
  msr_status status = simulation_plan(s, &plan, err);
  if (status != MSR_OK) return status;
  effect_list *const list = s->verbose ? effects_create(s, plan) : NULL;
  if (s->verbose && !list) status = fail(err, MSR_ENOMEM, "out of memory for the effects");
  if (list) steps_print(stderr, s, plan);
  if (list) effects_print(stderr, list);
  if (status == MSR_OK) status = simulate(s, plan, list, err);
  free(list);
  msr_plan_free(plan);
  return status;
}
