/* guard.c - watches a state for numbers that can't be true.
 *
 * A sound run can't have more kinetic and spring energy than the scene had to give: what it had at
 * the start, plus the most that the other potentials (gravity, pushes) lost, plus what driving
 * forces (wind) have done, at most sum |F| |dx| between two looks. Near the limit of stability,
 * with s = h omega / 2 near 1, the energy of the method itself swings: by 1 / (1 - s^2) with
 * Verlet, by (1 + s) / (1 - s) with symplectic Euler, at most 4 / (1 - s^2), which widens the bound
 * (modified energy of the harmonic oscillator: Hairer, Lubich & Wanner 2003, Acta Numerica 12,
 * 399, 1.5). */
#include "run/guard.h"

#include "base/number.h"

#include <math.h>
#include <string.h>

/* A mass that moves less than this in a step hasn't run away, whatever its share of the energy: one
 * that rests on a support is kicked by h g and reflected for ever. */
static const double slow = 0.01; /* [px] */

typedef struct energies {
  double moving;    /* kinetic and of springs */
  double potential; /* of all other conservative forces */
} energies;

static energies energies_of(const msr_state *state) {
  const msr_energy e = msri_state_energies(state);
  return (energies){e.kinetic + e.spring, e.total - e.kinetic - e.spring};
}

/* ---- Work of driving forces */

static bool drives(const msr_force *force) { return !force->conservative && !force->dissipative; }

/* Bound of the work done since the last look; the forces now become those of the last look. */
static msr_status follow_drive(msr_state *state, double *work, msr_error *err) {
  const msr_view view = msr_state_view(state);
  const size_t n = view.n;
  double *force = state->drive, *last_force = force + 2 * n, *last_q = force + 4 * n;
  const msr_status status = msri_state_add_forces(state, &view, drives, force);
  if (status != MSR_OK) return msri_fail(err, status, "a force: %s", msr_status_text(status));
  *work = 0;
  for (size_t i = 0; i < n; i++) {
    const double fx = (force[i] + last_force[i]) / 2, fy = (force[n + i] + last_force[n + i]) / 2;
    *work += hypot(fx, fy) * hypot(state->q[i] - last_q[i], state->q[n + i] - last_q[n + i]);
  }
  memcpy(last_force, force, 2 * n * sizeof *force);
  memcpy(last_q, state->q, 2 * n * sizeof *force);
  return MSR_OK;
}

msr_status msri_guard_begin(msr_state *state, msr_error *err) {
  if (state->guard.begun) return MSR_OK;
  const energies start = energies_of(state);
  double ignored = 0;
  const msr_status status = state->plan->driven ? follow_drive(state, &ignored, err) : MSR_OK;
  state->guard = (msri_guard){status == MSR_OK, start.moving, start.potential, 0, 0};
  return status;
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

/* What to do: a step that is stable, in the user's terms. */
static void advise(const msr_plan_figures *f, char *text, size_t size) {
  if (f->integrator->stability == 0)
    msri_format(text, size, "%s is stable for no step; use verlet", f->integrator->name);
  else if (f->h > f->safe_step)
    msri_format(text, size, "DT %.3g or %.0f substeps would have worked", f->safe_step,
                ceil(f->dt / f->safe_step));
  else
    msri_format(text, size, "the step is below the limit of stability, %.3g s: try %llu substeps",
                f->stable_step, 2 * (unsigned long long)f->substeps);
}

static msr_status refuse(const msr_state *state, size_t mass, double ratio, msr_error *err) {
  char name[64], advice[160];
  advise(&state->plan->figures, advice, sizeof advice);
  msri_plan_mass_name(state->plan, mass, name, sizeof name);
  return msri_fail(err, MSR_EUNSTABLE,
                   "unstable at iteration %llu, t = %g s: %s has run away, with %.3g times the "
                   "energy that the scene had to give; %s",
                   (unsigned long long)state->iteration, state->t, name, ratio, advice);
}

/* Adds what driving forces have done since the last look. */
static msr_status add_drive(msr_state *state, msr_error *err) {
  double work = 0;
  const msr_status status = state->plan->driven ? follow_drive(state, &work, err) : MSR_OK;
  state->guard.work += work;
  return status;
}

msr_status msr_state_check(msr_state *state, msr_error *err) {
  msr_status status = msri_guard_begin(state, err);
  if (status == MSR_OK) status = add_drive(state, err);
  if (status != MSR_OK) return status;
  msri_guard *guard = &state->guard;
  const msr_plan_figures *f = &state->plan->figures;
  const energies now = energies_of(state);
  guard->fallen = msri_max(guard->fallen, guard->potential - now.potential);
  const double given = guard->energy + guard->fallen + guard->work;
  const bool finite = isfinite(now.moving) && isfinite(now.potential);
  if (finite && now.moving <= allowance(f) * given) return MSR_OK;
  const msr_view view = msr_state_view(state);
  const size_t mass = culprit(&view);
  if (finite && speed(&view, mass) * f->h <= slow) return MSR_OK;
  return refuse(state, mass, now.moving / given, err);
}
