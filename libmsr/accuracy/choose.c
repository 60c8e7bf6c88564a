/* choose.c - the method and step that bring every mass within an error at the least work.
 *
 * Every method aims at the error, against a reference, on that very scene; the one whose next run
 * promises to be the cheapest is always the next, until none can be cheaper than the best that was
 * as accurate as asked. Over the whole run nothing is foretold: the run to come has the same bits
 * as the one that was tried, compared at the instants. If the whole is too long for the budget,
 * this is done on its beginning, then on as much as can be afforded, with those that are still in
 * question; a smaller error is aimed at then, so that there is room for it to grow as it did: e ~
 * t^g with g as measured, but at least 1 for symplectic or reversible methods and 2 for others.
 * That is no promise, though: beyond what was tried a mass may meet a support, or a lattice buckle.
 *
 * Costs are counted in calls of forces, and planned by the time that they take on a common machine,
 * so that the choice is the same again, while neither the budget nor the reference's part of it
 * runs out. */
#include "accuracy/pilot.h"

#include "base/number.h"

#include <math.h>
#include <stdlib.h>

static const msri_setting_defaults usual = {10, 500, 1.1};
static const double reference_share = 0.5; /* of it */
static const double own_share = 0.1;       /* of the error, that the reference may have */
static const double trials = 60;           /* work of a choice over that of Verlet's largest step */
static const double in_question = 4;       /* work of a method that may yet be the best, over it */

/* What the best is known from. */
typedef struct finding {
  msri_measured best;
  size_t n;    /* instants up to the horizon */
  double own;  /* error of the reference */
  bool parted; /* the reference goes no further */
  bool late;   /* time was up */
} finding;

/* ---- Stages */

/* Time of an instant over that of the whole run. */
static double share_at(const msri_pilot *c, size_t n) {
  return (double)c->setting.iteration[n - 1] / (double)c->setting.iteration[c->all - 1];
}

/* The last instant within a share of the run; the first at least. */
static size_t instants_within(const msri_pilot *c, double share) {
  size_t n = c->all;
  while (n > 1 && share_at(c, n) > share) n--;
  return n;
}

/* The best or, when time was up before there was one, the run that was good for longest. */
static void settle(const msri_pilot *c, finding *found) {
  const bool any = c->best.point.integrator != NULL;
  const msri_measured *m = any ? &c->best : &c->longest;
  if (m->good == 0 || (!any && (!c->setting.watch.over || m->good <= found->n))) return;
  *found = (finding){*m, m->good, msri_reference_error(&c->reference), c->reference.parted, !any};
  found->best.point.max = m->good_error;
  found->best.point.seconds *= share_at(c, m->good) / share_at(c, c->reference.n);
}

/* A caller who didn't give a budget may have no way to. */
static const char *advice(const msri_pilot *c) {
  return c->setting.watch.options->budget > 0
             ? "raise the budget, or ask for a larger error"
             : "ask for a larger error, or choose integrator and substeps yourself";
}

/* One stage, up to setting.n and with an error of at most `share` of what is asked for there; or up
 * to the horizon, if it is before. */
static msr_status stage(msri_pilot *c, double share, finding *found, msr_error *err) {
  const double own = own_share * c->error;
  const msri_reference_goal goal = {own, share * own, 0.25, reference_share, advice(c)};
  msri_reference_clear(&c->reference);
  msr_status status = msri_reference_find(&c->setting, &goal, &c->reference, err);
  if (status != MSR_OK) return status;
  const bool parted = c->reference.parted;
  const double sure = msri_reference_error(&c->reference) / own_share;
  c->wanted = (parted ? c->error : msri_max(share * c->error, sure)) - sure * own_share;
  c->best = c->longest = (msri_measured){0};
  status = msri_pilot_run(c, err);
  if (status == MSR_OK) settle(c, found);
  return status;
}

/* Methods whose work isn't far above the best's go on, for a run `times` as long. */
static void go_on(msri_pilot *c, double times) {
  const double best = c->best.cost;
  for (size_t i = 0; i < c->setting.n_methods; i++) {
    msri_aim *a = &c->aim[i];
    const double r = a->passed > 0 ? a->passed : a->r;
    const double cost = a->cost * pow(r / a->r, a->growth);
    *a = (msri_aim){.integrator = a->integrator,
                    .order = a->order,
                    .growth = a->growth,
                    .coarsest = a->coarsest,
                    .r = r,
                    .cost = times * cost,
                    .done = !(cost <= in_question * best) || a->tries == 0};
  }
}

/* Growth of the error with time: e ~ t^growth. */
static double growth_of(const finding *f) {
  const msr_integrator *integrator = f->best.point.integrator;
  const double least = integrator->symplectic || integrator->reversible ? 1 : 2;
  const double times = f->best.error / f->best.early;
  return times > 0 && isfinite(times) ? msri_max(least, log(times) / log(4)) : least;
}

/* How far the whole run is beyond the first stage, and how far the second can go. */
static size_t second_length(const msri_pilot *c, const finding *f) {
  const double budget = 0.8 * c->setting.watch.budget;
  const double spent = msri_setting_seconds(&c->setting, c->setting.cost);
  const double cost = c->reference.cost + in_question * f->best.cost;
  const double share =
      (budget - spent) / msri_setting_seconds(&c->setting, cost) * share_at(c, f->n);
  return share > 0 ? instants_within(c, share) : 1;
}

static double first_share(const msri_pilot *c) {
  const double steps = msri_setting_verlet(&c->setting, c->setting.iteration[c->all - 1]);
  const double share =
      c->setting.watch.budget / 4 / msri_setting_seconds(&c->setting, trials * steps);
  return share >= 0.5 ? 1 : share;
}

/* Of the error asked for, what may be there after `n` instants. Supports let nothing be said of
 * what follows: then all of it. */
static double part(const msri_pilot *c, size_t n, double growth) {
  return c->setting.contacts ? 1 : pow(share_at(c, n), growth);
}

static msr_status choose(msri_pilot *c, finding *found, msr_error *err) {
  c->setting.n = instants_within(c, first_share(c));
  msr_status status = stage(c, part(c, c->setting.n, 1.5), found, err);
  if (status != MSR_OK || found->n == 0 || found->parted || found->late || found->n == c->all)
    return status;
  const size_t n = second_length(c, found);
  const msri_watch *watch = &c->setting.watch;
  const bool late = msri_watch_elapsed(watch) > reference_share / 2 * watch->budget;
  if (share_at(c, n) < 2 * share_at(c, found->n) || late) return status;
  go_on(c, share_at(c, n) / share_at(c, found->n));
  c->setting.n = n;
  msr_error said;
  status = stage(c, part(c, n, growth_of(found)) / (n < c->all ? 2 : 1), found, &said);
  return c->setting.watch.over || status == MSR_EUNSTABLE ? MSR_OK : status;
}

/* ---- The choice */

/* The largest error at the end of the run, if it goes on growing as it did. */
static double foretold(const msri_pilot *c, const finding *f) {
  return (f->best.point.max + f->own) * pow(share_at(c, f->n), -growth_of(f));
}

static void explain(const msri_pilot *c, const finding *f, msr_accuracy_choice *choice) {
  const msr_accuracy_point *p = &f->best.point;
  const double whole = c->setting.until, tried = whole * share_at(c, f->n);
  char step[64], how[128] = "";
  if (p->integrator->adaptive)
    msri_format(step, sizeof step, "tolerance %.2g", p->atol);
  else
    msri_format(step, sizeof step, "%llu substep%s", (unsigned long long)p->substeps,
                p->substeps > 1 ? "s" : "");
  if (f->late)
    msri_format(how, sizeof how, ", up to %.4g s of %.4g s, when time was up", tried, whole);
  else if (f->parted)
    msri_format(how, sizeof how, ", up to %.4g s: beyond, none can be promised", tried);
  else if (f->n < c->all && c->setting.contacts)
    msri_format(how, sizeof how, ", tried up to %.4g s of %.4g s", tried, whole);
  else if (f->n < c->all)
    msri_format(how, sizeof how, ", tried up to %.4g s of %.4g s; if it grows on likewise, %.2g px",
                tried, whole, foretold(c, f));
  msri_format(choice->reason, sizeof choice->reason,
              "%s with %s takes the least work for %g px: largest error %.2g px%s",
              p->integrator->name, step, c->error, choice->error, how);
}

static msr_status conclude(const msri_pilot *c, const finding *f, msr_accuracy_choice *choice,
                           msr_error *err) {
  const msr_accuracy_point *p = &f->best.point;
  if (f->n == 0 && c->setting.watch.over)
    return msri_fail(err, MSR_EUNSTABLE, "nothing tried in %g s was within %g px; %s",
                     c->setting.watch.budget, c->error, advice(c));
  if (f->n == 0)
    return msri_fail(err, MSR_EUNSTABLE,
                     "nothing tried is within %g px; ask for a larger error, or for less time",
                     c->error);
  const double share = share_at(c, f->n);
  *choice = (msr_accuracy_choice){
      .options = msri_setting_options(&c->setting, p->integrator, p->substeps, p->atol),
      .error = p->max + f->own,
      .seconds = p->seconds / share,
      .horizon = share * c->setting.until,
  };
  explain(c, f, choice);
  return MSR_OK;
}

msr_status msr_accuracy_choose(const msr_scene *scene, double error,
                               const msr_accuracy_options *options, msr_accuracy_choice *choice,
                               msr_error *err) {
  static const msr_accuracy_options defaults = {0};
  if (!options) options = &defaults;
  if (!(error > 0 && isfinite(error)))
    return msri_fail(err, MSR_EUSAGE, "the error must be a number above 0, not %g", error);
  msri_pilot c = {.error = error};
  msr_error said = {MSR_OK, ""}; /* of pilots that failed, too */
  finding found = {.n = 0};
  msr_status status = msri_setting_open(&c.setting, scene, options, &usual, err);
  if (status != MSR_OK) return status;
  c.all = c.setting.n;
  status = choose(&c, &found, &said);
  if (c.setting.watch.status != MSR_OK)
    status = msri_fail(&said, c.setting.watch.status, "stopped before the choice was made");
  if (status == MSR_OK) status = conclude(&c, &found, choice, &said);
  msri_reference_clear(&c.reference);
  msri_setting_close(&c.setting);
  free(c.aim);
  if (status == MSR_OK) return MSR_OK;
  return msri_hand_on(err, status, &said, "%s", msr_status_text(status));
}
