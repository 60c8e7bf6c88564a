/* singles.h - factors and their use where strips are too short for vectors: pair by pair. */
#ifndef MSRI_SINGLES_H
#define MSRI_SINGLES_H

#include "solvers/lanes.h"
#include "solvers/stiffness.h"

/* What the way up sums: z A z and r D^-1 r. */
typedef struct msri_sums {
  msri_lanes zy, rz;
} msri_sums;

/* As of stiffness.h, for a graph of single pairs, anchors apart. */
void msri_singles_factorise(msri_stiffness *a);
void msri_singles_forward(const msri_stiffness *a, size_t from, size_t to, double *z);
msri_sums msri_singles_backward(const msri_stiffness *a, double *z, double *y);

#endif
