/* watch.h - follows a run: frames done, progress on a terminal, energy. */
#ifndef CLI_WATCH_H
#define CLI_WATCH_H

#include "outputs.h"
#include "status_line.h"

typedef struct watch {
  const settings *s;
  msr_plan_figures plan;
  status_line line;
  _Atomic uint64_t frames; /* that all outputs took and completed, maybe in another thread */
  double first_energy, least_energy, most_energy;
  uint64_t looks; /* at the energy */
  double looking; /* [s] */
} watch;

/* Before outputs are opened: from here on a signal ends the run, so that they are closed. */
void watch_start(watch *w, const settings *s, const msr_plan *plan);

/* To be the last sink: it counts the frames. */
msr_sink watch_sink(watch *w);

/* For msr_run_options; `data` is the watch. MSR_EINTR after a signal. */
msr_status watch_poll(void *data, const msr_state *state);

/* One line that says what was done; a table of times if there is a list of effects; a warning if
 * the state came to energy from nowhere. */
void watch_print_summary(const watch *w, const msr_state *state, const effect_list *list,
                         const outputs *out);

#endif
