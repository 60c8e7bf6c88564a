/* drift.h - a drift of discs under way: what collisions change of it; see drift.c. */
#ifndef MSRI_DRIFT_H
#define MSRI_DRIFT_H

#include "contacts/contact.h"
#include "contacts/disc_pair.h"

#include <math.h>

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
  const msri_vec path = {(x[j] - x0[j]) - (x[i] - x0[i]), (y[j] - y0[j]) - (y[i] - y0[i])};
  return (msri_disc_pair){i, j, from, path, d->diameter, d->parts ? d->apart : 0};
}

/* ---- One mass */

/* What forces change its velocity by in the step. */
static inline msri_vec msri_drift_kick_of(const msri_drift *d, size_t i) {
  if (!d->kick) return (msri_vec){0, 0};
  return (msri_vec){d->unit * d->kick[i], d->unit * d->kick[d->n + i]};
}

/* Its velocity, `later` of a kick after v. */
static inline msri_vec msri_drift_velocity_at(const msri_drift *d, size_t i, double later) {
  const msri_vec kick = msri_drift_kick_of(d, i);
  return (msri_vec){d->v[i] + later * kick.x, d->v[d->n + i] + later * kick.y};
}

/* In the middle of the step, and at its end. */
static inline msri_vec msri_drift_velocity(const msri_drift *d, size_t i) {
  return msri_drift_velocity_at(d, i, -d->behind);
}

static inline msri_vec msri_drift_end_velocity(const msri_drift *d, size_t i) {
  return msri_drift_velocity_at(d, i, 0.5 - d->behind);
}

/* The speed below which i and j would be back at each other in a few steps. */
static inline double msri_drift_slow_speed(const msri_drift *d, size_t i, size_t j) {
  const msri_vec a = msri_drift_kick_of(d, i), b = msri_drift_kick_of(d, j);
  return 2 * (sqrt(a.x * a.x + a.y * a.y) + sqrt(b.x * b.x + b.y * b.y));
}

static inline msri_vec msri_drift_path_of(const msri_drift *d, size_t i) {
  return (msri_vec){d->q[i] - d->q0[i], d->q[d->n + i] - d->q0[d->n + i]};
}

/* It goes `path` now. */
static inline void msri_drift_redirect(const msri_drift *d, size_t i, msri_vec path) {
  d->q[i] = d->q0[i] + path.x, d->q[d->n + i] = d->q0[d->n + i] + path.y;
  d->pass[i] = d->passes;
}

static inline void msri_drift_speed_up(const msri_drift *d, size_t i, double x, double y) {
  d->v[i] += x, d->v[d->n + i] += y;
  if (d->debts) msri_debts_cancel(d->debts, i);
}

/* Neither has been pushed since the pair was looked at in the last pass. */
static inline bool msri_drift_as_it_was(const msri_drift *d, size_t i, size_t j) {
  return d->pass[i] < d->since && d->pass[j] < d->since;
}

/* ---- Energy */

/* What a change of paths by D does to the kinetic energy if velocities change by f D: the sum of
 * f m v.D + f^2 m D.D / 2. */
typedef struct msri_work {
  double linear, square;
} msri_work;

static inline void msri_drift_do_work(msri_work *w, double m, msri_vec v, msri_vec change) {
  w->linear += m * (v.x * change.x + v.y * change.y);
  w->square += m * (change.x * change.x + change.y * change.y);
}

/* The factor f, or, if that would take more energy than collisions have lost, one that doesn't. */
double msri_drift_allowed(msri_drift *d, const msri_work *w, double f);

/* ---- Pairs */

/* If the pair meets, puts it right. Returns whether it met. */
bool msri_drift_collide(msri_drift *d, size_t i, size_t j);

/* After all collisions: if the pair touches, and is slow, it has no normal velocity at the end of
 * the step. Returns whether that changed anything. */
bool msri_drift_rest(msri_drift *d, size_t i, size_t j);

#endif
