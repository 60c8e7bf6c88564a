/* mesh.h - what the forces along springs share. */
#ifndef MSRI_MESH_H
#define MSRI_MESH_H

#include "base/base.h"

/* Largest row sum of the matrix of a force w n along every spring, divided by the masses: a bound
 * (Gershgorin) of its eigenvalues when each spring's own is w at most. The weight of a spring is
 * its stiffness if `weight` is NULL, else *weight. MSR_ENOMEM. */
msr_status msri_mesh_bound(const msr_view *s, const double *weight, double *bound);

/* The largest length over rest length of a spring with L > 0; 0: there is none. */
double msri_mesh_longest(const msr_view *s);

/* The largest k (L - l) / (l m) of a spring between masses, m the lighter of them, 0 if none is
 * compressed: the square of the rate at which it gives way to the side [1/s^2]. */
double msri_mesh_buckling(const msr_view *s);

#endif
