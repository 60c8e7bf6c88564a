/* ties.h - which masses never collide: those that springs tie, and those of one body that are too
 * close from the start. */
#ifndef MSRI_TIES_H
#define MSRI_TIES_H

#include "base/base.h"

/* Mass i is tied to partner[first[i]] .. partner[first[i+1]-1], ascending, all above i. */
typedef struct msri_ties {
  size_t *first;     /* [n + 1] */
  uint32_t *partner; /* [first[n]] */
} msri_ties;

/* For discs of a diameter. MSR_EUSAGE if too many are closer than that; MSR_ENOMEM. */
msr_status msri_ties_create(const msr_view *start, double diameter, msri_ties *ties,
                            msr_error *err);
void msri_ties_clear(msri_ties *ties);

/* Is i tied to j, i < j? */
bool msri_ties_tied(const msri_ties *ties, size_t i, size_t j);

#endif
