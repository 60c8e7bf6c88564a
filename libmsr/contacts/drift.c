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
 * Slow contacts come to rest where e < 1. Half a kick is still to come: ways and velocities are
 * changed as if e were 1, which alone leaves at rest what was at rest; discs go as near as
 * touching; and then what is left of the normal velocity at the end of the step, v + h a / 2, is
 * taken from pairs that touch, one after the other. Each time that only loses energy.
 *
 * What can't be so solved becomes a zone of impact (Provot 1997, Collision and self-collision
 * handling in cloth model): all of it go the way of its centre of mass, so that nobody comes nearer
 * to anybody, and the velocities against that centre are reversed, or vanish if they are slow. */
#include "contacts/drift.h"

#include <math.h>

/* ---- Energy */

/* What a change of ways by D does to the kinetic energy if velocities change by f D: the sum of
 * f m v.D + f^2 m D.D / 2. */
typedef struct work {
  double linear, square;
} work;

static void do_work(work *w, double m, msri_vec v, msri_vec change) {
  w->linear += m * (v.x * change.x + v.y * change.y);
  w->square += m * (change.x * change.x + change.y * change.y);
}

/* The factor f, or, if that would take more energy than collisions have lost, one that doesn't. */
static double allowed(msri_drift *d, const work *w, double f) {
  if (d->parts) return 0;
  if (f * (w->linear + f * w->square / 2) > d->lost) {
    const double root = sqrt(w->linear * w->linear + 2 * w->square * d->lost);
    f = w->square > 0 ? msri_max(0, root - w->linear) / w->square : 0;
  }
  d->lost = msri_max(0, d->lost - f * (w->linear + f * w->square / 2));
  return f;
}

/* ---- One mass */

/* What forces change its velocity by in the step. */
static msri_vec kick_of(const msri_drift *d, size_t i) {
  if (!d->kick) return (msri_vec){0, 0};
  return (msri_vec){d->unit * d->kick[i], d->unit * d->kick[d->n + i]};
}

/* Its velocity, `later` of a kick after v. */
static msri_vec velocity_at(const msri_drift *d, size_t i, double later) {
  const msri_vec kick = kick_of(d, i);
  return (msri_vec){d->v[i] + later * kick.x, d->v[d->n + i] + later * kick.y};
}

/* In the middle of the step, and at its end. */
static msri_vec velocity(const msri_drift *d, size_t i) { return velocity_at(d, i, -d->behind); }

static msri_vec end_velocity(const msri_drift *d, size_t i) {
  return velocity_at(d, i, 0.5 - d->behind);
}

/* The speed below which i and j would be back at each other in a few steps. */
static double slow_speed(const msri_drift *d, size_t i, size_t j) {
  const msri_vec a = kick_of(d, i), b = kick_of(d, j);
  return 2 * (sqrt(a.x * a.x + a.y * a.y) + sqrt(b.x * b.x + b.y * b.y));
}

static bool is_slow(const msri_drift *d, double speed, size_t i, size_t j) {
  return d->rests && fabs(speed) <= slow_speed(d, i, j);
}

/* The factor of a change of velocity: slow contacts first keep their energy, see msri_drift_rest.
 */
static double factor(const msri_drift *d, bool slow) {
  return (slow ? 2 : 1 + d->restitution) / d->h;
}

static msri_vec way_of(const msri_drift *d, size_t i) {
  return (msri_vec){d->q[i] - d->q0[i], d->q[d->n + i] - d->q0[d->n + i]};
}

/* It goes `way` now. */
static void redirect(const msri_drift *d, size_t i, msri_vec way) {
  d->q[i] = d->q0[i] + way.x, d->q[d->n + i] = d->q0[d->n + i] + way.y;
  d->pass[i] = d->passes;
}

static void speed_up(const msri_drift *d, size_t i, double x, double y) {
  d->v[i] += x, d->v[d->n + i] += y;
  if (d->debts) msri_debts_cancel(d->debts, i);
}

/* Supports stop a mass that was pushed. */
static void obstruct(msri_drift *d, size_t i) {
  const size_t n = d->n;
  const double from[] = {d->q0[i], d->q0[n + i]};
  double to[] = {d->q[i], d->q[n + i]};
  work w = {0};
  if (!d->supports->stop || !d->supports->stop(d->supports->self, from, to)) return;
  const msri_vec change = {to[0] - d->q[i], to[1] - d->q[n + i]};
  const msri_vec v = velocity(d, i);
  do_work(&w, msri_drift_mass(d, i), v, change);
  const double speed = fabs(change.x) > fabs(change.y) ? v.x : v.y;
  const double f = allowed(d, &w, factor(d, is_slow(d, speed, i, i)));
  speed_up(d, i, f * change.x, f * change.y);
  if (change.x != 0) d->held[i] = change.x > 0 ? -1 : 1;
  if (change.y != 0) d->held[n + i] = change.y > 0 ? -1 : 1;
  d->q[i] = to[0], d->q[n + i] = to[1];
  d->pass[i] = d->passes;
}

/* ---- A pair */

/* Would it go further than it may? */
static bool is_too_far(const msri_drift *d, size_t i, msri_vec n, double s) {
  const msri_vec way = way_of(d, i);
  const double x = way.x + s * n.x, y = way.y + s * n.y;
  return x * x + y * y > d->most * d->most;
}

static double approach(const msri_drift *d, const msri_disc_pair *p, msri_vec n) {
  const msri_vec vi = velocity(d, p->i), vj = velocity(d, p->j);
  return (vi.x - vj.x) * n.x + (vi.y - vj.y) * n.y;
}

/* How far along n the two are to go: those that are slow touch in the end, so that no gap stays
 * between those that rest. */
static double gap(const msri_drift *d, const msri_disc_pair *p, msri_vec n) {
  if (!is_slow(d, approach(d, p, n), p->i, p->j)) return msri_disc_pair_gap(p);
  const msri_vec r = p->from;
  return msri_disc_pair_floor(p, r.x * r.x + r.y * r.y) - (r.x * n.x + r.y * n.y);
}

/* Pushes two apart by s along n, their centre of mass staying where it is; by less if one would go
 * too far. */
static void push_apart(msri_drift *d, const msri_disc_pair *p, msri_vec n, double s) {
  const size_t i = p->i, j = p->j;
  const double mi = msri_drift_mass(d, i), mj = msri_drift_mass(d, j);
  const double of_i = -(mj / (mi + mj)), of_j = mi / (mi + mj);
  while (s > 0 && (is_too_far(d, i, n, s * of_i) || is_too_far(d, j, n, s * of_j)))
    s = s > 1e-12 * d->diameter ? s / 2 : 0;
  if (s == 0) return;
  const double speed = approach(d, p, n), m = mj * of_j;
  const work w = {-m * speed * s, m * s * s};
  const double f = s * allowed(d, &w, factor(d, is_slow(d, speed, i, j)));
  const msri_vec di = way_of(d, i), dj = way_of(d, j);
  redirect(d, i, (msri_vec){di.x + s * of_i * n.x, di.y + s * of_i * n.y});
  redirect(d, j, (msri_vec){dj.x + s * of_j * n.x, dj.y + s * of_j * n.y});
  speed_up(d, i, f * of_i * n.x, f * of_i * n.y);
  speed_up(d, j, f * of_j * n.x, f * of_j * n.y);
  d->collisions += speed > 0 && !d->parts;
}

/* Neither has been pushed since the pair was looked at in the last pass. */
static bool is_as_it_was(const msri_drift *d, size_t i, size_t j) {
  return d->pass[i] < d->since && d->pass[j] < d->since;
}

bool msri_drift_collide(msri_drift *d, size_t i, size_t j) {
  if (is_as_it_was(d, i, j)) return false;
  const msri_disc_pair p = msri_drift_pair(d, i, j);
  if (!msri_disc_pair_meets(&p)) return false;
  const msri_vec n = msri_disc_pair_normal(&p, d->restitution);
  const double s = gap(d, &p, n) - (p.way.x * n.x + p.way.y * n.y);
  if (!(s > 0)) return false;
  push_apart(d, &p, n, s);
  obstruct(d, i);
  obstruct(d, j);
  return true;
}

/* ---- Rest */

/* Changes its velocity by (x, y), but for what leads into a support that has stopped it. */
static void nudge(msri_drift *d, size_t i, double x, double y) {
  const size_t n = d->n;
  const msri_vec end = end_velocity(d, i);
  speed_up(d, i, d->held[i] * (end.x + x) > 0 ? -end.x : x,
           d->held[n + i] * (end.y + y) > 0 ? -end.y : y);
}

bool msri_drift_rest(msri_drift *d, size_t i, size_t j) {
  if (d->pass[i] == 0 && d->pass[j] == 0) return false;
  const double slow = slow_speed(d, i, j), reach = d->diameter + d->h * slow;
  const double *x = d->q, *y = x + d->n, rx = x[j] - x[i], ry = y[j] - y[i];
  const double r2 = rx * rx + ry * ry, r = sqrt(r2);
  if (!(r2 > 0 && r2 <= reach * reach)) return false;
  const msri_vec vi = end_velocity(d, i), vj = end_velocity(d, j);
  const double speed = ((vj.x - vi.x) * rx + (vj.y - vi.y) * ry) / r;
  if (speed == 0 || !(fabs(speed) <= slow)) return false;
  const double mi = msri_drift_mass(d, i), mj = msri_drift_mass(d, j);
  const double of_i = speed * mj / (mi + mj) / r, of_j = -speed * mi / (mi + mj) / r;
  nudge(d, i, of_i * rx, of_i * ry);
  nudge(d, j, of_j * rx, of_j * ry);
  return true;
}

/* ---- Zones: rings of masses that go the same way */

void msri_drift_part(msri_drift *d) {
  for (size_t i = 0; i < d->n; i++) d->zone[i] = d->next[i] = (uint32_t)i;
}

/* The way of its centre of mass. */
static msri_vec common_way(const msri_drift *d, size_t first) {
  msri_vec sum = {0, 0};
  double mass = 0;
  size_t i = first;
  do {
    const double m = msri_drift_mass(d, i);
    const msri_vec way = way_of(d, i);
    sum.x += m * way.x, sum.y += m * way.y, mass += m;
  } while ((i = d->next[i]) != first);
  return (msri_vec){sum.x / mass, sum.y / mass};
}

/* Is nobody of it fast against its way? */
static bool goes_slowly(const msri_drift *d, size_t first, msri_vec way) {
  size_t i = first;
  if (!d->rests) return false;
  do {
    const msri_vec v = velocity(d, i);
    const double x = v.x - way.x / d->h, y = v.y - way.y / d->h, slow = slow_speed(d, i, i);
    if (!(x * x + y * y <= slow * slow)) return false;
  } while ((i = d->next[i]) != first);
  return true;
}

/* All of it go the way, and have one velocity in the end. */
static void rest_together(msri_drift *d, size_t first, msri_vec way) {
  msri_vec sum = {0, 0};
  double mass = 0;
  size_t i = first;
  do {
    const msri_vec v = end_velocity(d, i);
    const double m = msri_drift_mass(d, i);
    sum.x += m * v.x, sum.y += m * v.y, mass += m;
  } while ((i = d->next[i]) != first);
  if (way.x == 0 && way.y == 0) sum = way;
  do {
    const msri_vec v = end_velocity(d, i);
    speed_up(d, i, sum.x / mass - v.x, sum.y / mass - v.y);
    redirect(d, i, way);
  } while ((i = d->next[i]) != first);
}

static void go_together(msri_drift *d, size_t first, msri_vec way) {
  work w = {0};
  if (!d->parts && goes_slowly(d, first, way)) {
    rest_together(d, first, way);
    return;
  }
  size_t i = first;
  do {
    const msri_vec old = way_of(d, i);
    do_work(&w, msri_drift_mass(d, i), velocity(d, i), (msri_vec){way.x - old.x, way.y - old.y});
  } while ((i = d->next[i]) != first);
  const double f = allowed(d, &w, (1 + d->restitution) / d->h);
  do {
    const msri_vec old = way_of(d, i);
    speed_up(d, i, f * (way.x - old.x), f * (way.y - old.y));
    redirect(d, i, way);
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

/* The joint zone goes the way of its centre of mass; or, if that leads into a support, nowhere. */
bool msri_drift_join(msri_drift *d, size_t i, size_t j) {
  if (d->zone[i] == d->zone[j] || is_as_it_was(d, i, j)) return false;
  const msri_disc_pair p = msri_drift_pair(d, i, j);
  if (!msri_disc_pair_meets(&p)) return false;
  for (size_t k = j; d->zone[k] != d->zone[i]; k = d->next[k]) d->zone[k] = d->zone[i];
  swap_next(d, i, j);
  go_together(d, i, common_way(d, i));
  if (is_stopped(d, i)) go_together(d, i, (msri_vec){0, 0});
  return true;
}

void msri_drift_join_all(msri_drift *d) {
  for (size_t i = 0; i < d->n; i++) d->zone[i] = 0, d->next[i] = (uint32_t)((i + 1) % d->n);
  go_together(d, 0, common_way(d, 0));
  if (is_stopped(d, 0)) go_together(d, 0, (msri_vec){0, 0});
}
