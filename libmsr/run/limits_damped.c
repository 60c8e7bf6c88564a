/* limits_damped.c - the largest stable step with damping.
 *
 * Each eigenvector x of the damped problem solves a scalar one, of w^2 = x*Kx / x*Mx and
 * g = x*Cx / x*Mx (Tisseur & Meerbergen 2001, SIAM Review 43, 235): one step of the method on
 * scalars tells all if it takes all forces together. Whether g follows from w is asked of the
 * forces themselves: C u is compared with M u and K u for a vector u at random. */
#include "run/limits.h"
#include "run/region.h"

#include "base/vector.h"
#include "solvers/lanczos.h"
#include "solvers/tangent.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* c[2n] = what depends on v at v = 0, less what it is at v = u. */
static msr_status probe(const msri_start *s, char *scratch, const double *u, double *c) {
  const size_t n = s->view.n;
  msr_status status = MSR_OK;
  memset(c, 0, 2 * n * sizeof *c);
  double *const none = c + 2 * n;
  for (int moving = 1; moving >= 0 && status == MSR_OK; moving--) {
    msr_view at = s->view;
    at.vx = moving ? u : none, at.vy = at.vx + n;
    for (size_t i = 0; i < 2 * n; i++) c[i] = -c[i];
    for (size_t i = 0; i < s->plan->n_terms && status == MSR_OK; i++) {
      const msri_term *term = &s->plan->term[i];
      if (term->force->uses_velocity)
        status = term->force->add(term->self, scratch + term->scratch, &at, c, c + n);
    }
  }
  return status;
}

/* a[2n] times sqrt(m), or over it, then made 1 at most: what it was divided by. */
static double weigh(const msri_start *s, bool up, double *a) {
  const size_t n = s->view.n;
  for (size_t i = 0; i < 2 * n; i++) {
    const double root = sqrt(msr_view_mass(&s->view, i < n ? i : i - n));
    a[i] = up ? a[i] * root : a[i] / root;
  }
  const double largest = msri_largest(2 * n, a);
  for (size_t i = 0; i < 2 * n && largest > 0; i++) a[i] /= largest;
  return largest;
}

/* Is c = steady M u + growing k, with k = K u? By least squares in the norm of M^-1. */
static bool fits(const msri_start *s, double *u, double *k, double *c, msri_swings *swings) {
  const size_t n = 2 * s->view.n;
  const double of_u = weigh(s, true, u), of_k = weigh(s, false, k), of_c = weigh(s, false, c);
  const double uu = msri_dot(n, u, u), uk = msri_dot(n, u, k), kk = msri_dot(n, k, k);
  const double uc = msri_dot(n, u, c), kc = msri_dot(n, k, c), cc = msri_dot(n, c, c);
  const double det = uu * kk - uk * uk;
  if (!(uu > 0)) return false;
  const bool independent = det > 1e-9 * uu * kk;
  const double growing = independent ? (uu * kc - uk * uc) / det : 0;
  const double steady = (uc - growing * uk) / uu;
  for (size_t i = 0; i < n; i++) c[i] -= steady * u[i] + growing * k[i];
  const double rounding = 1e-8, most = msri_max(fabs(steady), fabs(growing));
  swings->steady = fabs(steady) > rounding * most ? steady * (of_c / of_u) : 0;
  swings->growing = fabs(growing) > rounding * most ? growing * (of_c / of_k) : 0;
  return msri_dot(n, c, c) <= rounding * rounding * cc;
}

static msr_status is_known(const msri_start *s, msri_swings *swings, bool *known) {
  const size_t n = 2 * s->view.n;
  *known = false;
  if (s->vast) return MSR_OK;
  double *u = msri_alloc(4 * n, sizeof *u, "the stable step", NULL);
  char *scratch = msri_alloc(1, s->plan->scratch_bytes, "the stable step", NULL);
  msr_status status = u && scratch ? MSR_OK : MSR_ENOMEM;
  double *const k = u + n, *const c = u + 2 * n; /* and [n] zeros */
  if (status == MSR_OK) {
    msri_fill_at_random(n, u);
    msri_tangent_product(&s->view, u, k);
    status = probe(s, scratch, u, c);
  }
  if (status == MSR_OK) *known = fits(s, u, k, c, swings);
  free(scratch);
  free(u);
  return status;
}

/* Flows along springs are taken one after the other, which no scalar tells of: only a rate that is
 * the same for all masses is known then. */
static msr_status find_swings(const msri_start *s, msri_swings *swings, bool *known) {
  const bool splits = s->plan->figures.integrator->splits;
  const msr_status status = is_known(s, swings, known);
  if (status != MSR_OK) return status;
  *known = *known && !(splits && (swings->growing != 0 || s->midpoint > 0));
  if (!*known) *swings = (msri_swings){.omega = swings->omega, .most = s->flow + s->midpoint};
  return MSR_OK;
}

/* The segment between the two limits, as in plan/stable.c. */
static double segment(const msri_start *s, double omega) {
  const msr_integrator *method = s->plan->figures.integrator;
  const double limit = msri_min(method->damping_stability, msri_midpoint_limit);
  const double damping = (s->flow > 0 ? s->flow / method->damping_stability : 0) +
                         (s->midpoint > 0 ? s->midpoint / limit : 0);
  return 1 / ((omega > 0 ? omega / method->stability : 0) + damping);
}

msr_status msri_limits_damp(const msri_start *s, msr_limit *limit, msr_error *err) {
  const msr_integrator *method = s->plan->figures.integrator;
  if (!msri_plan_damps(s->plan)) return MSR_OK;
  msri_swings swings = {.omega = limit->omega};
  bool known = false;
  double step = method->splits ? segment(s, limit->omega) : limit->step;
  msr_status status = MSR_OK;
  if (!isinf(method->stability)) status = find_swings(s, &swings, &known);
  if (status == MSR_OK && !isinf(method->stability) && (known || !method->splits))
    status = msri_region_step(method, &swings, &step, err);
  /* Beyond the limit without damping a composition may grow in bands too narrow to be seen. */
  const bool bands = method->splits && method->evaluations > 1 && step > limit->step;
  if (bands) step = limit->step;
  if (!known || bands) limit->found = MSR_FOUND_BOUND;
  limit->step = step;
  return status;
}
