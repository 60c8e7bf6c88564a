/* krylov.h - solving with the derivative of a stage without its matrix. */
#ifndef MSRI_KRYLOV_H
#define MSRI_KRYLOV_H

#include "integrators/newton.h"

/* a [n]: the acceleration of the stage at q. What the system returns. */
msr_status msri_stage_acceleration(const msri_stage *stage, const double *q, double *a);

enum { MSRI_KRYLOV_VECTORS = 7 };

/* x with |A x - r| <= tolerance |x| if rounding lets it, A = 1 - weight da/dq at q. */
msr_status msri_krylov_solve(const msri_stage *stage, const double *q, const double *r,
                             double tolerance, double *memory, double *x);

#endif
