/* shares.h - whose the time of a sweep is. */
#ifndef MSRI_SHARES_H
#define MSRI_SHARES_H

#include "sweep/field.h"
#include "sweep/tally.h"

/* What kernels do; the last is the integrator's. */
enum { MSRI_SHARE_SPRINGS, MSRI_SHARE_WEIGHT, MSRI_SHARE_AIR, MSRI_SHARE_MOTION, MSRI_SHARES };

typedef struct msri_shares {
  double *memory;             /* [msri_shares_size] */
  double share[MSRI_SHARES];  /* summed over what was measured */
  double measuring, sweeping; /* time so far [s] */
  double copying;             /* rows in and out: its part of the integrator's share */
  double drifts;              /* past what is in the way, over kicks before them */
  uint32_t turn;
} msri_shares;

/* Doubles of memory that measuring takes. */
size_t msri_shares_size(const msr_plan *plan, int ways);

/* What reading the clock takes [s]. */
double msri_shares_clock(void);

/* Measures shares on some masses as they are, before a pass; does nothing if enough of the time
 * went there already. */
void msri_shares_measure(msri_shares *shares, const msri_pass *pass);

/* Time of a sweep [s] from the integrator's seconds to those of all effects. */
void msri_shares_split(msri_shares *shares, const msr_plan *plan, double spent, double *seconds);

#endif
