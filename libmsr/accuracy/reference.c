/* reference.c - the truth, as far as it can be known.
 *
 * Two unrelated methods of high order run side by side; the largest difference over all masses is
 * the error of either. Both are refined while it pays: their steps are halved, tolerances divided
 * by 100. Where they part (chaos after many impacts), nothing can be said: that is the horizon. */
#include "accuracy/reference.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Methods that have nothing in common but the scene, and the substeps of the first level over the
 * fewest that are stable. Where there is something in the way, all methods see to it likewise, so
 * that the witness must have other steps. */
typedef struct entrant {
  const msr_integrator *integrator;
  double fineness, atol;
} entrant;

typedef struct pair {
  entrant truth, witness;
} pair;

static const pair quick = {{&msr_integrator_srkn6, 1, 0}, {&msr_integrator_rk8pd, 1, 1e-3}};
static const pair smooth = {{&msr_integrator_kahan_li_8, 1, 0}, {&msr_integrator_rk8pd, 1, 1e-6}};
static const pair impacts = {{&msr_integrator_kahan_li_8, 1, 0}, {&msr_integrator_rk4, 2.9, 0}};

static const double quick_goal = 1e-6; /* below this error a quick look is of no use [px] */
static const double atol_ratio = 100;  /* from level to level; steps are halved */
enum { MOST_LEVELS = 12 };

typedef struct duel {
  msri_setting *setting;
  const msri_reference_goal *goal;
  msri_reference *made; /* under way */
  msri_trial truth, witness;
} duel;

/* ---- One level of refinement */

static msr_status level_options(const msri_setting *setting, const entrant *e, int level,
                                msr_plan_options *options, msr_error *err) {
  uint64_t fewest;
  const msr_status status = msri_setting_fewest(setting, e->integrator, false, &fewest, err);
  if (status != MSR_OK) return status;
  if (fewest == 0)
    return msri_fail(err, MSR_EUNSTABLE, "%s has no stable step here", e->integrator->name);
  const double substeps = ceil((double)fewest * e->fineness * pow(2, level));
  *options =
      msri_setting_options(setting, e->integrator, e->integrator->adaptive ? 1 : (uint64_t)substeps,
                           e->atol * pow(atol_ratio, -level));
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
static msr_status try_level(duel *d, const pair *p, int level, msr_error *err) {
  msri_reference *r = d->made;
  msr_status status = level_options(d->setting, &p->truth, level, &r->truth, err);
  if (status == MSR_OK) status = level_options(d->setting, &p->witness, level, &r->witness, err);
  if (status == MSR_OK) status = msri_trial_open(d->setting, &r->truth, &d->truth, err);
  if (status == MSR_OK) status = msri_trial_open(d->setting, &r->witness, &d->witness, err);
  msri_watch_next(&d->setting->watch, d->goal->share, "reference: %s and %s, %llu substeps",
                  p->truth.integrator->name, p->witness.integrator->name,
                  (unsigned long long)r->truth.substeps);
  if (status == MSR_OK) status = fight(d, err);
  msri_trial_close(d->setting, &d->truth);
  msri_trial_close(d->setting, &d->witness);
  return status;
}

/* ---- Refining */

/* Does b reach as far as a, with less error there? */
static bool better(const msri_reference *a, const msri_reference *b) {
  if (a->n == 0 || b->n == 0) return b->n > 0;
  return b->n >= a->n && b->gap[a->n - 1] < a->gap[a->n - 1];
}

/* Is it so much better that still finer ones are worth trying? */
static bool pays(const duel *d, const msri_reference *a, const msri_reference *b) {
  if (a->n == 0) return true;
  if (!better(a, b)) return false;
  if (b->n < d->setting->n) return (double)b->n > (1 + d->goal->longer) * (double)a->n;
  return a->n < b->n || b->gap[a->n - 1] < a->gap[a->n - 1] / 2;
}

static bool good_enough(const duel *d, const msri_reference *r) {
  return r->n == d->setting->n && msri_reference_error(r) <= d->goal->enough;
}

/* Would another level, twice as long, end in time? */
static bool time_for_more(const duel *d, double spent) {
  const msri_watch *watch = &d->setting->watch;
  return !watch->over && msri_watch_elapsed(watch) + 2 * spent < d->goal->share * watch->budget;
}

/* One more level; the better one of it and `best` is kept. `more`: another may be worth it. */
static msr_status refine(duel *d, const pair *p, int level, msri_reference *best, bool *more,
                         msr_error *err) {
  msri_reference next;
  const double start = msri_watch_elapsed(&d->setting->watch);
  msr_status status = reserve(d->setting, &next, err);
  if (status != MSR_OK) return status;
  d->made = &next;
  status = try_level(d, p, level, err);
  const bool keep = status == MSR_OK && better(best, &next);
  *more = status == MSR_OK && pays(d, best, &next) &&
          time_for_more(d, msri_watch_elapsed(&d->setting->watch) - start);
  msri_reference worse = keep ? *best : next;
  if (keep) *best = next;
  msri_reference_clear(&worse);
  return status;
}

static msr_status refine_all(duel *d, msri_reference *best, msr_error *err) {
  const pair *p = d->setting->contacts ? &impacts : &smooth;
  msr_status status = MSR_OK;
  bool more = true;
  if (!d->setting->contacts && d->goal->enough >= quick_goal)
    status = refine(d, &quick, 0, best, &more, err);
  more = !d->setting->watch.over;
  for (int level = 0; status == MSR_OK && more && level < MOST_LEVELS; level++) {
    if (good_enough(d, best)) break;
    status = refine(d, p, level, best, &more, err);
  }
  return status;
}

msr_status msri_reference_find(msri_setting *setting, const msri_reference_goal *goal,
                               msri_reference *reference, msr_error *err) {
  duel d = {.setting = setting, .goal = goal};
  *reference = (msri_reference){0};
  msr_error said = {MSR_OK, ""};
  const msr_status status = refine_all(&d, reference, &said);
  if (reference->n > 0 && (status == MSR_OK || status == MSR_EUNSTABLE)) return MSR_OK;
  msri_reference_clear(reference);
  if (setting->watch.status != MSR_OK)
    return msri_fail(err, setting->watch.status, "stopped before there was a reference");
  if (status != MSR_OK && status != MSR_EUNSTABLE)
    return msri_hand_on(err, status, &said, "%s", msr_status_text(status));
  return msri_fail(err, MSR_EUNSTABLE,
                   "no reference: no two methods agree even at %g s; raise the budget, or lower "
                   "TENSION_RESSORT or speeds",
                   msri_setting_time(setting, 0));
}
