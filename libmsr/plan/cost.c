/* cost.c - what each effect takes in a step, counted from its loops: operations on doubles, and
 * bytes of arrays that are read and written. Forces tell their own; springs, contacts, steps and
 * what watches over them are the library's. */
#include "integrators/splitting.h"
#include "plan/plan.h"
#include "sweep/sweep.h"

#include <math.h>

/* dx, dy 2, length 4, force over length 3, its parts 2, at both ends 4; x, y are read, and fx, fy
 * read and written. */
static const msr_load springs = {.spring = 15, .mass_bytes = 48};

/* Both coordinates: q + h u 4, compared with the pixel 4, by those that stay in theirs; but where
 * they are known to be far from all that they could meet. */
static const msr_load drift = {.mass = 8, .mass_bytes = 48};
static const msr_load free_drift = {.mass = 4, .mass_bytes = 48};

/* Beside each evaluation: a made 0, divided by m, v += h a, q += h v of both coordinates. */
static const msr_load stage = {.mass = 10, .mass_bytes = 144};

/* In a sweep all is one loop (forces/lattice_kernel.inc), once for each evaluation. Arrays are
 * those that it goes over, in cache: of them x, y, vx, vy come from memory and go back there, 64
 * bytes, once in a pass of up to 32 stages. Springs as above; x, y are read, forces to the cells
 * below are left for these, and read there, 32, and so is the stiffness, to each of the neighbours
 * below and to the right 8. */
static msr_load swept_springs(const msr_plan *plan) {
  const double ways = plan->neighbours / 2.0;
  return (msr_load){.spring = 15, .mass_bytes = 16 + 32 * (ways - 1) + 8 * ways};
}

/* A weight is added to both coordinates; a flow v = keep v + push takes 4 unless it tells, where v
 * is at hand, but for drifts without forces, before which v is read and written. */
static const msr_load swept_weight = {.mass = 2};
static const msr_load swept_flow = {.mass = 4}, swept_coast = {.mass_bytes = 32};

/* f / m 2, two kicks 8, a drift 4: x, y, vx, vy are read and written. Where supports see to the
 * drift a is written for them. */
static const msr_load swept_stage = {.mass = 14, .mass_bytes = 64};
static const msr_load swept_kicks = {.mass = 10, .mass_bytes = 48};

/* Speeds: sum of v^2; compared as they come in a sweep. Energies: those, of springs and of what
 * falls. */
static const msr_load glance = {.mass = 4, .mass_bytes = 16};
static const msr_load look = {.mass = 8, .spring = 9, .mass_bytes = 48};

/* The same, and q, v kept. */
static const msr_load look_and_keep = {.mass = 8, .spring = 9, .mass_bytes = 112};

static const msr_load unknown = {.call = (double)NAN, .call_bytes = (double)NAN};

/* Adds so many calls, shared among the masses. */
static void add(const msr_plan *plan, double calls, const msr_load *load, msr_cost *cost) {
  const msr_springs *s = &plan->mesh.springs;
  const double masses = (double)plan->figures.masses, each = calls / masses;
  const double n = (double)s->n + (double)s->n_anchors;
  cost->calls += calls;
  cost->operations += each * (load->call + load->mass * masses + load->spring * n);
  cost->bytes += each * (load->call_bytes + load->mass_bytes * masses + load->spring_bytes * n);
}

/* Evaluations of the acceleration in a step; NAN: as many as it takes. */
static double evaluations(const msr_plan *plan) {
  const msr_integrator *i = plan->figures.integrator;
  if (msri_plan_sweeps(plan)) return msri_course_evaluations(plan);
  return i->evaluations > 0 && !i->implicit && !i->adaptive ? i->evaluations : (double)NAN;
}

static bool told(const msr_load *l) {
  return l->call + l->mass + l->spring + l->call_bytes + l->mass_bytes + l->spring_bytes > 0;
}

static double coasts(const msr_plan *plan) {
  return msri_splitting_drifts(plan->figures.integrator) - evaluations(plan);
}

static msr_cost cost_of_swept_air(const msr_plan *plan, const msr_force *force) {
  const double calls = msri_force_calls(force, plan->figures.integrator, evaluations(plan));
  const msr_load own = {.mass = force->flow_load.mass};
  msr_cost cost = {0};
  add(plan, calls, told(&force->flow_load) ? &own : &swept_flow, &cost);
  add(plan, coasts(plan), &swept_coast, &cost);
  cost.calls = calls;
  return cost;
}

static msr_cost cost_of_swept_force(const msr_plan *plan, const msr_force *force) {
  const msr_load springs_load = swept_springs(plan);
  msr_cost cost = {0};
  if (force->relax) return cost_of_swept_air(plan, force);
  add(plan, evaluations(plan), force->uniform ? &swept_weight : &springs_load, &cost);
  return cost;
}

static msr_cost cost_of_force(const msr_plan *plan, const msr_force *force) {
  const msr_integrator *i = plan->figures.integrator;
  const bool splits = i->splits && force->uses_velocity;
  const msr_load *own = splits && force->flow ? &force->flow_load : &force->add_load;
  const msr_load *load = force == &msr_force_springs ? &springs : told(own) ? own : &unknown;
  msr_cost cost = {.at_least = splits && !force->flow};
  add(plan, msri_force_calls(force, i, evaluations(plan)), load, &cost);
  return cost;
}

/* A drift without forces before it is by itself. */
static void add_swept_steps(const msr_plan *plan, msr_cost *cost) {
  const bool meets = msri_plan_meets(plan);
  add(plan, evaluations(plan), meets ? &swept_kicks : &swept_stage, cost);
  if (!meets) add(plan, coasts(plan), &free_drift, cost);
}

/* One drift, or one look back, a step; of what is met only the least is known. */
static msr_cost cost_of_contact(const msr_plan *plan, const msr_effect *effect) {
  static const msr_load nothing = {0};
  const bool collisions = plan->discs && effect == &plan->effect[plan->row.contact];
  const bool first = effect == &plan->effect[plan->n_terms];
  msr_cost cost = {.at_least = true};
  add(plan, isnan(evaluations(plan)) ? (double)NAN : 1,
      collisions ? &unknown
      : first    ? msri_plan_arms(plan) ? &free_drift : &drift
                 : &nothing,
      &cost);
  return cost;
}

static msr_cost cost_of_step(const msr_plan *plan, size_t e) {
  const msr_plan_figures *f = &plan->figures;
  const double looks = 1 / ((double)msri_care_period(f) * (double)f->substeps);
  msr_cost cost = {0};
  if (e == plan->row.leaps) add(plan, (double)NAN, &unknown, &cost);
  if (e == plan->row.integrator) {
    if (msri_plan_sweeps(plan))
      add_swept_steps(plan, &cost);
    else
      add(plan, evaluations(plan), &stage, &cost);
    cost.calls = f->integrator->adaptive ? (double)NAN : 1;
    cost.at_least = !f->integrator->splits;
  }
  if (e == plan->row.guard) {
    if (!msri_plan_sweeps(plan)) add(plan, 1.0 / MSRI_GLANCE, &glance, &cost);
    add(plan, 1.0 / MSRI_LOOK, &look, &cost);
    if (plan->driven) add(plan, 1, plan->followed ? &unknown : &(msr_load){0}, &cost);
  }
  if (e == plan->row.care) {
    add(plan, looks, &look_and_keep, &cost);
    cost.at_least = true;
  }
  return cost;
}

void msri_plan_count_costs(msr_plan *plan) {
  const bool sweeps = msri_plan_sweeps(plan);
  for (size_t e = 0; e < plan->n_effects && plan->effect[e].on; e++) {
    msr_effect *effect = &plan->effect[e];
    if (effect->role == MSR_ROLE_FORCE)
      effect->cost =
          sweeps ? cost_of_swept_force(plan, effect->force) : cost_of_force(plan, effect->force);
    if (effect->role == MSR_ROLE_CONTACT) effect->cost = cost_of_contact(plan, effect);
    if (effect->role == MSR_ROLE_STEP) effect->cost = cost_of_step(plan, e);
  }
}
