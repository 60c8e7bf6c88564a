/* plan.c - compiles a scene: masses, springs, the forces and contacts that it calls for, the step.
 *
 * What the scene doesn't call for gets no term, so that nothing of it is ever run. */
#include "plan/plan.h"

#include "base/number.h"
#include "formats/ppm.h"
#include "integrators/tolerance.h"
#include "plan/state.h"

#include <stdlib.h>
#include <string.h>

/* ---- Masses */

static msr_status copy_picture(msr_plan *plan, const msr_picture *picture, msr_error *err) {
  plan->figures.width = picture->width;
  plan->figures.height = picture->height;
  return msri_picture_copy(picture, &plan->picture, err);
}

/* Are all masses equal? Then the plan keeps one number for them all. */
static bool uniform(const msr_scene *scene, double *m) {
  *m = scene->n_picture > 0 || scene->n_masses == 0 ? scene->conf.mass : scene->mass[0].m;
  for (size_t i = 0; i < scene->n_masses; i++)
    if (scene->mass[i].m != *m) return false;
  return true;
}

static msr_status copy_masses(msr_plan *plan, const msr_scene *scene, msr_error *err) {
  const size_t n = msr_scene_masses(scene);
  plan->figures.masses = n;
  plan->n_picture = scene->n_picture;
  plan->mass = msri_alloc(scene->n_masses, sizeof *plan->mass, "the masses", err);
  if (!plan->mass) return MSR_ENOMEM;
  if (scene->n_masses > 0) memcpy(plan->mass, scene->mass, scene->n_masses * sizeof *plan->mass);
  if (uniform(scene, &plan->uniform_mass)) return MSR_OK;
  plan->m = msri_alloc(n, sizeof *plan->m, "the masses", err);
  if (!plan->m) return MSR_ENOMEM;
  for (size_t i = 0; i < n; i++)
    plan->m[i] = i < scene->n_picture ? scene->conf.mass : scene->mass[i - scene->n_picture].m;
  return MSR_OK;
}

/* ---- Effects */

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
  plan->scratch_bytes += (force->scratch_size + 15) / 16 * 16;
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

static bool conserves(const msr_plan *plan, const msr_scene *scene) {
  for (size_t i = 0; i < plan->n_terms; i++)
    if (!plan->term[i].force->conservative || plan->term[i].force->uses_time) return false;
  return !msri_plan_meets(plan) || (scene->restitution == 1 && scene->friction == 0);
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

static msr_status call_for_effects(msr_plan *plan, const msr_scene *scene, const msr_view *start,
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
  add_absent(plan);
  sort_effects(plan, plan->effect + most);
  return MSR_OK;
}

/* ---- The plan */

static void count_memory(msr_plan *plan) {
  const msri_mesh *mesh = &plan->mesh;
  msr_plan_figures *f = &plan->figures;
  const size_t added = f->masses - plan->n_picture;
  f->plan_bytes =
      sizeof *plan + 3 * f->width * f->height + added * sizeof *plan->mass +
      (plan->m ? f->masses * sizeof *plan->m : 0) + mesh->run_capacity * sizeof *mesh->run +
      mesh->n_added * (sizeof *mesh->k + sizeof *mesh->L) +
      mesh->anchor_capacity * sizeof *mesh->anchor + (plan->graph ? plan->graph->bytes : 0) +
      (plan->contact.drift ? f->width * f->height / 8 : 0) +
      (plan->discs ? msri_discs_bytes(plan->discs) : 0);
  f->state_bytes = msri_state_bytes(plan);
}

static msr_status compile(msr_plan *plan, const msr_scene *scene, const msr_plan_options *options,
                          msr_error *err) {
  const uint64_t substeps = options->substeps;
  const bool automatic = !options->integrator && substeps == 0;
  msr_status status = scene->picture ? copy_picture(plan, scene->picture, err) : MSR_OK;
  if (status == MSR_OK) status = copy_masses(plan, scene, err);
  if (status == MSR_OK) status = msri_mesh_create(scene, &plan->mesh, err);
  if (status != MSR_OK) return status;
  if (plan->figures.integrator->implicit)
    status = msri_graph_create(plan->figures.masses, &plan->mesh.springs, &plan->graph, err);
  if (status != MSR_OK) return status;
  plan->figures.springs = plan->mesh.springs.n;
  plan->figures.anchors = plan->mesh.springs.n_anchors;
  const size_t n = plan->figures.masses;
  double *q = msri_alloc(4 * n, sizeof *q, "the masses", err);
  if (!q) return MSR_ENOMEM;
  double *v = q + 2 * n;
  msri_plan_start(plan, q, q + n, v, v + n);
  const msr_view start = msri_plan_view(plan, 0, q, v);
  status = call_for_effects(plan, scene, &start, err);
  plan->conserves = conserves(plan, scene);
  plan->cares = automatic && msri_plan_can_leap(plan);
  if (plan->cares) plan->figures.care = &msr_integrator_energy_momentum;
  plan->careful = plan->cares && msri_plan_crushes(plan, &start);
  if (status == MSR_OK) status = msri_plan_choose_step(plan, &start, substeps, err);
  if (status == MSR_OK && automatic) status = msri_plan_choose_leaps(plan, err);
  free(q);
  count_memory(plan);
  return status;
}

static msr_status check_integrator(const msr_integrator *integrator, msr_error *err) {
  if (integrator->name && integrator->summary && integrator->step) return MSR_OK;
  return msri_fail(err, MSR_EUSAGE, "an integrator needs at least name, summary and step");
}

msr_status msr_plan_create(const msr_scene *scene, const msr_plan_options *options, msr_plan **plan,
                           msr_error *err) {
  static const msr_plan_options defaults = {0};
  if (!options) options = &defaults;
  const msr_integrator *integrator =
      options->integrator ? options->integrator : &msr_integrator_verlet;
  msr_status status = check_integrator(integrator, err);
  msri_tolerance tolerance = {.atol = options->atol, .rtol = options->rtol};
  if (status == MSR_OK) status = msri_tolerance_check(&tolerance, err);
  if (status != MSR_OK) return status;
  msr_plan *made = msri_alloc(1, sizeof *made, "a plan", err);
  if (!made) return MSR_ENOMEM;
  made->figures = (msr_plan_figures){.integrator = integrator,
                                     .iterations = scene->conf.iterations,
                                     .images = scene->conf.images,
                                     .dt = scene->conf.dt,
                                     .impacts = options->impacts,
                                     .atol = tolerance.atol,
                                     .rtol = tolerance.rtol};
  status = compile(made, scene, options, err);
  if (status == MSR_OK)
    *plan = made;
  else
    msr_plan_free(made);
  return status;
}

void msr_plan_free(msr_plan *plan) {
  if (!plan) return;
  for (size_t i = 0; i < plan->n_terms; i++) {
    if (plan->term[i].made && plan->term[i].force->release)
      plan->term[i].force->release(plan->term[i].made);
    free(plan->term[i].params);
  }
  if (plan->contact.release) plan->contact.release(plan->contact.self);
  msri_discs_free(plan->discs);
  free(plan->graph);
  msri_mesh_clear(&plan->mesh);
  msri_notes_clear(&plan->notes);
  msr_picture_free(plan->picture);
  free(plan->term);
  free(plan->effect);
  free(plan->reason);
  free(plan->mass);
  free(plan->m);
  free(plan);
}

const char *msr_plan_warning(const msr_plan *plan, size_t i) {
  return msri_notes_at(&plan->notes, i);
}

const msr_effect *msr_plan_effects(const msr_plan *plan, size_t *n) {
  *n = plan->n_effects;
  return plan->effect;
}

msr_plan_figures msr_plan_describe(const msr_plan *plan) { return plan->figures; }
