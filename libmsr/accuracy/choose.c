/* choose.c - the method and step that bring every mass within an error at the least work.
 *
 * Every method is tried against the reference from its largest step on, by the step that its order
 * foretells, until it is as accurate as asked or takes more work than the best so far. */
#include "accuracy/ladder.h"
#include "accuracy/measure.h"

#include "base/number.h"

#include <math.h>

static const double default_budget = 10, reference_share = 0.5; /* [s] */
static const double own_share = 0.1; /* of the error, that the reference may have */

typedef struct search {
  msri_setting setting;
  msri_reference reference;
  double error;
  msr_accuracy_point best; /* integrator NULL: none yet */
} search;

/* ---- One method */

static bool as_asked(const search *s, const msr_accuracy_point *p) {
  return p->stable && p->max + msri_reference_error(&s->reference) <= s->error;
}

/* The step that the order foretells to be just small enough. */
static void foretell(const search *s, const msr_accuracy_point *p, msri_ladder *l) {
  const double most = 1e9, wanted = 0.7 * (s->error - msri_reference_error(&s->reference));
  if (l->integrator->adaptive || !p->stable) {
    msri_ladder_next(&s->setting, l, p);
    return;
  }
  const double times = pow(p->max / wanted, 1 / msri_max(1, l->integrator->order));
  const double substeps = ceil((double)p->substeps * msri_min(msri_max(times, 1.1), 100));
  l->done = substeps > most;
  l->options.substeps = l->done ? 1 : (uint64_t)substeps;
  l->evaluations = (double)p->evaluations * substeps / (double)p->substeps;
}

static bool promising(const search *s, const msri_ladder *l) {
  return !l->done && (!s->best.integrator || l->evaluations < (double)s->best.evaluations);
}

static msr_status try_method(search *s, const msr_integrator *integrator, msr_error *err) {
  const uint64_t iterations = s->setting.iteration[s->reference.n - 1];
  msri_ladder l;
  msr_status status = msri_ladder_begin(&s->setting, integrator, iterations, &l, err);
  l.coarser = false;
  while (status == MSR_OK && promising(s, &l)) {
    msr_accuracy_point p;
    msri_watch_next(&s->setting.watch, 1, "choosing: %s", integrator->name);
    status = msri_measure(&s->setting, &s->reference, NULL, &l.options, s->setting.far, &p, err);
    if (status != MSR_OK) return status;
    if (as_asked(s, &p)) {
      if (!s->best.integrator || p.evaluations < s->best.evaluations) s->best = p;
      return MSR_OK;
    }
    foretell(s, &p, &l);
  }
  return status;
}

static msr_status try_all(search *s, const msr_accuracy_options *options, msr_error *err) {
  const bool all = options->n_integrators == 0;
  const msr_integrator *const *list = all ? msr_integrators : options->integrators;
  for (size_t i = 0; all ? list[i] != NULL : i < options->n_integrators; i++) {
    if (list[i]->stability <= 0 && !list[i]->adaptive) continue;
    const msr_status status = try_method(s, list[i], err);
    if (s->setting.watch.status != MSR_OK)
      return msri_fail(err, s->setting.watch.status, "stopped before the choice was made");
    if (s->setting.watch.over) return MSR_OK;
    if (status != MSR_OK && status != MSR_EUSAGE) return status;
  }
  return MSR_OK;
}

/* ---- The choice */

static void explain(const search *s, double whole, msr_accuracy_choice *choice) {
  const msr_accuracy_point *p = &s->best;
  char step[64], horizon[64] = "";
  if (p->integrator->adaptive)
    msri_format(step, sizeof step, "tolerance %g", p->atol);
  else
    msri_format(step, sizeof step, "%llu substeps", (unsigned long long)p->substeps);
  if (choice->horizon < whole)
    msri_format(horizon, sizeof horizon, " up to %.4g s of %.4g s", choice->horizon, whole);
  msri_format(choice->reason, sizeof choice->reason,
              "%s with %s is the least work for %g px: largest error %.2g px%s",
              p->integrator->name, step, s->error, choice->error, horizon);
}

static msr_status conclude(const search *s, msr_accuracy_choice *choice, msr_error *err) {
  const msr_accuracy_point *p = &s->best;
  if (!p->integrator)
    return msri_fail(err, MSR_EUNSTABLE, "nothing tried is within %g px; ask for less", s->error);
  const double horizon = msri_setting_time(&s->setting, s->reference.n - 1);
  *choice = (msr_accuracy_choice){
      .options = msri_setting_options(&s->setting, p->integrator, p->substeps, p->atol),
      .error = p->max + msri_reference_error(&s->reference),
      .seconds = p->seconds * s->setting.until / horizon,
      .horizon = msri_min(horizon, s->setting.until),
  };
  explain(s, s->setting.until, choice);
  return MSR_OK;
}

static msr_status choose(search *s, const msr_accuracy_options *options,
                         msr_accuracy_choice *choice, msr_error *err) {
  const double own = own_share * s->error;
  const msri_reference_goal goal = {own, own, reference_share};
  msr_status status = msri_reference_find(&s->setting, &goal, &s->reference, err);
  if (status == MSR_OK) status = try_all(s, options, err);
  return status == MSR_OK ? conclude(s, choice, err) : status;
}

msr_status msr_accuracy_choose(const msr_scene *scene, double error,
                               const msr_accuracy_options *options, msr_accuracy_choice *choice,
                               msr_error *err) {
  static const msr_accuracy_options defaults = {0};
  if (!options) options = &defaults;
  if (!(error > 0 && isfinite(error)))
    return msri_fail(err, MSR_EUSAGE, "the error must be a number above 0, not %g", error);
  search s = {.error = error};
  msr_status status = msri_setting_open(&s.setting, scene, options, default_budget, err);
  if (status != MSR_OK) return status;
  status = choose(&s, options, choice, err);
  msri_reference_clear(&s.reference);
  msri_setting_close(&s.setting);
  return status;
}
