/* tolerance.h - what an adaptive method is asked for, and the steps that follow from it.
 *
 * A step's error is to be within atol + rtol |q| in q and, with times in seconds, atol + rtol |v|
 * in v, |.| being the largest component. An error e of v displaces a mode of angular frequency
 * omega by e / omega, and there are some omega steps in a second: so v's errors make some atol px a
 * second, however stiff the springs are. */
#ifndef MSRI_TOLERANCE_H
#define MSRI_TOLERANCE_H

#include "base/base.h"

typedef struct msri_tolerance {
  double atol, rtol;
  double q, v; /* of the step under way, > 0 */
} msri_tolerance;

/* Are atol and rtol finite and 0 or more? Both 0: atol becomes 1e-6. MSR_EUSAGE. */
msr_status msri_tolerance_check(msri_tolerance *tolerance, msr_error *err);

/* Fits q and v to y = q[n], v[n] at the start of a step of h, or, if that is more, to its change,
 * h y' (slope; NULL: unknown); never below what rounding does to them. */
void msri_tolerance_fit(msri_tolerance *tolerance, size_t n, const double *y, double h,
                        const double *slope);

/* The largest |e| over tolerance, e = of q[n], of v[n]; not finite if an element isn't. */
double msri_tolerance_share(const msri_tolerance *tolerance, size_t n, const double *e);

/* The next step over one whose error, of order h^p, had this share of the tolerance. */
double msri_step_growth(double share, double p);

/* The step towards a time `rest` ahead (or, if it's negative, back), of h > 0 at most: what is left
 * after it is nothing, or as long at least. */
double msri_step_portion(double h, double rest);

#endif
