/* contacts.c - what is in the way, as integrators and the library's own steps see it.
 *
 * Masses that met something are owed a part of the acceleration at the end of the step (see
 * contacts/kept.c and located.c), which is evaluated at once, and kept for the integrator to find
 * when it asks for it next. */
#include "plan/state.h"

#include <math.h>
#include <string.h>

/* Contacts are the effects that are on after the terms. */
static void count(msr_state *state, uint64_t collisions) {
  const size_t first = state->plan->n_terms, n = state->plan->n_contacts;
  for (size_t e = first; e < first + n; e++) state->meter.calls[e]++;
  state->contacts += collisions;
}

static size_t enter(msr_state *state) {
  return msri_meter_turn(&state->meter, state->plan->row.contact);
}

static void leave(msr_state *state, size_t was) { msri_meter_turn(&state->meter, was); }

/* Pays what masses are owed after collisions. */
static msr_status settle(msr_state *state, const double *q, double *v) {
  const size_t n = state->plan->figures.masses;
  const double t = state->end, *a = state->ahead;
  if (state->debts.n == 0 && state->debts.status == MSR_OK) return MSR_OK;
  const msr_status status = msri_state_accelerate(state, t, q, NULL, state->ahead);
  const msr_status paid = msri_debts_pay(&state->debts, 0, a, a + n, v, v + n);
  if (status != MSR_OK || paid != MSR_OK) return status != MSR_OK ? status : paid;
  state->known = (msri_known){q, t};
  return MSR_OK;
}

bool msri_state_knows(msr_state *state, double t, const double *q) {
  const bool knows = state->known.q == q && state->known.t == t;
  state->known.q = NULL;
  return knows;
}

/* Supports alone. */
static uint64_t drift(msr_state *state, double h, const msri_flock *all, msri_debts *debts) {
  const msri_contact *contact = &state->plan->contact;
  uint64_t collisions = 0;
  if (all->x != state->q) msri_state_disarm(state);
  if (all->x != state->q || !msri_plan_arms(state->plan))
    return contact->drift(contact->self, h, all, debts);
  for (size_t from = 0, block = 0; from < all->n; from += MSRI_FLOCK_BLOCK, block++) {
    const msri_flock f = msri_flock_part(all, from);
    collisions += msri_armed_drift(&state->armed[block], contact, h, &f, debts);
  }
  return collisions;
}

msr_status msri_state_drift(void *self, double h, const double *u, const double *a, double *q,
                            double *v) {
  msr_state *state = self;
  const msri_contact *contact = &state->plan->contact;
  const msri_flock flock = msri_flock_of(state->plan->figures.masses, u, a, q, v);
  const msri_obstacles all = {state->plan->discs, contact, state->discs};
  msri_debts *debts = a && msri_plan_settles(state->plan) ? &state->debts : NULL;
  const size_t was = enter(state);
  const uint64_t collisions = state->plan->discs ? msri_discs_drift(&all, h, u, a, q, v, debts)
                                                 : drift(state, h, &flock, debts);
  state->known.q = NULL;
  count(state, collisions);
  const msr_status status = settle(state, q, v);
  leave(state, was);
  return status;
}

msr_status msri_state_bounce(void *self, double h, const double *q0, const double *v0, double *q,
                             double *v, bool *met) {
  msr_state *state = self;
  const msri_contact *contact = &state->plan->contact;
  const size_t n = state->plan->figures.masses;
  const msri_obstacles all = {state->plan->discs, contact, state->discs};
  // in the last moment of a step what is owed is nothing, and the rounding of (q - q0) / h is much
  const bool settles = contact->meet && h > 1e-3 * state->plan->figures.h;
  msri_debts *debts = settles && msri_plan_settles(state->plan) ? &state->debts : NULL;
  const size_t was = enter(state);
  const uint64_t collisions = state->plan->discs
                                  ? msri_discs_bounce(&all, h, q0, v0, q, v, debts)
                                  : contact->bounce(contact->self, n, h, q0, v0, q, v, debts);
  *met = collisions > 0;
  state->known.q = NULL;
  count(state, collisions);
  const msr_status status = settle(state, q, v);
  leave(state, was);
  return status;
}

void msri_state_meet(msr_state *state, double h, msri_meeting *meeting) {
  const msri_contact *contact = &state->plan->contact;
  const size_t n = state->plan->figures.masses;
  const double *q0 = state->before, *v0 = q0 + 2 * n;
  const size_t was = enter(state);
  contact->meet(contact->self, n, h, q0, v0, state->q, state->v, meeting);
  count(state, 0);
  leave(state, was);
}

void msri_state_strike(msr_state *state) {
  const msri_contact *contact = &state->plan->contact;
  const size_t n = state->plan->figures.masses;
  const size_t was = enter(state);
  count(state, contact->strike(contact->self, n, state->before, state->q, state->v));
  leave(state, was);
}

msr_status msri_state_hold(void *self, const double *q0, const double *q, bool *held, bool *more) {
  msr_state *state = self;
  const msri_contact *contact = &state->plan->contact;
  const size_t n = state->plan->figures.masses, was = enter(state);
  *more = contact->hold(contact->self, n, q0, q, held);
  leave(state, was);
  if (!*more || !state->effort.limited) return MSR_OK;
  for (size_t i = 0; i < 2 * n; i++)
    if (held[i] && !(fabs(q[i] - q0[i]) <= state->effort.reach)) return MSR_EUNSTABLE;
  return MSR_OK;
}

msr_status msri_state_rebound(void *self, const bool *held, const double *push, double *v) {
  msr_state *state = self;
  const msri_contact *contact = &state->plan->contact;
  const size_t was = enter(state);
  count(state, contact->rebound(contact->self, state->plan->figures.masses, held, push, v));
  leave(state, was);
  return MSR_OK;
}
