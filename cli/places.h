/* places.h - where a run's files are: an output never replaces an input or another output. */
#ifndef CLI_PLACES_H
#define CLI_PLACES_H

#include "options.h"

/* MSR_EUSAGE if an output would overwrite an input, or two outputs each other, however their names
 * are spelt. */
msr_status places_check(const settings *s, msr_error *err);

#endif
