/* study.h - a study of accuracy as its user sees it: progress on a terminal, Ctrl-C. */
#ifndef CLI_STUDY_H
#define CLI_STUDY_H

#include "options.h"

typedef struct study {
  const settings *s;
  msr_accuracy *result;
  msr_accuracy_figures figures;
  const msr_accuracy_point *point; /* [n] */
  size_t n;
  double dt, time; /* of an iteration, of the whole scene [s] */
  bool contacts;   /* something may be hit: impacts were located */
  bool *risky;     /* [n]: stable so far, at a step that may explode in the rest of the scene */
} study;

/* Studies the scene; signals must be caught already. After a signal it holds what was measured so
 * far. What msr_accuracy_study returns. */
msr_status study_run(study *st, const settings *s, const msr_scene *scene, msr_error *err);

void study_free(study *st);

/* Tells the user of times that are shorter than they seem. */
void study_tell_limits(const study *st);

/* Does the scene go on after what was compared? */
bool study_short(const study *st);

/* The order measured at a point, in table and CSV; NAN: errors are too small to measure one. */
double study_order(const study *st, size_t i);

/* Chooses for --accuracy. What msr_accuracy_choose returns. */
msr_status study_choose(const settings *s, const msr_scene *scene, msr_accuracy_choice *choice,
                        msr_error *err);

/* Tells the user what was chosen, and why. */
void study_tell_choice(const settings *s, const msr_accuracy_choice *choice);

#endif
