/* cost.c - what each effect takes in a step, counted from its loops: operations on doubles, and
 * bytes of arrays that are read and written. Forces tell their own; springs, contacts, steps and
 * what watches over them are the library's. */
#include "plan/plan.h"

#include <math.h>

/* dx, dy 2, length 4, force over length 3, its parts 2, at both ends 4; x, y are read, and fx, fy
 * read and written. */
static const msr_load springs = {.spring = 15, .mass_bytes = 48};

/* Both coordinates: q + h u 4, compared with the pixel 4, by those that stay in theirs. */
static const msr_load drift = {.mass = 8, .mass_bytes = 48};

/* Beside each evaluation: a made 0, divided by m, v += h a, q += h v of both coordinates. */
static const msr_load stage = {.mass = 10, .mass_bytes = 144};

/* Speeds: sum of v^2. Energies: those, of springs and of what falls. */
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
  return i->evaluations > 0 && !i->implicit && !i->adaptive ? i->evaluations : (double)NAN;
}

static bool told(const msr_load *l) {
  return l->call + l->mass + l->spring + l->call_bytes + l->mass_bytes + l->spring_bytes > 0;
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

/* One drift, or one look back, a step; of what is met only the least is known. */
static msr_cost cost_of_contact(const msr_plan *plan, const msr_effect *effect) {
  static const msr_load nothing = {0};
  const bool collisions = plan->discs && effect == &plan->effect[plan->row.contact];
  const bool first = effect == &plan->effect[plan->n_terms];
  msr_cost cost = {.at_least = true};
  add(plan, isnan(evaluations(plan)) ? (double)NAN : 1,
      collisions ? &unknown
      : first    ? &drift
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
    add(plan, evaluations(plan), &stage, &cost);
    cost.calls = f->integrator->adaptive ? (double)NAN : 1;
    cost.at_least = !f->integrator->splits;
  }
  if (e == plan->row.guard) {
    add(plan, 1.0 / MSRI_GLANCE, &glance, &cost);
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
  for (size_t e = 0; e < plan->n_effects && plan->effect[e].on; e++) {
    msr_effect *effect = &plan->effect[e];
    if (effect->role == MSR_ROLE_FORCE) effect->cost = cost_of_force(plan, effect->force);
    if (effect->role == MSR_ROLE_CONTACT) effect->cost = cost_of_contact(plan, effect);
    if (effect->role == MSR_ROLE_STEP) effect->cost = cost_of_step(plan, e);
  }
}
