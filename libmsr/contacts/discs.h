/* discs.h - masses as discs that collide with each other. It acts after what stands in the way of
 * single masses, and around it: a mass that another pushes is stopped by a support. */
#ifndef MSRI_DISCS_H
#define MSRI_DISCS_H

#include "contacts/contact.h"

typedef struct msri_discs msri_discs;

/* For the masses and springs of `start`, whose m and m_stride the discs keep. `*discs` is NULL if
 * no two masses could meet: all are tied. MSR_ENOMEM; MSR_EUSAGE for 2^32 - 1 masses or more. */
msr_status msri_discs_create(const msr_view *start, double diameter, double restitution,
                             msri_discs **discs, msr_error *err);
void msri_discs_free(msri_discs *discs);

/* Bytes of the discs; of the memory that each state has for them, aligned as malloc's and zeroed at
 * first. */
size_t msri_discs_bytes(const msri_discs *discs);
size_t msri_discs_room(const msri_discs *discs);

/* Masses may be elsewhere than where the last drift left them, unless its places come by another
 * address. */
void msri_discs_moved(const msri_discs *discs, void *room);

/* All that may be met. */
typedef struct msri_obstacles {
  const msri_discs *discs;
  const msri_contact *supports; /* its drift NULL: none */
  void *room;                   /* the state's, for discs */
} msri_obstacles;

/* As msri_contact's drift and bounce. */
uint64_t msri_discs_drift(const msri_obstacles *all, double h, const double *u, const double *a,
                          double *q, double *v, msri_debts *debts);
uint64_t msri_discs_bounce(const msri_obstacles *all, double h, const double *q0, const double *v0,
                           double *q, double *v, msri_debts *debts);

#endif
