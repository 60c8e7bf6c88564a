/* study.c - what accuracy costs in time: every method at many steps, against the reference.
 *
 * The run that promises to take the fewest evaluations is always the next, so that coarse points
 * of all methods come first. A method is done when its error comes near the reference's own, or
 * near what is asked for, or when it takes a hundred times the work of another that is as good. */
#include "accuracy/ladder.h"
#include "accuracy/measure.h"

#include <math.h>
#include <stdlib.h>

static const double default_budget = 60, reference_share = 0.25; /* [s] */
static const double default_finest = 1e-10;                      /* [px] */
static const double parted = 1e-3;  /* where references differ by so much, they have parted [px] */
static const double hopeless = 100; /* times the work of a method that is as good */

struct msr_accuracy {
  msr_accuracy_figures figures;
  msr_accuracy_point *point;
  size_t n, capacity;
};

typedef struct study {
  msri_setting setting;
  msri_reference reference;
  msri_screens screens;
  msri_ladder *ladder; /* [n] */
  size_t n;
  double finest;
  bool complete;
  msr_accuracy *made;
} study;

/* ---- Which methods */

static bool asked_twice(const study *s, const msr_integrator *integrator) {
  for (size_t i = 0; i < s->n; i++)
    if (s->ladder[i].integrator == integrator) return true;
  return false;
}

static msr_status begin_ladders(study *s, const msr_integrator *const *list, size_t n, bool all,
                                msr_error *err) {
  const uint64_t iterations = s->setting.iteration[s->reference.n - 1];
  s->ladder = msri_alloc(n, sizeof *s->ladder, "the methods", err);
  if (!s->ladder) return MSR_ENOMEM;
  for (size_t i = 0; i < n; i++) {
    const bool stable = list[i]->adaptive || list[i]->stability > 0;
    if ((all && !stable) || asked_twice(s, list[i])) continue;
    const msr_status status =
        msri_ladder_begin(&s->setting, list[i], iterations, &s->ladder[s->n], err);
    if (status != MSR_OK) return status;
    s->n++;
  }
  return MSR_OK;
}

static msr_status choose_methods(study *s, const msr_accuracy_options *options, msr_error *err) {
  if (options->n_integrators > 0)
    return begin_ladders(s, options->integrators, options->n_integrators, false, err);
  size_t n = 0;
  while (msr_integrators[n]) n++;
  return begin_ladders(s, msr_integrators, n, true, err);
}

/* ---- Points */

/* The method whose next run is the shortest; NULL: all are done. */
static msri_ladder *shortest(study *s) {
  msri_ladder *least = NULL;
  for (size_t i = 0; i < s->n; i++) {
    msri_ladder *l = &s->ladder[i];
    if (!l->done && (!least || l->evaluations < least->evaluations)) least = l;
  }
  return least;
}

static bool is_hopeless(const study *s, const msr_accuracy_point *point) {
  for (size_t i = 0; i < s->made->n; i++) {
    const msr_accuracy_point *p = &s->made->point[i];
    if (p->max <= point->max && hopeless * (double)p->evaluations < (double)point->evaluations)
      return true;
  }
  return false;
}

/* Would a run so many times longer still end in time? */
static bool time_for(const study *s, double spent, double times) {
  return msri_watch_elapsed(&s->setting.watch) + times * spent < s->setting.watch.budget;
}

static void go_on(study *s, msri_ladder *ladder, const msr_accuracy_point *point, double spent) {
  const double target = msri_max(s->finest, 2 * msri_reference_error(&s->reference));
  const bool coarser = ladder->coarser;
  msri_ladder_next(&s->setting, ladder, point);
  ladder->done |= !coarser && point->stable && (point->max <= target || is_hopeless(s, point));
  if (ladder->done || point->evaluations == 0) return;
  const double times = ladder->evaluations / (double)point->evaluations;
  if (time_for(s, spent, times)) return;
  ladder->done = true;
  s->complete = false;
}

static msr_status keep(msr_accuracy *made, const msr_accuracy_point *point, msr_error *err) {
  msr_accuracy_point *grown =
      msri_grow(made->point, &made->capacity, made->n + 1, sizeof *point, "the points", err);
  if (!grown) return MSR_ENOMEM;
  made->point = grown;
  made->point[made->n++] = *point;
  return MSR_OK;
}

static void announce(study *s, const msr_plan_options *o) {
  if (o->integrator->adaptive)
    msri_watch_next(&s->setting.watch, 1, "%s, tolerance %g", o->integrator->name, o->atol);
  else
    msri_watch_next(&s->setting.watch, 1, "%s, %llu substeps", o->integrator->name,
                    (unsigned long long)o->substeps);
}

/* Errors, then times, of runs that together take about a six-hundredth of the budget. */
static msr_status measure(study *s, const msr_plan_options *options, msr_accuracy_point *point,
                          msr_error *err) {
  const msri_limits limits = {s->setting.far, UINT64_MAX};
  msri_measured measured;
  announce(s, options);
  const msr_status status =
      msri_measure(&s->setting, &s->reference, &s->screens, options, &limits, &measured, err);
  *point = measured.point;
  point->seconds = (double)NAN;
  if (status != MSR_OK || !point->stable) return status;
  return msri_measure_time(&s->setting, &s->reference, options, s->setting.watch.budget / 600,
                           &point->seconds, err);
}

/* One run of the ladder. A method that doesn't take the scene has no points; nor has a run that is
 * stopped before it has a time. */
static msr_status climb(study *s, msri_ladder *ladder, msr_error *err) {
  const double start = msri_watch_elapsed(&s->setting.watch);
  const msr_plan_options options = ladder->options;
  msr_accuracy_point point;
  msr_status status = measure(s, &options, &point, err);
  if (s->setting.watch.over) {
    s->complete = false;
    return point.seconds >= 0 ? keep(s->made, &point, err) : MSR_OK;
  }
  ladder->done = status == MSR_EUSAGE;
  if (ladder->done) return MSR_OK;
  if (status == MSR_OK) status = keep(s->made, &point, err);
  if (status == MSR_OK) go_on(s, ladder, &point, msri_watch_elapsed(&s->setting.watch) - start);
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

/* ---- What the points say */

static size_t place(const study *s, const msr_integrator *integrator) {
  size_t i = 0;
  while (s->ladder[i].integrator != integrator) i++;
  return i;
}

static bool before(const study *s, const msr_accuracy_point *a, const msr_accuracy_point *b) {
  const size_t i = place(s, a->integrator), j = place(s, b->integrator);
  if (i != j) return i < j;
  return a->integrator->adaptive ? a->atol > b->atol : a->substeps < b->substeps;
}

static void sort(const study *s) {
  msr_accuracy_point *p = s->made->point;
  for (size_t i = 1; i < s->made->n; i++)
    for (size_t j = i; j > 0 && before(s, &p[j], &p[j - 1]); j--) {
      const msr_accuracy_point swap = p[j];
      p[j] = p[j - 1];
      p[j - 1] = swap;
    }
}

/* log of the ratio of errors over that of steps. */
static void find_orders(msr_accuracy *made) {
  for (size_t i = 1; i < made->n; i++) {
    const msr_accuracy_point *a = &made->point[i - 1];
    msr_accuracy_point *b = &made->point[i];
    const bool comparable = a->integrator == b->integrator && !b->integrator->adaptive;
    if (comparable && a->stable && b->stable && a->max > 0 && b->max > 0)
      b->order = log(a->max / b->max) / log((double)b->substeps / (double)a->substeps);
  }
}

/* An error below the reference's own can't be told from it. */
static double error_of(const msr_accuracy *made, const msr_accuracy_point *p) {
  return msri_max(p->max, made->figures.reference_error);
}

static bool beats(const msr_accuracy *made, const msr_accuracy_point *a,
                  const msr_accuracy_point *b) {
  if (!a->stable) return false;
  const double x = error_of(made, a), y = error_of(made, b);
  return x <= y && a->seconds <= b->seconds && (x < y || a->seconds < b->seconds);
}

static void find_front(msr_accuracy *made) {
  for (size_t i = 0; i < made->n; i++) {
    msr_accuracy_point *p = &made->point[i];
    p->front = p->stable;
    for (size_t j = 0; j < made->n && p->front; j++) p->front = !beats(made, &made->point[j], p);
  }
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

static msr_status run(study *s, const msr_accuracy_options *options, msr_error *err) {
  const msri_reference_goal goal = {parted, s->finest / 4, reference_share};
  msr_status status = msri_reference_find(&s->setting, &goal, &s->reference, err);
  if (status == MSR_OK) status = msri_screens_open(&s->setting, &s->screens, err);
  if (status == MSR_OK) status = choose_methods(s, options, err);
  s->complete = s->setting.watch.status == MSR_OK;
  if (status == MSR_OK && s->complete) status = climb_all(s, err);
  if (status != MSR_OK) return status;
  describe(s);
  sort(s);
  find_orders(s->made);
  find_front(s->made);
  return MSR_OK;
}

static void close(study *s) {
  msri_screens_close(&s->screens);
  msri_reference_clear(&s->reference);
  msri_setting_close(&s->setting);
  free(s->ladder);
}

msr_status msr_accuracy_study(const msr_scene *scene, const msr_accuracy_options *options,
                              msr_accuracy **accuracy, msr_error *err) {
  static const msr_accuracy_options defaults = {0};
  if (!options) options = &defaults;
  study s = {.finest = options->finest > 0 ? options->finest : default_finest};
  msr_status status = msri_setting_open(&s.setting, scene, options, default_budget, err);
  if (status != MSR_OK) return status;
  s.made = msri_alloc(1, sizeof *s.made, "a study", err);
  status = s.made ? run(&s, options, err) : MSR_ENOMEM;
  close(&s);
  if (status == MSR_OK)
    *accuracy = s.made;
  else
    msr_accuracy_free(s.made);
  return status;
}

void msr_accuracy_free(msr_accuracy *accuracy) {
  if (!accuracy) return;
  free(accuracy->point);
  free(accuracy);
}

msr_accuracy_figures msr_accuracy_describe(const msr_accuracy *accuracy) {
  return accuracy->figures;
}

const msr_accuracy_point *msr_accuracy_points(const msr_accuracy *accuracy, size_t *n) {
  *n = accuracy->n;
  return accuracy->point;
}

const msr_accuracy_point *msr_accuracy_cheapest(const msr_accuracy *accuracy, double error) {
  const msr_accuracy_point *best = NULL;
  for (size_t i = 0; i < accuracy->n; i++) {
    const msr_accuracy_point *p = &accuracy->point[i];
    const bool good = p->stable && p->max + accuracy->figures.reference_error <= error;
    if (good && (!best || p->seconds < best->seconds)) best = p;
  }
  return best;
}
