/* limits.h - what the analysis of a plan's stable steps is made of. */
#ifndef MSRI_LIMITS_H
#define MSRI_LIMITS_H

#include "plan/plan.h"

/* A plan at its start. */
typedef struct msri_start {
  const msr_plan *plan;
  msr_view view;  /* x, y, vx and vy NULL: nothing depends on them */
  size_t side[2]; /* of a full rectangle of 4 neighbours, which is all there is; 0: it isn't */
  bool vast;      /* more masses than matrices are analysed of: nothing is made that has their
                   * number, unless a force asks where masses begin (msr_force.ignores_start) */
  double other2;  /* bound of omega^2 of all forces but springs [1/s^2] */
  double flow, midpoint; /* bounds of the rates of damping of forces that have a flow, and of those
                          * that methods that split take an explicit midpoint step of [1/s] */
} msri_start;

/* The limit with damping, of which `omega` and how it was found are given. What a force or the
 * integrator returns, MSR_ENOMEM. */
msr_status msri_limits_damp(const msri_start *s, msr_limit *limit, msr_error *err);

#endif
