/* air.c - the drag of air that moves, which still air and wind share. */
#include "forces/air.h"

#include <math.h>

void msri_air_add(const msri_air *air, const msr_view *s, double *fx, double *fy) {
  for (size_t i = 0; i < s->n; i++) {
    fx[i] += air->c * (air->ax - s->vx[i]);
    fy[i] += air->c * (air->ay - s->vy[i]);
  }
}

static double keep_of(const msri_air *air, double h, double m) { return exp(-air->c * h / m); }

void msri_air_flow(const msri_air *air, const msr_view *s, double h, double *vx, double *vy) {
  const bool still = air->ax == 0 && air->ay == 0;
  double keep = s->n > 0 ? keep_of(air, h, s->m[0]) : 1;
  for (size_t i = 0; i < s->n; i++) {
    if (s->m_stride) keep = keep_of(air, h, s->m[i]);
    vx[i] *= keep, vy[i] *= keep;
    if (still) continue;
    vx[i] += (1 - keep) * air->ax;
    vy[i] += (1 - keep) * air->ay;
  }
}

double msri_air_relax(const msri_air *air, const msr_view *s, double h, msri_air_decay *last,
                      double *push) {
  const double m = s->m[0];
  if (last->h != h || last->m != m) *last = (msri_air_decay){h, m, keep_of(air, h, m)};
  push[0] = (1 - last->keep) * air->ax;
  push[1] = (1 - last->keep) * air->ay;
  return last->keep;
}

double msri_air_rate(double c, const msr_view *s) {
  double most = 0;
  for (size_t i = 0; i < msri_masses_that_differ(s); i++)
    most = msri_max(most, c / msr_view_mass(s, i));
  return most;
}
