/* motion.h - how far the masses of each body go in a step, and away from each other. */
#ifndef MSRI_MOTION_H
#define MSRI_MOTION_H

#include "contacts/bodies.h"

/* Of places, or of ways. */
typedef struct msri_box {
  double low[2], high[2];
} msri_box;

/* Each mass of a body goes `way`, but for no more than `spread`; infinite if one way isn't finite.
 */
typedef struct msri_motion {
  double way[2], spread;
} msri_motion;

msri_motion msri_motion_of(const msri_box *ways);

/* Boxes of each body's ways from q0 [2n] to q; of its places q if q0 is NULL. */
void msri_motion_measure(const msri_bodies *bodies, const double *q0, const double *q,
                         msri_box *box);

/* How far at most a mass is from where it would be if the body had gone from `at` to q without a
 * change of its form. */
double msri_motion_change(const msri_bodies *bodies, size_t body, const double *at,
                          const double *q);

#endif
