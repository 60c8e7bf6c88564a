/* effects.c - the forces and contacts that a scene calls for, and why the others are left out.
 *
 * What the scene doesn't call for gets no term, so that nothing of it is ever run. */
#include "plan/plan.h"

#include "base/number.h"

#include <stdlib.h>
#include <string.h>

/* A row for an effect, in the order of calling; its reason is written by the caller. */
static char *add_effect(msr_plan *plan, const char *name, bool on, const msr_force *force) {
  char *reason = plan->reason[plan->n_effects];
  plan->effect[plan->n_effects++] = (msr_effect){name, on, reason, force};
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
  char *reason = add_effect(plan, force->name, false, force);
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

static msr_status add_contact(msr_plan *plan, const msr_scene *scene, msr_error *err) {
  const bool closed = scene->picture && scene->options.closed_border;
  const bool masses = plan->figures.masses > 0, black = scene->n_supports > 0;
  const bool supports = black && masses, border = closed && masses;
  plan->figures.supports = scene->n_supports;
  char *reason = add_effect(plan, "supports", supports, NULL);
  if (!supports)
    msri_format(reason, MSR_MESSAGE_SIZE, black ? "there is no mass" : "there is no black pixel");
  else
    msri_format(reason, MSR_MESSAGE_SIZE, "%zu black pixels; restitution %g, friction %g",
                scene->n_supports, scene->restitution, scene->friction);
  reason = add_effect(plan, "border", border, NULL);
  if (!border)
    msri_format(reason, MSR_MESSAGE_SIZE, closed ? "there is no mass" : "it is open");
  else
    msri_format(reason, MSR_MESSAGE_SIZE, "it is closed; restitution %g, friction %g",
                scene->restitution, scene->friction);
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
  char *reason = add_effect(plan, "collisions", plan->discs, NULL);
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
      msri_format(add_effect(plan, (*f)->name, false, *f), MSR_MESSAGE_SIZE, "%s",
                  (*f)->absent ? (*f)->absent : "not asked for");
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
  enum { CONTACTS = 3 };
  size_t most = 1 + scene->n_forces + CONTACTS;
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
  add_absent(plan);
  sort_effects(plan, plan->effect + most);
  return MSR_OK;
}

const msr_effect *msr_plan_effects(const msr_plan *plan, size_t *n) {
  *n = plan->n_effects;
  return plan->effect;
}
