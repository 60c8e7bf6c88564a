/* watch.c - a run as its user sees it. It is ended between two steps, so that all that was written
 * stays whole. */
#include "watch.h"

#include "signals.h"
#include "times.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

void watch_start(watch *w, const settings *s, const msr_plan *plan) {
  *w = (watch){.s = s, .plan = msr_plan_describe(plan)};
  status_line_start(&w->line, s);
  signals_catch();
}

static void follow_energy(watch *w, uint64_t frame, const msr_state *state) {
  const double start = status_line_now(), energy = msr_state_energy(state).total;
  w->looking += status_line_now() - start;
  w->looks++;
  if (frame == 0) w->first_energy = w->least_energy = w->most_energy = energy;
  w->least_energy = fmin(w->least_energy, energy);
  w->most_energy = fmax(w->most_energy, energy);
}

static msr_status look(void *self, const msr_state *state, uint64_t frame, msr_error *err) {
  watch *w = self;
  (void)err;
  if (w->s->verbose) follow_energy(w, frame, state);
  return MSR_OK;
}

static msr_status count_frame(void *self, uint64_t frame, msr_error *err) {
  watch *w = self;
  (void)err;
  w->frames = frame + 1;
  return MSR_OK;
}

static msr_status close_nothing(void *self, msr_error *err) {
  (void)self, (void)err;
  return MSR_OK;
}

msr_sink watch_sink(watch *w) { return (msr_sink){w, look, close_nothing, count_frame}; }

static void show(const watch *w, uint64_t done) {
  const double share = (double)done / (double)w->plan.iterations;
  const double rate = (double)done / (w->line.shown - w->line.started);
  const double left = (double)(w->plan.iterations - done) / rate;
  status_line_show("frame %" PRIu64 "/%" PRIu64 "  %.0f %%  %.0f iterations/s  %.0f:%02.0f left",
                   (uint64_t)w->frames, w->plan.images, 100 * share, rate, floor(left / 60),
                   floor(fmod(left, 60)));
}

msr_status watch_poll(void *data, const msr_state *state) {
  watch *w = data;
  const uint64_t done = msr_state_iteration(state);
  if (signals_caught()) return MSR_EINTR;
  if (done > 0 && status_line_due(&w->line)) show(w, done);
  return MSR_OK;
}

static void print_where(const watch *w) {
  const char *const dir = w->s->output;
  const bool slash = dir[strlen(dir) - 1] == '/';
  if (w->s->no_frames) {
    fputs(", none drawn", stderr);
  } else if (strcmp(dir, "-") == 0) {
    fputs(" to standard output", stderr);
  } else {
    fprintf(stderr, " in %s%s (frame-000000.ppm ...)", dir, slash ? "" : "/");
  }
}

static void print_energy(const watch *w) {
  const double start = w->first_energy, scale = fabs(start) > 0 ? 100 / fabs(start) : 1;
  fprintf(stderr, ", energy within %+.2g .. %+.2g%s of the start",
          scale * (w->least_energy - start), scale * (w->most_energy - start),
          fabs(start) > 0 ? " %" : "");
}

static void print_leaps(const watch *w, const msr_state *state) {
  const msr_work work = msr_state_work(state);
  const double all = (double)w->plan.iterations * (double)w->plan.substeps;
  if (!w->plan.leaps) return;
  fprintf(stderr, ", %" PRIu64 " long steps (%s) for %.3g %% of the substeps", work.leaps,
          w->plan.leaps->name, 100 * (double)work.leapt / all);
}

static void print_rest(const msr_state *state) {
  const size_t resting = msr_state_resting(state);
  if (resting > 0) fprintf(stderr, ", %zu object%s at rest", resting, resting == 1 ? "" : "s");
}

static void tell_of_care(const watch *w, const msr_state *state) {
  const msr_work work = msr_state_work(state);
  char text[200];
  if (work.careful == UINT64_MAX) return;
  snprintf(text, sizeof text,
           "from t = %.6g s on by steps of energy-momentum: energy came from nowhere, as substeps "
           "of %s couldn't follow what is crushed there",
           (double)work.careful * w->plan.dt, w->plan.integrator->name);
  tell(w->s, "note", text);
}

/* The guard lets a run heat much further before it ends it. */
static void warn_of_heating(const watch *w, double gain) {
  char text[160];
  if (!(gain > 0.05)) return;
  snprintf(text, sizeof text,
           "energy from nowhere: %.0f %% of what the scene had to give; more substeps conserve it "
           "better (--substeps %" PRIu64 ")",
           100 * gain, 4 * w->plan.substeps);
  tell(w->s, "warning", text);
}

void watch_print_summary(const watch *w, const msr_state *state, const effect_list *list,
                         const outputs *out) {
  if (w->s->quiet) return;
  fprintf(stderr, "msr: %" PRIu64 " frame%s", w->frames, w->frames == 1 ? "" : "s");
  print_where(w);
  const double took = status_line_now() - w->line.started;
  fprintf(stderr, ": %.6g s simulated in ", w->plan.dt * (double)w->plan.iterations);
  fprintf(stderr, took < 10 ? "%.2g s" : "%.0f s", took);
  if (w->s->verbose) print_energy(w);
  if (w->s->verbose) print_leaps(w, state);
  if (w->s->verbose) print_rest(state);
  fputs("\n", stderr);
  const times looks = {w->looking, w->looks};
  if (list) times_print(stderr, list, state, out, &looks, took);
  tell_of_care(w, state);
  warn_of_heating(w, msr_state_energy_gain(state));
}
