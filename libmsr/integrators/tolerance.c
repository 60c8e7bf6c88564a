/* tolerance.c - see tolerance.h. The growth is that of Hairer, Norsett & Wanner, Solving Ordinary
 * Differential Equations I, 1993, II.4: among factors of safety from 0.75 to 0.95, and limits from
 * 2 to 5, 0.8 and 2 needed the fewest evaluations, as steps taken back are few. */
#include "integrators/tolerance.h"

#include <float.h>
#include <math.h>

msr_status msri_tolerance_check(msri_tolerance *tolerance, msr_error *err) {
  const double atol = tolerance->atol, rtol = tolerance->rtol;
  if (!(atol >= 0 && rtol >= 0 && isfinite(atol) && isfinite(rtol)))
    return msri_fail(err, MSR_EUSAGE,
                     "atol %g, rtol %g: each must be a finite number, 0 or more; with both 0, atol "
                     "is 1e-6",
                     atol, rtol);
  if (atol == 0 && rtol == 0) tolerance->atol = 1e-6;
  return MSR_OK;
}

static double largest(size_t n, const double *a) {
  double most = 0;
  for (size_t i = 0; i < n; i++) most = msri_worse(most, fabs(a[i]));
  return most;
}

static double fit(const msri_tolerance *tolerance, size_t n, const double *y, double h,
                  const double *slope) {
  const double rtol = msri_max(tolerance->rtol, 10 * DBL_EPSILON);
  const double size = largest(n, y), change = slope ? fabs(h) * largest(n, slope) : 0;
  return msri_max(tolerance->atol + rtol * msri_max(size, change), DBL_MIN / DBL_EPSILON);
}

void msri_tolerance_fit(msri_tolerance *tolerance, size_t n, const double *y, double h,
                        const double *slope) {
  tolerance->q = fit(tolerance, n, y, h, slope);
  tolerance->v = fit(tolerance, n, y + n, h, slope ? slope + n : NULL);
}

double msri_tolerance_share(const msri_tolerance *tolerance, size_t n, const double *e) {
  return msri_worse(largest(n, e) / tolerance->q, largest(n, e + n) / tolerance->v);
}

double msri_step_growth(double share, double p) {
  const double safety = 0.8, least = 0.2, most = 2;
  if (!isfinite(share)) return least;
  return share > 0 ? msri_max(least, msri_min(most, safety * pow(share, -1 / p))) : most;
}

double msri_step_portion(double h, double rest) {
  const double left = fabs(rest);
  if (h >= left) return rest;
  return copysign(2 * h > left ? left / 2 : h, rest);
}
