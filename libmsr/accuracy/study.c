/* study.c - what accuracy costs in time: every method at many steps, against the reference.
 *
 * The run that promises to take the fewest evaluations is always the next, so that coarse points
 * of all methods come first. A method is done when its error comes near the reference's own, or
 * near what is asked for, or when it costs thirty times as much as another that is as good. */
#include "accuracy/ladder.h"
#include "accuracy/measure.h"
#include "accuracy/result.h"

#include <math.h>
#include <stdlib.h>

static const msri_setting_defaults usual = {60, 32, 0};
static const double reference_share = 0.25; /* of the budget */
static const double default_finest = 1e-10; /* [px] */
static const double parted = 1e-3; /* where references differ by so much, they have parted [px] */
static const double timing = 0.2;  /* most time for all timed runs of a point [s] */
static const double hopeless = 30; /* times the cost of a method that is as good */

typedef struct study {
  msri_setting setting;
  msri_reference reference;
  msri_screens screens;
  msri_ladder *ladder; /* [setting.n_methods] */
  double *cost;        /* of each point [made->n] */
  size_t costs;        /* that there is room for */
  double finest;
  bool complete;
  msr_accuracy *made;
} study;

/* ---- Points */

static msr_status begin_ladders(study *s, msr_error *err) {
  const uint64_t iterations = s->setting.iteration[s->reference.n - 1];
  const size_t n = s->setting.n_methods;
  msr_status status = MSR_OK;
  s->ladder = msri_alloc(n, sizeof *s->ladder, "the methods", err);
  if (!s->ladder) return MSR_ENOMEM;
  for (size_t i = 0; i < n && status == MSR_OK; i++)
    status = msri_ladder_begin(&s->setting, s->setting.method[i], iterations, &s->ladder[i], err);
  return status;
}

/* The method whose next run is the shortest; NULL: all are done. */
static msri_ladder *shortest(study *s) {
  msri_ladder *least = NULL;
  for (size_t i = 0; i < s->setting.n_methods; i++) {
    msri_ladder *l = &s->ladder[i];
    if (!l->done && (!least || l->cost < least->cost)) least = l;
  }
  return least;
}

static bool is_hopeless(const study *s, const msri_measured *m) {
  for (size_t i = 0; i < s->made->n; i++)
    if (s->made->point[i].max <= m->point.max && hopeless * s->cost[i] < m->cost) return true;
  return false;
}

/* Would a run so many times longer still end in time? */
static bool time_for(const study *s, double spent, double times) {
  return msri_watch_elapsed(&s->setting.watch) + times * spent < s->setting.watch.budget;
}

static void go_on(study *s, msri_ladder *ladder, const msri_measured *m, double spent) {
  const double target = msri_max(s->finest, 2 * msri_reference_error(&s->reference));
  const bool coarser = ladder->coarser, stable = m->point.stable;
  msri_ladder_next(&s->setting, ladder, m->cost, stable);
  ladder->done |= !coarser && stable && (m->point.max <= target || is_hopeless(s, m));
  if (ladder->done || time_for(s, spent, ladder->cost / m->cost)) return;
  ladder->done = true;
  s->complete = false;
}

static void announce(study *s, const msr_plan_options *o) {
  if (o->integrator->adaptive)
    msri_watch_next(&s->setting.watch, 1, "%s, tolerance %g", o->integrator->name, o->atol);
  else
    msri_watch_next(&s->setting.watch, 1, "%s, %llu substeps", o->integrator->name,
                    (unsigned long long)o->substeps);
}

/* Is it the reference's own run? Its error can't be told from that of the reference. */
static bool is_truth(const study *s, const msr_plan_options *o) {
  const msr_plan_options *truth = &s->reference.truth;
  return o->integrator == truth->integrator && o->substeps == truth->substeps &&
         !(o->atol < truth->atol || o->atol > truth->atol);
}

/* Its error, then its time, unless it is a run that was made before. */
static msr_status measure(study *s, const msr_plan_options *options, msri_measured *m,
                          msr_error *err) {
  const msri_limits limits = {s->setting.far, s->setting.far, HUGE_VAL};
  announce(s, options);
  const msr_status status =
      msri_measure(&s->setting, &s->reference, &s->screens, options, &limits, m, err);
  m->point.seconds = (double)NAN;
  if (is_truth(s, options)) m->point.max = m->point.rms = msri_reference_error(&s->reference);
  if (status != MSR_OK || !m->point.stable || msri_result_has(s->made, &m->point)) return status;
  return msri_measure_time(&s->setting, &s->reference, options,
                           msri_min(timing, s->setting.watch.budget / 600), &m->point.seconds, err);
}

static msr_status keep(study *s, const msri_measured *m, msr_error *err) {
  const size_t n = s->made->n;
  double *cost = msri_grow(s->cost, &s->costs, n + 1, sizeof *cost, "the points", err);
  if (!cost) return MSR_ENOMEM;
  s->cost = cost;
  cost[n] = m->cost;
  return msri_result_add(s->made, &m->point, err);
}

/* One run of the ladder. A method that doesn't take the scene has no points; nor has a run that is
 * stopped before it has a time. */
static msr_status climb(study *s, msri_ladder *ladder, msr_error *err) {
  const double start = msri_watch_elapsed(&s->setting.watch);
  const msr_plan_options options = ladder->options;
  msri_measured m;
  msr_status status = measure(s, &options, &m, err);
  const bool over = s->setting.watch.over;
  s->complete &= !over;
  ladder->done = status == MSR_EUSAGE || over;
  if (ladder->done) status = MSR_OK;
  const bool timed = m.point.seconds >= 0, unstable = !ladder->done && !m.point.stable;
  if (status == MSR_OK && (timed || unstable)) status = keep(s, &m, err);
  if (status == MSR_OK && !ladder->done)
    go_on(s, ladder, &m, msri_watch_elapsed(&s->setting.watch) - start);
  return status;
}

static msr_status climb_all(study *s, msr_error *err) {
  msr_status status = MSR_OK;
  for (msri_ladder *next = shortest(s); next && status == MSR_OK; next = shortest(s)) {
    status = climb(s, next, err);
    if (s->setting.watch.over) return status;
  }
  return status;
}

/* ---- The whole */

static void describe(study *s) {
  const msri_reference *r = &s->reference;
  const msr_plan_figures f = msr_plan_describe(s->setting.plan);
  s->made->figures = (msr_accuracy_figures){
      .until = s->setting.until,
      .horizon = msri_setting_time(&s->setting, r->n - 1),
      .frames = r->n,
      .reference_error = msri_reference_error(r),
      .reference = r->truth.integrator,
      .reference_substeps = r->truth.substeps,
      .reference_atol = r->truth.atol,
      .witness = r->witness.integrator,
      .witness_substeps = r->witness.substeps,
      .witness_atol = r->witness.atol,
      .masses = f.masses,
      .springs = f.springs,
      .scene_hash = msri_scene_hash(s->setting.scene),
      .seconds = msri_watch_elapsed(&s->setting.watch),
      .complete = s->complete,
  };
}

static msr_status run(study *s, msr_error *err) {
  const msri_reference_goal goal = {parted, s->finest / 4, 0, reference_share,
                                    "raise the budget, or lower TENSION_RESSORT or speeds"};
  msr_status status = msri_reference_find(&s->setting, &goal, &s->reference, err);
  if (status == MSR_OK) status = msri_screens_open(&s->setting, &s->screens, err);
  if (status == MSR_OK) status = begin_ladders(s, err);
  s->complete = s->setting.watch.status == MSR_OK;
  if (status == MSR_OK && s->complete) status = climb_all(s, err);
  if (status != MSR_OK) return status;
  describe(s);
  msri_result_finish(s->made, s->setting.method);
  return MSR_OK;
}

static void close(study *s) {
  msri_screens_close(&s->screens);
  msri_reference_clear(&s->reference);
  msri_setting_close(&s->setting);
  free(s->ladder);
  free(s->cost);
}

msr_status msr_accuracy_study(const msr_scene *scene, const msr_accuracy_options *options,
                              msr_accuracy **accuracy, msr_error *err) {
  static const msr_accuracy_options defaults = {0};
  if (!options) options = &defaults;
  study s = {.finest = options->finest > 0 ? options->finest : default_finest};
  msr_error said = {MSR_OK, ""}; /* of runs that failed, too, which a study may do without */
  msr_status status = msri_setting_open(&s.setting, scene, options, &usual, err);
  if (status != MSR_OK) return status;
  s.made = msri_alloc(1, sizeof *s.made, "a study", &said);
  status = s.made ? run(&s, &said) : MSR_ENOMEM;
  close(&s);
  if (status == MSR_OK) {
    *accuracy = s.made;
    return MSR_OK;
  }
  msr_accuracy_free(s.made);
  return msri_hand_on(err, status, &said, "%s", msr_status_text(status));
}
