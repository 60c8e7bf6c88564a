/* region.h - the steps for which a method is stable on damped swings. */
#ifndef MSRI_REGION_H
#define MSRI_REGION_H

#include "base/base.h"

/* What swings: q'' = -w^2 q - g v for all w up to omega [1/s], with g = steady + growing w^2 plus
 * anything up to `most` [1/s]. */
typedef struct msri_swings {
  double omega, steady, growing, most;
} msri_swings;

/* The largest step below which all steps are stable for all of them, to 0.1 %; 0: there is none;
 * INFINITY: any step is. MSR_ENOMEM, or what the integrator's step returns. */
msr_status msri_region_step(const msr_integrator *integrator, const msri_swings *swings,
                            double *step, msr_error *err);

#endif
