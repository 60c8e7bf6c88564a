/* discs.c - masses as discs that collide without friction, so that momentum and angular momentum
 * are kept: first masses go where supports let them, then those that meet another are put right
 * (collide.c). */
#include "contacts/discs.h"

#include "base/vector.h"
#include "contacts/collide.h"
#include "contacts/flock.h"

#include <stdlib.h>
#include <string.h>

struct msri_discs {
  size_t n;
  const double *m;
  size_t m_stride;
  double diameter, restitution;
  msri_ties ties;
  msri_bodies bodies;
};

/* ---- Memory of a state: a vector, the zones, what is known of who may meet */

/* A drift, and which pairs may meet in it. */
typedef struct work {
  msri_drift d;
  msri_lists lists;
  double *vector; /* [2n] */
} work;

static work place(const msri_discs *discs, char *room, size_t *end) {
  const size_t n = discs->n;
  work c = {.d = {.n = n,
                  .m = discs->m,
                  .m_stride = discs->m_stride,
                  .diameter = discs->diameter,
                  .restitution = discs->restitution}};
  c.vector = msri_near_part(room, end, 2 * n * sizeof *c.vector);
  c.d.zone = msri_near_part(room, end, n * sizeof *c.d.zone);
  c.d.next = msri_near_part(room, end, n * sizeof *c.d.next);
  c.d.pass = msri_near_part(room, end, n * sizeof *c.d.pass);
  c.d.held = msri_near_part(room, end, 2 * n);
  c.lists = msri_lists_place(&discs->bodies, discs->diameter, &discs->ties, room, end);
  return c;
}

size_t msri_discs_room(const msri_discs *discs) {
  size_t end = 0;
  place(discs, NULL, &end);
  return end;
}

static work begin(const msri_obstacles *all, double h) {
  size_t end = 0;
  work c = place(all->discs, all->room, &end);
  c.d.supports = all->supports, c.d.h = h;
  return c;
}

void msri_discs_moved(const msri_discs *discs, void *room) {
  size_t end = 0;
  const work c = place(discs, room, &end);
  c.lists.kept->q = NULL;
}

/* ---- Drift and bounce */

/* Where no pair is near a look at velocities is enough. */
static bool drifts_alone(work *c, double h, const double *u, double *q) {
  msri_lists *const w = &c->lists;
  if (!msri_lists_is_idle(w, q)) return false;
  msri_displacement_measure(w->bodies, NULL, u, w->box);
  if (!msri_lists_foresees(w, h)) return false;
  msri_add_scaled(2 * c->d.n, h, u, q);
  msri_lists_end(w, q);
  return true;
}

uint64_t msri_discs_drift(const msri_obstacles *all, double h, const double *u, const double *a,
                          double *q, double *v, msri_debts *debts) {
  uint64_t met = 0;
  const msri_contact *supports = all->supports;
  work c = begin(all, h);
  msri_drift *const d = &c.d;
  if (!supports->drift && drifts_alone(&c, h, u, q)) return 0;
  memcpy(c.vector, q, 2 * d->n * sizeof *q);
  const msri_flock flock = msri_flock_of(d->n, u, a, q, v);
  if (supports->drift)
    met = supports->drift(supports->self, h, &flock, debts);
  else
    msri_add_scaled(2 * d->n, h, u, q);
  msri_displacement_measure(c.lists.bodies, c.vector, q, c.lists.box);
  d->debts = supports->drift ? debts : NULL;
  d->q0 = c.vector, d->q = q, d->v = v;
  d->kick = a, d->unit = h;
  return met + msri_collide(d, &c.lists, q);
}

uint64_t msri_discs_bounce(const msri_obstacles *all, double h, const double *q0, const double *v0,
                           double *q, double *v, msri_debts *debts) {
  uint64_t met = 0;
  const msri_contact *supports = all->supports;
  work c = begin(all, h);
  msri_drift *const d = &c.d;
  double *const kick = c.vector;
  for (size_t i = 0; i < 2 * d->n; i++) kick[i] = v[i] - v0[i];
  if (supports->bounce) met = supports->bounce(supports->self, d->n, h, q0, v0, q, v, debts);
  msri_displacement_measure(c.lists.bodies, q0, q, c.lists.box);
  d->q0 = q0, d->q = q, d->v = v;
  d->kick = kick, d->unit = 1, d->behind = 0.5;
  d->debts = supports->bounce ? debts : NULL;
  return met + msri_collide(d, &c.lists, NULL);
}

/* ---- Creation */

size_t msri_discs_bytes(const msri_discs *d) {
  return sizeof *d + (d->n + 2) * sizeof *d->ties.first +
         d->ties.first[d->n] * sizeof *d->ties.partner + msri_bodies_bytes(&d->bodies);
}

static bool all_tied(size_t n, const msri_ties *ties) {
  return ties->first[n] == (n % 2 ? (n - 1) / 2 * n : n / 2 * (n - 1));
}

msr_status msri_discs_create(const msr_view *start, double diameter, double restitution,
                             msri_discs **discs, msr_error *err) {
  if (start->n >= UINT32_MAX)
    return msri_fail(err, MSR_EUSAGE, "%zu masses are too many for collisions between them",
                     start->n);
  msri_discs *made = msri_alloc(1, sizeof *made, "collisions", err);
  if (!made) return MSR_ENOMEM;
  *made = (msri_discs){.n = start->n,
                       .m = start->m,
                       .m_stride = start->m_stride,
                       .diameter = diameter,
                       .restitution = restitution};
  msr_status status = msri_ties_create(start, diameter, &made->ties, err);
  const bool none = status == MSR_OK && all_tied(start->n, &made->ties);
  if (status == MSR_OK && !none)
    status = msri_bodies_create(start->n, &made->ties, &made->bodies, err);
  if (status != MSR_OK || none) {
    msri_discs_free(made);
    made = NULL;
  }
  if (status == MSR_OK) *discs = made;
  return status;
}

void msri_discs_free(msri_discs *discs) {
  if (!discs) return;
  msri_ties_clear(&discs->ties);
  msri_bodies_clear(&discs->bodies);
  free(discs);
}
