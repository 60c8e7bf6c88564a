/* fail.c - one line to stderr, and the end. */
#include "fail.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

void bench_fail(const char *what, ...) {
  va_list args;
  va_start(args, what);
  fputs("bench: ", stderr);
  vfprintf(stderr, what, args);
  fputc('\n', stderr);
  va_end(args);
  exit(EXIT_FAILURE);
}
