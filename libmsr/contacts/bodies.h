/* bodies.h - which masses hold together: those tied to each other, directly or through others. Few
 * that do, and loose ones, count as one body: the first that has any such. */
#ifndef MSRI_BODIES_H
#define MSRI_BODIES_H

#include "base/base.h"
#include "contacts/ties.h"

/* Masses begin .. end-1. */
typedef struct msri_stretch {
  size_t begin, end;
} msri_stretch;

typedef struct msri_bodies {
  size_t n, n_masses;
  uint32_t *of;          /* [n_masses]: the body of each */
  size_t *first;         /* [n + 1]: body b is stretch[first[b]] .. stretch[first[b+1]-1] */
  msri_stretch *stretch; /* [first[n]]; those of a body ascending */
} msri_bodies;

/* MSR_ENOMEM. */
msr_status msri_bodies_create(size_t n_masses, const msri_ties *ties, msri_bodies *bodies,
                              msr_error *err);
void msri_bodies_clear(msri_bodies *bodies);
size_t msri_bodies_bytes(const msri_bodies *bodies);

/* Its masses, in order, to set. Returns their number. */
size_t msri_bodies_masses(const msri_bodies *bodies, size_t body, uint32_t *set);

#endif
