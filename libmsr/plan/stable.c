/* stable.c - the largest step that is stable at any stretch, and the substeps that keep below it.
 *
 * Each force bounds its frequencies and rates of damping; with the integrator's limits on the
 * imaginary axis, S, and on the real one, D, a step is stable while h omega / S + h gamma / D < 1
 * (the segment between the two limits lies inside the stability region). */
#include "plan/plan.h"

#include <math.h>

const double msri_midpoint_limit = 2;

/* The integrator's limit of h gamma for a force. */
static double damping_limit(const msr_integrator *integrator, const msr_force *force) {
  const double limit = integrator->damping_stability;
  return integrator->splits && !force->flow ? msri_min(limit, msri_midpoint_limit) : limit;
}

/* `damping`: sum of gamma over its limit. */
static msr_status bound_rates(msr_plan *plan, const msr_view *start, double *damping,
                              msr_error *err) {
  double omega2 = 0;
  for (size_t i = 0; i < plan->n_terms; i++) {
    const msri_term *term = &plan->term[i];
    double of_x = 0, of_v = 0;
    if (!term->force->rates) continue;
    const msr_status status = term->force->rates(term->self, start, &of_x, &of_v);
    if (status != MSR_OK)
      return msri_fail(err, status, "%s: no bound for the stable step: %s", term->force->name,
                       msr_status_text(status));
    if (isinf(of_x) || isinf(of_v))
      return msri_fail(
          err, MSR_EINPUT,
          "%s: stiffness or damping over mass is beyond the range of numbers, 1.8e308; "
          "lower it, or raise MASSE",
          term->force->name);
    if (!(of_x >= 0 && of_v >= 0))
      return msri_fail(err, MSR_EUSAGE,
                       "force %s: rates must be numbers of 0 or more, not %g and %g",
                       term->force->name, of_x, of_v);
    const double limit = damping_limit(plan->figures.integrator, term->force);
    omega2 += of_x;
    plan->figures.gamma += isinf(limit) ? 0 : of_v;
    *damping += of_v > 0 ? of_v / limit : 0;
  }
  plan->figures.omega = sqrt(omega2);
  return MSR_OK;
}

static double stable_step(const msr_plan_figures *f, double damping) {
  return 1 / ((f->omega > 0 ? f->omega / f->integrator->stability : 0) + damping);
}

/* Verlet's limit. */
static const double resolved = 2;

/* Where any step of an implicit method is stable, two things still call for steps that follow every
 * spring: supports, which stop a mass while its neighbours go on for the rest of the step, and
 * methods that keep phase-space area, whose energy grows when long steps meet springs that turn and
 * buckle. */
static double safe_step(const msr_plan *plan) {
  const msr_plan_figures *f = &plan->figures;
  const bool follows = msri_plan_meets(plan) || f->integrator->symplectic;
  const bool any = f->integrator->implicit && isinf(f->stable_step) && f->omega > 0;
  return plan->safe_share * (any && follows ? resolved / f->omega : f->stable_step);
}

double msri_plan_verlet_step(const msr_plan *plan) {
  const double omega = plan->figures.omega;
  return omega > 0 ? plan->safe_share * resolved / omega : plan->figures.dt;
}

/* The fewest equal steps of dt that are safe. */
static double fewest(const msr_plan_figures *f) {
  const double rounding = 1e-12;
  return msri_max(1, ceil(f->dt / f->safe_step * (1 - rounding)));
}

static msr_status explain_no_step(msr_plan *plan, msr_error *err) {
  const msr_plan_figures *f = &plan->figures;
  return msri_notes_add(
      &plan->notes, err, "%s declares no stable step for %s: expect it to explode; use verlet",
      f->integrator->name, f->omega > 0 && f->integrator->stability == 0 ? "springs" : "damping");
}

/* Says what the user didn't ask for: substeps, or a step that can't be trusted. */
static msr_status explain(msr_plan *plan, bool automatic, msr_error *err) {
  const msr_plan_figures *f = &plan->figures;
  if (f->stable_step == 0) return explain_no_step(plan, err);
  if (automatic && f->substeps > 1 && isinf(f->stable_step))
    return msri_notes_add(
        &plan->notes, err,
        "%llu substeps of %.4g s per iteration: safe where supports are hit or springs buckle; "
        "%s is stable for any step elsewhere: ask for fewer substeps, even 1, and look at energies",
        (unsigned long long)f->substeps, f->h, f->integrator->name);
  if (automatic && f->substeps > 1)
    return msri_notes_add(&plan->notes, err,
                          "%llu substeps of %.4g s per iteration: steps up to %.4g s are safe here "
                          "(the largest that is stable at any stretch is %.4g s)",
                          (unsigned long long)f->substeps, f->h, f->safe_step, f->stable_step);
  if (f->h <= f->safe_step) return MSR_OK;
  return msri_notes_add(&plan->notes, err,
                        "steps of %.4g s are above %.4g s, the largest that is %s: the run may %s; "
                        "%.10g substeps would be safe",
                        f->h, f->h > f->stable_step ? f->stable_step : f->safe_step,
                        f->h > f->stable_step ? "stable at any stretch" : "safe here",
                        f->h > f->stable_step ? "explode" : "heat up and then explode", fewest(f));
}

/* Forces are multiplied by 1 / m. */
static msr_status check_masses(const msr_view *s, msr_error *err) {
  for (size_t i = 0; i < msri_masses_that_differ(s); i++)
    if (isinf(1 / msr_view_mass(s, i)))
      return msri_fail(err, MSR_EINPUT, "a mass of %g kg is too small to divide by; raise MASSE",
                       msr_view_mass(s, i));
  return MSR_OK;
}

msr_status msri_plan_choose_step(msr_plan *plan, const msr_view *start, uint64_t substeps,
                                 msr_error *err) {
  msr_plan_figures *f = &plan->figures;
  double damping = 0;
  msr_status status = check_masses(start, err);
  if (status == MSR_OK) status = bound_rates(plan, start, &damping, err);
  if (status != MSR_OK) return status;
  f->stable_step = stable_step(f, damping);
  plan->safe_share = msri_plan_safe_share(plan, start);
  f->safe_step = safe_step(plan);
  const double needed = f->stable_step > 0 ? fewest(f) : 1;
  const bool any = isinf(f->stable_step);
  const double largest = any ? f->safe_step : f->stable_step;
  if (substeps == 0 && needed > MSRI_MOST_SUBSTEPS)
    return msri_fail(err, MSR_EINPUT,
                     "DT %g s is %g times the largest %s step, %g s; lower DT or TENSION_RESSORT, "
                     "or raise MASSE",
                     f->dt, f->dt / largest, any ? "safe" : "stable", largest);
  f->substeps = substeps > 0 ? substeps : (uint64_t)needed;
  f->h = f->dt / (double)f->substeps;
  return explain(plan, substeps == 0, err);
}
