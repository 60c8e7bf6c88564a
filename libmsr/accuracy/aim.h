/* aim.h - one method aims at an error: its largest step that is as accurate as asked. */
#ifndef MSRI_AIM_H
#define MSRI_AIM_H

#include "accuracy/measure.h"

/* The fineness r of a run is its number of substeps or, of an adaptive method, 1 px / atol. */
typedef struct msri_aim {
  const msr_integrator *integrator;
  double order;          /* error ~ r^-order */
  double growth;         /* cost ~ r^growth */
  double coarsest;       /* r is never below */
  double r;              /* of the next run */
  double cost;           /* that it may have */
  double failed, passed; /* the finest run that wasn't accurate, the coarsest that was; 0: none */
  double last_r, last_error; /* of the run before; 0: none */
  int tries;
  bool done;
} msri_aim;

/* The first run, up to `iterations`, is as coarse as is stable at any stretch. If others are
 * coarser it's for them to show that they are stable; `careful`: none is coarser than is safe for
 * ever so long. As msr_plan_create. */
msr_status msri_aim_begin(const msri_setting *setting, const msr_integrator *integrator,
                          uint64_t iterations, bool careful, double wanted, msri_aim *aim,
                          msr_error *err);

msr_plan_options msri_aim_options(const msri_setting *setting, const msri_aim *aim);

/* What follows a run that should have an error of at most `wanted`; was it good enough? */
void msri_aim_next(msri_aim *aim, const msri_measured *measured, double wanted, bool good);

#endif
