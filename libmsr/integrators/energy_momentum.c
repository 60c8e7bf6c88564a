/* energy_momentum.c - the implicit midpoint rule with the mean force f(q0, q1) of a discrete
 * gradient (Simo & Tarnow 1992, Z. angew. Math. Phys. 43, 757; Gonzalez 1996, J. Nonlinear Sci. 6,
 * 449): q1 = q0 + h (v0 + v1)/2,  v1 = v0 + h f(q0, q1). The work of f is what the potential loses,
 * so that the energy is kept for any h. With d = q1 - q0, d = h v0 + h^2/2 f and v1 = 2 d/h - v0.
 */
#include "base/vector.h"
#include "integrators/newton.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { KNOWN_D_PUSH = 3, HELD = 1 }; /* vectors of a step beside those of Newton's method */

/* Without a discrete gradient it is the midpoint rule, whose workspace is no larger. */
static msr_status without(const msr_system *system, const msr_interval *interval, double *q,
                          double *v, msr_workspace *work, msr_error *err) {
  const msr_integrator *midpoint = &msr_integrator_implicit_midpoint;
  return midpoint->step(midpoint, system, interval, q, v, work, err);
}

/* Solves for d and, as long as that leads into something, holds what would enter it and solves
 * again: nothing is ever let go, so that it ends. */
static msr_status solve(const msri_stage *stage, bool *held, double *memory, void *object,
                        double *d, msr_error *err) {
  const msr_system *system = stage->system;
  double *q = memory; /* of no more use once d is found */
  for (bool more = true; more;) {
    msr_status status = msri_newton(stage, memory, object, d, err);
    if (status != MSR_OK || !system->hold) return status;
    for (size_t i = 0; i < system->n; i++) q[i] = stage->q0[i] + d[i];
    status = system->hold(system->self, stage->q0, q, held, &more);
    if (status != MSR_OK) return status;
    for (size_t i = 0; i < system->n; i++) d[i] = held[i] ? 0 : d[i];
  }
  return MSR_OK;
}

static msr_status step(const msr_integrator *self, const msr_system *system,
                       const msr_interval *interval, double *q, double *v, msr_workspace *work,
                       msr_error *err) {
  if (!system->between) return without(system, interval, q, v, work, err);
  (void)self;
  const size_t n = system->n;
  const double h = interval->h;
  double *known = work->vector, *d = known + n, *push = d + n, *memory = push + n;
  bool *held = (void *)(memory + MSRI_NEWTON_VECTORS * n);
  msr_status status = msri_damp(system, interval->t, h / 2, false, q, v);
  if (status != MSR_OK) return status;
  for (size_t i = 0; i < n; i++) known[i] = h * v[i];
  memcpy(d, known, n * sizeof *d);
  memset(held, 0, n * sizeof *held);
  const msri_stage stage = {.system = system,
                            .t = msr_interval_time(interval, 0.5),
                            .q0 = q,
                            .v0 = v,
                            .known = known,
                            .weight = h * h / 2,
                            .between = true,
                            .held = system->hold ? held : NULL,
                            .push = push};
  status = solve(&stage, held, memory, work->object, d, err);
  if (status != MSR_OK) return status;
  for (size_t i = 0; i < n; i++) q[i] += d[i];
  for (size_t i = 0; i < n; i++) v[i] = 2 * d[i] / h - v[i];
  if (system->hold && system->rebound) {
    msri_scale(n, 2 / h, push);
    status = system->rebound(system->self, held, push, v);
  }
  return status == MSR_OK ? msri_damp(system, interval->end, h / 2, true, q, v) : status;
}

const msr_integrator msr_integrator_energy_momentum = {
    .name = "energy-momentum",
    .summary = "implicit, with a discrete gradient: keeps energy and momenta for any step",
    .reference = "Simo & Tarnow 1992, Z. angew. Math. Phys. 43, 757; Gonzalez 1996",
    .order = 2,
    .reversible = true,
    .conservative = true,
    .splits = true,
    .holds = true,
    .implicit = true,
    .stability = (double)INFINITY,
    .damping_stability = (double)INFINITY,
    .vectors = KNOWN_D_PUSH + MSRI_NEWTON_VECTORS + HELD,
    .open = msri_newton_open,
    .close = free,
    .step = step,
};
