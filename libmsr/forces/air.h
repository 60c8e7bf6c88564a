/* air.h - the drag of air that moves at (ax, ay): F = c (a - v) on every mass. */
#ifndef MSRI_AIR_H
#define MSRI_AIR_H

#include "base/base.h"

typedef struct msri_air {
  double c;      /* [kg/s] */
  double ax, ay; /* [px/s] */
} msri_air;

/* Adds it to fx, fy [n]. */
void msri_air_add(const msri_air *air, const msr_view *s, double *fx, double *fy);

/* Its flow while the air's velocity is held, exactly: v tends to a as exp(-c h / m). */
void msri_air_flow(const msri_air *air, const msr_view *s, double h, double *vx, double *vy);

/* The same for equal masses, as msr_force's relax. */
double msri_air_relax(const msri_air *air, const msr_view *s, double h, double *u);

/* The largest c / m. */
double msri_air_rate(double c, const msr_view *s);

#endif
