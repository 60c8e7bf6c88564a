/* reference.h - the truth, as far as it can be known: a fine run, and how far another, unrelated
 * one is from it. */
#ifndef MSRI_REFERENCE_H
#define MSRI_REFERENCE_H

#include "accuracy/trial.h"

typedef struct msri_reference {
  size_t n;       /* instants up to the horizon */
  bool parted;    /* it is where the two part; else the end, or where time was up */
  double *q;      /* [n][2 masses]: x, y */
  double *energy; /* [n] total */
  double *gap;    /* [n] largest difference of the two so far [px] */
  msr_plan_options truth, witness;
  double cost; /* of both up to the horizon */
} msri_reference;

/* How good it should be. */
typedef struct msri_reference_goal {
  double parted; /* beyond this difference they don't agree [px] */
  double enough; /* a smaller one needn't be refined [px] */
  double
      longer; /* share by which an early horizon must move for refining to pay; 0: any gain pays */
  double share;       /* of the budget */
  const char *advice; /* to the user, if there is none */
} msri_reference_goal;

/* Finds the longest and finest reference. MSR_EUNSTABLE if two methods agree at no instant, or what
 * the caller's poll returned before they did. */
msr_status msri_reference_find(msri_setting *setting, const msri_reference_goal *goal,
                               msri_reference *reference, msr_error *err);
void msri_reference_clear(msri_reference *reference);

/* The reference's own error up to the horizon [px]. */
static inline double msri_reference_error(const msri_reference *reference) {
  return reference->gap[reference->n - 1];
}

#endif
