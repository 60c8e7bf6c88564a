/* drift.h - a drift of discs under way: what collisions change of it. */
#ifndef MSRI_DRIFT_H
#define MSRI_DRIFT_H

#include "contacts/contact.h"
#include "contacts/disc_pair.h"
#include "contacts/near.h"

typedef struct msri_drift {
  size_t n;
  const double *m; /* mass i is m[i * m_stride] */
  size_t m_stride;
  double diameter, restitution;
  const msri_contact *supports;
  double h;
  const double *q0;    /* [2n]: places before */
  double *q, *v;       /* [2n]: places after, so far */
  const double *kick;  /* [2n]: in units of 1 / `unit`, what forces change velocities by in h; NULL:
                        * nothing */
  double unit, behind; /* v is ahead of the velocity in the middle by that share of it */
  bool rests;          /* slow contacts end without a relative velocity, see drift.c */
  signed char *held;   /* [2n]: a support stopped it on its way up, 1, or down, -1 */
  msri_debts *debts;   /* of the supports; may be NULL */
  double apart;        /* by which discs that overlap may part [px] */
  double most;         /* how far one may be pushed [px] */
  uint32_t *zone, *next; /* [n]: the zone that a mass is of, and the next mass of it */
  uint32_t *pass;        /* [n]: the last pass in which it was pushed */
  uint32_t passes;       /* the one under way */
  uint32_t since;        /* pairs that weren't pushed since this one are as they were */
  bool parts;            /* it only moves apart discs that overlap: velocities are left alone */
  double lost;           /* kinetic energy, in collisions of this drift */
  uint64_t collisions;
} msri_drift;

static inline double msri_drift_mass(const msri_drift *d, size_t i) {
  return d->m[i * d->m_stride];
}

/* The pair as it goes so far. */
static inline msri_disc_pair msri_drift_pair(const msri_drift *d, size_t i, size_t j) {
  const double *x0 = d->q0, *y0 = x0 + d->n, *x = d->q, *y = x + d->n;
  const msri_vec from = {x0[j] - x0[i], y0[j] - y0[i]};
  const msri_vec way = {(x[j] - x0[j]) - (x[i] - x0[i]), (y[j] - y0[j]) - (y[i] - y0[i])};
  return (msri_disc_pair){i, j, from, way, d->diameter, d->parts ? d->apart : 0};
}

/* If the pair meets, puts it right. Returns whether it met. */
bool msri_drift_collide(msri_drift *d, size_t i, size_t j);

/* After all collisions: if the pair touches, and is slow, it has no normal velocity at the end of
 * the step. Returns whether that changed anything. */
bool msri_drift_rest(msri_drift *d, size_t i, size_t j);

/* Every mass is a zone by itself. */
void msri_drift_part(msri_drift *d);

/* If the pair meets, makes one zone of theirs. Returns whether it did. */
bool msri_drift_join(msri_drift *d, size_t i, size_t j);

/* Makes one zone of all. */
void msri_drift_join_all(msri_drift *d);

#endif
