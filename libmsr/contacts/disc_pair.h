/* disc_pair.h - two discs: whether their paths meet, and what a collision makes of them. */
#ifndef MSRI_DISC_PAIR_H
#define MSRI_DISC_PAIR_H

#include "base/base.h"

#include <math.h>

typedef struct msri_vec {
  double x, y;
} msri_vec;

/* Disc j as seen from i: it was at `from`, and goes `path`. */
typedef struct msri_disc_pair {
  size_t i, j;
  msri_vec from, path;
  double diameter;
  double apart; /* discs that overlap are to be moved apart by up to so much in this step [px] */
} msri_disc_pair;

/* A path may come as near as this between two free places, so that what slides around a disc in
 * straight steps does so freely; and rounding; both of squares. */
static const double msri_disc_graze = 0.96, msri_disc_rounding = 1e-12;

/* The distance below which they mustn't come; they are at the square root of `from2`. */
static inline double msri_disc_pair_floor(const msri_disc_pair *p, double from2) {
  return from2 >= p->diameter * p->diameter ? p->diameter
                                            : msri_min(p->diameter, sqrt(from2) + p->apart);
}

/* Would the discs come too close: nearer than their diameter or, if they overlap, than they were?
 * A path that only grazes, between two places that are free, isn't too close. */
static inline bool msri_disc_pair_meets(const msri_disc_pair *p) {
  const msri_vec r = p->from, w = p->path, to = {r.x + w.x, r.y + w.y};
  const double least = msri_disc_pair_floor(p, r.x * r.x + r.y * r.y);
  const double least2 = least * least * (1 - msri_disc_rounding);
  if (to.x * to.x + to.y * to.y < least2) return true;
  const double b = -(r.x * w.x + r.y * w.y), way2 = w.x * w.x + w.y * w.y;
  if (!(b > 0 && b < way2)) return false;
  const double c = r.x * w.y - r.y * w.x;
  return c * c < msri_disc_graze * least2 * way2;
}

/* The direction of the collision, from i to j. */
msri_vec msri_disc_pair_normal(const msri_disc_pair *p, double restitution);

/* How far j is to go along the normal, as seen from i: 0, or more to part discs that overlap. */
double msri_disc_pair_gap(const msri_disc_pair *p);

#endif
