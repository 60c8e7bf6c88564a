/* lattice.h - cells of a square lattice side by side: their springs, and what follows from these
 * within a step, in one loop. */
#ifndef MSRI_LATTICE_H
#define MSRI_LATTICE_H

#include "base/base.h"

/* Springs that begin at a cell: to its right, and to the cells below it, right below it, one to the
 * left, one to the right. Along a row all are in the order of their cells. */
enum { MSRI_RIGHT, MSRI_BELOW, MSRI_BELOW_LEFT, MSRI_BELOW_RIGHT, MSRI_WAYS };

/* From a cell, columns to where a spring to below ends. */
static inline ptrdiff_t msri_lattice_shift(int way) {
  return way == MSRI_BELOW_LEFT ? -1 : way == MSRI_BELOW_RIGHT ? 1 : 0;
}

/* Forces of springs to the cells below. */
typedef struct msri_pull {
  double *x, *y;
} msri_pull;

/* Cells side by side that are worked on together: as many as the widest vector has lanes. */
enum { MSRI_LANES = 8 };

/* Bit by bit, from the first cell on: where there is a mass, where springs begin, and where those
 * from above end. */
typedef struct msri_block {
  uint32_t cell; /* the first: a multiple of MSRI_LANES */
  uint8_t mass, tie[MSRI_WAYS], tied[MSRI_WAYS];
} msri_block;

/* n cells of a row, or of rows one after the other. Those without a mass are all 0, and stay so, if
 * they are in a block with others; elsewhere, and around the cells, what is there is harmless. Rows
 * that follow each other are longer than MSRI_LANES. Forces to below are left in `pull`; those from
 * above are `back` after the place where those to below go, and may be overwritten, but for those
 * of MSRI_BELOW_RIGHT. */
typedef struct msri_cells {
  size_t n;                        /* a multiple of MSRI_LANES */
  double *x, *y, *vx, *vy;         /* [n]; of x and y the cell to the right of the last, too */
  const double *below_x, *below_y; /* [n]: with diagonals, from -1 to n */
  const msri_block *block;         /* [blocks]: those that hold masses, from the left */
  size_t blocks;
  msri_pull pull[MSRI_WAYS]; /* [n] */
  ptrdiff_t back[MSRI_WAYS];
} msri_cells;

/* Of n cells: their accelerations, and where they were before they drifted. */
typedef struct msri_trace {
  double *ax, *ay, *x, *y; /* [n] */
} msri_trace;

/* A look at masses that something may be in the way of. In blocks that are near it those are told
 * that leave their pixel, elsewhere those that go faster than they may, and what is no number.
 * Those that are near, or told, leave their trace; others may. */
typedef struct msri_lookout {
  const bool *near; /* [n / MSRI_LANES] */
  uint8_t *told;    /* [n / MSRI_LANES]: a bit for each of a block, added to what is there */
  double speed;     /* that masses may have */
  msri_trace trace;
  bool ran; /* one that isn't near was told: set by the kernel */
} msri_lookout;

/* What may act beside the springs: a weight; air between the kicks, which may push. */
enum { MSRI_WITH_WEIGHT = 1, MSRI_WITH_AIR = 2, MSRI_WITH_PUSH = 4, MSRI_BESIDES = 8 };

/* What a stage of a step does: forces, kicks, drift (see integrators/splitting.h). */
typedef struct msri_motion {
  double k, L[2];             /* of springs: along a side, along a diagonal */
  double w;                   /* 1 / mass */
  double weight[2];           /* a force that is the same on each mass */
  double kick[2], drift;      /* times h */
  double keep[2], push[2][2]; /* between the kicks twice: v = keep v + push, along x and y */
  bool relaxes;               /* else there is no air in this stage */
  bool pushes;                /* else push is 0, and isn't added */
} msri_motion;

/* Loops over cells, for springs to 4 neighbours or to 8. */
typedef struct msri_loops {
  /* Forces, then kick, kick, drift; by what acts beside the springs. */
  void (*advance[MSRI_BESIDES])(const msri_cells *cells, const msri_motion *motion);
  /* The same, watched. */
  void (*watch[MSRI_BESIDES])(const msri_cells *cells, const msri_motion *motion,
                              msri_lookout *watch);
  /* Only the forces of the springs to the cells below. */
  void (*pull)(const msri_cells *cells, const msri_motion *motion);
} msri_loops;

/* Those by vectors of some width: same bits by each of them. */
typedef struct msri_lattice_kernel {
  const char *name;
  bool (*runs_here)(void); /* has this machine got such vectors? NULL: every one has */
  msri_loops four, eight;
  /* The largest velocity of a mass along an axis; NaN if one is. */
  double (*fastest)(const msri_cells *cells);
} msri_lattice_kernel;

/* Widest first; the last runs anywhere. */
extern const msri_lattice_kernel msri_lattice_kernels[];

/* The widest that runs here. */
const msri_lattice_kernel *msri_lattice_widest(void);

#endif
