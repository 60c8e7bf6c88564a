/* watch.h - the time that a study may take, and the caller who may end it. */
#ifndef MSRI_WATCH_H
#define MSRI_WATCH_H

#include "run/step.h"

typedef struct msri_watch {
  const msr_accuracy_options *options;
  double begin, budget;  /* wall time [s] */
  double share;          /* of the budget, after which what is under way must end */
  double looked;         /* at the clock, last */
  uint64_t left, stride; /* substeps until the next look, between looks */
  double most;           /* msri_trial_cost at which what is under way is stopped */
  bool costly;           /* it was stopped because it took more */
  msr_status status;     /* what the caller's poll returned */
  bool over;             /* late, or the caller said so: what is under way has been stopped */
  char text[MSR_MESSAGE_SIZE];
} msri_watch;

/* Starts the clock; a budget of 0 is `budget`. */
void msri_watch_begin(msri_watch *watch, const msr_accuracy_options *options, double budget);

/* What comes next, for the user, may last until this share of the budget has gone, at any
 * cost. */
void msri_watch_next(msri_watch *watch, double share, const char *format, ...) MSRI_PRINTF(3, 4);

/* Is it over? MSR_EINTR, or what the caller's poll returned. */
msr_status msri_watch_look(msri_watch *watch);

/* The same for msri_step, looking at the clock only every few milliseconds. */
msri_poll msri_watch_poll(msri_watch *watch);

/* Wall time since the beginning [s]. */
double msri_watch_elapsed(const msri_watch *watch);

/* Processor time of this thread [s]. */
double msri_thread_seconds(void);

#endif
