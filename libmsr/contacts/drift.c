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

/* Changes its way, and its velocity. */
static void move(const msri_drift *d, size_t i, double x, double y) {
  d->q[i] += x, d->q[d->n + i] += y;
  d->pass[i] = d->passes;
}

static void speed_up(const msri_drift *d, size_t i, double x, double y) {
  d->v[i] += x, d->v[d->n + i] += y;
  if (d->owed) d->owed[i] = d->owed[d->n + i] = 0;
}

/* Supports stop a mass that was pushed. */
static void obstruct(const msri_drift *d, size_t i) {
  const size_t n = d->n;
  const double from[] = {d->q0[i], d->q0[n + i]};
  double to[] = {d->q[i], d->q[n + i]};
  if (!d->supports->stop || !d->supports->stop(d->supports->self, from, to)) return;
  for (size_t k = 0; k < 2; k++) {
    const size_t c = i + k * n;
    const double speed = d->v[c] - (d->kick ? d->behind * d->kick[c] : 0);
    if (!d->parts && (to[k] - d->q[c]) * speed < 0) d->v[c] -= (1 + d->restitution) * speed;
    d->q[c] = to[k];
  }
  d->pass[i] = d->passes;
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

/* The share of a push by which neither goes further than it may. */
static double share_of(const msri_drift *d, const msri_disc_pair *p, msri_vec n, double si,
                       double sj) {
  const double most2 = d->most * d->most;
  for (double share = 1; share > 0x1p-10; share /= 2)
    if (way2(d, p->i, share * si * n.x, share * si * n.y) <= most2 &&
        way2(d, p->j, share * sj * n.x, share * sj * n.y) <= most2)
      return share;
  return 0;
}

/* Pushes the two apart by `s` along n, their centre of mass staying where it is, and changes by
 * `change` the speed at which they part. */
static void push_apart(const msri_drift *d, const msri_disc_pair *p, msri_vec n, double s,
                       double change) {
  const double mi = msri_drift_mass(d, p->i), mj = msri_drift_mass(d, p->j);
  const double of_i = -(mj / (mi + mj)), of_j = mi / (mi + mj);
  const double way = s * share_of(d, p, n, s * of_i, s * of_j);
  move(d, p->i, way * of_i * n.x, way * of_i * n.y);
  move(d, p->j, way * of_j * n.x, way * of_j * n.y);
  speed_up(d, p->i, change * of_i * n.x, change * of_i * n.y);
  speed_up(d, p->j, change * of_j * n.x, change * of_j * n.y);
}

/* The change of speed that goes with a push by `s`, no more than the energy lost so far allows. */
static double change_for(msri_drift *d, const msri_disc_pair *p, msri_vec n, double s) {
  const double mi = msri_drift_mass(d, p->i), mj = msri_drift_mass(d, p->j);
  const double half = mi / (mi + mj) * mj / 2, speed = approach(d, p, n);
  const double most = sqrt(speed * speed + d->lost / half);
  const double after = msri_min(most, (1 + restitution_of(d, p, n, speed)) * s / d->h - speed);
  d->lost = msri_max(0, d->lost + half * (speed * speed - after * after));
  d->collisions += speed > 0;
  return speed + after;
}

bool msri_drift_collide(msri_drift *d, size_t i, size_t j) {
  if (d->pass[i] + 1 < d->passes && d->pass[j] + 1 < d->passes) return false; // as it was
  const msri_disc_pair p = msri_drift_pair(d, i, j);
  if (!msri_disc_pair_meets(&p)) return false;
  const msri_vec n = msri_disc_pair_normal(&p, d->restitution);
  const double s = msri_disc_pair_gap(&p) - (p.way.x * n.x + p.way.y * n.y);
  if (!(s > 0)) return false;
  push_apart(d, &p, n, s, d->parts ? 0 : change_for(d, &p, n, s));
  obstruct(d, i);
  obstruct(d, j);
  return true;
}

/* ---- Crowds: rings of masses that go the same way */

void msri_drift_part(msri_drift *d) {
  for (size_t i = 0; i < d->n; i++) d->crowd[i] = d->next[i] = (uint32_t)i;
  d->joined = true;
}

/* The mean of a vector [2n] and another times `factor` over a crowd, by mass. */
static msri_vec mean_of(const msri_drift *d, size_t first, const double *of, const double *other,
                        double factor) {
  const size_t n = d->n;
  double x = 0, y = 0, sum = 0;
  size_t i = first;
  do {
    const double m = msri_drift_mass(d, i);
    x += m * (of[i] + (other ? factor * other[i] : 0));
    y += m * (of[n + i] + (other ? factor * other[n + i] : 0));
    sum += m;
  } while ((i = d->next[i]) != first);
  return (msri_vec){x / sum, y / sum};
}

static void go_together(const msri_drift *d, size_t first, msri_vec way) {
  size_t i = first;
  do {
    d->q[i] = d->q0[i] + way.x;
    d->q[d->n + i] = d->q0[d->n + i] + way.y;
  } while ((i = d->next[i]) != first);
}

static bool is_stopped(const msri_drift *d, size_t first) {
  size_t i = first;
  if (!d->supports->stop) return false;
  do {
    const double from[] = {d->q0[i], d->q0[d->n + i]};
    double to[] = {d->q[i], d->q[d->n + i]};
    if (d->supports->stop(d->supports->self, from, to)) return true;
  } while ((i = d->next[i]) != first);
  return false;
}

static void swap_next(const msri_drift *d, size_t i, size_t j) {
  const uint32_t after = d->next[i];
  d->next[i] = d->next[j], d->next[j] = after;
}

/* The joint crowd goes the way of its centre of mass; or, if that leads into a support, nowhere. */
bool msri_drift_join(msri_drift *d, size_t i, size_t j) {
  const msri_disc_pair p = msri_drift_pair(d, i, j);
  if (d->crowd[i] == d->crowd[j] || !msri_disc_pair_meets(&p)) return false;
  for (size_t k = j; d->crowd[k] != d->crowd[i]; k = d->next[k]) d->crowd[k] = d->crowd[i];
  swap_next(d, i, j);
  go_together(d, i, mean_of(d, i, d->q, d->q0, -1));
  if (is_stopped(d, i)) go_together(d, i, (msri_vec){0, 0});
  return true;
}

void msri_drift_join_all(msri_drift *d) {
  for (size_t i = 0; i < d->n; i++) d->crowd[i] = 0, d->next[i] = (uint32_t)((i + 1) % d->n);
  go_together(d, 0, mean_of(d, 0, d->q, d->q0, -1));
  if (is_stopped(d, 0)) go_together(d, 0, (msri_vec){0, 0});
}

/* Reflects the velocities of a crowd in the middle of the step against that of its centre of mass;
 * or, if it went nowhere as supports stopped it, against these. */
static void turn(msri_drift *d, size_t first) {
  const size_t n = d->n;
  const bool stays =
      d->supports->stop && d->q[first] == d->q0[first] && d->q[n + first] == d->q0[n + first];
  const msri_vec mean = stays ? (msri_vec){0, 0} : mean_of(d, first, d->v, d->kick, -d->behind);
  size_t i = first;
  do {
    const double kx = d->kick ? d->behind * d->kick[i] : 0,
                 ky = d->kick ? d->behind * d->kick[n + i] : 0;
    const double change = 1 + d->restitution;
    speed_up(d, i, change * (mean.x - (d->v[i] - kx)), change * (mean.y - (d->v[n + i] - ky)));
  } while ((i = d->next[i]) != first);
  d->collisions++;
}

void msri_drift_turn(msri_drift *d) {
  for (size_t i = 0; i < d->n; i++)
    if (d->next[i] != i && d->crowd[i] == i) turn(d, i);
}
