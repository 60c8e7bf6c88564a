/* watch.c - each run is a process of its own, so that one that crashes or never ends harms no
 * other; what is seen lies in memory that both share. The bench's own eyes are used for all: energy
 * is sum m v^2 / 2 + m g y + k (l - L)^2 / 2, a mass is where its centre is. */
#include "watch.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* Looks in a run. */
enum { LOOKS = 500 };

/* A run whose energy has grown so much has exploded, and is ended. */
static const double runaway = 100;

typedef struct scene {
  const problem *p;
  double *x, *y, *vx, *vy; /* [n] */
} scene;

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* ---- Looking */

static double energy(const scene *s) {
  const problem *p = s->p;
  double sum = 0;
  for (size_t i = 0; i < p->n; i++)
    sum += p->m[i] * ((s->vx[i] * s->vx[i] + s->vy[i] * s->vy[i]) / 2 + p->gravity * s->y[i]);
  for (size_t b = 0; b < p->n_bonds; b++) {
    const bond *l = &p->bonds[b];
    const double stretch = hypot(s->x[l->i] - s->x[l->j], s->y[l->i] - s->y[l->j]) - l->L;
    sum += l->k * stretch * stretch / 2;
  }
  return sum;
}

/* From a point in a support to the nearest pixel that is none. */
static double depth_at(const problem *p, double x, double y) {
  double least = (double)INFINITY;
  for (size_t r = 0; r < p->height; r++)
    for (size_t c = 0; c < p->width; c++) {
      if (p->black[r * p->width + c]) continue;
      const double dx = fmax(0, fmax((double)c - x, x - (double)c - 1));
      const double dy = fmax(0, fmax((double)r - y, y - (double)r - 1));
      least = fmin(least, hypot(dx, dy));
    }
  return fmin(least, fmin(fmin(x, y), fmin((double)p->width - x, (double)p->height - y)));
}

static bool is_out(const problem *p, double x, double y) {
  if (!(x >= 0 && x < (double)p->width && y >= 0 && y < (double)p->height)) return p->closed;
  return !p->inside[(size_t)y * p->width + (size_t)x];
}

static void look_at_places(const scene *s, sight *seen) {
  const double surface = 0.01;
  size_t in = 0, out = 0;
  for (size_t i = 0; i < s->p->n; i++)
    if (is_black(s->p, s->x[i], s->y[i])) {
      const double depth = depth_at(s->p, s->x[i], s->y[i]);
      seen->depth = fmax(seen->depth, depth);
      in += depth > surface;
    } else
      out += is_out(s->p, s->x[i], s->y[i]);
  if (in > seen->in) seen->in = in;
  if (out > seen->out) seen->out = out;
}

static double fastest(const scene *s) {
  double most = 0;
  for (size_t i = 0; i < s->p->n; i++) most = fmax(most, hypot(s->vx[i], s->vy[i]));
  return most;
}

static void look(const scene *s, uint64_t iteration, sight *seen) {
  const problem *p = s->p;
  const double e = energy(s);
  seen->t = (double)iteration * p->dt;
  if (!isfinite(e)) {
    seen->how = NOT_FINITE;
    return;
  }
  if (iteration == 0) seen->start = e;
  const double change = (e - seen->start) / (p->scale > 0 ? p->scale : seen->start);
  seen->gain = fmax(seen->gain, change);
  seen->loss = fmax(seen->loss, -change);
  look_at_places(s, seen);
  if (iteration >= p->iterations - p->iterations / 10) seen->speed = fmax(seen->speed, fastest(s));
  if (change > runaway) seen->how = RUNAWAY;
}

/* ---- Working */

static void tell(int pipe, const sight *seen) {
  if (write(pipe, seen, sizeof *seen) != sizeof *seen) _exit(EXIT_FAILURE);
}

static void work(const solver *by, const problem *p, int pipe) {
  double *z = need(4 * p->n, sizeof *z);
  const scene s = {p, z, z + p->n, z + 2 * p->n, z + 3 * p->n};
  void *self = by->open(p);
  sight seen = {.how = WORKING};
  const double begin = now();
  const uint64_t stride = p->iterations > LOOKS ? p->iterations / LOOKS : 1;
  for (uint64_t i = 0; seen.how == WORKING; i += stride) {
    by->read(self, s.x, s.y, s.vx, s.vy);
    look(&s, i, &seen);
    if (i >= p->iterations && seen.how == WORKING) seen.how = DONE;
    tell(pipe, &seen);
    if (seen.how != WORKING) return;
    if (!by->advance(self, stride, seen.text)) seen.how = STOPPED;
    seen.seconds = now() - begin;
    if (seen.how == STOPPED) tell(pipe, &seen);
  }
}

static void work_within(const solver *by, const problem *p, unsigned limit, int pipe) {
  const struct rlimit time = {limit, limit + 1}, core = {0, 0};
  setrlimit(RLIMIT_CPU, &time);
  setrlimit(RLIMIT_CORE, &core);
  work(by, p, pipe);
  _exit(EXIT_SUCCESS);
}

/* The last of what was seen, and how the process ended if it didn't say. */
static sight follow(pid_t child, int pipe, unsigned limit) {
  sight seen = {.how = WORKING}, next;
  while (read(pipe, &next, sizeof next) == sizeof next) seen = next;
  int status;
  waitpid(child, &status, 0);
  if (seen.how != WORKING) return seen;
  const bool killed = WIFSIGNALED(status);
  const bool late = killed && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL);
  seen.how = late ? LATE : CRASHED;
  if (late) seen.seconds = limit;
  return seen;
}

sight watch(const solver *by, const problem *p, unsigned limit) {
  const char *declined = by->declines ? by->declines(p) : NULL;
  sight seen = {.how = DECLINED};
  if (declined) {
    snprintf(seen.text, sizeof seen.text, "%s", declined);
    return seen;
  }
  int ends[2];
  fflush(NULL);
  if (pipe(ends) != 0) bench_fail("no pipe could be made");
  const pid_t child = fork();
  if (child < 0) bench_fail("no process could be made");
  if (child == 0) work_within(by, p, limit, ends[1]);
  close(ends[1]);
  seen = follow(child, ends[0], limit);
  close(ends[0]);
  return seen;
}
