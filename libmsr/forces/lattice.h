/* lattice.h - cells of a square lattice side by side: their springs, and what follows from these
 * within a step, in one loop. */
#ifndef MSRI_LATTICE_H
#define MSRI_LATTICE_H

#include "base/base.h"

/* Springs that begin at a cell: to its right, and to the cells below it, right below it, one to the
 * left, one to the right. Along a row all are in the order of their cells. */
enum { MSRI_RIGHT, MSRI_BELOW, MSRI_BELOW_LEFT, MSRI_BELOW_RIGHT, MSRI_WAYS };

/* Forces of springs to the cells below. */
typedef struct msri_pull {
  double *x, *y;
} msri_pull;

enum { MSRI_LANES = 8 }; /* of the widest vector */

/* n cells of a row, or of rows one after the other. A cell without a mass, or at the
 * end of a row, has k 0 wherever there's no spring: whatever stands in its place is harmless. Rows
 * that follow each other are longer than MSRI_LANES. Forces from above may be where those to below
 * go, but for those of MSRI_BELOW_RIGHT. */
typedef struct msri_cells {
  size_t n;
  double *x, *y, *vx, *vy;         /* [n]; of x and y the cell to the right of the last, too */
  const double *below_x, *below_y; /* [n]: with diagonals, from -1 to n */
  const double *k[MSRI_WAYS];      /* [n] [kg/s^2] */
  msri_pull above[MSRI_WAYS];      /* [n]: of the springs that end at a cell; */
  msri_pull below[MSRI_WAYS];      /* [n] and of those that begin there: these are written */
} msri_cells;

/* What may act beside the springs: a weight; air between the kicks, which may push. */
enum { MSRI_WITH_WEIGHT = 1, MSRI_WITH_AIR = 2, MSRI_WITH_PUSH = 4, MSRI_BESIDES = 8 };

/* What a stage of a step does: forces, kicks, drift (see integrators/splitting.h). */
typedef struct msri_motion {
  double L[2];                /* of springs along a side, along a diagonal */
  double w;                   /* 1 / mass */
  double weight[2];           /* a force that is the same on each mass */
  double kick[2], drift;      /* times h */
  double keep[2], push[2][2]; /* between the kicks twice: v = keep v + push, along x and y */
  bool relaxes;               /* else there is no air in this stage */
  bool pushes;                /* else push is 0, and isn't added */
} msri_motion;

/* The same by vectors of some width: same bits by each of them. */
typedef struct msri_lattice_kernel {
  const char *name;
  bool (*runs_here)(void); /* has this machine got such vectors? NULL: every one has */
  struct {
    /* Forces, then kick, kick, drift; by what acts beside the springs. Returns the largest
     * velocity along an axis; NaN if one is. */
    double (*advance[MSRI_BESIDES])(const msri_cells *cells, const msri_motion *motion);
    /* The same without the drift; accelerations go to ax, ay [n]. */
    double (*kick[MSRI_BESIDES])(const msri_cells *cells, const msri_motion *motion, double *ax,
                                 double *ay);
    /* Only the forces of the springs to the cells below. */
    void (*pull)(const msri_cells *cells, const msri_motion *motion);
  } of[2]; /* 4 neighbours, 8 neighbours */
} msri_lattice_kernel;

/* Widest first; the last runs anywhere. */
extern const msri_lattice_kernel msri_lattice_kernels[];

/* The widest that runs here. */
const msri_lattice_kernel *msri_lattice_widest(void);

#endif
