/* motion.h - what forces do to masses along an axis within a stage: see msri_motion. */
#ifndef MSRI_MOTION_H
#define MSRI_MOTION_H

#include "forces/lattice.h"

typedef struct msri_moved {
  size_t n;
  double *q, *v; /* [n] */
  double *f;     /* [n] forces of the springs; */
  double *next;  /* [n] what takes their place, and 0 the place of that; NULL: 0 takes theirs */
} msri_moved;

/* Kicks, with air between them or not, and drift, as the lattice's kernels do. Returns the largest
 * velocity; NaN if one is. */
double msri_move(const msri_moved *moved, const msri_motion *motion, int axis, int besides);

/* The same without forces: velocities relax in air, if there is any, and drift. v, q [n]. */
void msri_coast(size_t n, const msri_motion *motion, int axis, double *v, double *q);

#endif
