/* stage.h - steps of a splitting as a row of stages: forces where masses are, kicks, a drift. */
#ifndef MSRI_STAGE_H
#define MSRI_STAGE_H

#include "contacts/armed.h"
#include "forces/lattice.h"
#include "integrators/splitting.h"
#include "plan/plan.h"

typedef struct msri_stage {
  bool forces; /* else it only relaxes, if it does, and drifts */
  bool tells;  /* how fast masses are */
  msri_motion motion;
} msri_stage;

/* Of the stage that was asked for last what doesn't depend on time; all 0: of none. */
typedef struct msri_still {
  bool inside; /* a step of others before and after it: those at the same drift are alike */
  int drift;
  size_t air; /* the term; else their number */
  msri_joint joint;
  msri_stage stage;
} msri_still;

/* What is stepped: the arrays of a state. */
typedef struct msri_swept {
  double *x, *y, *vx, *vy; /* [masses] */
  char *scratch;           /* of the terms */
  uint64_t *calls;         /* of the effects, counted up */
  msri_armed_rows armed;   /* of the objects, if something may be in the way */
  msri_still *still;       /* kept from stage to stage */
} msri_swept;

/* A course of steps: from substep `substep` of an iteration on, so many. */
typedef struct msri_course {
  const msr_plan *plan;
  uint64_t iteration, substep, steps;
} msri_course;

/* Stages that it takes: between two steps the end of one and the beginning of the next are one. */
uint64_t msri_course_stages(const msri_course *course);

/* Those that evaluate forces, of a step among others. */
int msri_course_evaluations(const msr_plan *plan);

/* Stage k of them, counted in the calls of the state. */
msri_stage msri_course_stage(const msri_course *course, uint64_t k, const msri_swept *state);

#endif
