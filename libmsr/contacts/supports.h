/* supports.h - fixed supports: solid pixels as bits, and what the rules of impact share. */
#ifndef MSRI_SUPPORTS_H
#define MSRI_SUPPORTS_H

#include "contacts/contact.h"

#include <math.h>

enum { MSRI_WORD = 64, MSRI_AXES = 2 };

/* A pixel owns its left and its lower edge. */
typedef struct msri_supports {
  size_t width, height;
  msri_supports_options options;
  uint64_t solid[]; /* [width * height / 64, rounded up]; rows from the bottom: y is up */
} msri_supports;

/* The edge through which a way enters a support: the last coordinate outside. */
typedef struct msri_face {
  int axis;          /* 0: x, 1: y */
  double edge, side; /* the support is above the edge, 1, or below it, -1 */
} msri_face;

static inline bool msri_supports_solid(const msri_supports *s, size_t bit) {
  return s->solid[bit / MSRI_WORD] >> (bit % MSRI_WORD) & 1;
}

/* Reflects the normal velocity of a mass that was moving by `way`; friction slows the other. */
static inline void msri_supports_reflect(const msri_supports *s, double way, double *normal,
                                         double *along) {
  const double before = *normal;
  if (way * before > 0) *normal = -s->options.restitution * before;
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

/* Does a mass that moves by `way` into a support come back to it within two steps of h? It's
 * reflected from `speed`, and `a` presses it on the support. */
static inline bool msri_supports_rests(const msri_supports *s, double way, double speed, double a,
                                       double h) {
  const double e = s->options.restitution;
  return (e < 1 || s->options.friction > 0) && way * a > 0 && e * fabs(speed) <= h * fabs(a);
}

/* The mass of a leg goes to `to` [2] by the rule MSR_IMPACTS_KEPT. Returns the number of
 * collisions. */
unsigned msri_supports_keep(const msri_supports *s, const double *to, msri_leg *leg);

/* The callbacks of a rule; the rest of the contact isn't set. */
extern const msri_contact msri_impacts_kept, msri_impacts_located;

#endif
