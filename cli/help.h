/* help.h - how to use the command. */
#ifndef CLI_HELP_H
#define CLI_HELP_H

#include "options.h"

/* Usage, commands and examples. */
void help_print(FILE *out);

/* One command and its options. */
void help_print_command(FILE *out, const struct command *c);

void help_print_version(FILE *out);

#endif
