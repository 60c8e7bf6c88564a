/* air.h - the drag of air that moves at (ax, ay): F = c (a - v) on every mass. */
#ifndef MSRI_AIR_H
#define MSRI_AIR_H

#include "base/base.h"

typedef struct msri_air {
  double c;      /* [kg/s] */
  double ax, ay; /* [px/s] */
} msri_air;

/* What is left of velocities after a time h, where it was asked for last; all 0: nowhere. It only
 * saves time. */
typedef struct msri_air_decay {
  double h, m, keep;
} msri_air_decay;

/* Adds it to fx, fy [n]. */
void msri_air_add(const msri_air *air, const msr_view *s, double *fx, double *fy);

/* Its flow while the air's velocity is held, exactly: v = keep v + (1 - keep) a, keep being
 * exp(-c h / m). */
void msri_air_flow(const msri_air *air, const msr_view *s, double h, double *vx, double *vy);

/* The same for equal masses, as msr_force's relax. */
double msri_air_relax(const msri_air *air, const msr_view *s, double h, msri_air_decay *last,
                      double *push);

/* The largest c / m. */
double msri_air_rate(double c, const msr_view *s);

#endif
