/* zones.h - masses of a drift that go the same way together. */
#ifndef MSRI_ZONES_H
#define MSRI_ZONES_H

#include "contacts/drift.h"

/* Every mass is a zone by itself. */
void msri_zones_part(msri_drift *d);

/* If the pair meets, makes one zone of theirs. Returns whether it did. */
bool msri_zones_join(msri_drift *d, size_t i, size_t j);

/* Makes one zone of all. */
void msri_zones_join_all(msri_drift *d);

#endif
