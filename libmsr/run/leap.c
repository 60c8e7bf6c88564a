/* leap.c - long implicit steps in place of many substeps, where they cost less.
 *
 * A stretch, an iteration or a part of it, is first tried as one step of the energy-momentum
 * method, which keeps the energy through elastic impacts at any length. What fails is tried again
 * at half its length; substeps do what is left. Costs are counted, in evaluations of the
 * acceleration, never timed: tries may spend a quarter of what the substeps of the stretch would
 * cost, and what leaps have saved of that so far. So a stretch costs at most 1.25 times as much as
 * its substeps.
 *
 * With care (see care.c) a stretch is a few substeps, and takes what it costs.
 *
 * Nothing is remembered from one stretch to the next, so that a run that is cut or saved has the
 * same bits. */
#include "run/leap.h"

#include "forces/mesh.h"
#include "run/guard.h"

#include <math.h>

enum { CAREFUL = 4, MOST_HALVES = 7 }; /* substeps of a step with care, at most; see take_halves */

/* A leap under way is a number of substeps. */
typedef struct course {
  msr_state *state;
  const msr_system *system;
  const msri_leaping *plan;
  uint64_t length;
  double credit; /* evaluations that may be spent */
} course;

static msr_interval interval_of(const course *c) {
  const msr_plan_figures *f = &c->state->plan->figures;
  const uint64_t end = c->state->substep + c->length;
  return (msr_interval){msri_state_time(c->state), (double)c->length * f->h,
                        msri_plan_time(f, c->state->iteration, end)};
}

/* One leap, which stops nothing further than `reach` before a support. If it can't be made, `made`
 * is false and the state as before. What a force returns. */
static msr_status try(course *c, const msr_interval *interval, double reach, bool *made) {
  msr_state *state = c->state;
  const msr_integrator *method = &msr_integrator_energy_momentum;
  const msri_rows *row = &state->plan->row;
  const size_t was = msri_meter_enter(&state->meter, state->care.on ? row->care : row->leaps);
  msri_state_keep(state, state->leap.before);
  state->effort = (msri_effort){.limited = true, .limit = c->credit, .reach = reach};
  msr_workspace work = {.vector = state->leap.vector};
  const msr_status status =
      method->step(method, c->system, interval, state->q, state->v, &work, NULL);
  c->credit -= state->effort.spent;
  state->leap.spent += state->effort.spent;
  state->fresh = false;
  msri_state_disarm(state);
  *made = status == MSR_OK;
  if (!*made) msri_state_put_back(state, state->leap.before);
  msri_meter_turn(&state->meter, was);
  return status == MSR_EUNSTABLE && !state->failed ? MSR_OK : status;
}

/* A step that can't be made, in halves that can; the plan's own method takes what is left after so
 * many. */
// NOLINTNEXTLINE(misc-no-recursion): MOST_HALVES deep
static msr_status take_halves(course *c, const msr_interval *whole, int times) {
  const double half = whole->h / 2, middle = whole->t + half;
  bool made;
  msr_status status = try(c, whole, (double)INFINITY, &made);
  if (status != MSR_OK || made) return status;
  if (times == 0) return msri_step_once(c->state, c->system, whole, NULL);
  status = take_halves(c, &(msr_interval){whole->t, half, middle}, times - 1);
  if (status != MSR_OK) return status;
  return take_halves(c, &(msr_interval){middle, half, whole->end}, times - 1);
}

/* With care the last try is one that can be made. */
static msr_status try_any(course *c, bool *made) {
  const msr_interval interval = interval_of(c);
  if (!c->state->care.on || c->length > 1) return try(c, &interval, msri_leap_reach, made);
  *made = true;
  return take_halves(c, &interval, MOST_HALVES);
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
  return c->credit > 0 && c->plan->substep * (double)c->length > msri_leap_least;
}

/* Would springs buckle many times over, in a stretch of h? Stiff ones that vibrate do: an implicit
 * step has to follow them, and costs more than all substeps (measured: leaps pay up to 4, and at 20
 * they don't, whatever the stiffness). */
static bool vibrates(msr_state *state, double h) {
  static const double most = 8;
  const size_t was = msri_meter_turn(&state->meter, state->plan->row.leaps);
  const msr_view view = msr_state_view(state);
  const double buckling = msri_mesh_buckling(&view);
  msri_meter_turn(&state->meter, was);
  return !(h * h * buckling < most);
}

msr_status msri_leap(msr_state *state, const msr_system *system, const msri_poll *poll) {
  const msri_leaping *plan = &state->plan->leaping;
  const uint64_t left = state->plan->figures.substeps - state->substep;
  const uint64_t most = state->care.on ? CAREFUL : plan->stretch;
  const uint64_t stretch = left < most ? left : most, end = state->substep + stretch;
  const double credit = msri_leap_share * plan->substep * (double)stretch;
  course c = {state, system, plan, stretch, state->care.on ? (double)INFINITY : credit};
  if (!state->care.on && vibrates(state, (double)stretch * state->plan->figures.h)) return MSR_OK;
  msr_status status = msri_poll_call(poll, state);
  while (state->substep < end && status == MSR_OK) {
    bool made;
    c.length = c.length < end - state->substep ? c.length : end - state->substep;
    if (!pays(&c)) return MSR_OK;
    status = try_any(&c, &made);
    if (status == MSR_OK && made) status = land(&c);
    if (!made) c.length /= 2;
  }
  return status;
}
