/* crush.c - which share of the stable step is safe.
 *
 * At the limit rounding is enough to make a mode grow. Where impacts excite every mode, a lattice
 * that crumples heats from 0.8 of the limit on, and doesn't at half of it. One that is crushed,
 * from about 0.15 k L^2 for each mass on, has masses that pass through each other, whose force
 * turns round within a step. Measured: where a fall does that, up to 8 times smaller steps keep the
 * energy to a few per cent; where it's crushed from the start, or thrown against a support, 64
 * times smaller ones to 7 per cent. Care (run/care.c) makes up for those, but not for what an
 * impact that keeps its place leaves, an error of the order of h^3: in 10 000 s the assignment's
 * example heats by 1.0 % of its energy at 0.43 of the limit, in 2 substeps, and by 0.12 % at 0.29,
 * in 3. */
#include "plan/plan.h"

#include <math.h>

static const double crushing = 0.15;

double msri_plan_gravity(const msr_plan *plan) {
  double g = 0;
  for (size_t i = 0; i < plan->n_terms; i++)
    if (plan->term[i].force == &msr_force_gravity)
      g += ((const msr_gravity *)plan->term[i].params)->g;
  return fabs(g);
}

/* Weight times the height of the picture, per mass, over k L^2 of its springs: how far a fall can
 * crush them. */
static double by_fall(const msr_plan *plan) {
  const double weight = plan->uniform_mass * msri_plan_gravity(plan);
  return weight * (double)plan->figures.height / plan->mesh.lattice_k;
}

/* k L^2 of a run's springs, and added to `crushed` what they can give to pass through each other:
 * all of a shorter one, of a longer one what is left when it has no length. */
static double stiffness_of(const msr_run_of_springs *run, const msr_view *s, double *crushed) {
  double whole = 0;
  for (size_t n = 0; n < run->count; n++) {
    const size_t i = run->first + n, j = i + run->offset;
    const double dx = s->x[j] - s->x[i], dy = s->y[j] - s->y[i];
    const double k = run->k[n * run->stride], L = run->L[n * run->stride];
    const double longer = sqrt(dx * dx + dy * dy) - L, e = longer * longer;
    if (L > 0) *crushed += k * (longer < 0 ? e : msri_max(0, e - L * L));
    whole += k * L * L;
  }
  return whole;
}

/* Kinetic energy, if there are supports, and what springs can give at the start, over what crushes
 * all springs to a point. A picture begins at rest, its springs as long as they will. */
static double at_start(const msr_plan *plan, const msr_view *s) {
  const msr_springs *springs = &plan->mesh.springs;
  if (plan->n_picture == s->n) return 0;
  double energy = msri_plan_meets(plan) ? 2 * msri_kinetic(s) : 0, whole = 0;
  for (size_t r = 0; r < springs->n_runs; r++) whole += stiffness_of(&springs->run[r], s, &energy);
  return whole > 0 ? energy / whole : 0;
}

bool msri_plan_crushes(const msr_plan *plan, const msr_view *start) {
  return at_start(plan, start) > crushing;
}

double msri_plan_safe_share(const msr_plan *plan, const msr_view *start) {
  const bool meets = msri_plan_meets(plan);
  if (!plan->cares && msri_plan_crushes(plan, start)) return 0.5 / 64;
  if (!meets) return 0.9;
  /* 0.42: too little for 2 substeps of that example; where something takes energy, 2 will do */
  if (plan->cares) return plan->conserves ? 0.42 : 0.5;
  const double crushed = by_fall(plan) / crushing;
  return crushed > 1 ? 0.5 / msri_min(crushed, 8) : 0.5;
}
