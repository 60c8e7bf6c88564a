/* status_line.c - a line that begins with a carriage return, written five times a second. */
#include "status_line.h"

#include <stdarg.h>
#include <time.h>
#include <unistd.h>

enum { WIDTH = 78 };

double status_line_now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void status_line_start(status_line *line, const settings *s) {
  line->shows = !s->quiet && isatty(STDERR_FILENO);
  line->started = line->shown = status_line_now();
}

bool status_line_due(status_line *line) {
  const double time = line->shows ? status_line_now() : 0;
  if (!line->shows || time - line->shown < 0.2) return false;
  line->shown = time;
  return true;
}

void status_line_show(const char *format, ...) {
  char text[WIDTH + 1];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  fprintf(stderr, "\r%-*s", WIDTH, text);
  fflush(stderr);
}

void status_line_end(status_line *line) {
  if (line->shown > line->started) fprintf(stderr, "\r%*s\r", WIDTH, "");
  line->shown = line->started;
}
