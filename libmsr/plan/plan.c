/* plan.c - compiles a scene: masses, springs, what it calls for (see effects.c), the step. */
#include "plan/plan.h"

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
      plan->contact.bytes + (plan->discs ? msri_discs_bytes(plan->discs) : 0);
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
  status = msri_plan_call_for_effects(plan, scene, &start, err);
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

msr_plan_figures msr_plan_describe(const msr_plan *plan) { return plan->figures; }
