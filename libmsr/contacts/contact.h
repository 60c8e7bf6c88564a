/* contact.h - what may stand in the way of a drift, behind one interface. */
#ifndef MSRI_CONTACT_H
#define MSRI_CONTACT_H

#include "base/base.h"

typedef struct msri_contact {
  void *self;
  /* q += h u for n masses (q = x[n], y[n], likewise the others) along a path bent by a (may be
   * NULL), stopped where something is in the way, which reflects v. Returns the number of
   * collisions. */
  uint64_t (*drift)(const void *self, size_t n, double h, const double *u, const double *a,
                    double *q, double *v);
  /* The same for a step that went from (q0, v0) to (q, v) as if nothing were in the way. */
  uint64_t (*bounce)(const void *self, size_t n, double h, const double *q0, const double *v0,
                     double *q, double *v);
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
