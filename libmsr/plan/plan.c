/* plan.c - compiles a scene: masses, springs, what it calls for (see effects.c), the step. */
#include "plan/plan.h"

#include "base/processors.h"
#include "integrators/tolerance.h"
#include "plan/state.h"
#include "sweep/sweep.h"

#include <stdlib.h>
#include <string.h>

/* ---- Masses */

static void share_picture(msr_plan *plan, const msr_scene *scene) {
  if (!scene->grid) return;
  plan->grid = msri_grid_share(scene->grid);
  plan->picture = plan->grid->picture;
  plan->figures.width = plan->picture->width;
  plan->figures.height = plan->picture->height;
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
  const msr_status status = msri_plan_keep_start(plan, scene, err);
  if (status != MSR_OK) return status;
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
  f->plan_bytes = sizeof *plan + msri_grid_bytes(plan->grid) +
                  added * ((plan->added_move ? 4 : 2) * sizeof *plan->added + 3) +
                  plan->n_effects * (2 * sizeof *plan->effect + sizeof *plan->reason) +
                  (plan->m ? f->masses * sizeof *plan->m : 0) + msri_mesh_bytes(mesh) +
                  (plan->graph ? plan->graph->bytes : 0) + plan->contact.bytes +
                  (plan->discs ? msri_discs_bytes(plan->discs) : 0) +
                  msri_objects_bytes(&plan->objects) + msri_bands_bytes(&plan->bands);
  f->state_bytes = msri_state_bytes(plan);
}

/* No more than can run at the same time: threads that wait for each other would take turns. */
static unsigned threads_of(const msr_plan_options *options) {
  const unsigned most = msri_processors();
  if (options->threads == 0) return 1;
  return options->threads < most ? options->threads : most;
}

/* What the scene calls for, and the steps. */
static msr_status decide(msr_plan *plan, const msr_scene *scene, const msr_view *start,
                         const msr_plan_options *options, msr_error *err) {
  const bool automatic = !options->integrator && options->substeps == 0;
  msr_status status = msri_plan_call_for_effects(plan, scene, start, err);
  plan->cares = automatic && !msri_plan_cannot_leap(plan);
  if (plan->cares) plan->figures.care = &msr_integrator_energy_momentum;
  plan->careful = plan->cares && msri_plan_crushes(plan, start);
  if (status == MSR_OK) status = msri_plan_choose_step(plan, start, options->substeps, err);
  if (status == MSR_OK && automatic) status = msri_plan_choose_leaps(plan, err);
  return status;
}

/* Is it of interest where masses begin, and how fast? Those of a picture begin at rest, with
 * springs as long as they will. */
static bool looks_at_start(const msr_scene *scene) {
  for (size_t i = 0; i < scene->n_forces; i++)
    if (!scene->force[i].force->ignores_start) return true;
  return scene->n_masses > 0 || scene->diameter > 0;
}

static msr_status prepare_sweeps(msr_plan *plan, msr_error *err) {
  if (plan->mesh.n_added > 0)
    return msri_bands_create(plan->figures.masses, &plan->mesh.springs, &plan->bands, err);
  return msri_objects_create(plan->grid->picture, plan->neighbours, &plan->objects, err);
}

static msr_status say_attached(msr_plan *plan, const msr_scene *scene, msr_error *err) {
  if (!scene->options.attach || plan->figures.anchors > 0) return MSR_OK;
  return msri_notes_add(&plan->notes, err,
                        "no mass has a black pixel beside it: nothing is attached");
}

static msr_status compile(msr_plan *plan, const msr_scene *scene, const msr_plan_options *options,
                          msr_error *err) {
  share_picture(plan, scene);
  msr_status status = copy_masses(plan, scene, err);
  if (status == MSR_OK) status = msri_mesh_create(scene, &plan->mesh, err);
  if (status != MSR_OK) return status;
  if (plan->figures.integrator->implicit)
    status = msri_graph_create(plan->figures.masses, &plan->mesh.springs, &plan->graph, err);
  if (status != MSR_OK) return status;
  plan->figures.springs = plan->mesh.springs.n;
  plan->figures.anchors = plan->mesh.springs.n_anchors;
  status = say_attached(plan, scene, err);
  if (status != MSR_OK) return status;
  const size_t n = plan->figures.masses, places = looks_at_start(scene) ? n : 0;
  double *q = msri_alloc(4 * places, sizeof *q, "the masses", err);
  if (!q) return MSR_ENOMEM;
  if (places > 0) msri_plan_start(plan, q, q + n, q + 2 * n, q + 3 * n);
  const msr_view start =
      places > 0 ? msri_plan_view(plan, 0, q, q + 2 * n) : msri_plan_view(plan, 0, NULL, NULL);
  status = decide(plan, scene, &start, options, err);
  free(q);
  if (status == MSR_OK && msri_plan_sweeps(plan)) status = prepare_sweeps(plan, err);
  if (status != MSR_OK) return status;
  msri_plan_complete_effects(plan, &(msri_asked){options->integrator, options->substeps > 0});
  plan->figures.threads = msri_plan_sweeps(plan) ? msri_sweep_threads(plan) : 1;
  msri_plan_say_vectors(plan);
  count_memory(plan);
  return MSR_OK;
}

static msr_status check_threads(unsigned threads, msr_error *err) {
  if (threads <= MSRI_MOST_THREADS) return MSR_OK;
  return msri_fail(err, MSR_EUSAGE, "%u threads are more than the %d that there may be", threads,
                   MSRI_MOST_THREADS);
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
  if (status == MSR_OK) status = check_threads(options->threads, err);
  if (status != MSR_OK) return status;
  msr_plan *made = msri_alloc(1, sizeof *made, "a plan", err);
  if (!made) return MSR_ENOMEM;
  made->timed = options->timed;
  made->figures = (msr_plan_figures){.integrator = integrator,
                                     .iterations = scene->conf.iterations,
                                     .images = scene->conf.images,
                                     .dt = scene->conf.dt,
                                     .impacts = options->impacts,
                                     .atol = tolerance.atol,
                                     .rtol = tolerance.rtol};
  made->threads = threads_of(options);
  made->neighbours = scene->options.neighbours;
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
  msri_objects_clear(&plan->objects);
  msri_bands_clear(&plan->bands);
  msri_mesh_clear(&plan->mesh);
  msri_notes_clear(&plan->notes);
  msri_grid_free(plan->grid);
  free(plan->term);
  free(plan->effect);
  free(plan->reason);
  free(plan->added);
  free(plan->added_rgb);
  free(plan->m);
  free(plan);
}

const char *msr_plan_warning(const msr_plan *plan, size_t i) {
  return msri_notes_at(&plan->notes, i);
}

msr_plan_figures msr_plan_describe(const msr_plan *plan) { return plan->figures; }
