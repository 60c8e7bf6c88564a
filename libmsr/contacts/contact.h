/* contact.h - what may stand in the way of a drift, behind one interface. */
#ifndef MSRI_CONTACT_H
#define MSRI_CONTACT_H

#include "base/base.h"

typedef struct msri_contact {
  void *self;
  /* q += h u for n masses (q = x[n], y[n], likewise u and v), stopped where something is in the
   * way, which reflects v. Returns the number of collisions. */
  uint64_t (*move)(const void *self, size_t n, double h, const double *u, double *q, double *v);
  void (*release)(void *self);
} msri_contact;

/* The black pixels of a picture and, if it's closed, its border. MSR_ENOMEM. */
typedef struct msri_supports_options {
  bool closed;
  double restitution, friction;
} msri_supports_options;
msr_status msri_supports_create(const msr_picture *picture, const msri_supports_options *options,
                                msri_contact *contact, msr_error *err);

#endif
