/* measure.c - one run against the reference. Errors and times are measured in separate runs. */
#include "accuracy/measure.h"

#include <math.h>
#include <string.h>

/* ---- Pictures */

msr_status msri_screens_open(const msri_setting *setting, msri_screens *screens, msr_error *err) {
  *screens = (msri_screens){0};
  if (msr_plan_describe(setting->plan).width == 0) return MSR_OK;
  msr_status status = msr_renderer_create(setting->plan, NULL, &screens->truth, err);
  if (status == MSR_OK) status = msr_renderer_create(setting->plan, NULL, &screens->run, err);
  if (status == MSR_OK) status = msr_state_create(setting->plan, &screens->state, err);
  if (status != MSR_OK) msri_screens_close(screens);
  return status;
}

void msri_screens_close(msri_screens *screens) {
  msr_renderer_free(screens->truth);
  msr_renderer_free(screens->run);
  msr_state_free(screens->state);
  *screens = (msri_screens){0};
}

/* Pixels that differ between the reference, with positions q, and the run. */
static size_t differing(const msri_screens *screens, const double *q, const msr_state *run) {
  const size_t n = run->plan->figures.masses;
  memcpy(screens->state->q, q, 2 * n * sizeof *q);
  const msr_picture *a = msr_renderer_draw(screens->truth, screens->state);
  const msr_picture *b = msr_renderer_draw(screens->run, run);
  size_t count = 0;
  for (size_t p = 0; p < a->width * a->height; p++)
    count += memcmp(a->rgb + 3 * p, b->rgb + 3 * p, 3) != 0;
  return count;
}

/* ---- Errors */

/* A run under way. */
typedef struct course {
  msri_setting *setting;
  const msri_reference *reference;
  const msri_screens *screens; /* NULL: none */
  msri_trial trial;
  size_t done; /* instants */
  double squares, max, energy, scale, pixels;
  double early; /* max in the first quarter */
  double wanted, good_error;
  size_t good;
} course;

static void compare_positions(course *c, const double *q) {
  const msr_state *run = c->trial.state;
  const size_t n = c->setting->masses;
  double most = 0;
  for (size_t i = 0; i < n; i++) {
    const double dx = run->q[i] - q[i], dy = run->q[n + i] - q[n + i], d2 = dx * dx + dy * dy;
    c->squares += d2;
    most = msri_worse(d2, most);
  }
  c->max = msri_worse(sqrt(most), c->max);
}

static void compare_energy(course *c, double truth) {
  const msr_energy e = msri_state_energies(c->trial.state);
  c->energy = msri_max(c->energy, fabs(e.total - truth));
  c->scale = msri_max(c->scale, e.kinetic + e.spring);
}

static uint64_t end_of(const course *c) { return c->setting->iteration[c->reference->n - 1]; }

static void compare(course *c) {
  const double *q = c->reference->q + c->done * 2 * c->setting->masses;
  compare_positions(c, q);
  compare_energy(c, c->reference->energy[c->done]);
  if (c->screens && c->screens->state)
    c->pixels += (double)differing(c->screens, q, c->trial.state);
  if (4 * c->setting->iteration[c->done] <= end_of(c)) c->early = c->max;
  c->done++;
  if (!(c->max <= c->wanted)) return;
  c->good = c->done;
  c->good_error = c->max;
}

/* Up to the horizon, or to where the error is beyond `most`. */
static msr_status follow(course *c, double most, msr_error *err) {
  while (c->done < c->reference->n) {
    const msr_status status =
        msri_trial_step(c->setting, &c->trial, c->setting->iteration[c->done], err);
    if (status != MSR_OK) return status;
    compare(c);
    if (!(c->max <= most)) return MSR_EUNSTABLE;
  }
  return MSR_OK;
}

static msr_accuracy_point blank(const msr_plan_options *options) {
  const double none = (double)NAN, infinite = (double)INFINITY;
  return (msr_accuracy_point){.integrator = options->integrator,
                              .substeps = options->substeps,
                              .atol = options->atol,
                              .seconds = none,
                              .rms = infinite,
                              .max = infinite,
                              .drift = none,
                              .pixels = none,
                              .order = none};
}

static void fill(const course *c, msr_accuracy_point *point) {
  const msr_plan_figures f = msr_plan_describe(c->setting->plan);
  const double instants = (double)c->done, pixels = (double)f.width * (double)f.height;
  point->stable = true;
  point->rms = sqrt(c->squares / (instants * (double)c->setting->masses));
  point->max = c->max;
  point->drift = c->scale > 0 ? c->energy / c->scale : 0;
  if (c->screens && c->screens->state) point->pixels = c->pixels / (instants * pixels);
}

static msr_status run(course *c, const msri_limits *limits, msri_measured *measured,
                      msr_error *err) {
  msri_watch *watch = &c->setting->watch;
  watch->most = limits->cost;
  const msr_status status = follow(c, limits->error, err);
  const msr_work work = msr_state_work(c->trial.state);
  msr_accuracy_point *point = &measured->point;
  point->steps = work.steps;
  point->evaluations = work.evaluations;
  if (status == MSR_OK) fill(c, point);
  measured->cost = msri_trial_cost(c->trial.state);
  measured->error = c->max;
  measured->sound = status == MSR_OK || (isfinite(c->max) && c->max > limits->error);
  measured->early = c->early;
  measured->good = c->good;
  measured->good_error = c->good_error;
  measured->share = (double)c->trial.state->iteration / (double)end_of(c);
  point->seconds = c->trial.seconds / measured->share;
  const bool ended = (status == MSR_EUNSTABLE || watch->costly) && !watch->over;
  return ended ? MSR_OK : status;
}

msr_status msri_measure(msri_setting *setting, const msri_reference *reference,
                        const msri_screens *screens, const msr_plan_options *options,
                        const msri_limits *limits, msri_measured *measured, msr_error *err) {
  course c = {
      .setting = setting, .reference = reference, .screens = screens, .wanted = limits->wanted};
  *measured = (msri_measured){.point = blank(options)};
  msr_status status = msri_trial_open(setting, options, &c.trial, err);
  if (status != MSR_OK) return status;
  status = run(&c, limits, measured, err);
  msri_trial_close(setting, &c.trial);
  return status;
}

/* ---- Times */

/* Times of runs [s]: the two least, and all together. */
typedef struct times {
  int runs;
  double least, second, spent;
} times;

static void add(times *t, double seconds) {
  t->runs++;
  t->spent += seconds;
  t->second = msri_min(t->second, msri_max(t->least, seconds));
  t->least = msri_min(t->least, seconds);
}

/* One run if it is long; else three at least, until two agree on the least, or time is up. */
static bool enough(const times *t, double total) {
  const double longest = 2.5 * total, shortest = total / 50, alike = 1.01;
  if (t->runs == 0 || t->spent > longest) return t->runs > 0;
  if (t->runs < 3 || t->spent < shortest) return false;
  return t->second < alike * t->least || t->spent > total;
}

static msr_status repeat(msri_setting *setting, msri_trial *trial, const msr_state *start,
                         uint64_t end, double total, times *t, msr_error *err) {
  msr_status status = MSR_OK;
  while (status == MSR_OK && !enough(t, total)) {
    msr_state_copy(trial->state, start);
    trial->seconds = 0;
    status = msri_trial_step(setting, trial, end, err);
    if (status == MSR_OK) add(t, trial->seconds);
  }
  return status;
}

msr_status msri_measure_time(msri_setting *setting, const msri_reference *reference,
                             const msr_plan_options *options, double total, double *seconds,
                             msr_error *err) {
  const uint64_t end = setting->iteration[reference->n - 1];
  times t = {.least = (double)INFINITY, .second = (double)INFINITY};
  msr_state *start = NULL;
  msri_trial trial;
  msr_status status = msri_trial_open(setting, options, &trial, err);
  if (status != MSR_OK) return status;
  status = msr_state_create(trial.plan, &start, err);
  if (status == MSR_OK) status = repeat(setting, &trial, start, end, total, &t, err);
  if (t.runs > 0) *seconds = t.least;
  msr_state_free(start);
  msri_trial_close(setting, &trial);
  return status;
}
