/* setting.c - what all runs of a study share. */
#include "accuracy/setting.h"

#include <math.h>
#include <stdlib.h>

/* Memory for the positions of one reference. There are two while it is refined. */
static const double most_bytes = 128e6;

/* ---- Instants */

static uint64_t most_instants(const msri_setting *s) {
  const double fit = most_bytes / (2 * (double)s->masses * sizeof(double)), most = 10000;
  return fit < 2 ? 2 : fit < most ? (uint64_t)fit : (uint64_t)most;
}

double msri_setting_seconds(const msri_setting *s, double cost) {
  const msr_plan_figures f = msr_plan_describe(s->plan);
  const double each = 2e-9, small = 20;
  return cost * each * ((double)f.masses + (double)f.springs + small);
}

double msri_setting_verlet(const msri_setting *s, uint64_t iteration) {
  const msr_plan_figures f = msr_plan_describe(s->plan);
  const double substeps = f.stable_step < f.dt ? ceil(f.dt / f.stable_step) : 1;
  return substeps * (double)iteration;
}

static msr_status choose_instants(msri_setting *s, uint64_t end,
                                  const msri_setting_defaults *defaults, msr_error *err) {
  const msr_plan_figures f = msr_plan_describe(s->plan);
  const uint64_t frame = f.iterations / f.images;
  const double verlet = msri_setting_seconds(s, msri_setting_verlet(s, frame));
  const bool slow = 1000 * verlet > s->watch.budget;
  msri_instants made;
  const msri_instants_wanted wanted = {.iterations = f.iterations,
                                       .images = f.images,
                                       .end = end,
                                       .fewest = defaults->fewest,
                                       .most = most_instants(s),
                                       .ratio = slow ? 1.5 : defaults->ratio};
  const msr_status status = msri_instants_choose(&wanted, &made, err);
  if (status != MSR_OK) return status;
  s->n = made.n;
  s->iteration = made.iteration;
  return MSR_OK;
}

double msri_setting_time(const msri_setting *s, size_t instant) {
  return (double)s->iteration[instant] * msr_plan_describe(s->plan).dt;
}

/* ---- Opening */

static msr_status check(const msr_accuracy_options *o, msr_error *err) {
  const double values[] = {o->until, o->budget, o->finest};
  static const char *const names[] = {"until", "budget", "finest"};
  for (size_t i = 0; i < sizeof values / sizeof *values; i++)
    if (!(values[i] >= 0 && values[i] < HUGE_VAL))
      return msri_fail(err, MSR_EUSAGE, "%s must be a number of 0 or more, not %g", names[i],
                       values[i]);
  for (size_t i = 0; i < o->n_integrators; i++)
    if (!o->integrators || !o->integrators[i])
      return msri_fail(err, MSR_EUSAGE, "integrator %zu isn't given", i);
  return MSR_OK;
}

/* ---- Methods */

static bool has(const msri_setting *s, const msr_integrator *integrator) {
  for (size_t i = 0; i < s->n_methods; i++)
    if (s->method[i] == integrator) return true;
  return false;
}

/* Those asked for, or all of the library that are stable at some step. */
static msr_status list_methods(msri_setting *s, const msr_accuracy_options *o, msr_error *err) {
  const bool all = o->n_integrators == 0;
  const msr_integrator *const *list = all ? msr_integrators : o->integrators;
  size_t n = o->n_integrators;
  while (all && list[n]) n++;
  s->method = msri_alloc(n, sizeof(const msr_integrator *), "the methods", err);
  if (!s->method) return MSR_ENOMEM;
  for (size_t i = 0; i < n; i++) {
    const bool never = all && !list[i]->adaptive && !(list[i]->stability > 0);
    if (!never && !has(s, list[i])) s->method[s->n_methods++] = list[i];
  }
  return MSR_OK;
}

/* ---- The scene */

/* The side of the picture or, if larger, of the box that holds all masses. */
static double extent(const msr_state *state) {
  const msr_plan_figures f = msr_plan_describe(state->plan);
  const msr_view s = msr_state_view(state);
  double far = msri_max((double)f.width, (double)f.height);
  double low[2] = {s.x[0], s.y[0]}, high[2] = {s.x[0], s.y[0]};
  for (size_t i = 0; i < s.n; i++) {
    low[0] = msri_min(low[0], s.x[i]), high[0] = msri_max(high[0], s.x[i]);
    low[1] = msri_min(low[1], s.y[i]), high[1] = msri_max(high[1], s.y[i]);
  }
  const double least = 10;
  return msri_max(msri_max(far, least), msri_max(high[0] - low[0], high[1] - low[1]));
}

static msr_status look_at_effects(msri_setting *s, msr_error *err) {
  size_t n;
  const msr_effect *effect = msr_plan_effects(s->plan, &n);
  for (size_t e = 0; e < n && effect[e].on; e++) {
    s->contacts |= effect[e].role == MSR_ROLE_CONTACT;
    s->damped |= effect[e].force && effect[e].force->uses_velocity;
  }
  msr_state *state;
  const msr_status status = msr_state_create(s->plan, &state, err);
  if (status != MSR_OK) return status;
  s->far = extent(state);
  msr_state_free(state);
  return MSR_OK;
}

static msr_status fill(msri_setting *s, const msr_accuracy_options *options,
                       const msri_setting_defaults *defaults, msr_error *err) {
  const msr_conf *conf = &s->scene->conf;
  if (s->masses == 0) return msri_fail(err, MSR_EINPUT, "the scene has no mass: nothing moves");
  if (conf->iterations == 0)
    return msri_fail(err, MSR_EINPUT, "NB_ITERATIONS is 0: there is no time to compare over");
  const double whole = (double)conf->iterations * conf->dt;
  const double asked = msri_max(1, ceil(options->until / conf->dt * (1 - 1e-12)));
  const bool all = options->until <= 0 || asked >= (double)conf->iterations;
  const msr_plan_options one = {.substeps = 1, .impacts = MSR_IMPACTS_LOCATED};
  s->until = all ? whole : options->until;
  msr_status status = msr_plan_create(s->scene, &one, &s->plan, err);
  if (status == MSR_OK) status = look_at_effects(s, err);
  if (status == MSR_OK) status = list_methods(s, options, err);
  if (status != MSR_OK) return status;
  return choose_instants(s, all ? conf->iterations : (uint64_t)asked, defaults, err);
}

msr_status msri_setting_open(msri_setting *setting, const msr_scene *scene,
                             const msr_accuracy_options *options,
                             const msri_setting_defaults *defaults, msr_error *err) {
  static const msr_accuracy_options none = {0};
  if (!options) options = &none;
  *setting = (msri_setting){.scene = scene, .masses = msr_scene_masses(scene)};
  msr_status status = check(options, err);
  if (status != MSR_OK) return status;
  msri_watch_begin(&setting->watch, options, defaults->budget);
  status = fill(setting, options, defaults, err);
  if (status != MSR_OK) msri_setting_close(setting);
  return status;
}

void msri_setting_close(msri_setting *setting) {
  msr_plan_free(setting->plan);
  free(setting->iteration);
  free(setting->method);
}

/* ---- Runs */

msr_plan_options msri_setting_options(const msri_setting *setting, const msr_integrator *integrator,
                                      uint64_t substeps, double atol) {
  return (msr_plan_options){
      .integrator = integrator,
      .substeps = substeps,
      .atol = integrator->adaptive ? atol : 0,
      .impacts = setting->contacts ? MSR_IMPACTS_LOCATED : MSR_IMPACTS_KEPT,
  };
}

msr_status msri_setting_fewest(const msri_setting *setting, const msr_integrator *integrator,
                               bool safe, uint64_t *substeps, msr_error *err) {
  const msr_plan_options one = {.integrator = integrator, .substeps = 1};
  msr_plan *plan;
  const msr_status status = msr_plan_create(setting->scene, &one, &plan, err);
  if (status != MSR_OK) return status;
  const msr_plan_figures f = msr_plan_describe(plan);
  const double needed = ceil(f.dt / (safe ? f.safe_step : f.stable_step) * (1 - 1e-12));
  const bool one_will_do = needed <= 1 || f.stable_step == 0;
  *substeps = one_will_do ? 1 : needed < MSRI_MOST_SUBSTEPS ? (uint64_t)needed : 0;
  msr_plan_free(plan);
  return MSR_OK;
}

int msri_setting_order(const msri_setting *setting, const msr_integrator *integrator) {
  const bool damped = setting->damped && integrator->damped_order > 0;
  const int order = damped ? integrator->damped_order : integrator->order;
  return order > 1 ? order : 1;
}
