/* outputs.h - what a run writes: frames, statistics, trajectory. */
#ifndef CLI_OUTPUTS_H
#define CLI_OUTPUTS_H

#include "options.h"

enum { MOST_OUTPUTS = 3 };

typedef struct outputs {
  msr_sink sink[MOST_OUTPUTS + 1]; /* [n], and room for one of the caller's own */
  size_t n;
} outputs;

/* Opens all that the settings ask for, or nothing: a failure leaves no file or directory behind.
 * MSR_EUSAGE, MSR_EIO, MSR_ENOMEM. */
msr_status outputs_open(const settings *s, const msr_plan *plan, outputs *out, msr_error *err);

/* Closes all; err, which may be NULL, is filled by the first that fails. */
msr_status outputs_close(outputs *out, msr_error *err);

#endif
