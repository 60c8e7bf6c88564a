/* course.h - a drift, and the pairs of it that are looked at. */
#ifndef MSRI_COURSE_H
#define MSRI_COURSE_H

#include "contacts/drift.h"
#include "contacts/lists.h"

typedef struct msri_course {
  msri_drift *d;
  msri_lists *lists;
  msri_pair *pair; /* [n]: those that are close, or that meet, ascending */
  size_t n;
  bool full; /* there are more */
} msri_course;

/* Longer ways than this, in diameters, are fast. */
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
 * ways. */
bool msri_course_is_hot(const msri_course *course);

/* Lists the pairs that are so close that pushes in this drift may reach from one to the other;
 * false: they are too many. */
bool msri_course_list_close(msri_course *course);

/* Lists the pairs that meet as they go so far, on ways of any length. Are there any? */
bool msri_course_list_meeting(msri_course *course);

#endif
