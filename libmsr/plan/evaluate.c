/* evaluate.c - the problem that an integrator sees: q'' = a(t, q, v) made of the plan's terms. Each
 * callback runs down the list of what is on. */
#include "plan/state.h"

#include "base/vector.h"

#include <string.h>

static bool any(const msr_force *force) { return force->add != NULL; }

static bool without_velocity(const msr_force *force) { return !force->uses_velocity; }

static msr_status add_force(msr_state *state, const msri_term *term, const msr_view *view,
                            double *fx, double *fy) {
  const msr_status status =
      term->force->add(term->self, state->scratch + term->scratch, view, fx, fy);
  if (status != MSR_OK) state->failed = term->force;
  return status;
}

msr_status msri_state_add_forces(msr_state *state, const msr_view *view,
                                 bool (*wanted)(const msr_force *), bool step, double *fx,
                                 double *fy) {
  msr_status status = MSR_OK;
  for (size_t i = 0; i < state->plan->n_terms && status == MSR_OK; i++) {
    const msri_term *term = &state->plan->term[i];
    if (!wanted(term->force)) continue;
    const size_t was = step ? msri_meter_enter(&state->meter, i) : state->meter.effect;
    status = add_force(state, term, view, fx, fy);
    if (step) msri_meter_turn(&state->meter, was);
  }
  return status;
}

/* f[2n] / m, times the inverse: divisions would take half as long as the springs of a block. */
void msri_state_divide_by_mass(const msr_view *s, double *f) {
  if (s->m_stride == 0) {
    msri_scale(2 * s->n, 1 / s->m[0], f);
    return;
  }
  for (size_t i = 0; i < s->n; i++) {
    const double w = 1 / s->m[i];
    f[i] *= w;
    f[i + s->n] *= w;
  }
}

msr_status msri_state_accelerate(msr_state *state, double t, const double *q, const double *v,
                                 double *a) {
  const msr_view view = msri_plan_view(state->plan, t, q, v);
  memset(a, 0, 2 * view.n * sizeof *a);
  state->evaluations++;
  const msr_status status =
      msri_state_add_forces(state, &view, v ? any : without_velocity, true, a, a + view.n);
  msri_state_divide_by_mass(&view, a);
  return status;
}

static msr_status acceleration(void *self, double t, const double *q, const double *v, double *a) {
  msr_state *state = self;
  if (state->known.q && !(v && msri_plan_damps(state->plan)) && msri_state_knows(state, t, q)) {
    memcpy(a, state->ahead, 2 * state->plan->figures.masses * sizeof *a);
    return MSR_OK;
  }
  return msri_state_accelerate(state, t, q, v, a);
}

/* v += h F(t, q, v + h/2 F(t, q, v) / m) / m for a force without a flow of its own. */
static msr_status midpoint(msr_state *state, const msri_term *term, const msr_view *view, double h,
                           double *v) {
  const size_t n = view->n;
  double *f = state->middle, *u = state->middle + 2 * n;
  memcpy(u, v, 2 * n * sizeof *u);
  for (int half = 1; half >= 0; half--) {
    msr_view at = *view;
    at.vx = u, at.vy = u + n;
    memset(f, 0, 2 * n * sizeof *f);
    const msr_status status = add_force(state, term, &at, f, f + n);
    if (status != MSR_OK) return status;
    msri_state_divide_by_mass(&at, f);
    const double step = half ? h / 2 : h;
    for (size_t i = 0; i < 2 * n; i++) u[i] = v[i] + step * f[i];
  }
  memcpy(v, u, 2 * n * sizeof *u);
  return MSR_OK;
}

static msr_status damp(void *self, double t, double h, bool backward, const double *q, double *v) {
  msr_state *state = self;
  const size_t terms = state->plan->n_terms;
  const msr_view view = msri_plan_view(state->plan, t, q, v);
  for (size_t n = 0; n < terms; n++) {
    const size_t i = backward ? terms - 1 - n : n;
    const msri_term *term = &state->plan->term[i];
    if (!term->force->uses_velocity) continue;
    const size_t was = msri_meter_enter(&state->meter, i);
    const msr_status status = term->force->flow
                                  ? term->force->flow(term->self, state->scratch + term->scratch,
                                                      &view, h, backward, v, v + view.n)
                                  : midpoint(state, term, &view, h, v);
    msri_meter_turn(&state->meter, was);
    if (status == MSR_OK) continue;
    state->failed = term->force;
    return status;
  }
  return MSR_OK;
}

msr_system msri_state_system(msr_state *state) {
  const bool own = msri_plan_meets(state->plan) && !msri_plan_bounces(state->plan);
  msr_system system = {
      .n = 2 * state->plan->figures.masses,
      .self = state,
      .acceleration = acceleration,
      .damp = msri_plan_damps(state->plan) ? damp : NULL,
      .drift = own ? msri_state_drift : NULL,
      .bounce = own ? msri_state_bounce : NULL,
      .atol = state->plan->figures.atol,
      .rtol = state->plan->figures.rtol,
  };
  if (state->stiffness.graph) msri_state_solve_implicitly(&system);
  return system;
}

msr_status msr_state_forces(msr_state *state, double *fx, double *fy, msr_error *err) {
  const msr_view view = msr_state_view(state);
  memset(fx, 0, view.n * sizeof *fx);
  memset(fy, 0, view.n * sizeof *fy);
  const msr_status status = msri_state_add_forces(state, &view, any, false, fx, fy);
  return status == MSR_OK
             ? MSR_OK
             : msri_fail(err, status, "force %s: %s", state->failed->name, msr_status_text(status));
}
