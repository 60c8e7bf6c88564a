/* status_line.h - one line on a terminal that says how far the work is, written over and over. */
#ifndef CLI_STATUS_LINE_H
#define CLI_STATUS_LINE_H

#include "report.h"

typedef struct status_line {
  bool shows;            /* there is a terminal, and the user doesn't want quiet */
  double started, shown; /* [s], when the work began and the line was last written */
} status_line;

/* Seconds of a clock that never jumps. */
double status_line_now(void);

void status_line_start(status_line *line, const settings *s);

/* Is it time to write it again? If so, it takes note of that. */
bool status_line_due(status_line *line);

/* Only when it is due. */
void status_line_show(const char *format, ...) CLI_PRINTF(1, 2);

/* Wipes it: to be called before anything else is printed. */
void status_line_end(status_line *line);

#endif
