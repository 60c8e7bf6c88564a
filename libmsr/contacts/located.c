/* located.c - impacts at the time when the path, bent by the acceleration, meets the support.
 *
 * The path of a mass is x + s w + s^2 a / 2. The first support on its chord is met where the path
 * crosses that pixel's edge; there w is reflected, and the path goes on from it. A few impacts a
 * step are followed; what can't be (a mass that rests, a place that isn't free) stays where it is
 * for the rest of the step, as in kept.c.
 *
 * `owed` is half of d(v at the end) / da: with it the velocity has the mean of the accelerations at
 * both ends, as Verlet's has. Elastic, an impact at s of h then makes of the velocity along the
 * normal -(v0 + (2s - h) (a0 + a1) / 2): a step of Verlet of 2s - h, reversed. Its errors have no
 * sign of their own, while with a0 alone each impact adds h^2/6 da/dt on average, and many of them
 * heat a stiff lattice. */
#include "contacts/supports.h"

enum { X, Y, MOST_IMPACTS = 8 };

/* A mass on its way: x + s rate + s^2 a / 2, `left` to go; rate is w but for a first leg whose mean
 * velocity isn't that of v. */
typedef struct flight {
  double x[MSRI_AXES], rate[MSRI_AXES], w[MSRI_AXES], a[MSRI_AXES], owed[MSRI_AXES], left;
  bool follows; /* owed is paid */
} flight;

/* ---- When a support is met, and what follows */

/* When the distance from the edge, d + b s + c s^2, falls through 0. */
static double crossing(const flight *f, const msri_face *met) {
  const double d = met->side * (met->edge - f->x[met->axis]);
  const double b = -met->side * f->rate[met->axis], c = -met->side * f->a[met->axis] / 2;
  const double root = sqrt(msri_max(0, b * b - 4 * c * d));
  const double s = b > 0 ? (b + root) / (-2 * c) : d > 0 ? 2 * d / (root - b) : 0;
  return s > f->left ? f->left : s;
}

/* Goes to the impact and is reflected; false, and nothing is done, if that place isn't free or no
 * impact: the mass only presses on the support. */
static bool strike_face(const msri_supports *s, const msri_face *met, flight *f) {
  const int d = met->axis, other = !d;
  const double t = crossing(f, met), speed = met->side * (f->w[d] + t * f->a[d]);
  const double rest = 1e-9 * fabs(f->a[d]) * f->left; // a speed that is rounding
  double x[MSRI_AXES];
  msri_face before;
  x[d] = met->edge;
  x[other] = f->x[other] + t * (f->rate[other] + t * f->a[other] / 2);
  if (!(t >= 0 && speed > rest) || !isfinite(x[other])) return false;
  if (msri_supports_face(s, f->x, x, &before)) return false;
  f->left -= t;
  for (int k = X; k < MSRI_AXES; k++) {
    f->x[k] = x[k];
    f->w[k] += t * f->a[k];
    f->owed[k] += t / 2;
  }
  f->owed[d] *= -s->options.restitution;
  msri_supports_reflect(s, met->side, &f->w[d], &f->w[other]);
  f->rate[X] = f->w[X], f->rate[Y] = f->w[Y];
  return true;
}

static void end_of(const flight *f, double *to) {
  for (int d = X; d < MSRI_AXES; d++)
    to[d] = f->x[d] + f->left * (f->rate[d] + f->left * f->a[d] / 2);
}

/* For the rest of the time the old rule: reflected in the middle of it, or at rest. `owed`: by half
 * of all the time. */
static unsigned stay(const msri_supports *s, const double *to, double owed, flight *f) {
  const double half = f->left / 2;
  msri_leg leg = {.h = f->left,
                  .a = {f->a[X], f->a[Y]},
                  .x = {f->x[X], f->x[Y]},
                  .v = {f->w[X] + half * f->a[X], f->w[Y] + half * f->a[Y]},
                  .follows = f->follows};
  const unsigned collisions = msri_supports_keep(s, to, &leg);
  for (int d = X; d < MSRI_AXES; d++) {
    f->x[d] = leg.x[d];
    f->w[d] = leg.v[d] + (half + leg.owed[d]) * f->a[d];
    f->owed[d] = owed + leg.owed[d];
  }
  return collisions;
}

/* Flies to the end, or to what follows where something is in the way. Returns the number of
 * collisions. */
static unsigned fly(const msri_supports *s, const double *end, flight *f) {
  const double half = f->left / 2;
  double to[] = {end[X], end[Y]};
  unsigned n = 0;
  for (msri_face met; msri_supports_face(s, f->x, to, &met); n++) {
    if (n == MOST_IMPACTS || !strike_face(s, &met, f)) return n + stay(s, to, half, f);
    end_of(f, to);
  }
  for (int d = X; d < MSRI_AXES; d++) {
    f->x[d] = to[d];
    f->w[d] += f->left * f->a[d];
    f->owed[d] += f->left / 2;
  }
  return n;
}

/* ---- All masses; i and j are the coordinates of one */

static bool same_pixel(const double *a, const double *b) {
  return floor(a[X]) == floor(b[X]) && floor(a[Y]) == floor(b[Y]);
}

static bool is_free(const msri_supports *s, const double *from, const double *to) {
  msri_face met;
  return same_pixel(from, to) || !msri_supports_face(s, from, to, &met);
}

/* msri_walk. */
static unsigned walk(const msri_supports *s, double h, const msri_flock *fl, size_t k,
                     const double *to, msri_debts *debts) {
  const double from[] = {fl->x[k], fl->y[k]};
  const double a[] = {fl->ax ? fl->ax[k] : 0, fl->ay ? fl->ay[k] : 0};
  fl->x[k] = to[X], fl->y[k] = to[Y];
  if (is_free(s, from, to)) return 0;
  flight f = {.x = {from[X], from[Y]},
              .rate = {fl->ux[k] - a[X] * h / 2, fl->uy[k] - a[Y] * h / 2},
              .w = {fl->vx[k] - a[X] * h / 2, fl->vy[k] - a[Y] * h / 2},
              .a = {a[X], a[Y]},
              .left = h,
              .follows = debts != NULL};
  const unsigned collisions = fly(s, to, &f);
  fl->x[k] = f.x[X], fl->y[k] = f.x[Y];
  fl->vx[k] = f.w[X] - (debts ? f.owed[X] : h / 2) * a[X];
  fl->vy[k] = f.w[Y] - (debts ? f.owed[Y] : h / 2) * a[Y];
  if (debts) msri_debts_add(debts, fl->first + k, f.owed[X] - h / 2, f.owed[Y] - h / 2);
  return collisions;
}

static uint64_t drift(const void *self, double h, const msri_flock *flock, msri_debts *debts) {
  return msri_supports_drift(self, h, flock, debts, walk);
}

static uint64_t stop_drift(const void *self, double h, const msri_flock *block,
                           const msri_places *from, uint64_t some, msri_debts *debts) {
  return msri_supports_stop(self, h, block, from, some, debts, walk);
}

/* The flight that mass i, of coordinates i and j, made in a step. Its acceleration is that which
 * leads to q from (q0, v0), near the one at the start, if one at the end is to follow; else the
 * mean. */
static flight flight_of(double h, const double *q0, const double *v0, const double *q,
                        const double *v, size_t i, size_t j, bool follows) {
  const size_t at[] = {i, j};
  flight f = {.left = h, .follows = follows};
  for (int d = X; d < MSRI_AXES; d++) {
    const size_t k = at[d];
    const double u = (q[k] - q0[k]) / h;
    f.a[d] = follows ? 2 * (u - v0[k]) / h : (v[k] - v0[k]) / h;
    f.x[d] = q0[k], f.w[d] = v0[k], f.rate[d] = u - f.a[d] * h / 2;
  }
  return f;
}

static uint64_t bounce(const void *self, size_t n, double h, const double *q0, const double *v0,
                       double *q, double *v, msri_debts *debts) {
  uint64_t collisions = 0;
  for (size_t i = 0, j = n; i < n; i++, j++) {
    const double from[] = {q0[i], q0[j]}, to[] = {q[i], q[j]};
    if (is_free(self, from, to)) continue;
    flight f = flight_of(h, q0, v0, q, v, i, j, debts != NULL);
    collisions += fly(self, to, &f);
    q[i] = f.x[X], q[j] = f.x[Y];
    v[i] = f.w[X] - (debts ? f.owed[X] * f.a[X] : 0);
    v[j] = f.w[Y] - (debts ? f.owed[Y] * f.a[Y] : 0);
    if (debts) msri_debts_add(debts, i, f.owed[X], f.owed[Y]);
  }
  return collisions;
}

/* ---- For steps that end at an impact */

static void meet(const void *self, size_t n, double h, const double *q0, const double *v0,
                 const double *q, const double *v, msri_meeting *m) {
  const double e = ((const msri_supports *)self)->options.restitution;
  *m = (msri_meeting){.first = h, .lasts = (double)INFINITY};
  for (size_t i = 0, j = n; i < n; i++, j++) {
    const double from[] = {q0[i], q0[j]}, to[] = {q[i], q[j]};
    msri_face met;
    if (same_pixel(from, to) || !msri_supports_face(self, from, to, &met)) continue;
    const flight f = flight_of(h, q0, v0, q, v, i, j, false);
    const double t = crossing(&f, &met), a = met.side * f.a[met.axis];
    const double speed = met.side * f.w[met.axis] + t * a;
    if (a > 0) m->lasts = msri_min(m->lasts, 2 * e * speed / a);
    m->depth = msri_max(m->depth, met.side * (to[met.axis] - met.edge));
    m->last = msri_max(m->last, t);
    if (m->masses++ > 0 && t >= m->first) continue;
    m->first = t;
    m->coordinate = met.axis == X ? i : j;
    m->edge = met.edge, m->side = met.side;
  }
}

static uint64_t strike(const void *self, size_t n, const double *q0, double *q, double *v) {
  uint64_t collisions = 0;
  for (size_t i = 0, j = n; i < n; i++, j++) {
    const double from[] = {q0[i], q0[j]};
    double x[] = {q[i], q[j]}, w[] = {v[i], v[j]};
    if (is_free(self, from, x)) continue;
    msri_face met;
    for (int edges = 0; edges < MSRI_AXES && msri_supports_face(self, from, x, &met); edges++) {
      x[met.axis] = met.edge;
      msri_supports_reflect(self, met.side, &w[met.axis], &w[!met.axis]);
      collisions++;
    }
    const bool out = is_free(self, from, x);
    q[i] = out ? x[X] : from[X], q[j] = out ? x[Y] : from[Y];
    v[i] = w[X], v[j] = w[Y];
  }
  return collisions;
}

const msri_contact msri_impacts_located = {
    .drift = drift, .stop_drift = stop_drift, .bounce = bounce, .meet = meet, .strike = strike};
