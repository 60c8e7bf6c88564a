/* contact.h - what may stand in the way of masses, behind one interface. */
#ifndef MSRI_CONTACT_H
#define MSRI_CONTACT_H

#include "contacts/debts.h"

/* What a step from (q0, v0) to (q, v) would meet. */
typedef struct msri_meeting {
  size_t masses;      /* that meet something */
  double first, last; /* when the first and the last of them do, since the start of the step [s] */
  double lasts;       /* the shortest time until one that is reflected comes back [s] */
  double depth;       /* how far the deepest is inside at the end [px] */
  size_t coordinate;  /* of q: that of the first one that crosses an edge, */
  double edge;        /* which is at q = edge, */
  double side;        /* inside being above it, 1, or below, -1 */
} msri_meeting;

/* Some masses in a row, on their way; all arrays [n]. */
typedef struct msri_flock {
  size_t n, first; /* debts call its mass k: first + k */
  double *x, *y, *vx, *vy;
  const double *ux, *uy; /* what they drift by; may be vx, vy */
  const double *ax, *ay; /* NULL: paths are straight */
} msri_flock;

/* Where masses are, or were. */
typedef struct msri_places {
  const double *x, *y; /* [n] */
} msri_places;

/* Where nothing else is said, q = x[n], y[n], likewise the others. */
typedef struct msri_contact {
  void *self;
  size_t bytes; /* that self takes */
  /* x += h u along a path bent by a, stopped where something is in the way, which reflects v, the
   * velocity in the middle of the drift. Returns the number of collisions. What masses are owed
   * (NULL: not wanted) goes with a: once that is paid, half a kick by the acceleration at the end
   * is more accurate. By ascending masses; calls for ranges that don't overlap may be made at once.
   */
  uint64_t (*drift)(const void *self, double h, const msri_flock *flock, msri_debts *debts);
  /* Up to MSRI_FLOCK_BLOCK masses have drifted so, as if nothing were in the way: of some of them,
   * a bit for each, puts those right that something is in the way of. */
  uint64_t (*stop_drift)(const void *self, double h, const msri_flock *block,
                         const msri_places *from, uint64_t some, msri_debts *debts);
  /* How far each of n masses can go, along either axis, and meet nothing, at least [px]; 0 as soon
   * as that is nothing for one of them. NULL: unknown. */
  double (*clearance)(const void *self, size_t n, const double *x, const double *y);
  /* As drift for n masses and a step that went from (q0, v0) to (q, v) as if nothing were in the
   * way; v is the velocity at the end, and has no half kick to come. */
  uint64_t (*bounce)(const void *self, size_t n, double h, const double *q0, const double *v0,
                     double *q, double *v, msri_debts *debts);
  /* As hold of msr_system: marks what would be stopped between q0 and q; tells whether it did.
   * NULL: that isn't how this contact works. */
  bool (*hold)(const void *self, size_t n, const double *q0, const double *q, bool *held);
  /* As rebound of msr_system, v being what elastic impacts leave. Returns the number of collisions.
   */
  uint64_t (*rebound)(const void *self, size_t n, const bool *held, const double *push, double *v);
  /* For a method that is to end its step at the first impact; NULL: none is. */
  void (*meet)(const void *self, size_t n, double h, const double *q0, const double *v0,
               const double *q, const double *v, msri_meeting *meeting);
  /* Puts those that met something between q0 and q on its edge and reflects v. Returns the number
   * of collisions. */
  uint64_t (*strike)(const void *self, size_t n, const double *q0, double *q, double *v);
  /* Stops one mass that is pushed from `from` to `to` [2] short of what is in the way, if anything
   * is: it keeps the coordinate along which it is. */
  bool (*stop)(const void *self, const double *from, double *to);
  void (*release)(void *self);
} msri_contact;

/* The black pixels of a picture and, if it's closed, its border. MSR_ENOMEM. */
typedef struct msri_supports_options {
  bool closed;
  double restitution, friction;
  msr_impacts impacts;
} msri_supports_options;
msr_status msri_supports_create(const msr_picture *picture, const msri_supports_options *options,
                                msri_contact *contact, msr_error *err);

#endif
