/* leaping.c - should a plan leap? Only where an iteration takes so many substeps that an implicit
 * step may cost less: see run/leap.c. */
#include "plan/plan.h"

#include <math.h>

/* Measured (x86-64, lattices of 20^2, 100^2 and 316^2 masses, 4 neighbours; with supports, the
 * assignment's scene): cost of a substep of Verlet, in evaluations of the acceleration. */
static const double free_substep = 1.2, supported_substep = 2.3;

/* Through empty space: four times the mean force and the matrix, some iterations. */
const double msri_leap_least = 100;

const double msri_leap_share = 0.25, msri_leap_reach = 1;

/* The time in which what has fallen through the picture moves by what a leap may leave out, at
 * supports; any, where there is none. */
static double time_of_stretch(const msr_plan *plan) {
  const double fallen = 2 * msri_plan_gravity(plan) * (double)plan->figures.height;
  return plan->contact.drift && fallen > 0 ? msri_leap_reach / sqrt(fallen) : (double)INFINITY;
}

/* An iteration is cut in so many stretches, at substeps. */
static uint64_t stretch_of(const msr_plan *plan) {
  const msr_plan_figures *f = &plan->figures;
  const double stretches = msri_max(1, ceil(f->dt / time_of_stretch(plan)));
  return (uint64_t)ceil((double)f->substeps / msri_min(stretches, (double)f->substeps));
}

static msr_status explain(msr_plan *plan, msr_error *err) {
  const msr_plan_figures *f = &plan->figures;
  return msri_notes_add(
      &plan->notes, err,
      "long implicit steps (%s) where they cost less than substeps of %s; tries cost at most %g "
      "%% more than these: to do without, ask for %s",
      f->leaps->name, f->integrator->name, 100 * msri_leap_share, f->integrator->name);
}

const char *msri_plan_cannot_leap(const msr_plan *plan) {
  const size_t n = plan->figures.masses, springs = plan->mesh.springs.n;
  if (springs == 0) return "there is no spring";
  if (n >= UINT32_MAX || springs >= UINT32_MAX) return "there are too many masses or springs";
  if (plan->discs) return "masses collide";
  return plan->contact.drift && !plan->contact.hold ? "impacts are located" : NULL;
}

msr_status msri_plan_choose_leaps(msr_plan *plan, msr_error *err) {
  msr_plan_figures *f = &plan->figures;
  const double substep = plan->contact.drift ? supported_substep : free_substep;
  const uint64_t stretch = stretch_of(plan);
  if (msri_plan_cannot_leap(plan)) return MSR_OK;
  if (msri_leap_share * substep * (double)stretch < msri_leap_least) return MSR_OK;
  const msr_status status = msri_graph_create(f->masses, &plan->mesh.springs, &plan->graph, err);
  if (status != MSR_OK) return status;
  plan->leaping = (msri_leaping){.substep = substep, .stretch = stretch};
  plan->middle = true;
  f->leaps = &msr_integrator_energy_momentum;
  return explain(plan, err);
}
