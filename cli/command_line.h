/* command_line.h - command lines to type. */
#ifndef CLI_COMMAND_LINE_H
#define CLI_COMMAND_LINE_H

#include "options.h"

/* What was typed, as one line for a shell. */
void command_line_print(FILE *out, const settings *s);

/* A run of the same scene with these steps in time. */
void command_line_print_run(FILE *out, const settings *s, const msr_plan_options *options);

#endif
