/* report.h - what the command says to its user, and the exit status that goes with it. */
#ifndef CLI_REPORT_H
#define CLI_REPORT_H

#include "options.h"

#if defined(__GNUC__)
#define CLI_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define CLI_PRINTF(text, first)
#endif

/* Fills err and returns status, as the library's own functions do. */
msr_status fail(msr_error *err, msr_status status, const char *format, ...) CLI_PRINTF(3, 4);

/* A line `msr: kind: text` on standard error, unless the user wants quiet. */
void tell(const settings *s, const char *kind, const char *text);

/* Prints why the command failed, if it did, and returns its exit status. */
int report(const settings *s, msr_status status, const msr_error *err);

/* Ends what was printed on standard output: MSR_EIO if it didn't all get there. */
msr_status print_end(msr_error *err);

#endif
