/* own_integrator.c - an integrator of one's own: PEFRL, of order 4 (Omelyan, Mryglod & Folk 2002).
 * Introduces msr_integrate, which steps any system q'' = a(t, q, v), here the quartic oscillator
 * q'' = -q^3, without a scene; msr_plan_options.integrator takes the same struct for a scene. */
#include <msr.h>

#include <math.h>
#include <stdio.h>

/* Drifts and kicks in turn; both rows read the same backwards, hence the method is reversible. */
static msr_status step(const msr_integrator *self, const msr_system *s,
                       const msr_interval *interval, double *q, double *v, msr_workspace *work,
                       msr_error *err) {
  static const double x = 0.1786178958448091, l = -0.2123418310626054, c = -0.06626458266981849;
  const double drifts[] = {x, c, 1 - 2 * (c + x), c, x}, kicks[] = {0.5 - l, l, l, 0.5 - l};
  double *a = work->vector, share = 0;
  (void)self, (void)err;
  for (int k = 0; k < 4; k++) {
    msr_status status = msr_system_drift(s, drifts[k] * interval->h, v, NULL, q, v);
    const double t = msr_interval_time(interval, share += drifts[k]);
    if (status == MSR_OK) status = s->acceleration(s->self, t, q, v, a);
    if (status != MSR_OK) return status;
    for (size_t i = 0; i < s->n; i++) v[i] += kicks[k] * interval->h * a[i];
  }
  return msr_system_drift(s, drifts[4] * interval->h, v, NULL, q, v);
}

static const msr_integrator pefrl = {.name = "pefrl",
                                     .summary = "five drifts, four kicks",
                                     .order = 4,
                                     .damped_order = 1,
                                     .symplectic = true,
                                     .reversible = true,
                                     .evaluations = 4,
                                     .stability = 2.97,
                                     .damping_stability = 1,
                                     .vectors = 1,
                                     .step = step};

static msr_status quartic(void *self, double t, const double *q, const double *v, double *a) {
  (void)self, (void)t, (void)v;
  a[0] = -q[0] * q[0] * q[0];
  return MSR_OK;
}

static double at_ten(unsigned steps) {
  const msr_system system = {.n = 1, .acceleration = quartic};
  double q = 1, v = 0;
  return msr_integrate(&pefrl, &system, 0, 10.0 / steps, steps, &q, &v, NULL) ? (double)NAN : q;
}

int main(void) {
  const double exact = at_ten(3200);
  for (unsigned n = 50; n <= 400; n *= 2)
    printf("h = %-6g error %.1e, %.1f times that of h / 2 (order 4: 16)\n", 10.0 / n,
           at_ten(n) - exact, (at_ten(n) - exact) / (at_ten(2 * n) - exact));
}
