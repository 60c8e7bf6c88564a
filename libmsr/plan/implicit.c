/* implicit.c - what implicit methods ask of a scene: the mean force between two places, and solving
 * with the matrix of the springs. */
#include "plan/state.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Measured (x86-64, lattices of 100^2 and 316^2 masses, 4 neighbours), in evaluations of the
 * acceleration: the mean force between two places, the matrix and its factors, an iteration of
 * conjugate gradients. */
static const double cost_between = 2, cost_linearise = 8, cost_iteration = 8;

/* More evaluations than a step takes that is going to succeed. */
enum { MOST_EVALUATIONS = 30 };

/* MSR_EUNSTABLE if that is more than may be spent. */
static msr_status spend(msr_state *state, double cost) {
  msri_effort *e = &state->effort;
  e->spent += cost;
  return e->limited && e->spent > e->limit ? MSR_EUNSTABLE : MSR_OK;
}

static bool steady(const msr_force *force) { return !force->uses_velocity; }

static msr_status call(msr_state *state, const msri_term *term, const msr_view *from,
                       const msr_view *to, double *f) {
  const size_t n = from->n;
  char *scratch = state->scratch + term->scratch;
  return to ? term->force->between(term->self, scratch, from, to, f, f + n)
            : term->force->add(term->self, scratch, from, f, f + n);
}

/* Adds the force in the middle, corrected along the way so that its work is what the potential
 * loses (Gonzalez 1996, eq. 2.8), if that is more than the rounding of the potential. */
static msr_status add_middle(msr_state *state, const msri_term *term, const msr_view *from,
                             const msr_view *to, double *f) {
  const size_t n = 2 * from->n;
  double *q = state->between, *g = q + n;
  const double *q0 = from->x, *q1 = to->x;
  for (size_t i = 0; i < n; i++) q[i] = q0[i] + (q1[i] - q0[i]) / 2;
  memset(g, 0, n * sizeof *g);
  const msr_view middle = msri_plan_view(state->plan, from->t, q, NULL);
  const msr_status status = call(state, term, &middle, NULL, g);
  if (status != MSR_OK) return status;
  double work = 0, way = 0, share = 0;
  if (term->force->conservative) {
    for (size_t i = 0; i < n; i++) {
      const double d = q1[i] - q0[i];
      work += g[i] * d;
      way += d * d;
    }
    const double u0 = term->force->energy(term->self, from);
    const double u1 = term->force->energy(term->self, to);
    const double missing = u0 - u1 - work;
    if (fabs(missing) > 8 * DBL_EPSILON * (fabs(u0) + fabs(u1))) share = missing / way;
  }
  for (size_t i = 0; i < n; i++) f[i] += g[i] + share * (q1[i] - q0[i]);
  return MSR_OK;
}

static msr_status between(void *self, double t, const double *q0, const double *q1, double *a) {
  msr_state *state = self;
  const msr_plan *plan = state->plan;
  const msr_view from = msri_plan_view(plan, t, q0, NULL), to = msri_plan_view(plan, t, q1, NULL);
  memset(a, 0, 2 * from.n * sizeof *a);
  state->evaluations++;
  state->effort.evaluations++;
  if (state->effort.limited && state->effort.evaluations > MOST_EVALUATIONS) return MSR_EUNSTABLE;
  if (spend(state, cost_between) != MSR_OK) return MSR_EUNSTABLE;
  for (size_t i = 0; i < plan->n_terms; i++) {
    const msri_term *term = &plan->term[i];
    if (!steady(term->force)) continue;
    const size_t was = msri_meter_enter(&state->meter, i);
    const msr_status status = term->force->between ? call(state, term, &from, &to, a)
                                                   : add_middle(state, term, &from, &to, a);
    msri_meter_turn(&state->meter, was);
    if (status == MSR_OK) continue;
    state->failed = term->force;
    return status;
  }
  msri_state_divide_by_mass(&from, a);
  return MSR_OK;
}

static msr_status linearise(void *self, double t, const double *q0, const double *from,
                            const double *q, double c, const bool *held) {
  msr_state *state = self;
  (void)t;
  msri_stiffness_linearise(&state->stiffness, q0, from, q, c, held);
  return spend(state, cost_linearise);
}

static msr_status solve(void *self, const double *r, double tolerance, double *x) {
  msr_state *state = self;
  msri_stiffness *a = &state->stiffness;
  const msri_effort *e = &state->effort;
  const uint64_t before = a->iterations;
  const double left = (e->limit - e->spent) / cost_iteration;
  a->most = e->limited && left < MSRI_MOST_ITERATIONS ? (int)left : MSRI_MOST_ITERATIONS;
  const msr_status status = msri_stiffness_solve(a, r, tolerance, x);
  const msr_status spent = spend(state, cost_iteration * (double)(a->iterations - before));
  return status == MSR_OK ? spent : status;
}

void msri_state_solve_implicitly(msr_system *system) {
  const msr_state *state = system->self;
  system->between = between;
  system->linearise = linearise;
  system->solve = solve;
  if (!state->plan->contact.hold) return;
  system->hold = msri_state_hold;
  system->rebound = msri_state_rebound;
}
