/* drift.c - paths and velocities of discs that meet, changed together.
 *
 * A free drift is d = h v. Whatever changes a path by D changes the velocity by (1 + e) D / h. If
 * in the end no pair's path leads them together, and all D are sums of s n / m with s > 0, n the
 * normal of a pair, then <d, h v - d> >= 0 in the metric of the masses, and so the new velocity has
 * no more kinetic energy than v, and just as much if e = 1 and nobody was pushed away from whom he
 * had met (Moreau 1988, Unilateral contact and dry friction in finite freedom dynamics). And as the
 * path is the mean of both velocities if e = 1, the work of the forces on it is what it should be:
 * no heat.
 *
 * Slow contacts come to rest where e < 1. Half a kick is still to come: paths and velocities are
 * changed as if e were 1, which alone leaves at rest what was at rest; discs go as near as
 * touching; and then what is left of the normal velocity at the end of the step, v + h a / 2, is
 * taken from pairs that touch, one after the other. Each time that only loses energy. */
#include "contacts/drift.h"

/* ---- Energy */

double msri_drift_allowed(msri_drift *d, const msri_work *w, double f) {
  if (d->parts) return 0;
  if (f * (w->linear + f * w->square / 2) > d->lost) {
    const double root = sqrt(w->linear * w->linear + 2 * w->square * d->lost);
    f = w->square > 0 ? msri_max(0, root - w->linear) / w->square : 0;
  }
  d->lost = msri_max(0, d->lost - f * (w->linear + f * w->square / 2));
  return f;
}

/* ---- One mass */

static bool is_slow(const msri_drift *d, double speed, size_t i, size_t j) {
  return d->rests && fabs(speed) <= msri_drift_slow_speed(d, i, j);
}

/* The factor of a change of velocity: slow contacts first keep their energy, see msri_drift_rest.
 */
static double factor(const msri_drift *d, bool slow) {
  return (slow ? 2 : 1 + d->restitution) / d->h;
}

/* Supports stop a mass that was pushed. */
static void obstruct(msri_drift *d, size_t i) {
  const size_t n = d->n;
  const double from[] = {d->q0[i], d->q0[n + i]};
  double to[] = {d->q[i], d->q[n + i]};
  msri_work w = {0};
  if (!d->supports->stop || !d->supports->stop(d->supports->self, from, to)) return;
  const msri_vec change = {to[0] - d->q[i], to[1] - d->q[n + i]};
  const msri_vec v = msri_drift_velocity(d, i);
  msri_drift_do_work(&w, msri_drift_mass(d, i), v, change);
  const double speed = fabs(change.x) > fabs(change.y) ? v.x : v.y;
  const double f = msri_drift_allowed(d, &w, factor(d, is_slow(d, speed, i, i)));
  msri_drift_speed_up(d, i, f * change.x, f * change.y);
  if (change.x != 0) d->held[i] = change.x > 0 ? -1 : 1;
  if (change.y != 0) d->held[n + i] = change.y > 0 ? -1 : 1;
  d->q[i] = to[0], d->q[n + i] = to[1];
  d->pass[i] = d->passes;
}

/* ---- A pair */

/* Would it go further than it may? */
static bool is_too_far(const msri_drift *d, size_t i, msri_vec n, double s) {
  const msri_vec path = msri_drift_path_of(d, i);
  const double x = path.x + s * n.x, y = path.y + s * n.y;
  return x * x + y * y > d->most * d->most;
}

static double approach(const msri_drift *d, const msri_disc_pair *p, msri_vec n) {
  const msri_vec vi = msri_drift_velocity(d, p->i), vj = msri_drift_velocity(d, p->j);
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
  const msri_work w = {-m * speed * s, m * s * s};
  const double f = s * msri_drift_allowed(d, &w, factor(d, is_slow(d, speed, i, j)));
  const msri_vec di = msri_drift_path_of(d, i), dj = msri_drift_path_of(d, j);
  msri_drift_redirect(d, i, (msri_vec){di.x + s * of_i * n.x, di.y + s * of_i * n.y});
  msri_drift_redirect(d, j, (msri_vec){dj.x + s * of_j * n.x, dj.y + s * of_j * n.y});
  msri_drift_speed_up(d, i, f * of_i * n.x, f * of_i * n.y);
  msri_drift_speed_up(d, j, f * of_j * n.x, f * of_j * n.y);
  d->collisions += speed > 0 && !d->parts;
}

bool msri_drift_collide(msri_drift *d, size_t i, size_t j) {
  if (msri_drift_as_it_was(d, i, j)) return false;
  const msri_disc_pair p = msri_drift_pair(d, i, j);
  if (!msri_disc_pair_meets(&p)) return false;
  const msri_vec n = msri_disc_pair_normal(&p, d->restitution);
  const double s = gap(d, &p, n) - (p.path.x * n.x + p.path.y * n.y);
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
  const msri_vec end = msri_drift_end_velocity(d, i);
  msri_drift_speed_up(d, i, d->held[i] * (end.x + x) > 0 ? -end.x : x,
                      d->held[n + i] * (end.y + y) > 0 ? -end.y : y);
}

bool msri_drift_rest(msri_drift *d, size_t i, size_t j) {
  if (d->pass[i] == 0 && d->pass[j] == 0) return false;
  const double slow = msri_drift_slow_speed(d, i, j), reach = d->diameter + d->h * slow;
  const double *x = d->q, *y = x + d->n, rx = x[j] - x[i], ry = y[j] - y[i];
  const double r2 = rx * rx + ry * ry, r = sqrt(r2);
  if (!(r2 > 0 && r2 <= reach * reach)) return false;
  const msri_vec vi = msri_drift_end_velocity(d, i), vj = msri_drift_end_velocity(d, j);
  const double speed = ((vj.x - vi.x) * rx + (vj.y - vi.y) * ry) / r;
  if (speed == 0 || !(fabs(speed) <= slow)) return false;
  const double mi = msri_drift_mass(d, i), mj = msri_drift_mass(d, j);
  const double of_i = speed * mj / (mi + mj) / r, of_j = -speed * mi / (mi + mj) / r;
  nudge(d, i, of_i * rx, of_i * ry);
  nudge(d, j, of_j * rx, of_j * ry);
  return true;
}
