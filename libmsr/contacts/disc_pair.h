/* disc_pair.h - two discs: whether their ways meet, and what a collision makes of them. */
#ifndef MSRI_DISC_PAIR_H
#define MSRI_DISC_PAIR_H

#include "base/base.h"

typedef struct msri_vec {
  double x, y;
} msri_vec;

/* Disc j as seen from i: it was at `from`, and goes `way`. */
typedef struct msri_disc_pair {
  size_t i, j;
  msri_vec from, way;
  double diameter;
  double apart; /* discs that overlap are to be moved apart by up to so much in this step [px] */
} msri_disc_pair;

/* Would the discs come too close: nearer than their diameter or, if they overlap, than they were?
 * A way that only grazes, between two places that are free, isn't too close. */
bool msri_disc_pair_meets(const msri_disc_pair *p);

/* The direction of the collision, from i to j. */
msri_vec msri_disc_pair_normal(const msri_disc_pair *p, double restitution);

/* How far j is to go along the normal, as seen from i. */
double msri_disc_pair_gap(const msri_disc_pair *p);

#endif
