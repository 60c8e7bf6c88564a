/* gnuplot.h - gnuplot as a child process that reads a script and draws. */
#ifndef CLI_GNUPLOT_H
#define CLI_GNUPLOT_H

#include "options.h"

#include <signal.h>
#include <sys/types.h>

typedef struct gnuplot {
  FILE *script;            /* write it here */
  pid_t process;           /* of the child */
  struct sigaction broken; /* what a broken pipe did before */
} gnuplot;

/* What it draws goes to the descriptor `out`. MSR_EIO, with advice if it isn't there. */
msr_status gnuplot_start(gnuplot *g, int out, msr_error *err);

/* Ends the script and waits. MSR_EIO if gnuplot failed; it has told why on standard error.
 * MSR_EINTR after a signal, if it didn't end well. */
msr_status gnuplot_end(gnuplot *g, msr_error *err);

#endif
