/* zones.c - zones of impact (Provot 1997, Collision and self-collision handling in cloth model):
 * what can't be put right pair by pair all goes the way of its centre of mass, so that nobody comes
 * nearer to anybody, and the velocities against that centre are reversed, or vanish if they are
 * slow. A zone is a ring of masses. */
#include "contacts/zones.h"

void msri_zones_part(msri_drift *d) {
  for (size_t i = 0; i < d->n; i++) d->zone[i] = d->next[i] = (uint32_t)i;
}

/* That of its centre of mass. */
static msri_vec mean(const msri_drift *d, size_t first,
                     msri_vec (*of)(const msri_drift *d, size_t i)) {
  msri_vec sum = {0, 0};
  double mass = 0;
  size_t i = first;
  do {
    const double m = msri_drift_mass(d, i);
    const msri_vec its = of(d, i);
    sum.x += m * its.x, sum.y += m * its.y, mass += m;
  } while ((i = d->next[i]) != first);
  return (msri_vec){sum.x / mass, sum.y / mass};
}

/* Is nobody of it fast against its path? */
static bool goes_slowly(const msri_drift *d, size_t first, msri_vec path) {
  size_t i = first;
  if (!d->rests) return false;
  do {
    const msri_vec v = msri_drift_velocity(d, i);
    const double x = v.x - path.x / d->h, y = v.y - path.y / d->h,
                 slow = msri_drift_slow_speed(d, i, i);
    if (!(x * x + y * y <= slow * slow)) return false;
  } while ((i = d->next[i]) != first);
  return true;
}

/* All of it go by this path, and have one velocity in the end. */
static void rest_together(msri_drift *d, size_t first, msri_vec path) {
  const bool stays = path.x == 0 && path.y == 0;
  const msri_vec common = stays ? path : mean(d, first, msri_drift_end_velocity);
  size_t i = first;
  do {
    const msri_vec v = msri_drift_end_velocity(d, i);
    msri_drift_speed_up(d, i, common.x - v.x, common.y - v.y);
    msri_drift_redirect(d, i, path);
  } while ((i = d->next[i]) != first);
}

static void go_together(msri_drift *d, size_t first, msri_vec path) {
  msri_work w = {0};
  if (!d->parts && goes_slowly(d, first, path)) {
    rest_together(d, first, path);
    return;
  }
  size_t i = first;
  do {
    const msri_vec old = msri_drift_path_of(d, i);
    msri_drift_do_work(&w, msri_drift_mass(d, i), msri_drift_velocity(d, i),
                       (msri_vec){path.x - old.x, path.y - old.y});
  } while ((i = d->next[i]) != first);
  const double f = msri_drift_allowed(d, &w, (1 + d->restitution) / d->h);
  do {
    const msri_vec old = msri_drift_path_of(d, i);
    msri_drift_speed_up(d, i, f * (path.x - old.x), f * (path.y - old.y));
    msri_drift_redirect(d, i, path);
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
bool msri_zones_join(msri_drift *d, size_t i, size_t j) {
  if (d->zone[i] == d->zone[j] || msri_drift_as_it_was(d, i, j)) return false;
  const msri_disc_pair p = msri_drift_pair(d, i, j);
  if (!msri_disc_pair_meets(&p)) return false;
  for (size_t k = j; d->zone[k] != d->zone[i]; k = d->next[k]) d->zone[k] = d->zone[i];
  swap_next(d, i, j);
  go_together(d, i, mean(d, i, msri_drift_path_of));
  if (is_stopped(d, i)) go_together(d, i, (msri_vec){0, 0});
  return true;
}

void msri_zones_join_all(msri_drift *d) {
  for (size_t i = 0; i < d->n; i++) d->zone[i] = 0, d->next[i] = (uint32_t)((i + 1) % d->n);
  go_together(d, 0, mean(d, 0, msri_drift_path_of));
  if (is_stopped(d, 0)) go_together(d, 0, (msri_vec){0, 0});
}
