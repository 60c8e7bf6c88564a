/* encounters.h - a drift, and the pairs of it that are looked at. */
#ifndef MSRI_ENCOUNTERS_H
#define MSRI_ENCOUNTERS_H

#include "contacts/drift.h"
#include "contacts/lists.h"

typedef struct msri_encounters {
  msri_drift *d;
  msri_lists *lists;
  msri_pair *pair; /* [n]: those that are close, or that meet, ascending */
  size_t n;
  bool full; /* there are more */
} msri_encounters;

/* Longer paths than this, in diameters, are fast. */
static const double msri_slow = 0.3;

static inline double msri_distance2(const msri_drift *d, size_t i, size_t j) {
  const double *x = d->q0, *y = x + d->n, rx = x[j] - x[i], ry = y[j] - y[i];
  return rx * rx + ry * ry;
}

static inline bool msri_drift_meets(msri_drift *d, size_t i, size_t j) {
  const msri_disc_pair p = msri_drift_pair(d, i, j);
  return msri_disc_pair_meets(&p);
}

/* Does anything meet, or overlap? Bodies of which masses do become hot. Lists are good for the
 * paths. */
bool msri_encounters_are_hot(const msri_encounters *c);

/* Lists the pairs that are so close that pushes in this drift may reach from one to the other;
 * false: they are too many. */
bool msri_encounters_list_close(msri_encounters *c);

/* Lists the pairs that meet as they go so far, on paths of any length. Are there any? */
bool msri_encounters_list_meeting(msri_encounters *c);

#endif
