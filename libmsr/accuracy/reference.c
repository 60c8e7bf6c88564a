/* reference.c - the truth, as far as it can be known.
 *
 * Two unrelated methods of high order run side by side; the largest difference over all masses is
 * the error of either. Both are refined while it pays: their steps are halved, tolerances divided
 * by 100. Where they part (chaos after many impacts), nothing can be said: that is the horizon. */
#include "accuracy/reference.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Methods that have nothing in common but the scene. */
static const struct pair {
  const msr_integrator *truth, *witness;
} pairs[] = {{&msr_integrator_kahan_li_8, &msr_integrator_rk4}};

static const double coarsest_atol = 1e-8, atol_ratio = 100;
enum { MOST_LEVELS = 12 };

typedef struct duel {
  msri_setting *setting;
  const msri_reference_goal *goal;
  msri_reference *made; /* under way */
  msri_trial truth, witness;
} duel;

/* ---- One level of refinement */

static msr_status level_options(const msri_setting *setting, const msr_integrator *integrator,
                                int level, msr_plan_options *options, msr_error *err) {
  uint64_t substeps;
  const msr_status status = msri_setting_fewest(setting, integrator, false, &substeps, err);
  if (status != MSR_OK) return status;
  if (substeps == 0)
    return msri_fail(err, MSR_EUNSTABLE, "%s has no stable step here", integrator->name);
  const bool fixed = !integrator->adaptive || setting->contacts;
  const double atol = coarsest_atol * pow(atol_ratio, -level);
  *options = msri_setting_options(setting, integrator, fixed ? 2 * substeps << level : 1, atol);
  return MSR_OK;
}

/* Largest distance of a mass between the two; NAN if there is none. */
static double distance(const msr_state *a, const msr_state *b) {
  const size_t n = a->plan->figures.masses;
  double most = 0;
  for (size_t i = 0; i < n; i++) {
    const double d = hypot(a->q[i] - b->q[i], a->q[n + i] - b->q[n + i]);
    if (!(d <= most)) most = d;
  }
  return most;
}

static msr_status advance(duel *d, size_t instant, msr_error *err) {
  const uint64_t iteration = d->setting->iteration[instant];
  const msr_status status = msri_trial_step(d->setting, &d->truth, iteration, err);
  return status == MSR_OK ? msri_trial_step(d->setting, &d->witness, iteration, err) : status;
}

/* Do they agree? Then the instant is added. */
static bool record(const duel *d) {
  msri_reference *r = d->made;
  const msr_state *truth = d->truth.state;
  const size_t n = 2 * d->setting->masses;
  const double gap = distance(truth, d->witness.state);
  if (!(gap <= d->goal->parted)) return false;
  memcpy(r->q + r->n * n, truth->q, n * sizeof *r->q);
  r->energy[r->n] = msri_state_energies(truth).total;
  r->gap[r->n] = r->n > 0 ? msri_max(gap, r->gap[r->n - 1]) : gap;
  r->n++;
  return true;
}

/* Side by side up to the horizon. Being stopped, or unstable, ends it there. */
static msr_status fight(duel *d, msr_error *err) {
  msr_status status = MSR_OK;
  for (size_t i = 0; i < d->setting->n && status == MSR_OK; i++) {
    status = advance(d, i, err);
    if (status == MSR_OK && !record(d)) break;
  }
  const bool ended = status == MSR_EUNSTABLE || d->setting->watch.over;
  d->made->cost = msri_trial_cost(d->truth.state) + msri_trial_cost(d->witness.state);
  return ended ? MSR_OK : status;
}

static msr_status reserve(const msri_setting *setting, msri_reference *r, msr_error *err) {
  const size_t n = setting->n;
  *r = (msri_reference){0};
  r->q = msri_alloc(n, 2 * setting->masses * sizeof *r->q, "the reference", err);
  r->energy = msri_alloc(n, sizeof *r->energy, "the reference", err);
  r->gap = msri_alloc(n, sizeof *r->gap, "the reference", err);
  if (r->q && r->energy && r->gap) return MSR_OK;
  msri_reference_clear(r);
  return MSR_ENOMEM;
}

void msri_reference_clear(msri_reference *reference) {
  free(reference->q);
  free(reference->energy);
  free(reference->gap);
  *reference = (msri_reference){0};
}

/* A reference of the pair at a level, of 0 instants if they don't agree at all. */
static msr_status try_level(duel *d, const struct pair *pair, int level, msr_error *err) {
  msri_reference *r = d->made;
  msr_status status = level_options(d->setting, pair->truth, level, &r->truth, err);
  if (status == MSR_OK) status = level_options(d->setting, pair->witness, level, &r->witness, err);
  if (status == MSR_OK) status = msri_trial_open(d->setting, &r->truth, &d->truth, err);
  if (status == MSR_OK) status = msri_trial_open(d->setting, &r->witness, &d->witness, err);
  msri_watch_next(&d->setting->watch, d->goal->share, "reference: %s and %s, level %d",
                  pair->truth->name, pair->witness->name, level + 1);
  if (status == MSR_OK) status = fight(d, err);
  msri_trial_close(d->setting, &d->truth);
  msri_trial_close(d->setting, &d->witness);
  return status;
}

/* ---- Refining */

/* Does b reach further than a, or as far with half the error? */
static bool better(const duel *d, const msri_reference *a, const msri_reference *b) {
  if (b->n == 0) return false;
  if (a->n == 0) return true;
  if (b->n < a->n) return false;
  return (double)b->n > (1 + d->goal->longer) * (double)a->n || b->gap[a->n - 1] < a->gap[a->n - 1] / 2;
}

static bool good_enough(const duel *d, const msri_reference *r) {
  return r->n == d->setting->n && msri_reference_error(r) <= d->goal->enough;
}

/* Would another level, twice as long, end in time? */
static bool time_for_more(const duel *d, double spent) {
  const msri_watch *watch = &d->setting->watch;
  return msri_watch_elapsed(watch) + 2 * spent < d->goal->share * watch->budget;
}

static msr_status refine(duel *d, const struct pair *pair, msri_reference *best, msr_error *err) {
  for (int level = 0; level < MOST_LEVELS && !good_enough(d, best); level++) {
    msri_reference next;
    d->made = &next;
    const double start = msri_watch_elapsed(&d->setting->watch);
    msr_status status = reserve(d->setting, &next, err);
    if (status == MSR_OK) status = try_level(d, pair, level, err);
    const bool pays = status == MSR_OK && better(d, best, &next);
    msri_reference worse = pays ? *best : next;
    if (pays) *best = next;
    msri_reference_clear(&worse);
    if (status != MSR_OK || d->setting->watch.over || (!pays && best->n > 0)) return status;
    if (!time_for_more(d, msri_watch_elapsed(&d->setting->watch) - start)) return MSR_OK;
  }
  return MSR_OK;
}

msr_status msri_reference_find(msri_setting *setting, const msri_reference_goal *goal,
                               msri_reference *reference, msr_error *err) {
  duel d = {.setting = setting, .goal = goal};
  *reference = (msri_reference){0};
  msr_error said = {MSR_OK, ""};
  msr_status status = refine(&d, &pairs[0], reference, &said);
  if (reference->n > 0 && (status == MSR_OK || status == MSR_EUNSTABLE)) return MSR_OK;
  msri_reference_clear(reference);
  if (setting->watch.status != MSR_OK)
    return msri_fail(err, setting->watch.status, "stopped before there was a reference");
  if (status != MSR_OK && status != MSR_EUNSTABLE)
    return msri_hand_on(err, status, &said, "%s", msr_status_text(status));
  return msri_fail(err, MSR_EUNSTABLE,
                   "no reference: %s and %s don't agree even at %g s; raise the budget, or lower "
                   "TENSION_RESSORT or speeds",
                   pairs[0].truth->name, pairs[0].witness->name, msri_setting_time(setting, 0));
}
