/* effects.c - the forces and contacts that a scene calls for, and why the others are left out.
 *
 * What the scene doesn't call for gets no term, so that nothing of it is ever run. */
#include "plan/plan.h"

#include "base/number.h"
#include "base/pixel.h"
#include "integrators/splitting.h"
#include "sweep/sweep.h"

#include <stdlib.h>
#include <string.h>

/* A row for an effect, in the order of calling; its reason is written by the caller. */
static char *add_effect(msr_plan *plan, msr_role role, const char *name, bool on,
                        const msr_force *force) {
  char *reason = plan->reason[plan->n_effects];
  plan->effect[plan->n_effects++] =
      (msr_effect){.name = name, .on = on, .reason = reason, .force = force, .role = role};
  return reason;
}

/* The term's own copy of the parameters, compiled. */
static msr_status compile_force(msri_term *term, const void *params, const msr_view *start,
                                msr_error *err) {
  const msr_force *force = term->force;
  term->params = msri_alloc(1, force->params_size, "a force", err);
  if (!term->params) return MSR_ENOMEM;
  if (params) memcpy(term->params, params, force->params_size);
  term->self = term->params;
  if (!force->prepare) return MSR_OK;
  msr_error said = {MSR_OK, ""};
  const msr_status status = force->prepare(term->params, start, &term->made, &said);
  term->self = term->made;
  if (status == MSR_OK) return MSR_OK;
  free(term->params);
  return msri_hand_on(err, status, &said, "force %s: %s", force->name, msr_status_text(status));
}

static msr_status add_term(msr_plan *plan, const msr_force *force, const void *params,
                           const msr_view *start, msr_error *err) {
  char *reason = add_effect(plan, MSR_ROLE_FORCE, force->name, false, force);
  if (force->idle && force->idle(params, start, reason, MSR_MESSAGE_SIZE)) return MSR_OK;
  msri_term *term = &plan->term[plan->n_terms];
  *term = (msri_term){.force = force, .scratch = plan->scratch_bytes};
  const msr_status status = compile_force(term, params, start, err);
  if (status != MSR_OK) return status;
  plan->n_terms++;
  plan->effect[plan->n_effects - 1].on = true;
  plan->scratch_bytes += msri_round_up(force->scratch_size, 16);
  plan->midpoint |= force->uses_velocity && !force->flow;
  plan->middle |= plan->figures.integrator->implicit && !force->uses_velocity && !force->between;
  plan->driven |= msri_force_drives(force);
  plan->followed |= msri_force_drives(force) && !force->power;
  msri_format(reason, MSR_MESSAGE_SIZE, "asked for");
  if (force->describe) force->describe(term->params, start, reason, MSR_MESSAGE_SIZE);
  return MSR_OK;
}

/* "12 black pixels, the first at (3,40)": column and row, in reading order. */
static void describe_supports(const msr_plan *plan, const msr_scene *scene, char *reason) {
  const size_t width = plan->picture->width, n = scene->n_supports;
  size_t first = 0;
  while (msri_pixel_of(plan->picture->rgb + 3 * first) != MSRI_SUPPORT) first++;
  msri_format(reason, MSR_MESSAGE_SIZE,
              "%zu black pixel%s, the first at (%zu,%zu); restitution %g, friction %g", n,
              n == 1 ? "" : "s", first % width, first / width, scene->restitution, scene->friction);
}

static msr_status add_contact(msr_plan *plan, const msr_scene *scene, msr_error *err) {
  const bool closed = scene->picture && scene->options.closed_border;
  const bool masses = plan->figures.masses > 0, black = scene->n_supports > 0;
  const bool supports = black && masses, border = closed && masses;
  plan->figures.supports = scene->n_supports;
  char *reason = add_effect(plan, MSR_ROLE_CONTACT, "supports", supports, NULL);
  if (!supports)
    msri_format(reason, MSR_MESSAGE_SIZE, black ? "there is no mass" : "there is no black pixel");
  else
    describe_supports(plan, scene, reason);
  reason = add_effect(plan, MSR_ROLE_CONTACT, "border", border, NULL);
  if (!border)
    msri_format(reason, MSR_MESSAGE_SIZE, closed ? "there is no mass" : "it is open");
  else
    msri_format(reason, MSR_MESSAGE_SIZE, "it is closed; restitution %g, friction %g",
                scene->restitution, scene->friction);
  plan->n_contacts += (size_t)supports + border;
  if (!supports && !border) return MSR_OK;
  const msri_supports_options options = {closed, scene->restitution, scene->friction,
                                         plan->figures.impacts};
  return msri_supports_create(plan->picture, &options, &plan->contact, err);
}

static msr_status add_collisions(msr_plan *plan, const msr_scene *scene, const msr_view *start,
                                 msr_error *err) {
  const char *off = "not asked for";
  msr_status status = MSR_OK;
  if (scene->diameter > 0 && start->n > 1) {
    status = msri_discs_create(start, scene->diameter, scene->restitution, &plan->discs, err);
    off = "no two masses that could meet";
  } else if (scene->diameter > 0) {
    off = "fewer than two masses";
  }
  plan->n_contacts += plan->discs != NULL;
  char *reason = add_effect(plan, MSR_ROLE_CONTACT, "collisions", plan->discs, NULL);
  msri_format(reason, MSR_MESSAGE_SIZE, "%s", off);
  if (plan->discs)
    msri_format(reason, MSR_MESSAGE_SIZE, "asked for: discs of diameter %g px; restitution %g",
                scene->diameter, scene->restitution);
  return status;
}

static bool listed(const msr_plan *plan, const msr_force *force) {
  for (size_t e = 0; e < plan->n_effects; e++)
    if (plan->effect[e].force == force) return true;
  return false;
}

static void add_absent(msr_plan *plan) {
  for (const msr_force *const *f = msr_forces; *f; f++)
    if (!listed(plan, *f))
      msri_format(add_effect(plan, MSR_ROLE_FORCE, (*f)->name, false, *f), MSR_MESSAGE_SIZE, "%s",
                  (*f)->absent ? (*f)->absent : "not asked for");
}

/* ---- What steps, and what watches over it */

static void add_integrator(msr_plan *plan, const msri_asked *asked) {
  const msr_integrator *i = plan->figures.integrator;
  const bool on = plan->figures.masses > 0;
  char *reason = add_effect(plan, MSR_ROLE_STEP, "integrator", on, NULL);
  msri_format(reason, MSR_MESSAGE_SIZE, on ? "%s, %s: order %d" : "there is no mass", i->name,
              asked->integrator ? "asked for" : "the default", i->order);
}

/* Why steps of the library's own choice are out of the question; NULL: they aren't. */
static const char *cannot_choose(const msr_plan *plan, const msri_asked *asked) {
  if (plan->figures.masses == 0) return "there is no mass";
  if (asked->integrator) return "an integrator was asked for";
  if (asked->substeps) return "a number of substeps was asked for";
  return msri_plan_cannot_leap(plan);
}

static void add_leaps(msr_plan *plan, const msri_asked *asked) {
  const msr_plan_figures *f = &plan->figures;
  const char *const cannot = cannot_choose(plan, asked);
  char *reason = add_effect(plan, MSR_ROLE_STEP, "leaps", f->leaps, NULL);
  msri_format(reason, MSR_MESSAGE_SIZE, "%s", cannot ? cannot : "");
  if (cannot) return;
  msri_format(reason, MSR_MESSAGE_SIZE, "an iteration takes %llu substep%s: %s%s",
              (unsigned long long)f->substeps, f->substeps == 1 ? "" : "s",
              f->leaps ? f->leaps->name : "too few for it to pay",
              f->leaps ? ", implicit, wherever cheaper" : "");
}

/* Steps between two looks at speeds: row by row it's drifts that are counted, and past supports the
 * loop tells of each. */
static int steps_between_looks(const msr_plan *plan) {
  const int drifts = msri_splitting_drifts(plan->figures.integrator);
  if (!msri_plan_sweeps(plan)) return MSRI_GLANCE;
  return msri_plan_meets(plan) ? 1 : (MSRI_SPEEDS + drifts - 1) / drifts;
}

static void add_guard(msr_plan *plan) {
  const bool on = plan->figures.masses > 0;
  const int steps = steps_between_looks(plan);
  char speeds[32] = "at each step", *reason = add_effect(plan, MSR_ROLE_STEP, "guard", on, NULL);
  if (steps > 1) msri_format(speeds, sizeof speeds, "every %d steps", steps);
  msri_format(reason, MSR_MESSAGE_SIZE,
              on ? "always: stops what is unstable; speeds %s, energies every %d steps"
                 : "there is no mass",
              speeds, MSRI_LOOK);
}

static void add_care(msr_plan *plan, const msri_asked *asked) {
  const msr_plan_figures *f = &plan->figures;
  const char *const cannot = cannot_choose(plan, asked);
  char *reason = add_effect(plan, MSR_ROLE_STEP, "care", f->care, NULL);
  msri_format(reason, MSR_MESSAGE_SIZE, "%s", cannot ? cannot : "");
  if (!cannot)
    msri_format(reason, MSR_MESSAGE_SIZE, "%s %s", f->care->name,
                plan->careful ? "from the start: springs are crushed there"
                              : "takes over should energy come from nowhere");
}

/* The effect of a step by that name, if it is on. */
static size_t row_of(const msr_plan *plan, const char *name) {
  size_t e = plan->n_terms + plan->n_contacts;
  while (e < plan->n_effects && !(plan->effect[e].on && strcmp(plan->effect[e].name, name) == 0))
    e++;
  return e;
}

/* Those that are on first, both halves in their order. `spare` has room for all. */
static void sort_effects(msr_plan *plan, msr_effect *spare) {
  size_t n = 0;
  for (int on = 1; on >= 0; on--)
    for (size_t e = 0; e < plan->n_effects; e++)
      if (plan->effect[e].on == on) spare[n++] = plan->effect[e];
  memcpy(plan->effect, spare, n * sizeof *spare);
}

/* Does nothing give energy or take it? */
static bool conserves(const msr_plan *plan, const msr_scene *scene) {
  for (size_t i = 0; i < plan->n_terms; i++)
    if (!plan->term[i].force->conservative || plan->term[i].force->uses_time) return false;
  return !msri_plan_meets(plan) || (scene->restitution == 1 && scene->friction == 0);
}

msr_status msri_plan_call_for_effects(msr_plan *plan, const msr_scene *scene, const msr_view *start,
                                      msr_error *err) {
  enum { CONTACTS = 3, STEPS = 4 };
  size_t most = 1 + scene->n_forces + CONTACTS + STEPS;
  for (const msr_force *const *f = msr_forces; *f; f++) most++;
  plan->term = msri_alloc(1 + scene->n_forces, sizeof *plan->term, "the forces", err);
  plan->reason = msri_alloc(most, sizeof *plan->reason, "the effects", err);
  plan->effect = msri_alloc(2 * most, sizeof *plan->effect, "the effects", err);
  if (!plan->term || !plan->reason || !plan->effect) return MSR_ENOMEM;
  msr_status status = add_term(plan, &msr_force_springs, NULL, start, err);
  for (size_t i = 0; i < scene->n_forces && status == MSR_OK; i++)
    status = add_term(plan, scene->force[i].force, scene->force[i].params, start, err);
  if (status == MSR_OK) status = add_contact(plan, scene, err);
  if (status == MSR_OK) status = add_collisions(plan, scene, start, err);
  if (status != MSR_OK) return status;
  plan->conserves = conserves(plan, scene);
  return MSR_OK;
}

void msri_plan_complete_effects(msr_plan *plan, const msri_asked *asked) {
  add_integrator(plan, asked);
  add_leaps(plan, asked);
  add_guard(plan);
  add_care(plan, asked);
  add_absent(plan);
  sort_effects(plan, plan->effect + plan->n_effects);
  plan->row = (msri_rows){.contact = plan->n_terms + (plan->discs ? plan->n_contacts - 1 : 0),
                          .integrator = row_of(plan, "integrator"),
                          .leaps = row_of(plan, "leaps"),
                          .guard = row_of(plan, "guard"),
                          .care = row_of(plan, "care")};
  msri_plan_count_costs(plan);
}

const msr_effect *msr_plan_effects(const msr_plan *plan, size_t *n) {
  *n = plan->n_effects;
  return plan->effect;
}
