/* measure.c - time, memory, medians, and the bars that figures are held against. */
#include "speed.h"

#include <stdarg.h>
#include <stdlib.h>
#include <time.h>

double seconds_now(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void *need(size_t count, size_t size) {
  void *block = calloc(count + 1, size);
  if (!block) bench_fail("there is no memory");
  return block;
}

static int by_size(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

spread spread_of(double *sample, size_t n) {
  qsort(sample, n, sizeof *sample, by_size);
  return (spread){sample[n / 4], sample[n / 2], sample[n - 1 - n / 4]};
}

/* ---- Bars */

static char bars[64][160];
static size_t n_bars;

__attribute__((format(printf, 5, 0))) static void add_bar(bool passed, double value,
                                                          const char *relation, double bar,
                                                          const char *what, va_list args) {
  char text[96];
  vsnprintf(text, sizeof text, what, args);
  if (n_bars < sizeof bars / sizeof *bars)
    snprintf(bars[n_bars++], sizeof *bars, "%s    %-62s %8.3g, %s %g", passed ? "PASS" : "FAIL",
             text, value, relation, bar);
}

void bar_at_least(double value, double bar, const char *what, ...) {
  va_list args;
  va_start(args, what);
  add_bar(value >= bar, value, "at least", bar, what, args);
  va_end(args);
}

void bar_at_most(double value, double bar, const char *what, ...) {
  va_list args;
  va_start(args, what);
  add_bar(value <= bar, value, "at most", bar, what, args);
  va_end(args);
}

void bars_print(void) {
  if (n_bars > 0) printf("\n== Bars\n");
  for (size_t i = 0; i < n_bars; i++) printf("%s\n", bars[i]);
}
