/* watch.h - follows a run: signals, frames done, progress on a terminal, energy. */
#ifndef CLI_WATCH_H
#define CLI_WATCH_H

#include "options.h"

typedef struct watch {
  const settings *s;
  msr_plan_figures plan;
  bool shows;            /* progress goes to a terminal */
  double started, shown; /* [s], when the run began and progress was last shown */
  uint64_t frames;       /* that all outputs took */
  double first_energy, least_energy, most_energy;
} watch;

/* Before outputs are opened: from here on a signal ends the run, not msr, so that they are closed.
 * That goes for Ctrl-C, SIGTERM and SIGHUP, of which the third ends msr at once, and for SIGPIPE.
 */
void watch_start(watch *w, const settings *s, const msr_plan *plan);

/* To be the last sink: it counts the frames. */
msr_sink watch_sink(watch *w);

/* For msr_run_options; `data` is the watch. MSR_EINTR after a signal. */
msr_status watch_poll(void *data, const msr_state *state);

/* Wipes the progress line: to be called before anything else is printed. */
void watch_end(watch *w);

/* If nobody reads what msr writes any more, ends it as if SIGPIPE had not been caught. */
void watch_end_by_pipe(void);

/* One line that says what was done, and a warning if the state came to energy from nowhere. */
void watch_print_summary(const watch *w, const msr_state *state);

#endif
