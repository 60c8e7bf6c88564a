/* kept.c - impacts by the assignment's rule, swept.
 *
 * A mass moves along x, then along y. On each axis every pixel that it would enter is looked at: if
 * one is a support, the coordinate keeps its old value and the velocity along the axis is reflected
 * (times the restitution), with Coulomb friction on the other component. With restitution 1 and no
 * friction each axis alone is reversible, and the two in turn keep phase-space volume: a lattice
 * isn't heated, as it is by an exact reflection. Since no pixel on the way is skipped, no speed
 * passes through.
 *
 * Verlet keeps not the energy itself but, to h^4, H + h^2 (v V'' v / 12 - F^2 / (24 m)), V'' being
 * the springs' matrix (modified energy: Hairer, Lubich & Wanner 2003, Acta Numerica 12, 399, 1.5).
 * In that a reflected v_k changes the sign of h^2 v_k V''_kj v_j / 6, j being the neighbours; what
 * is gained or lost is random, and heats in the long run. With -v0 + h (a1 - a0) / 3 at the end,
 * a0 and a1 being the accelerations at both ends, it stays the same, but for h^3: heating is
 * several times less. Reversible and keeping volume it is as before.
 *
 * A rebound that would be back within two steps isn't followed: its endless little jumps would be
 * those of the step, not of the mass. With restitution below 1 such a mass rests: half a kick is
 * still to come, so -h a / 2 along the normal leaves it no velocity. The impulse of that is the
 * weight of a step, h a, as it should be; friction of up to so much times its coefficient holds the
 * mass where it is, or slows it (Coulomb). */
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

/* Half a kick by the acceleration at the end is still to come: after it the mass is at rest. */
static void end_at_rest(msri_leg *leg, int axis) {
  leg->v[axis] = leg->follows ? 0 : -leg->h / 2 * leg->a[axis];
  leg->owed[axis] = leg->follows ? -leg->h / 2 : 0;
}

/* See above: (1 + e) h/12 times a0 - a1. */
static void keep_energy(const msri_supports *s, int axis, msri_leg *leg) {
  const double share = (1 + s->options.restitution) * leg->h / 12;
  if (!leg->follows) return;
  leg->v[axis] += share * leg->a[axis];
  leg->owed[axis] = -share;
}

/* The mass stays on its support; friction, too, holds it, or slows it. Does it hold? */
static bool rest(const msri_supports *s, int axis, double path, msri_leg *leg) {
  const double before = leg->v[axis], kick = leg->h / 2;
  const bool turns = s->options.restitution < 1, reflected = !turns && path * before > 0;
  const double after = turns ? -kick * leg->a[axis] : reflected ? -before : before;
  const double most = s->options.friction * fabs(before - after);
  const double slip = leg->v[!axis] + kick * leg->a[!axis];
  const bool holds = most > 0 && fabs(slip) <= most;
  leg->v[axis] = after;
  if (turns) end_at_rest(leg, axis);
  if (reflected) keep_energy(s, axis, leg);
  if (holds) end_at_rest(leg, !axis);
  if (!holds) leg->v[!axis] -= copysign(most, slip);
  return holds;
}

/* A support is in the way along an axis. Does friction hold the mass along the other one, too? */
static bool stop(const msri_supports *s, int axis, double path, msri_leg *leg) {
  const double before = leg->v[axis];
  if (msri_supports_rests(s, path, before, leg->a[axis], leg->h)) return rest(s, axis, path, leg);
  msri_supports_reflect(s, path, &leg->v[axis], &leg->v[!axis]);
  if (path * before > 0) keep_energy(s, axis, leg);
  return false;
}

unsigned msri_supports_keep(const msri_supports *s, const double *to, msri_leg *leg) {
  const double from[] = {leg->x[0], leg->x[1]};
  unsigned collisions = 0;
  for (int axis = 0; axis < MSRI_AXES; axis++) {
    const bool same = floor(to[axis]) == floor(from[axis]);
    if (same || !blocked(s, from[axis], to[axis], leg->x[!axis], axis == 0)) {
      leg->x[axis] = to[axis];
      continue;
    }
    collisions++;
    if (!stop(s, axis, to[axis] - from[axis], leg)) continue;
    leg->x[0] = from[0], leg->x[1] = from[1];
    break;
  }
  return collisions;
}

/* ---- All masses, or some */

static void owe(msri_debts *debts, size_t mass, const msri_leg *leg) {
  if (leg->owed[0] != 0 || leg->owed[1] != 0)
    msri_debts_add(debts, mass, leg->owed[0], leg->owed[1]);
}

/* msri_walk. */
static unsigned walk(const msri_supports *s, double h, const msri_flock *f, size_t k,
                     const double *to, msri_debts *debts) {
  msri_leg leg = {.h = h,
                  .a = {f->ax ? f->ax[k] : 0, f->ay ? f->ay[k] : 0},
                  .x = {f->x[k], f->y[k]},
                  .v = {f->vx[k], f->vy[k]},
                  .follows = debts != NULL};
  const unsigned collisions = msri_supports_keep(s, to, &leg);
  f->x[k] = leg.x[0], f->y[k] = leg.x[1];
  f->vx[k] = leg.v[0], f->vy[k] = leg.v[1];
  if (collisions > 0 && debts) owe(debts, f->first + k, &leg);
  return collisions;
}

static uint64_t drift(const void *self, double h, const msri_flock *flock, msri_debts *debts) {
  return msri_supports_drift(self, h, flock, debts, walk);
}

static uint64_t stop_drift(const void *self, double h, const msri_flock *block,
                           const msri_places *from, uint64_t some, msri_debts *debts) {
  return msri_supports_stop(self, h, block, from, some, debts, walk);
}

/* Half of the velocity's change comes before the drift, half after it, so that a bounce costs no
 * energy. */
static uint64_t bounce(const void *self, size_t n, double h, const double *q0, const double *v0,
                       double *q, double *v, msri_debts *debts) {
  uint64_t collisions = 0;
  (void)debts;
  for (size_t i = 0, j = n; i < n; i++, j++) {
    const double to[] = {q[i], q[j]}, half[] = {(v[i] - v0[i]) / 2, (v[j] - v0[j]) / 2};
    msri_leg leg = {.h = h,
                    .a = {2 * half[0] / h, 2 * half[1] / h},
                    .x = {q0[i], q0[j]},
                    .v = {(v0[i] + v[i]) / 2, (v0[j] + v[j]) / 2}};
    const unsigned met = msri_supports_keep(self, to, &leg);
    if (met == 0) continue;
    q[i] = leg.x[0], q[j] = leg.x[1];
    v[i] = leg.v[0] + half[0], v[j] = leg.v[1] + half[1];
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
    .drift = drift, .stop_drift = stop_drift, .bounce = bounce, .hold = hold, .rebound = rebound};
