/* outputs.c - opens and closes what a run writes: one row per output. */
#include "outputs.h"

#include "simulation.h"

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

typedef struct output {
  const char *(*path)(const settings *s); /* NULL: not asked for */
  msr_status (*open)(const settings *s, const msr_plan *plan, msr_sink *sink, msr_error *err);
} output;

/* Statistics and trajectory take their place only when they are closed after a frame, so that a
 * failure undoes them; frames are the last, since --force removes those of an earlier run. */
static const output rows[MOST_OUTPUTS] = {
    {stats_path, open_stats},
    {trajectory_path, open_trajectory},
    {frames_path, open_frames},
};

msr_status outputs_open(const settings *s, const msr_plan *plan, outputs *out, msr_error *err) {
  msr_status status = MSR_OK;
  out->n = 0;
  for (size_t i = 0; i < MOST_OUTPUTS && status == MSR_OK; i++) {
    if (!rows[i].path(s)) continue;
    status = rows[i].open(s, plan, &out->sink[out->n], err);
    if (status == MSR_OK) out->n++;
  }
  if (status != MSR_OK) outputs_close(out, NULL);
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
