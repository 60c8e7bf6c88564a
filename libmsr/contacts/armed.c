/* armed.c - see armed.h. */
#include "contacts/armed.h"

#include "base/vector.h"

#include <math.h>

uint64_t msri_armed_drift(msri_armed *armed, const msri_contact *contact, double h,
                          const msri_flock *f, msri_debts *debts) {
  if (msri_armed_waits(armed)) return contact->drift(contact->self, h, f, debts);
  const double path = fabs(h) * msri_largest_of_two(f->n, f->ux, f->uy);
  if (msri_armed_covers(armed, path)) {
    msri_add_scaled(f->n, h, f->ux, f->x);
    msri_add_scaled(f->n, h, f->uy, f->y);
    return 0;
  }
  const uint64_t collisions = contact->drift(contact->self, h, f, debts);
  msri_armed_earn(armed, path, contact->clearance(contact->self, f->n, f->x, f->y));
  return collisions;
}
