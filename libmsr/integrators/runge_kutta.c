/* runge_kutta.c - explicit Runge-Kutta methods for q' = v, v' = a(t, q, v) (Hairer, Norsett &
 * Wanner, Solving Ordinary Differential Equations I, 1993, II.1). A method is a Butcher tableau. */
#include "base/base.h"
#include "base/vector.h"

#include <string.h>

enum { MOST_STAGES = 4 };

typedef struct tableau {
  int stages;
  double a[MOST_STAGES][MOST_STAGES], b[MOST_STAGES], c[MOST_STAGES];
} tableau;

/* Workspace: the stage's position, then the stages' velocities, then their accelerations. */
typedef struct stages {
  double *q, *v[MOST_STAGES], *a[MOST_STAGES];
} stages;

static stages carve(int count, size_t n, double *work) {
  stages k = {.q = work};
  for (int s = 0; s < count; s++) {
    k.v[s] = work + (size_t)(1 + s) * n;
    k.a[s] = work + (size_t)(1 + count + s) * n;
  }
  return k;
}

/* sum += h w[0] rates[0] + ... */
static void add_rates(size_t n, int count, double h, const double *w, double *const *rates,
                      double *sum) {
  for (int s = 0; s < count; s++) {
    if (h * w[s] != 0) msri_add_scaled(n, h * w[s], rates[s], sum);
  }
}

static msr_status step(const msr_integrator *self, const msr_system *system,
                       const msr_interval *interval, double *q, double *v, msr_workspace *work,
                       msr_error *err) {
  (void)err;
  const tableau *row = self->coefficients;
  const size_t n = system->n, bytes = n * sizeof(double);
  const double h = interval->h;
  const stages k = carve(row->stages, n, work->vector);
  for (int s = 0; s < row->stages; s++) {
    memcpy(k.q, q, bytes);
    memcpy(k.v[s], v, bytes);
    add_rates(n, s, h, row->a[s], k.v, k.q);
    add_rates(n, s, h, row->a[s], k.a, k.v[s]);
    const msr_status status = system->acceleration(
        system->self, msr_interval_time(interval, row->c[s]), k.q, k.v[s], k.a[s]);
    if (status != MSR_OK) return status;
  }
  add_rates(n, row->stages, h, row->b, k.v, q);
  add_rates(n, row->stages, h, row->b, k.a, v);
  return MSR_OK;
}

static const tableau euler = {1, {{0}}, {1}, {0}};
static const tableau rk4 = {
    4,
    {{0}, {0.5}, {0, 0.5}, {0, 0, 1}},
    {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6},
    {0, 0.5, 0.5, 1},
};

const msr_integrator msr_integrator_euler = {
    .name = "euler",
    .summary = "explicit Euler, unstable for every step: for contrast",
    .reference = "Euler 1768",
    .order = 1,
    .evaluations = 1,
    .stability = 0,
    .damping_stability = 2,
    .vectors = 3,
    .step = step,
    .coefficients = &euler,
};

const msr_integrator msr_integrator_rk4 = {
    .name = "rk4",
    .summary = "the classical Runge-Kutta method",
    .reference = "Kutta 1901, Z. Math. Phys. 46, 435",
    .order = 4,
    .evaluations = 4,
    .stability = 2.8284271247461903,
    .damping_stability = 2.785293563405282,
    .vectors = 9,
    .step = step,
    .coefficients = &rk4,
};
