/* dirk.c - diagonally implicit Runge-Kutta methods for q'' = a(t, q) (Hairer & Wanner, Solving
 * Ordinary Differential Equations II, 1996, IV.6). A method is a Butcher tableau. With A = a^2 and
 * k_i the acceleration of stage i, its displacement solves one equation,
 *     d_i = c_i h v + h^2 (A_i1 k_1 + ... + A_ii k_i),  k_i = a(t + c_i h, q + d_i).
 * What depends on v is advanced by its own flow, by half a step at each end (Strang 1968). */
#include "base/vector.h"
#include "integrators/newton.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_STAGES = 2 };

typedef struct tableau {
  int stages;
  double a[MOST_STAGES][MOST_STAGES], b[MOST_STAGES], c[MOST_STAGES];
} tableau;

/* Weight of h^2 k_j in the displacement of a row w[stages] of the tableau: sum of w_m a_mj. */
static double weight_of(const tableau *row, const double *w, int j) {
  double sum = 0;
  for (int m = j; m < row->stages; m++) sum += w[m] * row->a[m][j];
  return sum;
}

/* A step under way. All vectors are [n]. */
typedef struct stages {
  const tableau *row;
  const msr_interval *interval;
  double *known, *k[MOST_STAGES], *memory;
  void *object;
} stages;

static stages lay_out(const tableau *row, const msr_interval *interval, size_t n,
                      const msr_workspace *work) {
  stages s = {.row = row, .interval = interval, .known = work->vector, .object = work->object};
  for (int i = 0; i < row->stages; i++) s.k[i] = s.known + (size_t)(1 + i) * n;
  s.memory = s.known + (size_t)(1 + row->stages) * n;
  return s;
}

/* k_i, from those before it: by the displacement d_i, of which `known` is all but its own part. */
static msr_status solve_stage(const stages *s, int i, const msri_stage *at, msr_error *err) {
  const tableau *row = s->row;
  const size_t n = at->system->n;
  const double h = s->interval->h, own = row->a[i][i] * row->a[i][i] * h * h;
  double *d = s->k[i], *known = s->known;
  for (size_t m = 0; m < n; m++) known[m] = row->c[i] * h * at->v0[m];
  for (int j = 0; j < i; j++)
    msri_add_scaled(n, h * h * weight_of(row, row->a[i], j), s->k[j], known);
  memcpy(d, known, n * sizeof *d);
  if (i > 0) msri_add_scaled(n, own, s->k[i - 1], d);
  msri_stage stage = *at;
  stage.t = msr_interval_time(s->interval, row->c[i]);
  stage.known = known;
  stage.weight = own;
  const msr_status status = msri_newton(&stage, s->memory, s->object, d, err);
  for (size_t m = 0; m < n; m++) d[m] = own > 0 ? (d[m] - known[m]) / own : 0;
  return status;
}

static msr_status step(const msr_integrator *self, const msr_system *system,
                       const msr_interval *interval, double *q, double *v, msr_workspace *work,
                       msr_error *err) {
  const tableau *row = self->coefficients;
  const size_t n = system->n;
  const double h = interval->h;
  const stages s = lay_out(row, interval, n, work);
  const msri_stage stage = {.system = system, .q0 = q, .v0 = v};
  msr_status status = msri_damp(system, interval->t, h / 2, false, q, v);
  for (int i = 0; i < row->stages && status == MSR_OK; i++)
    status = solve_stage(&s, i, &stage, err);
  if (status != MSR_OK) return status;
  msri_add_scaled(n, h, v, q);
  for (int j = 0; j < row->stages; j++) {
    msri_add_scaled(n, h * h * weight_of(row, row->b, j), s.k[j], q);
    msri_add_scaled(n, h * row->b[j], s.k[j], v);
  }
  return msri_damp(system, interval->end, h / 2, true, q, v);
}

#define GAMMA 0.29289321881345247560 /* 1 - 1/sqrt 2 */

static const tableau backward_euler = {1, {{1}}, {1}, {1}};
static const tableau midpoint = {1, {{0.5}}, {1}, {0.5}};
static const tableau sdirk2 = {2, {{GAMMA}, {1 - GAMMA, GAMMA}}, {1 - GAMMA, GAMMA}, {GAMMA, 1}};

const msr_integrator msr_integrator_backward_euler = {
    .name = "backward-euler",
    .summary = "backward Euler: implicit, L-stable, damps whatever the step doesn't follow",
    .reference = "Curtiss & Hirschfelder 1952, Proc. Nat. Acad. Sci. 38, 235",
    .order = 1,
    .splits = true,
    .implicit = true,
    .stability = (double)INFINITY,
    .damping_stability = (double)INFINITY,
    .vectors = 1 + 1 + MSRI_NEWTON_VECTORS,
    .open = msri_newton_open,
    .close = free,
    .step = step,
    .coefficients = &backward_euler,
};

const msr_integrator msr_integrator_implicit_midpoint = {
    .name = "implicit-midpoint",
    .summary = "the implicit midpoint rule: stable for any step where forces are linear",
    .reference = "Hairer, Lubich & Wanner 2006, Geometric Numerical Integration, II.1",
    .order = 2,
    .symplectic = true,
    .reversible = true,
    .splits = true,
    .implicit = true,
    .stability = (double)INFINITY,
    .damping_stability = (double)INFINITY,
    .vectors = 1 + 1 + MSRI_NEWTON_VECTORS,
    .open = msri_newton_open,
    .close = free,
    .step = step,
    .coefficients = &midpoint,
};

const msr_integrator msr_integrator_sdirk2 = {
    .name = "sdirk2",
    .summary = "two implicit stages: L-stable, damps less than backward Euler",
    .reference = "Alexander 1977, SIAM J. Numer. Anal. 14, 1006",
    .order = 2,
    .splits = true,
    .implicit = true,
    .stability = (double)INFINITY,
    .damping_stability = (double)INFINITY,
    .vectors = 1 + 2 + MSRI_NEWTON_VECTORS,
    .open = msri_newton_open,
    .close = free,
    .step = step,
    .coefficients = &sdirk2,
};
