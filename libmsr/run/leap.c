/* leap.c - long implicit steps in place of many substeps, where they cost less.
 *
 * A leg, an iteration or a part of it, is first tried as one step of the energy-momentum method,
 * which keeps the energy through elastic impacts at any length. What fails is tried again at half
 * its length; substeps do what is left. Costs are counted, in evaluations of the acceleration,
 * never timed: tries may spend a quarter of what the substeps of the leg would cost, and what leaps
 * have saved of that so far. So a leg costs at most 1.25 times as much as its substeps.
 *
 * Nothing is remembered from one leg to the next, so that a run that is cut or saved has the same
 * bits. */
#include "run/leap.h"

#include "forces/mesh.h"
#include "run/guard.h"

#include <math.h>
#include <string.h>

enum { CAREFUL = 4, MOST_HALVES = 10 }; /* substeps of a step with care, at most; see try_halves */

/* A leap under way is a number of substeps. */
typedef struct course {
  msr_state *state;
  const msr_system *system;
  const msri_leaping *plan;
  uint64_t length;
  double credit; /* evaluations that may be spent */
} course;

/* From the state to where it is kept, and back. */
static void keep(const msr_state *state, double *kept) {
  const size_t n = 2 * state->plan->figures.masses;
  memcpy(kept, state->q, n * sizeof *kept);
  memcpy(kept + n, state->v, n * sizeof *kept);
}

static void restore(msr_state *state, const double *kept) {
  const size_t n = 2 * state->plan->figures.masses;
  memcpy(state->q, kept, n * sizeof *kept);
  memcpy(state->v, kept + n, n * sizeof *kept);
}

static msr_interval interval_of(const course *c) {
  const msr_plan_figures *f = &c->state->plan->figures;
  const uint64_t end = c->state->substep + c->length;
  return (msr_interval){msri_state_time(c->state), (double)c->length * f->h,
                        msri_plan_time(f, c->state->iteration, end)};
}

/* One leap, which stops nothing further than `reach` before a support. MSR_EUNSTABLE if it can't be
 * made, and the state is as before. */
static msr_status try(course *c, const msr_interval *interval, double reach) {
  msr_state *state = c->state;
  const msr_integrator *method = &msr_integrator_energy_momentum;
  double *before = state->leap.before;
  keep(state, before);
  state->effort = (msri_effort){.limited = true, .limit = c->credit, .reach = reach};
  msr_workspace work = {.vector = state->leap.vector};
  const msr_status status =
      method->step(method, c->system, interval, state->q, state->v, &work, NULL);
  c->credit -= state->effort.spent;
  state->leap.spent += state->effort.spent;
  if (status == MSR_OK) return MSR_OK;
  restore(state, before);
  if (status == MSR_EUNSTABLE) state->failed = NULL;
  return status;
}

/* With care: a step that can't be made, in halves that can; the plan's own method takes what is
 * left after so many. */
static msr_status try_halves(course *c, const msr_interval *whole, int times) {
  const double half = whole->h / 2, middle = whole->t + half;
  const msr_status status = try(c, whole, (double)INFINITY);
  if (status != MSR_EUNSTABLE) return status;
  c->state->fresh = false;
  if (times == 0) return msri_step_once(c->state, c->system, whole, NULL);
  const msr_status first = try_halves(c, &(msr_interval){whole->t, half, middle}, times - 1);
  if (first != MSR_OK) return first;
  return try_halves(c, &(msr_interval){middle, half, whole->end}, times - 1);
}

static msr_status try_any(course *c) {
  const msr_interval interval = interval_of(c);
  if (c->state->care.on && c->length == 1) return try_halves(c, &interval, MOST_HALVES);
  return try(c, &interval, c->plan->reach);
}

/* After a leap. */
static msr_status land(course *c) {
  enum { EASY = 8 };
  msr_state *state = c->state;
  state->fresh = false;
  state->substep += c->length;
  state->work.steps++;
  state->leap.leaps++;
  state->leap.leapt += c->length;
  c->credit += c->plan->substep * (double)c->length;
  const msr_status status = msri_guard_follow(state, (double)c->length * state->plan->figures.h);
  if (state->effort.evaluations <= EASY) c->length *= 2;
  return status;
}

/* Is a leap of that length worth a try? */
static bool pays(const course *c) {
  if (c->state->care.on) return c->length > 0;
  return c->credit > 0 && c->plan->substep * (double)c->length > c->plan->least;
}

/* Would springs buckle many times over, in a leg of h? Stiff ones that vibrate do: an implicit step
 * has to follow them, and costs more than all substeps (measured: leaps pay up to 4, and at 20 they
 * don't, whatever the stiffness). */
static bool vibrates(const msr_state *state, double h) {
  static const double most = 8;
  const msr_view view = msr_state_view(state);
  return !(h * h * msri_mesh_buckling(&view) < most);
}

static msr_status poll(course *c, const msri_poll *poll) {
  return poll->call ? poll->call(poll->data, c->state) : MSR_OK;
}

/* Where a leg begins, so that a run that is interrupted goes on with the same bits. */
typedef struct beginning {
  uint64_t substep, contacts;
} beginning;

static void go_back(msr_state *state, const beginning *to) {
  restore(state, state->leap.start);
  state->fresh = false;
  state->substep = to->substep;
  state->contacts = to->contacts;
}

msr_status msri_leap(msr_state *state, const msr_system *system, const msri_poll *watch) {
  const msri_leaping *plan = &state->plan->leaping;
  const uint64_t left = state->plan->figures.substeps - state->substep;
  const uint64_t most = state->care.on ? CAREFUL : plan->leg;
  const uint64_t leg = left < most ? left : most, end = state->substep + leg;
  const beginning start = {state->substep, state->contacts};
  const double credit = plan->share * plan->substep * (double)leg;
  course c = {state, system, plan, leg, state->care.on ? (double)INFINITY : credit};
  msr_status status = MSR_OK;
  if (!state->care.on && vibrates(state, (double)leg * state->plan->figures.h)) return MSR_OK;
  keep(state, state->leap.start);
  while (state->substep < end && status == MSR_OK) {
    c.length = c.length < end - state->substep ? c.length : end - state->substep;
    if (!pays(&c)) return MSR_OK;
    status = poll(&c, watch);
    if (status != MSR_OK) break;
    status = try_any(&c);
    if (status == MSR_OK) {
      status = land(&c);
    } else if (status == MSR_EUNSTABLE) {
      c.length /= 2;
      status = MSR_OK;
    }
  }
  if (status != MSR_OK) go_back(state, &start);
  return status;
}
