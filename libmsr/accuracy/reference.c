/* reference.c - the truth, as far as it can be known.
 *
 * Two unrelated methods run side by side; both are refined while it pays. Where they part (chaos
 * after many impacts), nothing can be said: that is the horizon. Pairs of high order serve where
 * motion is smooth. What supports do costs all methods their order, unless impacts are few; there
 * a pair that is cheap per step may be more exact. The pair that begins best is refined. Where
 * explicit methods need many steps an iteration, implicit ones may tell the truth sooner; and where
 * there is no time for those of high order, cheaper ones may reach further. */
#include "accuracy/duel.h"

#include <math.h>
#include <stdlib.h>

/* Whatever sees to supports is the same for all methods at the same step: there the two of a pair
 * have different ones. The first of each list is for a quick look. */
static const msri_rivals smooth[] = {
    {{&msr_integrator_srkn6, 1, 0}, {&msr_integrator_rk8pd, 1, 1e-3}},
    {{&msr_integrator_kahan_li_8, 1, 0}, {&msr_integrator_rk8pd, 1, 1e-6}},
};
static const msri_rivals impacts[] = {
    {{&msr_integrator_pefrl, 2, 0}, {&msr_integrator_verlet, 3, 0}},
    {{&msr_integrator_kahan_li_8, 1, 0}, {&msr_integrator_rk4, 3, 0}},
    {{&msr_integrator_verlet, 12, 0}, {&msr_integrator_pefrl, 5, 0}},
};

static const msri_rivals stiff = {{&msr_integrator_energy_momentum, 6, 0},
                                  {&msr_integrator_implicit_midpoint, 4, 0}};

static const double many_steps = 20;    /* of Verlet, an iteration */
static const double explicit_cost = 30; /* of a quick look, over Verlet's */
static const double quick_goal = 1e-6;  /* below this error a quick look is of no use [px] */
enum { MOST_LEVELS = 12, MOST_VAIN = 6 };

typedef struct quest {
  msri_setting *setting;
  const msri_reference_goal *goal;
  msri_reference best;
  const msri_rivals *pair; /* that made it */
  double share;            /* of the budget, to be kept to */
  double spent;            /* on its last level [s] */
  double cost;             /* of the last level that was tried */
  int vain;                /* levels in a row that weren't worth it */
} quest;

/* Does b reach as far as a, with less error there? */
static bool better(const msri_reference *a, const msri_reference *b) {
  if (a->n == 0 || b->n == 0) return b->n > 0;
  const size_t n = a->n < b->n ? a->n : b->n;
  if (n < a->n) return false;
  return b->gap[n - 1] < a->gap[n - 1] || b->n > n;
}

/* Is it so much better that still finer ones are worth trying? Without supports any gain is. */
static bool pays(const quest *q, const msri_reference *a, const msri_reference *b) {
  if (a->n == 0) return true;
  if (!better(a, b)) return false;
  const bool exacter = b->gap[a->n - 1] < a->gap[a->n - 1] / 2;
  if (b->n == q->setting->n || q->goal->longer == 0) return exacter || b->n > a->n;
  const double longer = q->setting->contacts ? q->goal->longer : 0;
  return (double)b->n > (1 + longer) * (double)a->n;
}

static bool good_enough(const quest *q) {
  const size_t n = q->best.n;
  return n > 0 && n == q->setting->n && msri_reference_error(&q->best) <= q->goal->enough;
}

static bool quickly(const quest *q) { return q->goal->enough >= quick_goal; }

/* Would another level, twice as long, end in time? */
static bool time_for_more(const quest *q) {
  const msri_watch *watch = &q->setting->watch;
  return watch->status == MSR_OK &&
         msri_watch_elapsed(watch) + 2 * q->spent < q->share * watch->budget;
}

/* A level of a pair; it's kept if it is better than the best so far. */
static msr_status try(quest *q, const msri_rivals *pair, int level, msr_error *err) {
  const double start = msri_watch_elapsed(&q->setting->watch);
  msri_reference next;
  msri_watch_next(&q->setting->watch, q->share, "reference: %s and %s, level %d",
                  pair->truth.integrator->name, pair->witness.integrator->name, level + 1);
  const msr_status status = msri_duel(q->setting, pair, level, q->goal->parted, &next, err);
  if (status != MSR_OK) return status;
  const bool keep = better(&q->best, &next);
  q->vain = pays(q, &q->best, &next) ? 0 : q->vain + 1;
  q->cost = next.cost;
  msri_reference worse = keep ? q->best : next;
  if (keep) {
    q->best = next;
    q->pair = pair;
  }
  if (q->pair == pair) q->spent = msri_watch_elapsed(&q->setting->watch) - start;
  msri_reference_clear(&worse);
  return MSR_OK;
}

/* Level after level of a pair, from the one given, while the next costs less than `most` or, if
 * that is no limit, while it pays. At supports finer steps may by chance be worse: a study goes on
 * past one level in vain. */
static msr_status refine(quest *q, const msri_rivals *pair, int level, double most,
                         msr_error *err) {
  msr_status status = MSR_OK;
  const int patience = q->setting->contacts && q->goal->longer == 0 ? 1 : 0;
  q->vain = 0;
  q->cost = 0;
  for (; status == MSR_OK && level < MOST_LEVELS; level++) {
    const bool vain = q->best.n == 0 ? level >= MOST_VAIN : most == HUGE_VAL && q->vain > patience;
    if (good_enough(q) || vain || !time_for_more(q) || 2 * q->cost > most) break;
    status = try(q, pair, level, err);
  }
  return status;
}

/* Refines the pair whose first level is best, the quick one aside. */
static msr_status try_explicit(quest *q, const msri_rivals *pair, size_t n, msr_error *err) {
  msr_status status = MSR_OK;
  for (size_t i = quickly(q) ? 0 : 1; status == MSR_OK && i < n; i++) {
    if (good_enough(q) || q->setting->watch.over) return MSR_OK;
    status = try(q, &pair[i], 0, err);
  }
  bool fine = false;
  for (size_t i = 1; i < n; i++) fine |= q->pair == &pair[i];
  return status == MSR_OK ? refine(q, fine ? q->pair : pair + 1, 1, HUGE_VAL, err) : status;
}

/* Was there time for the first half? */
static bool halfway(const quest *q) {
  const msri_setting *s = q->setting;
  return q->best.n > 0 && 2 * s->iteration[q->best.n - 1] >= s->iteration[s->n - 1];
}

static msr_status try_all(quest *q, msr_error *err) {
  const msri_setting *s = q->setting;
  const msri_rivals *pair = s->contacts ? impacts : smooth;
  const size_t n = s->contacts ? sizeof impacts / sizeof *impacts : sizeof smooth / sizeof *smooth;
  const uint64_t end = s->iteration[s->n - 1];
  const double steps = msri_setting_verlet(s, end);
  const bool many = steps > many_steps * (double)end;
  msr_status status = MSR_OK;
  if (many && quickly(q)) status = refine(q, &stiff, 0, explicit_cost * steps, err);
  if (status == MSR_OK && !good_enough(q)) status = try_explicit(q, pair, n, err);
  if (status != MSR_OK || q->best.parted || halfway(q)) return status;
  q->share *= 2;
  q->spent = 0;
  return many ? refine(q, &stiff, 0, HUGE_VAL, err) : quickly(q) ? MSR_OK : try(q, pair, 0, err);
}

void msri_reference_clear(msri_reference *reference) {
  free(reference->q);
  free(reference->energy);
  free(reference->gap);
  *reference = (msri_reference){0};
}

msr_status msri_reference_find(msri_setting *setting, const msri_reference_goal *goal,
                               msri_reference *reference, msr_error *err) {
  quest q = {.setting = setting, .goal = goal, .share = goal->share};
  msr_error said = {MSR_OK, ""};
  const msr_status status = try_all(&q, &said);
  *reference = q.best;
  if (reference->n > 0 && (status == MSR_OK || status == MSR_EUNSTABLE)) return MSR_OK;
  msri_reference_clear(reference);
  if (setting->watch.status != MSR_OK)
    return msri_fail(err, setting->watch.status, "stopped before there was a reference");
  if (status != MSR_OK && status != MSR_EUNSTABLE)
    return msri_hand_on(err, status, &said, "%s", msr_status_text(status));
  const double first = msri_setting_time(setting, 0);
  if (setting->watch.over)
    return msri_fail(err, MSR_EUNSTABLE, "no reference: in %g s no two methods got to %g s; %s",
                     setting->watch.share * setting->watch.budget, first, goal->advice);
  return msri_fail(err, MSR_EUNSTABLE,
                   "no reference: no two methods agree within %g px even at %g s; %s", goal->parted,
                   first, goal->advice);
}
