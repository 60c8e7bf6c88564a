/* renderer.h - drawing in two halves: what needs the state, and the rest. */
#ifndef MSRI_RENDERER_H
#define MSRI_RENDERER_H

#include "base/file.h"

/* Takes from the state where its masses are. */
void msri_renderer_take(msr_renderer *renderer, const msr_state *state);

/* Draws what was taken, as P6, into a file; the time that drawing took, without writing, is added
 * to `drawing` [s]. MSR_EIO. */
msr_status msri_renderer_write(msr_renderer *renderer, msri_file *file, double *drawing,
                               msr_error *err);

#endif
