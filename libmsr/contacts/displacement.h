/* displacement.h - how far the masses of each body go in a step, and away from each other. */
#ifndef MSRI_DISPLACEMENT_H
#define MSRI_DISPLACEMENT_H

#include "contacts/bodies.h"

/* Of places, or of paths. */
typedef struct msri_box {
  double low[2], high[2];
} msri_box;

/* Each mass of a body goes `path`, but for no more than `spread`; infinite if one path isn't
 * finite.
 */
typedef struct msri_displacement {
  double path[2], spread;
} msri_displacement;

msri_displacement msri_displacement_of(const msri_box *paths);

/* Boxes of each body's paths from q0 [2n] to q; of its places q if q0 is NULL. */
void msri_displacement_measure(const msri_bodies *bodies, const double *q0, const double *q,
                               msri_box *box);

/* How far at most a mass is from where it would be if the body had gone from `at` to q without a
 * change of its form. */
double msri_displacement_change(const msri_bodies *bodies, size_t body, const double *at,
                                const double *q);

#endif
