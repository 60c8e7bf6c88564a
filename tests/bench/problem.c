/* problem.c - a free 20 x 20 block of m = 0.1 kg, neither gravity nor supports, either deformed by
 * a smooth mode or at rest length and spinning at 2 rad/s, and the right-hand side of it. */
#include "bench.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { SIDE = 20, MASSES = SIDE * SIDE };

static const double mass = 0.1, end = 1, pi = 3.14159265358979323846;

double clock_now(bool elsewhere) {
  struct timespec now;
  clock_gettime(elsewhere ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void *need(size_t count, size_t size) {
  enum { LINE = 64 };
  const size_t bytes = (count * size + LINE - 1) / LINE * LINE;
  void *block = aligned_alloc(LINE, bytes);
  if (!block) bench_fail("out of memory");
  return memset(block, 0, bytes);
}

static msr_scene *block(double k) {
  const msr_conf conf = {
      .dt = end, .mass = mass, .stiffness = k, .iterations = 1000000, .images = 1};
  msr_error err;
  msr_picture *picture;
  msr_scene *scene;
  msr_status status = msr_picture_create(SIDE, SIDE, &picture, &err);
  if (status != MSR_OK) bench_fail("%s", err.message);
  for (size_t i = 0; i < MASSES; i++) memcpy(picture->rgb + 3 * i, "\377\0\0", 3);
  status = msr_scene_from_picture("block", picture, &conf, NULL, &scene, &err);
  if (status != MSR_OK) bench_fail("%s", err.message);
  msr_picture_free(picture);
  return scene;
}

/* The four longest waves that the block has room for, the amplitude falling as length squared. */
static void deform(double *q) {
  const double amplitude = 0.01;
  double *x = q, *y = q + MASSES;
  for (size_t i = 0; i < MASSES; i++) {
    double dx = 0, dy = 0;
    for (int j = 1; j <= 4; j++) {
      const double u = cos(j * pi * x[i] / SIDE), w = cos(j * pi * y[i] / SIDE);
      dx += amplitude / (j * j) * u * (1 + w / 2);
      dy += amplitude / (j * j) * w * (1 - u / 2);
    }
    x[i] += dx;
    y[i] += dy;
  }
}

static void spin(const double *q, double *v) {
  const double rate = 2, centre = SIDE / 2.0;
  for (size_t i = 0; i < MASSES; i++) {
    v[i] = -rate * (q[MASSES + i] - centre);
    v[MASSES + i] = rate * (q[i] - centre);
  }
}

static bool in_time(problem *p) {
  enum { PERIOD = 256 };
  return ++p->evaluations % PERIOD != 0 || clock_now(false) < p->deadline;
}

/* A force that is none: it lets a method that chooses its own steps be stopped. */
static msr_status watch_clock(const void *self, void *scratch, const msr_view *s, double *fx,
                              double *fy) {
  (void)scratch, (void)s, (void)fx, (void)fy;
  problem *p = *(problem *const *)self;
  return in_time(p) ? MSR_OK : MSR_EINTR;
}

static const msr_force watch = {.name = "watch",
                                .summary = "F = 0",
                                .dissipative = true,
                                .params_size = sizeof(problem *),
                                .add = watch_clock};

void problem_create(problem *p, start how, double k, double limit) {
  *p = (problem){.k = k, .T = end, .limit = limit, .n = 2 * MASSES};
  p->scene = block(k);
  p->watched = block(k);
  msr_error err;
  if (msr_scene_add_force(p->watched, &watch, &p, &err) != MSR_OK ||
      msr_plan_create(p->scene, NULL, &p->plan, &err) != MSR_OK ||
      msr_state_create(p->plan, &p->state, &err) != MSR_OK)
    bench_fail("%s", err.message);
  p->view = msr_state_view(p->state);
  p->view.vx = p->view.vy = NULL;
  p->start = need(2 * p->n, sizeof *p->start);
  memcpy(p->start, p->view.x, MASSES * sizeof *p->start);
  memcpy(p->start + MASSES, p->view.y, MASSES * sizeof *p->start);
  if (how == DEFORMED)
    deform(p->start);
  else
    spin(p->start, p->start + p->n);
}

void problem_free(problem *p) {
  msr_state_free(p->state);
  msr_plan_free(p->plan);
  msr_scene_free(p->watched);
  msr_scene_free(p->scene);
  free(p->start);
}

bool accelerate(problem *p, const double *q, double *a) {
  p->view.x = q;
  p->view.y = q + MASSES;
  memset(a, 0, p->n * sizeof *a);
  msr_force_springs.add(NULL, NULL, &p->view, a, a + MASSES);
  const double w = 1 / mass;
  for (size_t i = 0; i < p->n; i++) a[i] *= w;
  return in_time(p);
}

bool differentiate(problem *p, const double *y, double *dy) {
  memcpy(dy, y + p->n, p->n * sizeof *dy);
  return accelerate(p, y, dy + p->n);
}

double largest_distance(const double *q, const double *r) {
  double most = 0;
  for (size_t i = 0; i < MASSES; i++) {
    const double d = hypot(q[i] - r[i], q[MASSES + i] - r[MASSES + i]);
    if (!(d <= most)) most = isnan(d) ? (double)INFINITY : d;
  }
  return most;
}
