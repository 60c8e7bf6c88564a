/* newton.h - the equations of implicit methods, solved by Newton's method. */
#ifndef MSRI_NEWTON_H
#define MSRI_NEWTON_H

#include "base/base.h"

/* d = known + weight a(t, q0 + d) for the displacement d [n] of a stage or, if `between`, with the
 * mean acceleration from q0 to q0 + d. v0 is for systems without damp(). Where held [n] is true
 * (NULL: nowhere) d is 0 as it was, and push [n] becomes what is missing, -known - weight a. */
typedef struct msri_stage {
  const msr_system *system;
  double t;
  const double *q0, *v0, *known;
  double weight;
  bool between;
  const bool *held;
  double *push;
} msri_stage;

enum { MSRI_NEWTON_VECTORS = 5 };

/* Solves it to rounding, from the guess that d holds; `memory` is MSRI_NEWTON_VECTORS vectors,
 * `object` what msri_newton_open made. d is more exact than q0 + d can be. MSR_EUNSTABLE if the
 * iteration doesn't converge, or what the system returns. */
msr_status msri_newton(const msri_stage *stage, double *memory, void *object, double *d,
                       msr_error *err);

/* What depends on v, by its own flow. */
static inline msr_status msri_damp(const msr_system *system, double t, double h, bool backward,
                                   const double *q, double *v) {
  return system->damp ? system->damp(system->self, t, h, backward, q, v) : MSR_OK;
}

/* open() of methods that use it, closed by free(): memory for systems without solve(). */
msr_status msri_newton_open(const msr_integrator *self, const msr_system *system, void **object,
                            msr_error *err);

#endif
