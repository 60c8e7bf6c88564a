/* stable.c - the largest step that is stable in any state, and the substeps that keep below it.
 *
 * Each force bounds its frequencies and rates of damping; with the integrator's limits on the
 * imaginary axis, S, and on the real one, D, a step is stable while h omega / S + h gamma / D < 1
 * (the segment between the two limits lies inside the stability region). */
#include "plan/plan.h"

#include <math.h>

/* Stability limit of the explicit midpoint rule, which stands in for a flow that isn't given. */
static const double midpoint_limit = 2;

static const double most_substeps = 1e9;

static msr_status bound_rates(msr_plan *plan, const msr_view *start, msr_error *err) {
  double omega2 = 0;
  for (size_t i = 0; i < plan->n_terms; i++) {
    const msri_term *term = &plan->term[i];
    double of_x = 0, of_v = 0;
    if (!term->force->rates) continue;
    const msr_status status = term->force->rates(term->self, start, &of_x, &of_v);
    if (status != MSR_OK)
      return msri_fail(err, status, "%s: no bound for the stable step: %s", term->force->name,
                       msr_status_text(status));
    const bool exact = plan->figures.integrator->splits && term->force->flow;
    omega2 += of_x;
    plan->figures.gamma += exact ? 0 : of_v;
  }
  plan->figures.omega = sqrt(omega2);
  return MSR_OK;
}

static double stable_step(const msr_plan_figures *f) {
  const double damping = f->integrator->splits ? midpoint_limit : f->integrator->damping_stability;
  const double share = (f->omega > 0 ? f->omega / f->integrator->stability : 0) +
                       (f->gamma > 0 ? f->gamma / damping : 0);
  return 1 / share;
}

double msri_plan_safe_step(const msr_plan *plan) {
  return (plan->contact.move ? 0.5 : 0.9) * plan->figures.stable_step;
}

/* The fewest equal steps of dt that are safe. */
static double fewest(const msr_plan *plan) {
  const double rounding = 1e-12;
  return msri_max(1, ceil(plan->figures.dt / msri_plan_safe_step(plan) * (1 - rounding)));
}

static msr_status explain(msr_plan *plan, int64_t asked, double needed, msr_error *err) {
  const msr_plan_figures *f = &plan->figures;
  if (f->h <= f->stable_step && asked != 0) return MSR_OK;
  if (f->stable_step == 0)
    return msri_notes_add(&plan->notes, err,
                          "%s has no stable step on this scene: expect it to explode; use verlet",
                          f->integrator->name);
  if (asked == 0)
    return f->substeps == 1
               ? MSR_OK
               : msri_notes_add(&plan->notes, err,
                                "the largest step that is stable in any state is %g s: each "
                                "iteration of %g s is made of %.0f substeps",
                                f->stable_step, f->dt, needed);
  return msri_notes_add(&plan->notes, err,
                        "steps of %g s are above the largest that is stable in any state, %g s: "
                        "the run may explode; %.0f substeps would be stable",
                        f->h, f->stable_step, needed);
}

msr_status msri_plan_choose_step(msr_plan *plan, const msr_view *start, int64_t substeps,
                                 msr_error *err) {
  msr_plan_figures *f = &plan->figures;
  f->dt = plan->conf.dt;
  f->iterations = plan->conf.iterations;
  f->images = plan->conf.images;
  if (substeps < MSR_SUBSTEPS_OFF)
    return msri_fail(err, MSR_EUSAGE, "substeps must be 1 or more, 0 for as many as needed");
  const msr_status status = bound_rates(plan, start, err);
  if (status != MSR_OK) return status;
  f->stable_step = stable_step(f);
  const bool never = f->integrator->stability == 0 && f->omega > 0;
  const double needed = never ? 1 : fewest(plan);
  if (substeps == 0 && needed > most_substeps)
    return msri_fail(err, MSR_EINPUT,
                     "DT %g s is %g times the largest stable step, %g s; lower DT or "
                     "TENSION_RESSORT, or raise MASSE",
                     f->dt, f->dt / f->stable_step, f->stable_step);
  f->substeps = substeps > 0 ? (uint64_t)substeps : substeps == 0 ? (uint64_t)needed : 1;
  f->h = f->dt / (double)f->substeps;
  return explain(plan, substeps, needed, err);
}
