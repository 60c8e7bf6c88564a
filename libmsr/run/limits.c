/* limits.c - the largest stable steps of a plan: h omega may reach the integrator's limit on the
 * imaginary axis, and omega^2 is the largest eigenvalue of M^-1 K, at rest or at the worst stretch.
 * To take springs or masses out of a mesh raises no eigenvalue (Weyl 1912, Math. Ann. 71, 441): a
 * picture's is no larger than that of the lattice without end. */
#include "run/limits.h"

#include "solvers/tangent.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Frequencies */

/* Masses of which matrices are analysed: that takes a fifth of a second at most. */
enum { MOST_ANALYSED = 1 << 17 };

static msr_status add_rates(msri_start *s) {
  for (size_t i = 0; i < s->plan->n_terms; i++) {
    const msri_term *term = &s->plan->term[i];
    double of_x = 0, of_v = 0;
    if (term->force == &msr_force_springs || !term->force->rates) continue;
    const msr_status status = term->force->rates(term->self, &s->view, &of_x, &of_v);
    if (status != MSR_OK) return status;
    s->other2 += of_x;
    *(term->force->flow ? &s->flow : &s->midpoint) += of_v;
  }
  return MSR_OK;
}

static bool pulls(const msr_plan *plan) {
  for (size_t i = 0; i < plan->n_terms; i++)
    if (plan->term[i].force == &msr_force_springs) return true;
  return false;
}

/* Finds the sides of the object if it's one full rectangle of 4 neighbours, and nothing else. */
static void measure(msri_start *s) {
  const msr_springs *springs = &s->plan->mesh.springs;
  size_t side[2];
  if (s->plan->n_picture < s->plan->figures.masses || s->plan->mesh.n_added > 0) return;
  if (springs->n_anchors > 0 || !s->plan->grid || !msri_grid_is_rectangle(s->plan->grid, side))
    return;
  if (springs->n == 2 * side[0] * side[1] - side[0] - side[1]) memcpy(s->side, side, sizeof side);
}

/* Is it of interest where masses begin? */
static bool looks_at_places(const msri_start *s) {
  for (size_t i = 0; i < s->plan->n_terms; i++)
    if (!s->plan->term[i].force->ignores_start) return true;
  return !s->vast && (s->side[0] == 0 || msri_plan_damps(s->plan));
}

/* The highest mode of a chain of n masses with free ends, in units of k/m. */
static double chain(double n) {
  const double pi = 3.14159265358979323846;
  return 4 * pow(sin((n - 1) / (2 * n) * pi), 2);
}

/* At rest only chains along their direction swing; stretched, x and y alike along both. */
static double rectangle_omega2(const msr_plan *plan, msri_stretch stretch, const size_t side[2]) {
  const double a = chain((double)side[0]), b = chain((double)side[1]);
  return plan->mesh.lattice_k / plan->uniform_mass *
         (stretch == MSRI_AS_THEY_ARE ? msri_max(a, b) : a + b);
}

/* Is there nothing but the masses and springs of a picture? */
static bool is_picture(const msr_plan *plan) {
  const msri_mesh *mesh = &plan->mesh;
  return plan->n_picture == plan->figures.masses && !plan->m && mesh->n_added == 0 &&
         mesh->springs.n_anchors == 0;
}

/* Of the lattice without end, by its plane waves; of any other mesh `bound`, Gershgorin's. */
static double vast_omega2(const msr_plan *plan, msri_stretch stretch, double bound) {
  static const double lattice[2][2] = {{4, 8}, {8, 12}}; /* 4 and 8 neighbours; over k / m */
  const double most = lattice[plan->neighbours == 8][stretch == MSRI_WITHOUT_END] *
                      (plan->mesh.lattice_k / plan->uniform_mass);
  return is_picture(plan) ? msri_min(most, bound) : bound;
}

static msr_status frequency(const msri_start *s, msri_stretch stretch, msr_limit *limit) {
  double omega2 = 0, bound = 0;
  msr_status status = MSR_OK;
  if (pulls(s->plan)) status = msr_force_springs.rates(NULL, &s->view, &bound, &(double){0});
  if (status == MSR_OK && bound > 0 && s->side[0] > 0) {
    omega2 = rectangle_omega2(s->plan, stretch, s->side);
    limit->found = MSR_FOUND_CLOSED_FORM;
  } else if (status == MSR_OK && bound > 0 && s->vast) {
    omega2 = vast_omega2(s->plan, stretch, bound);
    limit->found = MSR_FOUND_BOUND;
  } else if (status == MSR_OK) {
    status = msri_tangent_largest(&s->view, stretch, bound, &omega2, &limit->iterations);
    limit->found = MSR_FOUND_LANCZOS;
  }
  if (s->other2 > 0) limit->found = MSR_FOUND_BOUND;
  limit->omega = sqrt(omega2 + s->other2);
  return status;
}

static msr_status find_undamped(const msri_start *s, msri_stretch stretch, msr_limit *limit) {
  const msr_status status = frequency(s, stretch, limit);
  const double reach = s->plan->figures.integrator->stability;
  limit->step = limit->omega > 0 ? reach / limit->omega : (double)INFINITY;
  return status;
}

/* ---- All of it */

static void say_none_or_any(msr_limit *limit) {
  if (limit->step > 0 && !isinf(limit->step)) return;
  limit->found = limit->step > 0 ? MSR_FOUND_ANY : MSR_FOUND_NONE;
  limit->iterations = 0;
}

msr_status msr_plan_stability(const msr_plan *plan, msr_stability *stability, msr_error *err) {
  msri_start s = {.plan = plan, .vast = plan->figures.masses > MOST_ANALYSED};
  measure(&s);
  const bool places = looks_at_places(&s);
  const size_t n = plan->figures.masses;
  double *q = msri_alloc(places ? 4 * n : 0, sizeof *q, "the stable step", err);
  if (!q) return MSR_ENOMEM;
  if (places) msri_plan_start(plan, q, q + n, q + 2 * n, q + 3 * n);
  s.view = places ? msri_plan_view(plan, 0, q, q + 2 * n) : msri_plan_view(plan, 0, NULL, NULL);
  msr_stability found = {.bound = plan->figures.stable_step};
  msr_error said = {MSR_OK, ""};
  msr_status status = add_rates(&s);
  if (status == MSR_OK) status = find_undamped(&s, MSRI_AS_THEY_ARE, &found.at_rest);
  if (status == MSR_OK) status = find_undamped(&s, MSRI_WITHOUT_END, &found.stretched);
  found.damped = found.at_rest;
  if (status == MSR_OK) status = msri_limits_damp(&s, &found.damped, &said);
  say_none_or_any(&found.at_rest);
  say_none_or_any(&found.stretched);
  say_none_or_any(&found.damped);
  free(q);
  if (status != MSR_OK)
    return msri_hand_on(err, status, &said, "the stable step: %s", msr_status_text(status));
  *stability = found;
  return MSR_OK;
}
