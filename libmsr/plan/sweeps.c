/* sweeps.c - which plans step row by row (or band by band), and why others don't: methods made of
 * kicks and drifts do, where there is nothing but springs, a weight, air and, past a picture's
 * objects, supports. */
#include "base/number.h"
#include "integrators/splitting.h"
#include "plan/plan.h"

/* Does the force go row by row? Springs, a weight, air do. */
static bool is_simple(const msr_force *force) {
  if (force == &msr_force_springs) return true;
  return !force->uniform != !force->relax && !(force->relax && force->conservative);
}

/* The first force that doesn't, or is a second weight or air; NULL: there is none. */
static const msr_force *odd_force(const msr_plan *plan) {
  int uniform = 0, relax = 0;
  for (size_t i = 0; i < plan->n_terms; i++) {
    const msr_force *force = plan->term[i].force;
    uniform += force->uniform != NULL;
    relax += force->relax != NULL;
    if (!is_simple(force) || uniform > 1 || relax > 1) return force;
  }
  return NULL;
}

/* Of what a program has added. */
static const char *unlike_mesh(const msr_plan *plan) {
  if (plan->mesh.n_added < plan->mesh.springs.n)
    return "a program has added masses or springs to those of the picture";
  if (plan->m) return "the masses that a program has added differ";
  return msri_plan_meets(plan) ? "supports are in the way of what a program has added" : NULL;
}

/* NULL: nothing but forces may be amiss. */
static const char *unlike(const msr_plan *plan) {
  const msr_plan_figures *f = &plan->figures;
  const bool picture = f->masses == plan->n_picture && plan->mesh.n_added == 0;
  if (f->masses == 0) return "there is no mass";
  if (msri_splitting_drifts(f->integrator) == 0) return "its method isn't made of kicks and drifts";
  if (f->leaps) return "long implicit steps may take the place of substeps";
  if (f->anchors > 0) return "springs tie masses to fixed points";
  if (plan->discs) return "masses collide";
  if (msri_plan_bounces(plan)) return "supports are seen to after each step";
  if (plan->term[0].force != &msr_force_springs) return "no spring pulls";
  return picture ? NULL : unlike_mesh(plan);
}

bool msri_plan_sweeps(const msr_plan *plan) { return !unlike(plan) && !odd_force(plan); }

void msri_plan_say_vectors(msr_plan *plan) {
  const char *why = unlike(plan);
  const msr_force *odd = odd_force(plan);
  if (!why && !odd) return;
  msri_format(plan->by_vectors, sizeof plan->by_vectors, "%s%s", why ? why : odd->name,
              why              ? ""
              : is_simple(odd) ? " is the second of its kind"
                               : " isn't a weight or air");
  plan->figures.by_vectors = plan->by_vectors;
}
