/* disc_pair.c - two discs collide in the middle of a step.
 *
 * With r their distance vector and d the path of one as seen from the other, their velocity is
 * reflected along n = (r + d/2) / |r + d/2|, and each goes half the step with the old velocity,
 * half with the new one: the path along n is none, and the distance is afterwards what it was
 * before. So made, an elastic collision is reversible, keeps phase-space volume, and keeps momentum
 * and angular momentum, as r + d/2 is where they act on each other: the rule of kept.c for round
 * things. With a restitution e, n is along r + e/(1 + e) d, so that angular momentum is kept, too.
 */
#include "contacts/disc_pair.h"

#include <math.h>

static double dot(msri_vec a, msri_vec b) { return a.x * b.x + a.y * b.y; }

static double cross(msri_vec a, msri_vec b) { return a.x * b.y - a.y * b.x; }

static msri_vec along(msri_vec a, double s, msri_vec b) {
  return (msri_vec){a.x + s * b.x, a.y + s * b.y};
}

static msri_vec scaled(msri_vec a, double s) { return (msri_vec){s * a.x, s * a.y}; }

static double floor_of(const msri_disc_pair *p) {
  return msri_disc_pair_floor(p, dot(p->from, p->from));
}

/* Coincident discs part in a direction of their own: a point on the circle from a number in -1
 * .. 1.
 */
static msri_vec any_direction(size_t i, size_t j) {
  const uint64_t mixed = ((uint64_t)i * 0x9e3779b97f4a7c15U) ^ ((uint64_t)j * 0xbf58476d1ce4e5b9U);
  const double s = (double)(mixed >> 11) * 0x1p-52 - 1, d = 1 + s * s;
  return mixed & 1 ? (msri_vec){(1 - s * s) / d, 2 * s / d}
                   : (msri_vec){(s * s - 1) / d, 2 * s / d};
}

/* Where the path first comes as near as the diameter. */
static msri_vec touch(const msri_disc_pair *p) {
  const double b = -dot(p->from, p->path), path2 = dot(p->path, p->path),
               c = cross(p->from, p->path);
  const double outside = dot(p->from, p->from) - p->diameter * p->diameter;
  const double root = sqrt(msri_max(0, path2 * p->diameter * p->diameter - c * c));
  const double s = b > 0 ? msri_max(0, outside) / (b + root) : 0;
  return along(p->from, msri_min(s, 1), p->path);
}

/* Does the collision in the middle leave both on the sides where they are? */
static bool is_gentle(const msri_disc_pair *p, msri_vec n) {
  const double r = dot(p->from, n);
  return dot(p->path, n) < 0 && r > 0 && r * r >= msri_disc_graze * p->diameter * p->diameter;
}

msri_vec msri_disc_pair_normal(const msri_disc_pair *p, double restitution) {
  const double r = sqrt(dot(p->from, p->from));
  if (r < 1e-9 * p->diameter) return any_direction(p->i, p->j);
  if (r < p->diameter * (1 - msri_disc_rounding)) return scaled(p->from, 1 / r);
  const msri_vec middle = along(p->from, restitution / (1 + restitution), p->path);
  const msri_vec n = scaled(middle, 1 / sqrt(dot(middle, middle)));
  if (is_gentle(p, n)) return n;
  const msri_vec t = touch(p);
  return scaled(t, 1 / sqrt(dot(t, t)));
}

double msri_disc_pair_gap(const msri_disc_pair *p) {
  return floor_of(p) - msri_min(p->diameter, sqrt(dot(p->from, p->from)));
}
