/* air.c - the drag of air that moves, which still air and wind share. */
#include "forces/air.h"

#include <math.h>

void msri_air_add(const msri_air *air, const msr_view *s, double *fx, double *fy) {
  for (size_t i = 0; i < s->n; i++) {
    fx[i] += air->c * (air->ax - s->vx[i]);
    fy[i] += air->c * (air->ay - s->vy[i]);
  }
}

void msri_air_flow(const msri_air *air, const msr_view *s, double h, double *vx, double *vy) {
  double keep = s->n > 0 ? exp(-air->c * h / s->m[0]) : 1;
  for (size_t i = 0; i < s->n; i++) {
    if (s->m_stride) keep = exp(-air->c * h / s->m[i]);
    vx[i] = air->ax + (vx[i] - air->ax) * keep;
    vy[i] = air->ay + (vy[i] - air->ay) * keep;
  }
}

double msri_air_relax(const msri_air *air, const msr_view *s, double h, double *u) {
  u[0] = air->ax, u[1] = air->ay;
  return exp(-air->c * h / s->m[0]);
}

double msri_air_rate(double c, const msr_view *s) {
  double most = 0;
  for (size_t i = 0; i < msri_masses_that_differ(s); i++)
    most = msri_max(most, c / msr_view_mass(s, i));
  return most;
}
