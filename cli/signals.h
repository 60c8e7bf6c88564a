/* signals.h - Ctrl-C and its like end the work, not msr, so that what was made stays whole. */
#ifndef CLI_SIGNALS_H
#define CLI_SIGNALS_H

/* From here on Ctrl-C, SIGTERM, SIGHUP and SIGPIPE are only noted; another of the first three, 0.2
 * s later or more, ends msr at once. */
void signals_catch(void);

/* The last that came, or 0. */
int signals_caught(void);

/* If nobody reads what msr writes any more, ends it as if SIGPIPE had not been caught. */
void signals_end_by_pipe(void);

#endif
