/* result.h - what a study says. */
#ifndef MSRI_RESULT_H
#define MSRI_RESULT_H

#include "base/base.h"

struct msr_accuracy {
  msr_accuracy_figures figures;
  msr_accuracy_point *point; /* [n] */
  size_t n, capacity;
};

/* MSR_ENOMEM. */
msr_status msri_result_add(msr_accuracy *made, const msr_accuracy_point *point, msr_error *err);

/* Is there a point of the very same run? Adaptive methods may make it from several tolerances. */
bool msri_result_has(const msr_accuracy *made, const msr_accuracy_point *point);

/* Sorts the points, given all methods in order; finds orders and the front. */
void msri_result_finish(msr_accuracy *made, const msr_integrator *const *order);

#endif
