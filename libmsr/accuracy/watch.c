/* watch.c - the time that a study may take, and the caller who may end it.
 *
 * The budget is wall time. Runs are timed by the processor time of their thread, which other
 * programs on the machine hardly change. A look at the clock costs as much as a step of a small
 * scene, so that looks are spaced by a number of substeps that adapts to their length. */
#include "accuracy/watch.h"

#include "accuracy/trial.h"
#include "base/number.h"

#include <math.h>
#include <time.h>

static const double period = 0.002; /* between looks [s] */

static double seconds(clockid_t clock) {
  struct timespec now;
  clock_gettime(clock, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double msri_thread_seconds(void) { return seconds(CLOCK_THREAD_CPUTIME_ID); }

double msri_watch_elapsed(const msri_watch *watch) {
  return seconds(CLOCK_MONOTONIC) - watch->begin;
}

void msri_watch_begin(msri_watch *watch, const msr_accuracy_options *options, double budget) {
  *watch = (msri_watch){.options = options,
                        .begin = seconds(CLOCK_MONOTONIC),
                        .budget = options->budget > 0 ? options->budget : budget,
                        .share = 1,
                        .left = 1,
                        .stride = 1};
}

void msri_watch_next(msri_watch *watch, double share, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  msri_vformat(watch->text, sizeof watch->text, format, arguments);
  va_end(arguments);
  watch->share = share;
  watch->most = HUGE_VAL;
  watch->costly = false;
  watch->over = watch->status != MSR_OK;
  watch->left = watch->stride = 1;
  watch->looked = msri_watch_elapsed(watch);
}

msr_status msri_watch_look(msri_watch *watch) {
  if (watch->status != MSR_OK) return watch->status;
  const double share = msri_watch_elapsed(watch) / watch->budget;
  const msr_accuracy_progress progress = {watch->text, msri_min(share, 1)};
  const msr_accuracy_options *options = watch->options;
  if (options->poll) watch->status = options->poll(options->data, &progress);
  watch->over = watch->status != MSR_OK || share > watch->share;
  if (watch->status != MSR_OK) return watch->status;
  return watch->over ? MSR_EINTR : MSR_OK;
}

static msr_status poll(void *data, const msr_state *state) {
  msri_watch *watch = data;
  watch->costly = watch->most < HUGE_VAL && msri_trial_cost(state) > watch->most;
  if (watch->costly) return MSR_EINTR;
  if (--watch->left > 0) return MSR_OK;
  const double now = msri_watch_elapsed(watch), since = now - watch->looked;
  if (since < period / 2)
    watch->stride *= 2;
  else if (since > 2 * period && watch->stride > 1)
    watch->stride /= 2;
  watch->looked = now;
  watch->left = watch->stride;
  return msri_watch_look(watch);
}

msri_poll msri_watch_poll(msri_watch *watch) { return (msri_poll){poll, watch, 0}; }
