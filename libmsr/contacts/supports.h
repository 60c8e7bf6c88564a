/* supports.h - fixed supports: solid pixels as bits, and what the rules of impact share. */
#ifndef MSRI_SUPPORTS_H
#define MSRI_SUPPORTS_H

#include "contacts/flock.h"

#include <math.h>
#include <string.h>

enum { MSRI_WORD = 64, MSRI_AXES = 2 };

/* A pixel owns its left and its lower edge. */
typedef struct msri_supports {
  size_t width, height;
  msri_supports_options options;
  const msri_flock_kernel *kernel;
  unsigned char *distance; /* [height + 2][width + 2], see clearance.c */
  uint64_t solid[];        /* [width * height / 64, rounded up]; rows from the bottom: y is up */
} msri_supports;

/* The edge through which a path enters a support: the last coordinate outside. */
typedef struct msri_face {
  int axis;          /* 0: x, 1: y */
  double edge, side; /* the support is above the edge, 1, or below it, -1 */
} msri_face;

static inline bool msri_supports_solid(const msri_supports *s, size_t bit) {
  return s->solid[bit / MSRI_WORD] >> (bit % MSRI_WORD) & 1;
}

/* Reflects the normal velocity of a mass that was moving by `path`; friction slows the other. */
static inline void msri_supports_reflect(const msri_supports *s, double path, double *normal,
                                         double *along) {
  const double before = *normal;
  if (path * before > 0) *normal = -s->options.restitution * before;
  const double most = s->options.friction * fabs(before - *normal);
  *along = fabs(*along) > most ? *along - copysign(most, *along) : 0;
}

/* The first support on the way from `from` to `to` [2]; false if there is none. Whoever goes only
 * where there is none never passes one, at any speed. */
bool msri_supports_face(const msri_supports *s, const double *from, const double *to,
                        msri_face *met);

/* A step of a mass: it lasts h, a is its acceleration at the start, and v its velocity in the
 * middle. If `follows`, what the acceleration at the end is to be multiplied by and added to v goes
 * to owed; else that acceleration is taken to be a. */
typedef struct msri_leg {
  double h, a[MSRI_AXES], x[MSRI_AXES], v[MSRI_AXES], owed[MSRI_AXES];
  bool follows;
} msri_leg;

/* Does a mass that moves by `path` into a support come back to it within two steps of h? It's
 * reflected from `speed`, and `a` presses it on the support. */
static inline bool msri_supports_rests(const msri_supports *s, double path, double speed, double a,
                                       double h) {
  const double e = s->options.restitution;
  return (e < 1 || s->options.friction > 0) && path * a > 0 && e * fabs(speed) <= h * fabs(a);
}

/* The mass of a leg goes to `to` [2] by the rule MSR_IMPACTS_KEPT. Returns the number of
 * collisions. */
unsigned msri_supports_keep(const msri_supports *s, const double *to, msri_leg *leg);

/* Fills the distances. */
void msri_supports_measure(msri_supports *s);

/* msri_contact's clearance. */
double msri_supports_clearance(const void *self, size_t n, const double *x, const double *y);

/* Where `at` lies, in rows or columns of the distances. */
static inline size_t msri_supports_cell(double at, size_t size) {
  return at < 0 ? 0 : at < (double)size ? (size_t)(int64_t)at + 1 : size + 1;
}

/* How far it is from (x, y) to the nearest support, along one axis or the other, at least. */
static inline double msri_supports_gap(const msri_supports *s, double x, double y) {
  const size_t row = msri_supports_cell(y, s->height), column = msri_supports_cell(x, s->width);
  return (double)s->distance[row * (s->width + 2) + column] - 1;
}

/* The number of 0s below the lowest 1. */
static inline unsigned msri_lowest_bit(uint64_t bits) {
#ifdef __GNUC__
  return (unsigned)__builtin_ctzll(bits);
#else
  unsigned n = 0;
  for (; !(bits & 1); bits >>= 1) n++;
  return n;
#endif
}

/* What mass k does that wants to leave its pixel for `to` [2]. Returns the number of collisions. */
typedef unsigned msri_walk(const msri_supports *s, double h, const msri_flock *flock, size_t k,
                           const double *to, msri_debts *debts);

/* Is there certainly nothing in the way between two pixels that touch? A way from one to the other
 * goes through no pixels but these, and the two beside both if it's a diagonal. */
static inline bool msri_supports_open(const msri_supports *s, const double *from,
                                      const double *to) {
  const size_t wide = s->width + 2;
  const size_t r0 = msri_supports_cell(from[1], s->height),
               r1 = msri_supports_cell(to[1], s->height);
  const size_t c0 = msri_supports_cell(from[0], s->width), c1 = msri_supports_cell(to[0], s->width);
  const unsigned char *row0 = s->distance + r0 * wide, *row1 = s->distance + r1 * wide;
  const bool touch = r1 + 1 - r0 <= 2 && c1 + 1 - c0 <= 2;
  return touch && row0[c0] > 0 && row0[c1] > 0 && row1[c0] > 0 && row1[c1] > 0;
}

/* msri_contact's stop_drift: of some those walk that may have come to a support. Inline, so that
 * nothing is called through a pointer. */
static inline uint64_t msri_supports_stop(const msri_supports *s, double h, const msri_flock *f,
                                          const msri_places *was, uint64_t some, msri_debts *debts,
                                          msri_walk *walk) {
  uint64_t collisions = 0;
  for (uint64_t left = some; left > 0; left &= left - 1) {
    const size_t k = msri_lowest_bit(left);
    const double from[] = {was->x[k], was->y[k]}, to[] = {f->x[k], f->y[k]};
    const double gap = msri_supports_gap(s, from[0], from[1]);
    if (fabs(to[0] - from[0]) < gap && fabs(to[1] - from[1]) < gap) continue;
    if (msri_supports_open(s, from, to)) continue;
    f->x[k] = from[0], f->y[k] = from[1];
    collisions += walk(s, h, f, k, to, debts);
  }
  return collisions;
}

/* msri_contact's drift. */
static inline uint64_t msri_supports_drift(const msri_supports *s, double h,
                                           const msri_flock *flock, msri_debts *debts,
                                           msri_walk *walk) {
  double x[MSRI_FLOCK_BLOCK], y[MSRI_FLOCK_BLOCK];
  uint64_t collisions = 0;
  for (size_t from = 0; from < flock->n; from += MSRI_FLOCK_BLOCK) {
    const msri_flock f = msri_flock_part(flock, from);
    memcpy(x, f.x, f.n * sizeof *x);
    memcpy(y, f.y, f.n * sizeof *y);
    s->kernel->glide(&f, h);
    const msri_places was = {x, y};
    collisions += msri_supports_stop(s, h, &f, &was, s->kernel->leave(&f, &was), debts, walk);
  }
  return collisions;
}

/* The callbacks of a rule; the rest of the contact isn't set. */
extern const msri_contact msri_impacts_kept, msri_impacts_located;

#endif
