/* limit_kernel.h - the machine's own limit: one step of a row of a full lattice, stripped of all
 * that a library needs (holes, other forces, a guard). Symplectic Euler, which goes through
 * Verlet's positions if it begins with velocities of half a step before:
 *
 *     u += h/m sum k (1 - L / |d|) d,    x += h u
 *
 * Each spring is computed once: those to the right are kept in registers, those to the row below in
 * a row that is handed on. Nothing else is left but a square root and a division for each, so the
 * divider of the machine is what bounds it. */
#ifndef LIMIT_KERNEL_H
#define LIMIT_KERNEL_H

#include <stddef.h>

/* n columns; rows are `pitch` apart, with room for whole vectors and one more. */
typedef struct lattice {
  size_t n, rows, pitch;
  double *x, *y, *u, *v; /* [rows + 1][pitch] */
} lattice;

/* Forces on a row of masses by the springs below it, times h/m. */
typedef struct forces {
  double *x, *y; /* [pitch] */
} forces;

typedef struct limit_kernel {
  const char *vectors;
  int (*runs_here)(void); /* NULL: everywhere */
  /* Springs from row to row + 1. */
  void (*edge)(const lattice *g, size_t row, forces f);
  /* Steps a row: `f` holds what those above it do on entry, what it does to the row below on exit.
   * `known`: what the row below does, computed before; NULL: to be computed now. */
  void (*step)(const lattice *g, size_t row, forces f, const forces *known);
} limit_kernel;

/* The widest that runs here. */
const limit_kernel *limit_kernel_here(void);

#endif
