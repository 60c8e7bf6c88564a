/* kept.c - impacts by the assignment's rule, swept.
 *
 * A mass moves along x, then along y. On each axis every pixel that it would enter is looked at: if
 * one is a support, the coordinate keeps its old value and the velocity along the axis is reflected
 * (times the restitution), with Coulomb friction on the other component. With restitution 1 and no
 * friction each axis alone is reversible, and the two in turn keep phase-space volume: a lattice
 * isn't heated, as it is by an exact reflection. Since no pixel on the way is skipped, no speed
 * passes through. */
#include "contacts/supports.h"

/* A line of pixels: bit `start` + `step` * cell, cells 0 .. cells-1; none if the line is outside.
 */
typedef struct line {
  size_t start, step, cells;
} line;

static size_t clamp_cell(double cell, size_t cells) {
  return cell < 0 ? 0 : cell < (double)cells ? (size_t)cell : cells - 1;
}

/* Is there a support among the cells entered from `from` to `to` (both whole, from != to)? */
static bool solid_between(const msri_supports *s, const line *along, double from, double to) {
  const double last = (double)along->cells - 1, step = to > from ? 1 : -1;
  if (msri_max(from, to) < 0 || msri_min(from, to) > last) return false;
  const size_t a = clamp_cell(from + step, along->cells), b = clamp_cell(to, along->cells);
  for (size_t cell = a; cell != b; cell += step > 0 ? 1 : (size_t)-1)
    if (msri_supports_solid(s, along->start + along->step * cell)) return true;
  return msri_supports_solid(s, along->start + along->step * b);
}

/* Would going from `from` to `to` along an axis of `size` pixels, in the pixel line of the other
 * coordinate `across` (of `across_size` pixels), meet something? */
static bool blocked(const msri_supports *s, double from, double to, double across, bool along_x) {
  const size_t size = along_x ? s->width : s->height;
  const size_t across_size = along_x ? s->height : s->width;
  if (!(isfinite(from) && isfinite(to))) return false;
  if (s->options.closed && (to < 0 || to >= (double)size)) return true;
  if (!(across >= 0 && across < (double)across_size)) return false;
  const size_t other = (size_t)across;
  const line along = along_x ? (line){other * s->width, 1, size} : (line){other, s->width, size};
  return solid_between(s, &along, floor(from), floor(to));
}

unsigned msri_supports_keep(const msri_supports *s, double to_x, double to_y, double *x, double *y,
                            double *vx, double *vy) {
  const double dx = to_x - *x, dy = to_y - *y;
  unsigned collisions = 0;
  if (floor(to_x) != floor(*x) && blocked(s, *x, to_x, *y, true)) {
    msri_supports_reflect(s, dx, vx, vy);
    collisions++;
  } else {
    *x = to_x;
  }
  if (floor(to_y) != floor(*y) && blocked(s, *y, to_y, *x, false)) {
    msri_supports_reflect(s, dy, vy, vx);
    collisions++;
  } else {
    *y = to_y;
  }
  return collisions;
}

static uint64_t drift(const void *self, size_t n, double h, const double *u, const double *a,
                      double *q, double *v, double *owed) {
  double *x = q, *y = q + n, *vx = v, *vy = v + n;
  const double *ux = u, *uy = u + n;
  uint64_t collisions = 0;
  (void)a, (void)owed;
  for (size_t i = 0; i < n; i++)
    collisions +=
        msri_supports_keep(self, x[i] + h * ux[i], y[i] + h * uy[i], &x[i], &y[i], &vx[i], &vy[i]);
  return collisions;
}

/* Half of the velocity's change comes before the way, half after it, so that a bounce costs no
 * energy. */
static uint64_t bounce(const void *self, size_t n, double h, const double *q0, const double *v0,
                       double *q, double *v, double *owed) {
  uint64_t collisions = 0;
  (void)h, (void)owed;
  for (size_t i = 0, j = n; i < n; i++, j++) {
    double x = q0[i], y = q0[j], vx = (v0[i] + v[i]) / 2, vy = (v0[j] + v[j]) / 2;
    const unsigned met = msri_supports_keep(self, q[i], q[j], &x, &y, &vx, &vy);
    if (met == 0) continue;
    q[i] = x, q[j] = y;
    v[i] = vx + (v[i] - v0[i]) / 2, v[j] = vy + (v[j] - v0[j]) / 2;
    collisions += met;
  }
  return collisions;
}

/* ---- For steps that know what they hold */

static bool hold(const void *self, size_t n, const double *q0, const double *q, bool *held) {
  bool more = false;
  for (size_t i = 0, j = n; i < n; i++, j++) {
    const double x = q0[i], y = q0[j];
    const bool x_stops = !held[i] && floor(q[i]) != floor(x) && blocked(self, x, q[i], y, true);
    const double at = x_stops ? x : q[i];
    const bool y_stops = !held[j] && floor(q[j]) != floor(y) && blocked(self, y, q[j], at, false);
    held[i] |= x_stops, held[j] |= y_stops;
    more |= x_stops || y_stops;
  }
  return more;
}

/* Along one axis: the normal speed, reversed already, and friction on the other one. */
static void slow(const msri_supports *s, double push, double *normal, double *along) {
  const double before = *normal;
  *normal *= s->options.restitution;
  const double most = s->options.friction * fabs(push + *normal - before);
  *along = fabs(*along) > most ? *along - copysign(most, *along) : 0;
}

static uint64_t rebound(const void *self, size_t n, const bool *held, const double *push,
                        double *v) {
  uint64_t collisions = 0;
  for (size_t i = 0, j = n; i < n; i++, j++) {
    if (held[i]) slow(self, push[i], &v[i], &v[j]);
    if (held[j]) slow(self, push[j], &v[j], &v[i]);
    collisions += held[i] + held[j];
  }
  return collisions;
}

const msri_contact msri_impacts_kept = {
    .drift = drift, .bounce = bounce, .hold = hold, .rebound = rebound};
