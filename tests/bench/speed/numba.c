/* numba.c - Numba in a Python of its own, numba_peer.py; one serves all works, so that a kernel is
 * compiled once. */
#include "child.h"
#include "speed.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static child python;
static bool started;
static char version[64];

typedef struct numba_run {
  size_t n;
  int number; /* that Python knows it by */
} numba_run;

static bool start(void) {
  char own[256];
  snprintf(own, sizeof own, "%s/python/bin/python3", scratch);
  const char *const pythons[] = {own, "python3", "/usr/bin/python3"};
  for (size_t i = 0; !started && i < sizeof pythons / sizeof *pythons; i++) {
    const char *const argv[] = {pythons[i], "tests/bench/speed/numba_peer.py", scratch, NULL};
    started = child_open(&python, argv) && child_ask(&python, "Numba", "\n");
    if (!started) child_close(&python);
  }
  if (started) memcpy(version, python.line, strcspn(python.line, "\n"));
  return started;
}

const char *numba_version(void) { return started || start() ? version : "no Numba"; }

static void put(const char *path, const work *w) {
  FILE *f = fopen(path, "wb");
  if (!f) bench_fail("%s can't be written", path);
  if (w->drawn)
    fwrite(w->there, sizeof *w->there, w->width * w->height, f);
  else
    fwrite(w->i, sizeof *w->i, w->n_springs, f), fwrite(w->j, sizeof *w->j, w->n_springs, f);
  const double *const arrays[] = {w->x, w->y, w->u, w->v};
  for (size_t i = 0; i < 4; i++) fwrite(arrays[i], sizeof *w->x, w->n, f);
  if (fclose(f) != 0) bench_fail("%s can't be written", path);
}

static double ask(const char *question, const char *path, int number, size_t steps) {
  if (!child_ask(&python, "=", "%s %d %zu %s\n", question, number, steps, path))
    bench_fail("Python has ended: %s", python.line);
  return strtod(python.line + 1, NULL);
}

static entry open_numba(const contestant *c, const work *w, int threads) {
  (void)c;
  static int numbers;
  char path[256], data[300];
  if (!started && !start()) return (entry){.missing = "no Python has Numba"};
  numba_run *r = need(1, sizeof *r);
  *r = (numba_run){w->n, numbers++};
  snprintf(path, sizeof path, "%s/numba.data", scratch);
  put(path, w);
  snprintf(data, sizeof data, "%s %d %zu %zu %zu %d %.17g %.17g", path, w->drawn + w->full,
           w->width, w->height, w->n_springs, threads, step, step / mass * stiffness);
  const double bytes = ask("open", data, r->number, w->n);
  unlink(path);
  return (entry){r, w->n_springs, bytes, true, NULL};
}

static double run_numba(void *self, size_t steps) {
  const numba_run *r = self;
  return ask("run", "", r->number, steps);
}

static void read_numba(void *self, double *x, double *y) {
  const numba_run *r = self;
  char path[256];
  snprintf(path, sizeof path, "%s/numba.data", scratch);
  ask("read", path, r->number, 0);
  FILE *f = fopen(path, "rb");
  if (!f || fread(x, sizeof *x, r->n, f) + fread(y, sizeof *y, r->n, f) != 2 * r->n)
    bench_fail("%s can't be read", path);
  fclose(f);
  unlink(path);
}

static void close_numba(void *self) {
  const numba_run *r = self;
  ask("close", "", r->number, 0);
  free(self);
}

const contestant numba = {
    .name = "Numba, parallel",
    .grain = 1,
    .threads = MOST_THREADS,
    .open = open_numba,
    .run = run_numba,
    .read = read_numba,
    .close = close_numba,
};
