/* outputs.h - what a run writes: frames, statistics, trajectory; how long that takes. */
#ifndef CLI_OUTPUTS_H
#define CLI_OUTPUTS_H

#include "effects.h"

enum { MOST_OUTPUTS = 3 };

/* A sink, with the time that it takes. */
typedef struct output {
  msr_sink sink;
  bool beside;      /* it completes frames beside the simulation */
  task task;        /* that it does; WRITING draws, too */
  double *seconds;  /* [TASKS] of the outputs */
  uint64_t *frames; /* [TASKS] likewise: that it took */
} output;

typedef struct outputs {
  msr_sink sink[MOST_OUTPUTS + 1]; /* [n], and room for one of the caller's own */
  output output[MOST_OUTPUTS];     /* [n] */
  size_t n;
  double seconds[TASKS];  /* opening and closing included */
  uint64_t frames[TASKS]; /* that went there */
} outputs;

/* Opens all that the settings ask for, or nothing: a failure leaves no file or directory behind.
 * The sinks point to `out`, which must stay where it is.
 * MSR_EUSAGE, MSR_EIO, MSR_ENOMEM. */
msr_status outputs_open(const settings *s, const msr_plan *plan, outputs *out, msr_error *err);

/* Closes all; err, which may be NULL, is filled by the first that fails. */
msr_status outputs_close(outputs *out, msr_error *err);

#endif
