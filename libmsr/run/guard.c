/* guard.c - watches a state for numbers that can't be true.
 *
 * A sound run can't gain energy that the scene didn't have to give: kinetic and spring energy at
 * the start, plus the most that the other potentials (gravity, pushes) lost, plus what driving
 * forces (wind) have done, h sum max(0, F v) in each substep, with v at its end and F there or, if
 * that is more, at its start: in a long step from rest, air is strong first and fast last. A fall
 * out of the picture gives no more than one to its bottom. To that comes what is no flaw: one kick
 * of 2 h F by the outer forces of the start (a mass that rests on a support is kicked and reflected
 * for ever), and rounding.
 *
 * Near the limit of stability, with s = h omega / 2 near 1, the energy of the method itself swings:
 * by 1 / (1 - s^2) with Verlet, by (1 + s) / (1 - s) with symplectic Euler, at most 4 / (1 - s^2),
 * which widens the bound (modified energy of the harmonic oscillator: Hairer, Lubich & Wanner 2003,
 * Acta Numerica 12, 399, 1.5). */
#include "run/guard.h"

#include "base/number.h"

#include <math.h>
#include <string.h>

/* Motion that rounding may make, against the springs: far below what can be seen. */
static const double rounding = 1e-6; /* [px] */

typedef struct energies {
  double moving;         /* kinetic and of springs */
  double gravity, outer; /* potentials of gravity, and of all others but springs */
} energies;

static energies energies_of(const msr_state *state) {
  const msr_energy e = msri_state_energies(state);
  return (energies){e.kinetic + e.spring, e.gravity, e.total - e.kinetic - e.spring - e.gravity};
}

/* ---- What the scene has to give */

static msr_status find_drive(msr_state *state) {
  if (!state->plan->driven) return MSR_OK;
  const msr_view view = msr_state_view(state);
  double *f = state->drive;
  memset(f, 0, 2 * view.n * sizeof *f);
  return msri_state_add_forces(state, &view, msri_force_drives, false, f, f + view.n);
}

static double power(const msr_state *state) {
  const size_t n = 2 * state->plan->figures.masses;
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += msri_max(0, state->drive[i] * state->v[i]);
  return sum;
}

msr_status msri_guard_follow(msr_state *state, double h) {
  if (!state->plan->driven) return MSR_OK;
  const double before = power(state);
  const msr_status status = find_drive(state);
  state->guard.work += h * msri_max(before, power(state));
  return status;
}

static bool is_outer(const msr_force *force) {
  return force->conservative && force != &msr_force_springs;
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

static double rounding_energy(const msr_view *s, double omega) {
  double mass = 0;
  for (size_t i = 0; i < s->n; i++) mass += msr_view_mass(s, i);
  return mass * pow(omega * rounding, 2) / 2;
}

msr_status msri_guard_begin(msr_state *state, msr_error *err) {
  if (state->guard.begun) return MSR_OK;
  const msr_plan_figures *figures = &state->plan->figures;
  const msr_view view = msr_state_view(state);
  double *f = state->work.vector; /* the integrator begins anew */
  state->fresh = false;
  memset(f, 0, 2 * view.n * sizeof *f);
  msr_status status = msri_state_add_forces(state, &view, is_outer, false, f, f + view.n);
  if (status == MSR_OK) status = find_drive(state);
  const energies start = energies_of(state);
  state->guard = (msri_guard){
      .begun = status == MSR_OK,
      .energy =
          start.moving + kick_energy(&view, figures->h, f) + rounding_energy(&view, figures->omega),
      .gravity = start.gravity,
      .outer = start.outer,
  };
  return status == MSR_OK
             ? MSR_OK
             : msri_fail(err, status, "force %s: %s", state->failed->name, msr_status_text(status));
}

/* ---- The verdict */

/* Times the energy given that there may be. */
static double allowance(const msr_plan_figures *f) {
  const double share = f->h / f->stable_step, swing = 1 - share * share;
  return swing > 0 ? 4 / msri_max(swing, 0.004) : 10;
}

static double speed(const msr_view *s, size_t i) { return hypot(s->vx[i], s->vy[i]); }

/* The first mass that isn't finite, else the fastest. */
static size_t culprit(const msr_view *s) {
  size_t fastest = 0;
  for (size_t i = 0; i < s->n; i++) {
    if (!isfinite(speed(s, i)) || !isfinite(s->x[i]) || !isfinite(s->y[i])) return i;
    if (speed(s, i) > speed(s, fastest)) fastest = i;
  }
  return fastest;
}

/* What to do where any step is stable: a step that is more accurate. */
static void advise_accuracy(const msr_plan_figures *f, char *text, size_t size) {
  if (f->integrator->adaptive)
    msri_format(text, size,
                "any step is stable, but errors are too large: lower atol, %g, and rtol, %g",
                f->atol, f->rtol);
  else
    msri_format(text, size,
                "any step is stable, but this one follows too little: try %llu substeps",
                4 * (unsigned long long)f->substeps);
}

/* What to do: a step that is stable, in the user's terms. */
static void advise(const msr_plan_figures *f, bool finite, char *text, size_t size) {
  const double substeps = ceil(f->dt / f->safe_step);
  if (f->stable_step == 0)
    msri_format(text, size, "%s has no stable step here; use verlet", f->integrator->name);
  else if (f->h > f->safe_step)
    msri_format(text, size, "stable: DT %.3g, or %.10g substeps", 0.995 * f->safe_step, substeps);
  else if (finite && isinf(f->stable_step))
    advise_accuracy(f, text, size);
  else if (finite)
    msri_format(text, size,
                "the step is below the limit of stability, %.3g s: try %llu substeps, or damping",
                f->stable_step, 4 * (unsigned long long)f->substeps);
  else
    msri_format(text, size, "the step is stable: look for a force or a value that is too large");
}

/* `ratio`: energy over what there was to give; NaN: a number isn't finite. */
static msr_status refuse(const msr_state *state, double ratio, msr_error *err) {
  const msr_view view = msr_state_view(state);
  char name[64], what[96] = "is no longer finite", advice[192];
  advise(&state->plan->figures, !isnan(ratio), advice, sizeof advice);
  msri_plan_mass_name(state->plan, culprit(&view), name, sizeof name);
  if (!isnan(ratio))
    msri_format(what, sizeof what,
                "has run away, with %.3g times the energy that the scene had to give", ratio);
  return msri_fail(err, MSR_EUNSTABLE, "unstable at iteration %llu, t = %g s: %s %s; %s",
                   (unsigned long long)state->iteration, view.t, name, what, advice);
}

/* What gravity has given since the start: a fall out of the picture counts to its bottom only. */
static double given_by_gravity(const msr_state *state, double fallen) {
  return state->plan->picture ? msri_min(fallen, fabs(state->guard.gravity)) : fallen;
}

msr_status msr_state_check(msr_state *state, msr_error *err) {
  const msr_status status = msri_guard_begin(state, err);
  if (status != MSR_OK) return status;
  msri_guard *guard = &state->guard;
  const energies now = energies_of(state);
  const double fallen = guard->gravity - now.gravity, pushed = guard->outer - now.outer;
  guard->lost = msri_max(guard->lost, given_by_gravity(state, fallen) + pushed);
  const double given = guard->energy + guard->lost + guard->work;
  const double gain = now.moving - guard->energy - fallen - pushed - guard->work;
  const bool finite = isfinite(now.moving) && isfinite(gain);
  if (finite && given > 0) guard->gain = msri_max(guard->gain, gain / given);
  if (finite && gain <= (allowance(&state->plan->figures) - 1) * given) return MSR_OK;
  return refuse(state, finite ? 1 + gain / given : (double)NAN, err);
}

double msr_state_energy_gain(const msr_state *state) { return state->guard.gain; }
