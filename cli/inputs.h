/* inputs.h - the two files that msr reads. */
#ifndef CLI_INPUTS_H
#define CLI_INPUTS_H

#include "options.h"

typedef struct inputs {
  const char *picture, *conf;
} inputs;

/* Which of the two operands is the picture; pipes aren't read. MSR_EINPUT if both are. */
msr_status inputs_find(const settings *s, inputs *in, msr_error *err);

#endif
