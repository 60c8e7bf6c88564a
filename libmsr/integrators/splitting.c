/* splitting.c - symplectic splittings of q'' = a(t, q): kicks v += b h a and drifts q += c h v in
 * turn (Hairer, Lubich & Wanner, Geometric Numerical Integration, 2006, II.5). A method is a row.
 *
 * What depends on v is advanced by its own flow, so that damping doesn't limit the step: by half a
 * step at each end of a symmetric method, which keeps order 2 (Strang 1968), else by a whole one
 * after the first kick (at both ends, damping would lower the limit of kick and drift). */
#include "base/base.h"

typedef struct splitting {
  int stages;
  double kick[4], drift[4]; /* [stages], in units of h; each kick precedes its drift */
  bool symmetric;           /* and so the last kick's a serves the next step's first */
} splitting;

static msr_status damp(const msr_system *system, double t, double h, bool backward, const double *q,
                       double *v) {
  return system->damp ? system->damp(system->self, t, h, backward, q, v) : MSR_OK;
}

static msr_status accelerate(const msr_system *system, double t, const double *q, const double *v,
                             double *a) {
  return system->acceleration(system->self, t, q, system->damp ? NULL : v, a);
}

static msr_status begin(const msr_integrator *self, const msr_system *system, double t,
                        const double *q, const double *v, msr_workspace *work) {
  const splitting *row = self->coefficients;
  return row->symmetric ? accelerate(system, t, q, v, work->vector) : MSR_OK;
}

static msr_status step(const msr_integrator *self, const msr_system *system,
                       const msr_interval *interval, double *q, double *v, msr_workspace *work,
                       msr_error *err) {
  (void)err;
  const splitting *row = self->coefficients;
  const double h = interval->h;
  double *a = work->vector, share = 0;
  msr_status status = MSR_OK;
  if (row->symmetric) status = damp(system, interval->t, h / 2, false, q, v);
  for (int s = 0; s < row->stages && status == MSR_OK; s++) {
    if (s > 0 || !row->symmetric)
      status = accelerate(system, msr_interval_time(interval, share), q, v, a);
    if (status != MSR_OK) return status;
    const double bh = row->kick[s] * h;
    for (size_t i = 0; i < system->n; i++) v[i] += bh * a[i];
    if (s == 0 && !row->symmetric) status = damp(system, interval->t, h, false, q, v);
    if (status == MSR_OK && row->drift[s] != 0)
      status = msr_system_drift(system, row->drift[s] * h, v, a, q, v);
    share += row->drift[s];
  }
  if (status != MSR_OK || !row->symmetric) return status;
  return damp(system, interval->end, h / 2, true, q, v);
}

static const splitting symplectic_euler = {1, {1}, {1}, false};
static const splitting verlet = {2, {0.5, 0.5}, {1, 0}, true};

const msr_integrator msr_integrator_symplectic_euler = {
    .name = "symplectic-euler",
    .summary = "kick, then drift: the assignment's five steps",
    .reference = "Euler; de Vogelaere 1956",
    .order = 1,
    .symplectic = true,
    .splits = true,
    .bounces = true,
    .evaluations = 1,
    .stability = 2,
    .damping_stability = 2,
    .vectors = 1,
    .begin = begin,
    .step = step,
    .coefficients = &symplectic_euler,
};

const msr_integrator msr_integrator_verlet = {
    .name = "verlet",
    .summary = "velocity Verlet: half kick, drift, half kick",
    .reference = "Verlet 1967, Phys. Rev. 159, 98; Swope et al. 1982",
    .order = 2,
    .symplectic = true,
    .reversible = true,
    .splits = true,
    .bounces = true,
    .evaluations = 1,
    .stability = 2,
    .damping_stability = 2,
    .vectors = 1,
    .begin = begin,
    .step = step,
    .coefficients = &verlet,
};
