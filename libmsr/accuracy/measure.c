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

typedef struct sums {
  double squares, max, energy, scale, pixels;
} sums;

static void compare_positions(const double *q, const msr_state *run, sums *s) {
  const size_t n = run->plan->figures.masses;
  double most = 0;
  for (size_t i = 0; i < n; i++) {
    const double dx = run->q[i] - q[i], dy = run->q[n + i] - q[n + i], d2 = dx * dx + dy * dy;
    s->squares += d2;
    if (!(d2 <= most)) most = d2;
  }
  if (!(sqrt(most) <= s->max)) s->max = sqrt(most);
}

static void compare_energy(double truth, const msr_state *run, sums *s) {
  const msr_energy e = msri_state_energies(run);
  s->energy = msri_max(s->energy, fabs(e.total - truth));
  s->scale = msri_max(s->scale, e.kinetic + e.spring);
}

/* Up to the horizon, or to where the error is beyond `most`. */
static msr_status follow(msri_setting *setting, const msri_reference *reference,
                         const msri_screens *screens, msri_trial *trial, double most, sums *s,
                         msr_error *err) {
  for (size_t i = 0; i < reference->n; i++) {
    const double *q = reference->q + i * 2 * setting->masses;
    const msr_status status = msri_trial_step(setting, trial, setting->iteration[i], err);
    if (status != MSR_OK) return status;
    compare_positions(q, trial->state, s);
    compare_energy(reference->energy[i], trial->state, s);
    if (!(s->max <= most)) return MSR_EUNSTABLE;
    if (screens && screens->state) s->pixels += (double)differing(screens, q, trial->state);
  }
  return MSR_OK;
}

static void fill(const msri_setting *setting, const msri_reference *reference,
                 const msri_screens *screens, const sums *s, msr_accuracy_point *point) {
  const msr_plan_figures f = msr_plan_describe(setting->plan);
  const double instants = (double)reference->n, pixels = (double)f.width * (double)f.height;
  point->rms = sqrt(s->squares / (instants * (double)setting->masses));
  point->max = s->max;
  point->drift = s->scale > 0 ? s->energy / s->scale : 0;
  if (screens && screens->state) point->pixels = s->pixels / (instants * pixels);
}

msr_status msri_measure(msri_setting *setting, const msri_reference *reference,
                        const msri_screens *screens, const msr_plan_options *options, double most,
                        msr_accuracy_point *point, msr_error *err) {
  const double none = (double)NAN, infinite = (double)INFINITY;
  *point = (msr_accuracy_point){.integrator = options->integrator,
                                .substeps = options->substeps,
                                .atol = options->atol,
                                .seconds = none,
                                .rms = infinite,
                                .max = infinite,
                                .drift = none,
                                .pixels = none,
                                .order = none};
  msri_trial trial;
  msr_status status = msri_trial_open(setting, options, &trial, err);
  if (status != MSR_OK) return status;
  sums s = {0};
  status = follow(setting, reference, screens, &trial, most, &s, err);
  const msr_work work = msr_state_work(trial.state);
  point->steps = work.steps;
  point->evaluations = work.evaluations;
  point->stable = status == MSR_OK;
  if (status == MSR_OK) fill(setting, reference, screens, &s, point);
  if (status == MSR_OK) point->seconds = trial.seconds;
  msri_trial_close(&trial);
  return status == MSR_EUNSTABLE && !setting->watch.over ? MSR_OK : status;
}

/* ---- Times */

/* Enough of them: `spent` [s] in `runs`, which should be `total`, and 3 unless they are long. */
static bool enough(int runs, double spent, double total) {
  const double longest = 2.5 * total;
  return runs > 0 && (spent > longest || (runs >= 3 && spent > total));
}

msr_status msri_measure_time(msri_setting *setting, const msri_reference *reference,
                             const msr_plan_options *options, double total, double *seconds,
                             msr_error *err) {
  const uint64_t end = setting->iteration[reference->n - 1];
  msri_trial start, trial;
  msr_status status = msri_trial_open(setting, options, &trial, err);
  if (status != MSR_OK) return status;
  start = (msri_trial){0};
  status = msr_state_create(trial.plan, &start.state, err);
  double least = (double)INFINITY, spent = 0;
  for (int runs = 0; status == MSR_OK && !enough(runs, spent, total); runs++) {
    msr_state_copy(trial.state, start.state);
    trial.seconds = 0;
    status = msri_trial_step(setting, &trial, end, err);
    least = msri_min(least, trial.seconds);
    spent += trial.seconds;
  }
  if (status == MSR_OK || (setting->watch.over && isfinite(least))) *seconds = least;
  msri_trial_close(&start);
  msri_trial_close(&trial);
  return status;
}
