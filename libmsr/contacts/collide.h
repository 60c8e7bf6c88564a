/* collide.h - the collisions of a drift. */
#ifndef MSRI_COLLIDE_H
#define MSRI_COLLIDE_H

#include "contacts/drift.h"
#include "contacts/lists.h"

/* Changes the drift so that no discs get nearer than they may; lists->box holds the boxes of its
 * paths. q is where places are stored from one drift to the next; NULL: others may have moved them
 * since the last. Returns the number of collisions. */
uint64_t msri_collide(msri_drift *drift, msri_lists *lists, const double *q);

#endif
