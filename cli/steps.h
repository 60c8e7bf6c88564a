/* steps.h - whether a run steps row by row, by how many threads, and why not otherwise. */
#ifndef CLI_STEPS_H
#define CLI_STEPS_H

#include "options.h"

#include <stdio.h>

/* One line, as msr plan prints it. */
void steps_print(FILE *out, const settings *s, const msr_plan *plan);

/* Tells a user who asked for threads that steps don't make use of them. */
void steps_note(const settings *s, const msr_plan *plan);

#endif
