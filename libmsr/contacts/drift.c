/* drift.c - ways and velocities of discs that meet, changed together.
 *
 * A free drift is d = h v. Whatever changes a way by D changes the velocity by (1 + e) D / h. If in
 * the end no pair's way leads them together, and all D are sums of s n / m with s > 0, n the normal
 * of a pair, then <d, h v - d> >= 0 in the metric of the masses, and so the new velocity has no
 * more kinetic energy than v, and just as much if e = 1 and nobody was pushed away from whom he had
 * met (Moreau 1988, Unilateral contact and dry friction in finite freedom dynamics). And as the way
 * is the mean of both velocities if e = 1, the work of the forces on it is what it should be: no
 * heat.
 *
 * What can't be so solved becomes a crowd: all of it go the way of its centre of mass, so that
 * nobody comes nearer to anybody, and the velocities against that centre are reversed. */
#include "contacts/drift.h"

#include <math.h>

/* ---- One mass */

/* Changes its way by (x, y) and its velocity with it. */
static void push(const msri_drift *d, size_t i, double x, double y, double factor) {
  d->q[i] += x, d->q[d->n + i] += y;
  d->v[i] += factor * x, d->v[d->n + i] += factor * y;
  d->pass[i] = d->passes;
  if (d->owed) d->owed[i] = d->owed[d->n + i] = 0;
}

/* Supports stop a mass that was pushed. Did they? */
static bool obstruct(msri_drift *d, size_t i) {
  const size_t n = d->n;
  const double from[] = {d->q0[i], d->q0[n + i]};
  double to[] = {d->q[i], d->q[n + i]};
  if (!d->supports->stop || !d->supports->stop(d->supports->self, from, to)) return false;
  const double factor = (1 + d->restitution) / d->h;
  push(d, i, to[0] - d->q[i], to[1] - d->q[n + i], factor);
  d->q[i] = to[0], d->q[n + i] = to[1]; // without rounding
  return true;
}

static double way2(const msri_drift *d, size_t i, double x, double y) {
  const double dx = d->q[i] + x - d->q0[i], dy = d->q[d->n + i] + y - d->q0[d->n + i];
  return dx * dx + dy * dy;
}

/* ---- A pair */

static double kick_along(const msri_drift *d, size_t i, msri_vec n) {
  return d->kick ? d->kick[i] * n.x + d->kick[d->n + i] * n.y : 0;
}

/* The speed at which the two come together in the middle of the step. */
static double approach(const msri_drift *d, const msri_disc_pair *p, msri_vec n) {
  const double *vx = d->v, *vy = vx + d->n;
  const double now = (vx[p->i] - vx[p->j]) * n.x + (vy[p->i] - vy[p->j]) * n.y;
  return now - d->behind * (kick_along(d, p->i, n) - kick_along(d, p->j, n));
}

/* The restitution of two that meet along n. They rest on each other if, with what e leaves them of
 * their speed, half a kick brings them back: then they leave with what that takes away. */
static double restitution_of(const msri_drift *d, const msri_disc_pair *p, msri_vec n,
                             double speed) {
  const double e = d->restitution;
  if (e == 1 || !(speed > 0)) return e;
  const double ki = d->half * kick_along(d, p->i, n), kj = d->half * kick_along(d, p->j, n);
  if (e * speed > fabs(ki) + fabs(kj)) return e;
  return msri_min(1, msri_max(0, ki - kj) / speed);
}

/* Pushes the two apart by `s` along n, their centre of mass staying where it is; no further than
 * anyone may be pushed. */
static void push_apart(const msri_drift *d, const msri_disc_pair *p, msri_vec n, double s,
                       double factor) {
  const double mi = msri_drift_mass(d, p->i), mj = msri_drift_mass(d, p->j);
  const double si = -s * (mj / (mi + mj)), sj = s * (mi / (mi + mj)), most2 = d->most * d->most;
  double share = 1;
  while (share > 0x1p-10 && (way2(d, p->i, share * si * n.x, share * si * n.y) > most2 ||
                             way2(d, p->j, share * sj * n.x, share * sj * n.y) > most2))
    share /= 2;
  if (share <= 0x1p-10) return;
  push(d, p->i, share * si * n.x, share * si * n.y, factor);
  push(d, p->j, share * sj * n.x, share * sj * n.y, factor);
}

bool msri_drift_collide(msri_drift *d, size_t i, size_t j) {
  if (d->pass[i] + 1 < d->passes && d->pass[j] + 1 < d->passes) return false; // as it was
  const msri_disc_pair p = msri_drift_pair(d, i, j, d->apart);
  if (!msri_disc_pair_meets(&p)) return false;
  const msri_vec n = msri_disc_pair_normal(&p, d->restitution);
  const double way = p.way.x * n.x + p.way.y * n.y, gap = msri_disc_pair_gap(&p);
  if (way < 0) {
    const double speed = approach(d, &p, n);
    push_apart(d, &p, n, -way, (1 + restitution_of(d, &p, n, speed)) / d->h);
    d->collisions += speed > 0;
  }
  if (way < gap) push_apart(d, &p, n, gap - msri_max(0, way), 0);
  obstruct(d, i);
  obstruct(d, j);
  return true;
}

/* ---- Crowds: rings of masses that go the same way */

void msri_drift_part(msri_drift *d) {
  for (size_t i = 0; i < d->n; i++) d->crowd[i] = d->next[i] = (uint32_t)i;
}

static void go_together(const msri_drift *d, size_t first, double x, double y) {
  const double factor = (1 + d->restitution) / d->h;
  const size_t n = d->n;
  size_t i = first;
  do {
    const double to_x = d->q0[i] + x, to_y = d->q0[n + i] + y;
    push(d, i, to_x - d->q[i], to_y - d->q[n + i], factor);
    d->q[i] = to_x, d->q[n + i] = to_y; // without rounding
  } while ((i = d->next[i]) != first);
}

static bool is_stopped(const msri_drift *d, size_t first) {
  const size_t n = d->n;
  size_t i = first;
  if (!d->supports->stop) return false;
  do {
    const double from[] = {d->q0[i], d->q0[n + i]};
    double to[] = {d->q[i], d->q[n + i]};
    if (d->supports->stop(d->supports->self, from, to)) return true;
  } while ((i = d->next[i]) != first);
  return false;
}

/* A crowd goes the way of its centre of mass; or, if that leads into a support, nowhere. */
static void settle_crowd(msri_drift *d, size_t first) {
  const size_t n = d->n;
  double x = 0, y = 0, sum = 0;
  size_t i = first;
  do {
    const double m = msri_drift_mass(d, i);
    x += m * (d->q[i] - d->q0[i]), y += m * (d->q[n + i] - d->q0[n + i]);
    sum += m;
  } while ((i = d->next[i]) != first);
  go_together(d, first, x / sum, y / sum);
  if (is_stopped(d, first)) go_together(d, first, 0, 0);
}

static void swap_next(msri_drift *d, size_t i, size_t j) {
  const uint32_t after = d->next[i];
  d->next[i] = d->next[j], d->next[j] = after;
}

bool msri_drift_join(msri_drift *d, size_t i, size_t j) {
  const msri_disc_pair p = msri_drift_pair(d, i, j, 0);
  if (d->crowd[i] == d->crowd[j] || !msri_disc_pair_meets(&p)) return false;
  for (size_t k = j; d->crowd[k] != d->crowd[i]; k = d->next[k]) d->crowd[k] = d->crowd[i];
  swap_next(d, i, j);
  settle_crowd(d, i);
  d->collisions++;
  return true;
}

void msri_drift_join_all(msri_drift *d) {
  for (size_t i = 0; i < d->n; i++) d->next[i] = (uint32_t)((i + 1) % d->n);
  settle_crowd(d, 0);
}
