/* outputs.c - opens and closes what a run writes: one row per output. The frames' directory is made
 * first, since other outputs may be in it, and goes again if one of them can't be opened. */
#include "outputs.h"

#include "report.h"
#include "simulation.h"
#include "status_line.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *frames_path(const settings *s) { return s->no_frames ? NULL : s->output; }
static const char *stats_path(const settings *s) { return s->stats; }
static const char *trajectory_path(const settings *s) { return s->trajectory; }

static msr_status open_frames(const settings *s, const msr_plan *plan, msr_sink *sink,
                              msr_error *err) {
  const msr_style style = simulation_style(s);
  return msr_frames_open(plan, s->output, &style, s->force, sink, err);
}

static msr_status open_stats(const settings *s, const msr_plan *plan, msr_sink *sink,
                             msr_error *err) {
  return msr_stats_open(plan, s->stats, sink, err);
}

static msr_status open_trajectory(const settings *s, const msr_plan *plan, msr_sink *sink,
                                  msr_error *err) {
  return msr_trajectory_open(plan, s->trajectory, sink, err);
}

typedef struct row {
  task task;
  const char *(*path)(const settings *s); /* NULL: not asked for */
  msr_status (*open)(const settings *s, const msr_plan *plan, msr_sink *sink, msr_error *err);
} row;

/* ---- How long it takes */

/* Time since `start` goes to the output, but for what of it went to drawing. The threads that come
 * here take turns. */
static void add_time(output *o, double start, double drawn) {
  double *const seconds = pthread_equal(pthread_self(), o->thread) ? o->seconds : o->beside;
  seconds[o->task] += status_line_now() - start - drawn;
  seconds[DRAWING] += drawn;
}

static double drawing(const output *o) {
  return o->task == WRITING ? msr_frames_drawing(&o->sink) : 0;
}

static msr_status write_timed(void *self, const msr_state *state, uint64_t frame, msr_error *err) {
  output *const o = self;
  const double start = status_line_now(), before = drawing(o);
  const msr_status status = o->sink.write(o->sink.self, state, frame, err);
  add_time(o, start, drawing(o) - before);
  o->frames[o->task]++;
  return status;
}

static msr_status complete_timed(void *self, uint64_t frame, msr_error *err) {
  output *const o = self;
  const double start = status_line_now(), before = drawing(o);
  const msr_status status = o->sink.complete(o->sink.self, frame, err);
  add_time(o, start, drawing(o) - before);
  return status;
}

static msr_status close_timed(void *self, msr_error *err) {
  output *const o = self;
  const double start = status_line_now();
  const msr_status status = msr_sink_close(&o->sink, err);
  add_time(o, start, 0);
  return status;
}

/* ---- Opening and closing */

/* Statistics and trajectory take their place only when they are closed after a frame, so that a
 * failure undoes them; frames are the last, since --force removes those of an earlier run. */
static const row rows[MOST_OUTPUTS] = {
    {STATS, stats_path, open_stats},
    {TRAJECTORY, trajectory_path, open_trajectory},
    {WRITING, frames_path, open_frames},
};

static msr_status open_row(const row *r, const settings *s, const msr_plan *plan, outputs *out,
                           msr_error *err) {
  output *const o = &out->output[out->n];
  const double start = status_line_now();
  *o = (output){r->task, pthread_self(), out->seconds, out->beside, out->frames, {0}};
  const msr_status status = r->open(s, plan, &o->sink, err);
  if (status != MSR_OK) return status;
  out->sink[out->n++] =
      (msr_sink){o, write_timed, close_timed, o->sink.complete ? complete_timed : NULL};
  add_time(o, start, 0);
  return MSR_OK;
}

static msr_status open_rows(const settings *s, const msr_plan *plan, outputs *out, msr_error *err) {
  msr_status status = MSR_OK;
  for (size_t i = 0; i < MOST_OUTPUTS && status == MSR_OK; i++) {
    if (rows[i].path(s)) status = open_row(&rows[i], s, plan, out, err);
  }
  if (status != MSR_OK) outputs_close(out, NULL);
  return status;
}

static msr_status cannot_make(const char *dir, msr_error *err) {
  char reason[128] = "unknown error";
  strerror_r(errno, reason, sizeof reason);
  return fail(err, MSR_EIO, "%s: cannot make it: %s; name another directory", dir, reason);
}

/* Makes a directory and those above it; made[i]: the first i bytes of its path were not there. */
static bool make_directory(char *path, bool *made) {
  for (size_t end = 1; path[end - 1]; end++) {
    const char next = path[end];
    if (next && next != '/') continue;
    path[end] = '\0';
    made[end] = mkdir(path, 0777) == 0;
    if (!made[end] && errno != EEXIST) return false;
    path[end] = next;
  }
  return true;
}

/* Removes what was made, from the deepest up. */
static void unmake_directory(char *path, const bool *made) {
  for (size_t end = strlen(path); end > 0; end--) {
    path[end] = '\0';
    if (made[end]) rmdir(path);
  }
}

static msr_status open_in(char *path, bool *made, const settings *s, const msr_plan *plan,
                          outputs *out, msr_error *err) {
  const msr_status status =
      make_directory(path, made) ? open_rows(s, plan, out, err) : cannot_make(s->output, err);
  if (status != MSR_OK) unmake_directory(path, made);
  return status;
}

msr_status outputs_open(const settings *s, const msr_plan *plan, outputs *out, msr_error *err) {
  *out = (outputs){.n = 0};
  if (s->no_frames || strcmp(s->output, "-") == 0) return open_rows(s, plan, out, err);
  char *const path = strdup(s->output);
  bool *const made = calloc(strlen(s->output) + 1, sizeof *made);
  const msr_status status = path && made
                                ? open_in(path, made, s, plan, out, err)
                                : fail(err, MSR_ENOMEM, "out of memory for the frames' directory");
  free(path);
  free(made);
  return status;
}

msr_status outputs_close(outputs *out, msr_error *err) {
  msr_status first = MSR_OK;
  for (size_t i = 0; i < out->n; i++) {
    const msr_status status = msr_sink_close(&out->sink[i], first == MSR_OK ? err : NULL);
    if (first == MSR_OK) first = status;
  }
  out->n = 0;
  return first;
}
