/* supports.c - fixed supports: the assignment's rule, swept.
 *
 * A mass moves along x, then along y. On each axis every pixel that it would enter is looked at: if
 * one is a support, the coordinate keeps its old value and the velocity along the axis is reflected
 * (times the restitution), with Coulomb friction on the other component. With restitution 1 and no
 * friction each axis alone is reversible, and the two in turn keep phase-space volume: a lattice
 * isn't heated, as it is by an exact reflection. Since no pixel on the way is skipped, no speed
 * passes through. */
#include "contacts/contact.h"

#include "base/pixel.h"

#include <math.h>
#include <stdlib.h>

enum { WORD = 64 };

/* Solid pixels as bits, rows from the bottom: y is up. */
typedef struct supports {
  size_t width, height;
  msri_supports_options options;
  uint64_t solid[]; /* [width * height / 64, rounded up] */
} supports;

/* A line of pixels: bit `start` + `step` * cell, cells 0 .. cells-1; none if the line is outside.
 */
typedef struct line {
  size_t start, step, cells;
} line;

static bool is_solid(const supports *s, size_t bit) {
  return s->solid[bit / WORD] >> (bit % WORD) & 1;
}

static size_t clamp_cell(double cell, size_t cells) {
  return cell < 0 ? 0 : cell < (double)cells ? (size_t)cell : cells - 1;
}

/* Is there a support among the cells entered from `from` to `to` (both whole, from != to)? */
static bool solid_between(const supports *s, const line *along, double from, double to) {
  const double last = (double)along->cells - 1, step = to > from ? 1 : -1;
  if (msri_max(from, to) < 0 || msri_min(from, to) > last) return false;
  const size_t a = clamp_cell(from + step, along->cells), b = clamp_cell(to, along->cells);
  for (size_t cell = a; cell != b; cell += step > 0 ? 1 : (size_t)-1)
    if (is_solid(s, along->start + along->step * cell)) return true;
  return is_solid(s, along->start + along->step * b);
}

/* Would going from `from` to `to` along an axis of `size` pixels, in the pixel line of the other
 * coordinate `across` (of `across_size` pixels), meet something? */
static bool blocked(const supports *s, double from, double to, double across, bool along_x) {
  const size_t size = along_x ? s->width : s->height;
  const size_t across_size = along_x ? s->height : s->width;
  if (!(isfinite(from) && isfinite(to))) return false;
  if (s->options.closed && (to < 0 || to >= (double)size)) return true;
  if (!(across >= 0 && across < (double)across_size)) return false;
  const size_t other = (size_t)across;
  const line along = along_x ? (line){other * s->width, 1, size} : (line){other, s->width, size};
  return solid_between(s, &along, floor(from), floor(to));
}

/* Reflects the normal velocity of a mass that was moving by `way`; friction slows the other. */
static void reflect(const msri_supports_options *o, double way, double *normal, double *along) {
  const double before = *normal;
  if (way * before > 0) *normal = -o->restitution * before;
  const double most = o->friction * fabs(before - *normal);
  *along = fabs(*along) > most ? *along - copysign(most, *along) : 0;
}

/* A mass goes to (to_x, to_y) by the rule above. Returns the number of collisions. */
static unsigned keep(const supports *s, double to_x, double to_y, double *x, double *y, double *vx,
                     double *vy) {
  const double dx = to_x - *x, dy = to_y - *y;
  unsigned collisions = 0;
  if (floor(to_x) != floor(*x) && blocked(s, *x, to_x, *y, true)) {
    reflect(&s->options, dx, vx, vy);
    collisions++;
  } else {
    *x = to_x;
  }
  if (floor(to_y) != floor(*y) && blocked(s, *y, to_y, *x, false)) {
    reflect(&s->options, dy, vy, vx);
    collisions++;
  } else {
    *y = to_y;
  }
  return collisions;
}

static uint64_t drift(const void *self, size_t n, double h, const double *u, const double *a,
                      double *q, double *v) {
  double *x = q, *y = q + n, *vx = v, *vy = v + n;
  const double *ux = u, *uy = u + n;
  uint64_t collisions = 0;
  (void)a;
  for (size_t i = 0; i < n; i++)
    collisions += keep(self, x[i] + h * ux[i], y[i] + h * uy[i], &x[i], &y[i], &vx[i], &vy[i]);
  return collisions;
}

/* Half of the velocity's change comes before the way, half after it, so that a bounce costs no
 * energy. */
static uint64_t bounce(const void *self, size_t n, double h, const double *q0, const double *v0,
                       double *q, double *v) {
  uint64_t collisions = 0;
  (void)h;
  for (size_t i = 0, j = n; i < n; i++, j++) {
    double x = q0[i], y = q0[j], vx = (v0[i] + v[i]) / 2, vy = (v0[j] + v[j]) / 2;
    const unsigned met = keep(self, q[i], q[j], &x, &y, &vx, &vy);
    if (met == 0) continue;
    q[i] = x, q[j] = y;
    v[i] = vx + (v[i] - v0[i]) / 2, v[j] = vy + (v[j] - v0[j]) / 2;
    collisions += met;
  }
  return collisions;
}

static void mark(supports *s, const msr_picture *picture) {
  for (size_t row = 0; row < s->height; row++)
    for (size_t column = 0; column < s->width; column++) {
      if (msri_pixel_at(picture, column, row) != MSRI_SUPPORT) continue;
      const size_t bit = (s->height - 1 - row) * s->width + column;
      s->solid[bit / WORD] |= (uint64_t)1 << (bit % WORD);
    }
}

msr_status msri_supports_create(const msr_picture *picture, const msri_supports_options *options,
                                msri_contact *contact, msr_error *err) {
  const size_t words = picture->width * picture->height / WORD + 1;
  supports *s = msri_alloc(1, sizeof *s + words * sizeof *s->solid, "the supports", err);
  if (!s) return MSR_ENOMEM;
  s->width = picture->width;
  s->height = picture->height;
  s->options = *options;
  mark(s, picture);
  *contact = (msri_contact){s, drift, bounce, free};
  return MSR_OK;
}
