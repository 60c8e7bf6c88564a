/* outputs.h - what a run writes: frames, statistics, trajectory; how long that takes. */
#ifndef CLI_OUTPUTS_H
#define CLI_OUTPUTS_H

#include "effects.h"

#include <pthread.h>

enum { MOST_OUTPUTS = 3 };

/* A sink, with the time that it takes. */
typedef struct output {
  task task;        /* that it does; WRITING draws, too */
  pthread_t thread; /* of the run */
  double *seconds;  /* [TASKS] of the outputs, */
  double *beside;   /* [TASKS] and beside the run */
  uint64_t *frames; /* [TASKS] that it took */
  msr_sink sink;
} output;

typedef struct outputs {
  msr_sink sink[MOST_OUTPUTS + 1]; /* [n], and room for one of the caller's own */
  output output[MOST_OUTPUTS];     /* [n] */
  size_t n;
  double seconds[TASKS];  /* of the run's, opening and closing included; */
  double beside[TASKS];   /* of a thread beside it, while it goes on */
  uint64_t frames[TASKS]; /* that went there */
} outputs;

/* Opens all that the settings ask for, or nothing: a failure leaves no file or directory behind.
 * The sinks point to `out`, which must stay where it is.
 * MSR_EUSAGE, MSR_EIO, MSR_ENOMEM. */
msr_status outputs_open(const settings *s, const msr_plan *plan, outputs *out, msr_error *err);

/* Closes all; err, which may be NULL, is filled by the first that fails. */
msr_status outputs_close(outputs *out, msr_error *err);

#endif
