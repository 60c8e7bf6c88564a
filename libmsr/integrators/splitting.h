/* splitting.h - the kicks and drifts of which the splittings are made, for who takes them apart. */
#ifndef MSRI_SPLITTING_H
#define MSRI_SPLITTING_H

#include "base/base.h"

/* What happens between two drifts, in units of h: a kick, a half flow of what depends on v
 * backward, one forward, a kick. */
typedef struct msri_joint {
  double kick_before, damp_back, damp_forward, kick_after;
} msri_joint;

/* Drifts of a step; 0: the method is no splitting. Joint j comes before drift j, the last one,
 * `drifts`, after all of them. */
int msri_splitting_drifts(const msr_integrator *integrator);
msri_joint msri_splitting_joint(const msr_integrator *integrator, int j);
double msri_splitting_drift(const msr_integrator *integrator, int j);

#endif
