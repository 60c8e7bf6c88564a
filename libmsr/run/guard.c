/* guard.c - watches a state for numbers that can't be true.
 *
 * A sound run can't gain energy that the scene didn't have to give: kinetic and spring energy at
 * the start, plus the most that the other potentials (gravity, pushes) lost, plus what driving
 * forces have done, in each substep h times the most power that they tell of (wind), else
 * h sum max(0, F v), with v at its end and F there or, if that is more, at its start: in a long
 * step from rest, air is strong first and fast last. A fall out of the picture gives no more than
 * one to its bottom. To that comes what is no flaw: one kick of 2 h F by the outer forces of the
 * start (a mass that rests on a support is kicked and reflected for ever), and rounding.
 *
 * All energies cost up to a third of a step: they are looked at every 256 steps, and whenever a
 * glance at the speeds, every 16 steps (row by row see MSRI_SPEEDS), sees more kinetic energy than
 * there may be. So what explodes slowly is told before it can be seen, and what does so at once
 * while there still are numbers.
 *
 * Near the limit of stability, with s = h omega / 2 near 1, the energy of the method itself swings:
 * by 1 / (1 - s^2) with Verlet, by (1 + s) / (1 - s) with symplectic Euler, at most 4 / (1 - s^2),
 * which widens the bound (modified energy of the harmonic oscillator: Hairer, Lubich & Wanner 2003,
 * Acta Numerica 12, 399, 1.5). */
#include "run/guard.h"

#include "base/vector.h"

#include <math.h>
#include <string.h>

/* Motion that rounding may make, against the springs: far below what can be seen. */
static const double rounding = 1e-6; /* [px] */

/* Heavy masses beside stiff springs of light ones would make it infinite. */
static const double largest = 1e290;

typedef struct energies {
  double moving;         /* kinetic and of springs */
  double gravity, outer; /* potentials of gravity, and of all others but springs */
} energies;

static energies energies_of(const msr_state *state) {
  const msr_energy e = msri_state_energies(state);
  return (energies){e.kinetic + e.spring, e.gravity, e.total - e.kinetic - e.spring - e.gravity};
}

/* ---- What the scene has to give */

static bool followed(const msr_force *force) { return msri_force_drives(force) && !force->power; }

/* Of the forces that don't tell their power, at v. */
static double power_along(const msr_state *state) {
  const size_t n = 2 * state->plan->figures.masses;
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += msri_max(0, state->drive[i] * state->v[i]);
  return sum;
}

static double told_power(const msr_state *state, const msr_view *view) {
  const msr_plan *plan = state->plan;
  double sum = 0;
  for (size_t i = 0; i < plan->n_terms; i++) {
    const msri_term *term = &plan->term[i];
    if (!msri_force_drives(term->force) || !term->force->power) continue;
    sum += msri_max(0, term->force->power(term->self, state->scratch + term->scratch, view));
  }
  return sum;
}

static msr_status find_drive(msr_state *state) {
  const msr_view view = msr_state_view(state);
  state->guard.power = told_power(state, &view);
  if (!state->plan->followed) return MSR_OK;
  double *f = state->drive;
  memset(f, 0, 2 * view.n * sizeof *f);
  return msri_state_add_forces(state, &view, followed, false, f, f + view.n);
}

msr_status msri_guard_follow(msr_state *state, double h) {
  if (!state->plan->driven) return MSR_OK;
  const size_t was = msri_meter_enter(&state->meter, state->plan->row.guard);
  const bool follows = state->plan->followed;
  const double told = state->guard.power, before = follows ? power_along(state) : 0;
  const msr_status status = find_drive(state);
  const double after = follows ? power_along(state) : 0;
  state->guard.work += h * (msri_max(told, state->guard.power) + msri_max(before, after));
  msri_meter_turn(&state->meter, was);
  return status;
}

/* Energy of every mass after a kick of 2 h F from rest; f[2n] are the outer forces. */
static double kick_energy(const msr_view *s, double h, const double *f) {
  double sum = 0;
  for (size_t i = 0; i < s->n; i++) {
    const double m = msr_view_mass(s, i), vx = 2 * h * (f[i] / m), vy = 2 * h * (f[s->n + i] / m);
    sum += m * (vx * vx + vy * vy);
  }
  return sum / 2;
}

/* The same where outer forces are equal on equal masses, and there's no room for each. */
static double uniform_kick_energy(const msr_state *state, double h) {
  const msr_view s = msr_state_view(state);
  double f[2] = {0};
  for (size_t i = 0; i < state->plan->n_terms; i++) {
    const msri_term *term = &state->plan->term[i];
    if (msri_force_is_outer(term->force)) term->force->uniform(term->self, &s, f);
  }
  const double vx = 2 * h * (f[0] / s.m[0]), vy = 2 * h * (f[1] / s.m[0]);
  return (double)s.n * s.m[0] * (vx * vx + vy * vy) / 2;
}

static msr_status find_kick_energy(msr_state *state, double *energy) {
  const msr_view view = msr_state_view(state);
  const double h = state->plan->figures.h;
  double *f = state->work.vector; /* the integrator begins anew */
  state->fresh = false;
  if (state->sweep) {
    *energy = uniform_kick_energy(state, h);
    return MSR_OK;
  }
  memset(f, 0, 2 * view.n * sizeof *f);
  const msr_status status =
      msri_state_add_forces(state, &view, msri_force_is_outer, false, f, f + view.n);
  *energy = kick_energy(&view, h, f);
  return status;
}

static double rounding_energy(const msr_view *s, double omega) {
  double mass = 0;
  for (size_t i = 0; i < s->n; i++) mass += msr_view_mass(s, i);
  return msri_min(mass * pow(omega * rounding, 2) / 2, largest);
}

static msr_status tell(const msr_state *state, msr_status status, msr_error *err) {
  return status == MSR_OK
             ? MSR_OK
             : msri_fail(err, status, "force %s: %s", state->failed->name, msr_status_text(status));
}

msr_status msri_guard_resume(msr_state *state, msr_error *err) {
  if (!state->guard.stale) return MSR_OK;
  const msr_status status = find_drive(state);
  state->guard.stale = status != MSR_OK;
  return tell(state, status, err);
}

static msr_status begin(msr_state *state, msr_error *err) {
  const msr_plan_figures *figures = &state->plan->figures;
  const msr_view view = msr_state_view(state);
  double kick;
  msr_status status = find_kick_energy(state, &kick);
  if (status == MSR_OK) status = find_drive(state);
  const energies start = energies_of(state);
  const double slack = kick + rounding_energy(&view, figures->omega);
  state->guard = (msri_guard){
      .begun = status == MSR_OK,
      .looked = msri_state_steps(state),
      .power = state->guard.power,
      .energy = start.moving + slack,
      .slack = slack,
      .gravity = start.gravity,
      .outer = start.outer,
  };
  return tell(state, status, err);
}

msr_status msri_guard_begin(msr_state *state, msr_error *err) {
  const size_t was = msri_meter_turn(&state->meter, state->plan->row.guard);
  const msr_status status = state->guard.begun ? msri_guard_resume(state, err) : begin(state, err);
  msri_meter_turn(&state->meter, was);
  return status;
}

/* ---- The verdict */

/* Times the energy given that there may be. */
static double allowance(const msr_plan_figures *f) {
  const double share = f->h / f->stable_step, swing = 1 - share * share;
  return swing > 0 ? 4 / msri_max(swing, 0.004) : 10;
}

/* What gravity has given since the start: a fall out of the picture counts to its bottom only. */
static double given_by_gravity(const msr_state *state, double fallen) {
  return state->plan->picture ? msri_min(fallen, fabs(state->guard.gravity)) : fallen;
}

/* What there is and was, and how much of it came from nowhere. */
typedef struct balance {
  double moving, given, gain;
} balance;

static balance balance_of(const msr_state *state, double *lost) {
  const msri_guard *guard = &state->guard;
  const energies now = energies_of(state);
  const double fallen = guard->gravity - now.gravity, pushed = guard->outer - now.outer;
  *lost = msri_max(*lost, given_by_gravity(state, fallen) + pushed);
  return (balance){.moving = now.moving,
                   .given = guard->energy + *lost + guard->work,
                   .gain = now.moving - guard->energy - fallen - pushed - guard->work};
}

static void take_note(msr_state *state, const balance *b) {
  msri_guard *guard = &state->guard;
  const bool finite = isfinite(b->moving) && isfinite(b->gain);
  if (finite && b->given > 0) guard->gain = msri_max(guard->gain, b->gain / b->given);
  // a fall out of the picture goes on
  guard->most = msri_max(allowance(&state->plan->figures) * b->given, 2 * b->moving);
  guard->looked = msri_state_steps(state);
}

double msri_guard_gain(msr_state *state, double *lost) {
  const balance b = balance_of(state, lost);
  take_note(state, &b);
  const double loss = state->plan->conserves ? -(b.gain + state->guard.slack) : 0;
  const double gain = msri_max(b.gain, loss);
  if (isnan(b.gain)) return (double)INFINITY;
  return gain <= 0 ? 0 : gain / b.given;
}

static msr_status check(msr_state *state, msr_error *err) {
  state->failed = NULL;
  const msr_status status = msri_guard_begin(state, err);
  if (status != MSR_OK) return status;
  const balance b = balance_of(state, &state->guard.lost);
  const bool finite = isfinite(b.moving) && isfinite(b.gain);
  const double most = allowance(&state->plan->figures) * b.given;
  take_note(state, &b);
  if (finite && b.gain <= most - b.given) return MSR_OK;
  return msri_guard_refuse(state, finite ? 1 + b.gain / b.given : (double)NAN, err);
}

msr_status msr_state_check(msr_state *state, msr_error *err) {
  const size_t was = msri_meter_enter(&state->meter, state->plan->row.guard);
  const msr_status status = check(state, err);
  msri_meter_turn(&state->meter, was);
  return status;
}

/* Is there more than there may be, as far as the last look knew, or no number? */
static bool runs(msr_state *state) {
  const msr_plan *plan = state->plan;
  const size_t n = plan->figures.masses, was = msri_meter_enter(&state->meter, plan->row.guard);
  const double *v = state->v;
  const double twice = plan->m
                           ? msri_sum_squares(n, plan->m, v) + msri_sum_squares(n, plan->m, v + n)
                           : plan->uniform_mass * msri_sum_squares(2 * n, NULL, v);
  msri_meter_turn(&state->meter, was);
  return !(twice / 2 <= state->guard.most);
}

uint64_t msri_guard_patience(const msr_state *state) {
  const uint64_t since = msri_state_steps(state) - state->guard.looked;
  return since > MSRI_LOOK ? 1 : MSRI_LOOK + 1 - since;
}

msr_status msri_guard_watch(msr_state *state, bool fast, msr_error *err) {
  const uint64_t steps = msri_state_steps(state);
  const bool late = fast || steps - state->guard.looked > MSRI_LOOK;
  return late || (steps % MSRI_GLANCE == 0 && runs(state)) ? msr_state_check(state, err) : MSR_OK;
}

double msr_state_energy_gain(const msr_state *state) { return state->guard.gain; }
