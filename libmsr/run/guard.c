/* guard.c - watches a state for numbers that can't be true.
 *
 * A sound run can't have more kinetic and spring energy than the scene had to give: what it had at
 * the start, plus what the other potentials (gravity, pushes) have lost, plus what driving forces
 * (wind) have done, at most sum |F| |dx| between two looks. Near the limit of stability, with
 * s = h omega / 2 near 1, the energy of the method itself swings: by 1 / (1 - s^2) with Verlet, by
 * (1 + s) / (1 - s) with symplectic Euler, at most 4 / (1 - s^2), which widens the bound (modified
 * energy of the harmonic oscillator: Hairer, Lubich & Wanner 2003, Acta Numerica 12, 399, 1.5). */
#include "run/guard.h"

#include "base/number.h"

#include <math.h>
#include <string.h>

/* Energy below which nothing could be seen: one mass moved by this, against its springs. */
static const double invisible = 0.01; /* [px] */

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
  state->guard = (msri_guard){status == MSR_OK, start.moving, start.potential, 0};
  return status;
}

/* ---- The verdict */

/* Times the energy given that there may be. */
static double allowance(const msr_plan_figures *f) {
  const double share = f->h / f->stable_step, swing = 1 - share * share;
  return swing > 0 ? 4 / msri_max(swing, 0.004) : 10;
}

static double mean_mass(const msr_view *s) {
  double sum = 0;
  for (size_t i = 0; i < s->n; i++) sum += msr_view_mass(s, i);
  return s->n ? sum / (double)s->n : 0;
}

/* The first mass that isn't finite, else the fastest. */
static size_t culprit(const msr_view *s) {
  size_t fastest = 0;
  double most = -1;
  for (size_t i = 0; i < s->n; i++) {
    const double speed = hypot(s->vx[i], s->vy[i]);
    if (!isfinite(speed) || !isfinite(s->x[i]) || !isfinite(s->y[i])) return i;
    if (speed > most) fastest = i, most = speed;
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

static msr_status refuse(const msr_state *state, double ratio, msr_error *err) {
  const msr_view view = msr_state_view(state);
  char mass[64], advice[160];
  advise(&state->plan->figures, advice, sizeof advice);
  msri_plan_mass_name(state->plan, culprit(&view), mass, sizeof mass);
  return msri_fail(err, MSR_EUNSTABLE,
                   "unstable at iteration %llu, t = %g s: %s has run away, with %.3g times the "
                   "energy that the scene had to give; %s",
                   (unsigned long long)state->iteration, state->t, mass, ratio, advice);
}

msr_status msr_state_check(msr_state *state, msr_error *err) {
  msr_status status = msri_guard_begin(state, err);
  if (status != MSR_OK) return status;
  msri_guard *guard = &state->guard;
  const msr_plan_figures *f = &state->plan->figures;
  if (state->plan->driven) {
    double work = 0;
    status = follow_drive(state, &work, err);
    if (status != MSR_OK) return status;
    guard->work += work;
  }
  const energies now = energies_of(state);
  const msr_view view = msr_state_view(state);
  const double visible = mean_mass(&view) * pow(f->omega * invisible, 2) / 2;
  const double fallen = msri_max(0, guard->potential - now.potential);
  const double given = guard->energy + fallen + guard->work + visible;
  const double ratio = now.moving / given;
  const bool sound =
      isfinite(now.moving) && isfinite(now.potential) && now.moving <= allowance(f) * given;
  return sound ? MSR_OK : refuse(state, ratio, err);
}
