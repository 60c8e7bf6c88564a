/* duel.h - two unrelated methods, side by side, as far as they agree. */
#ifndef MSRI_DUEL_H
#define MSRI_DUEL_H

#include "accuracy/reference.h"

/* A method, and how fine its steps are at the first level: substeps over the fewest that are stable
 * at any stretch, or tolerance [px]. From level to level steps are halved and tolerances divided
 * by 100. */
typedef struct msri_entrant {
  const msr_integrator *integrator;
  double fineness, atol;
} msri_entrant;

typedef struct msri_rivals {
  msri_entrant truth, witness;
} msri_rivals;

/* A reference, of 0 instants if they don't agree at all, up to where they differ by more than
 * `parted`, or where one of them is stopped or unstable. */
msr_status msri_duel(msri_setting *setting, const msri_rivals *pair, int level, double parted,
                     msri_reference *reference, msr_error *err);

#endif
