/* figure.h - what a study found, as a work-precision diagram. */
#ifndef CLI_FIGURE_H
#define CLI_FIGURE_H

#include "study.h"

/* Can it be drawn? MSR_EIO, with advice; MSR_EINTR. */
msr_status figure_check(const settings *s, msr_error *err);

/* Draws it to a descriptor; the name of --plot tells whether as PNG or as SVG. MSR_EIO, MSR_EINTR.
 */
msr_status figure_draw(const study *st, int out, msr_error *err);

#endif
