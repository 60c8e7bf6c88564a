/* parse.h - the command line, read and checked. */
#ifndef CLI_PARSE_H
#define CLI_PARSE_H

#include "options.h"

/* Settings from the words after argv[0]; what isn't given has its default. MSR_EUSAGE, MSR_ENOMEM;
 * s->command is set even so, and settings_free takes s in any case. */
msr_status settings_parse(int argc, char **argv, settings *s, msr_error *err);

/* What no option alone can tell: options that contradict each other, operands. MSR_EUSAGE. */
msr_status settings_check(const settings *s, msr_error *err);

void settings_free(settings *s);

#endif
