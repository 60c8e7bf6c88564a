/* impacts.c - steps that end at an impact, so that a method keeps its order through it.
 *
 * A step is tried as if nothing were in the way. If a mass would meet something, the state goes
 * back and the step is shortened until the first of them is just inside its edge (Newton's method
 * on the method's own steps, kept in a bracket); those that are, several at a time on a flat floor,
 * are put on it and reflected, and the rest of the step follows. Where masses rest, or many meet
 * something one after the other, no method shows its order: there the contact's own rule serves. */
#include "run/impacts.h"

#include "run/step.h"

#include <float.h>
#include <math.h>

enum { MOST_IMPACTS = 4, FEW_STEPS = 4, MOST_TRIES = 20 };

/* What is left of a step. */
typedef struct leg {
  msr_state *state;
  const msr_system *system;
  double t, h, end;
} leg;

msr_status msri_bounce(msr_state *state, double h) {
  const double *q0 = state->before, *v0 = q0 + 2 * state->plan->figures.masses;
  bool met = false;
  const msr_status status = msri_state_bounce(state, h, q0, v0, state->q, state->v, &met);
  if (met) state->fresh = false;
  return status;
}

static msr_status go(const leg *l, double h, msr_error *err) {
  const msr_interval interval = {l->t, h, h == l->h ? l->end : l->t + h};
  return msri_step_once(l->state, l->system, &interval, err);
}

static msr_status go_again(const leg *l, double h, msr_error *err) {
  msri_state_put_back(l->state, l->state->before);
  return go(l, h, err);
}

/* Inside by no more than this, a mass is at the edge: rounding of q. */
static double margin(const msri_meeting *m) { return 64 * DBL_EPSILON * (1 + fabs(m->edge)); }

/* Does a mass rest on its support, or come back to it within a few steps, or are there too many
 * impacts to follow one by one? */
static bool is_crowd(const leg *l, const msri_meeting *m) {
  const double h = l->state->plan->figures.h, moment = 1e-9 * h;
  return m->lasts < FEW_STEPS * h || (m->masses > MOST_IMPACTS && m->last - m->first > moment);
}

/* When the mass that is met first will be half the margin inside, seen from where it is at s. */
static double aim(const leg *l, const msri_meeting *m, double s) {
  const size_t k = m->coordinate;
  const double depth = m->side * (l->state->q[k] - m->edge), speed = m->side * l->state->v[k];
  return s - (depth - margin(m) / 2) / speed;
}

/* Shortens the step to s, at the first impact; s = 0 if that isn't found. */
static msr_status shorten(const leg *l, msri_meeting *m, double *s, msr_error *err) {
  double low = 0, high = l->h, next = m->first;
  for (int tries = 0; tries < MOST_TRIES; tries++) {
    *s = next > low && next < high ? next : low + (high - low) / 2;
    const msr_status status = go_again(l, *s, err);
    if (status != MSR_OK) return status;
    msri_meeting now;
    msri_state_meet(l->state, *s, &now);
    if (now.masses > 0) *m = now;
    if (now.masses > 0 && now.depth <= margin(m)) return MSR_OK;
    *(now.masses > 0 ? &high : &low) = *s;
    next = aim(l, m, *s);
  }
  *s = 0;
  return MSR_OK;
}

msr_status msri_step_by_impacts(msr_state *state, const msr_system *system,
                                const msr_interval *interval, msr_error *err) {
  leg l = {state, system, interval->t, interval->h, interval->end};
  for (int impacts = 0;; impacts++) {
    msri_meeting m;
    double s = 0;
    msri_state_keep(state, state->before);
    msr_status status = go(&l, l.h, err);
    if (status != MSR_OK) return status;
    msri_state_meet(state, l.h, &m);
    if (m.masses == 0) return MSR_OK;
    if (impacts == MOST_IMPACTS || is_crowd(&l, &m)) return msri_bounce(state, l.h);
    status = shorten(&l, &m, &s, err);
    if (status == MSR_OK && s == 0) status = go_again(&l, l.h, err);
    if (status != MSR_OK) return status;
    if (s == 0) return msri_bounce(state, l.h);
    msri_state_strike(state);
    state->fresh = false;
    l.t += s, l.h -= s;
  }
}
