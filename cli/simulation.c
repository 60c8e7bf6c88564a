/* simulation.c - the options of the command in terms of the library: scene, forces, plan. */
#include "simulation.h"

#include "inputs.h"
#include "report.h"
#include "steps.h"
#include "study.h"

#include <string.h>

static msr_status load(const settings *s, msr_scene **scene, msr_error *err) {
  const msr_scene_options options = {.neighbours = (int)s->neighbours,
                                     .attach = s->attach,
                                     .closed_border = s->border_closed != 0};
  inputs in;
  msr_status status = inputs_find(s, &in, err);
  if (status == MSR_OK) status = msr_scene_load(in.picture, in.conf, &options, scene, err);
  return status == MSR_EIO ? MSR_EINPUT : status;
}

static msr_status add_air(const settings *s, msr_scene *scene, msr_error *err) {
  const msr_drag drag = {.c = s->drag};
  const msr_wind wind = {
      .c = s->drag, .speed = s->wind, .gust = s->gust, .gust_time = s->gust_time, .seed = s->seed};
  if (option_given(s, "--wind")) return msr_scene_add_force(scene, &msr_force_wind, &wind, err);
  if (option_given(s, "--drag")) return msr_scene_add_force(scene, &msr_force_drag, &drag, err);
  return MSR_OK;
}

static msr_status add_push(const push *p, msr_scene *scene, msr_error *err) {
  msr_push force = {.fx = p->fx, .fy = p->fy};
  const msr_status status =
      msr_scene_mass_at(scene, (size_t)p->column, (size_t)p->row, &force.mass, err);
  return status == MSR_OK ? msr_scene_add_force(scene, &msr_force_push, &force, err) : status;
}

static msr_status add_forces(const settings *s, msr_scene *scene, msr_error *err) {
  const msr_damping damping = {.z = s->damping};
  msr_status status = msr_scene_set_contact(scene, s->restitution, s->friction, err);
  if (status == MSR_OK && s->collide) status = msr_scene_set_collisions(scene, s->diameter, err);
  if (status == MSR_OK && option_given(s, "--damping")) {
    status = msr_scene_add_force(scene, &msr_force_damping, &damping, err);
  }
  if (status == MSR_OK) status = add_air(s, scene, err);
  for (size_t i = 0; i < s->n_pushes && status == MSR_OK; i++) {
    status = add_push(&s->pushes[i], scene, err);
  }
  return status;
}

msr_style simulation_style(const settings *s) {
  msr_style style = s->style;
  style.scale = (unsigned)s->scale;
  return style;
}

msr_status simulation_scene(const settings *s, msr_scene **scene, msr_error *err) {
  const char *text;
  msr_status status = load(s, scene, err);
  if (status != MSR_OK) return status;
  for (size_t i = 0; (text = msr_scene_warning(*scene, i)); i++) tell(s, "warning", text);
  status = add_forces(s, *scene, err);
  if (status != MSR_OK) msr_scene_free(*scene);
  return status;
}

/* Tolerances are for methods that use them. */
static msr_plan_options options_of(const settings *s) {
  const bool adaptive = s->integrator && s->integrator->adaptive;
  return (msr_plan_options){.integrator = s->integrator,
                            .substeps = s->substeps,
                            .atol = adaptive ? s->atol : 0,
                            .rtol = adaptive ? s->rtol : 0,
                            .impacts = (msr_impacts)s->impacts,
                            .threads = (unsigned)s->threads};
}

static void tell_notes(const settings *s, const msr_plan *plan) {
  const char *text;
  for (size_t i = 0; (text = msr_plan_warning(plan, i)); i++) tell(s, "note", text);
  if (s->impacts == MSR_IMPACTS_LOCATED && !simulation_contacts(plan)) {
    tell(s, "note", "--impacts has no effect: there is no support, and the border is open");
  }
  steps_note(s, plan);
}

/* Was the very run that is to come tried, from its beginning to its end? */
static bool was_tried(const msr_accuracy_choice *choice, const msr_plan *plan) {
  const msr_plan_figures f = msr_plan_describe(plan);
  return choice->horizon >= (1 - 1e-9) * f.dt * (double)f.iterations;
}

static msr_status compile(const settings *s, const msr_scene *scene, msr_plan **plan,
                          msr_error *err) {
  const bool chooses = s->accuracy > 0;
  msr_accuracy_choice choice = {.options = options_of(s)};
  msr_status status = chooses ? study_choose(s, scene, &choice, err) : MSR_OK;
  choice.options.threads = (unsigned)s->threads;
  choice.options.timed = s->verbose;
  if (status == MSR_OK) status = msr_plan_create(scene, &choice.options, plan, err);
  if (status != MSR_OK) return status;
  if (chooses) study_tell_choice(s, &choice);
  if (!chooses || !was_tried(&choice, *plan)) tell_notes(s, *plan);
  return MSR_OK;
}

msr_status simulation_plan(const settings *s, msr_plan **plan, msr_error *err) {
  msr_scene *scene = NULL;
  msr_status status = simulation_scene(s, &scene, err);
  if (status != MSR_OK) return status;
  status = compile(s, scene, plan, err);
  msr_scene_free(scene);
  return status;
}

bool simulation_contacts(const msr_plan *plan) {
  size_t n;
  const msr_effect *const effect = msr_plan_effects(plan, &n);
  for (size_t i = 0; i < n && effect[i].on; i++) {
    if (effect[i].role == MSR_ROLE_CONTACT && strcmp(effect[i].name, "collisions") != 0)
      return true;
  }
  return false;
}
