/* near.h - which blocks of cells something may be in the way of, and how long none is of the
 * others.
 *
 * The masses of a block have a clearance: a path that each of them can go, along either axis, and
 * meet nothing. It's used up by the most that a mass may go in a step, the same for all; before
 * it's gone, it's asked for anew. A block that has too little of it is near. */
#ifndef MSRI_NEAR_H
#define MSRI_NEAR_H

#include "sweep/field.h"

typedef struct msri_near {
  bool *block;   /* [n / MSRI_LANES] of n cells: it's near */
  double *gone;  /* how far masses may have gone so far [px] */
  double *until; /* of blocks that hold masses, in their order: none meets anything until so much
                    is gone; 0: unknown */
  double least;  /* the least of these, of blocks that aren't near */
  double pace;   /* the most speed that was reckoned with [px/s] */
  bool known;    /* which are near, `least` and `pace` */
} msri_near;

/* Other cells: `gone`, and `until` of [n / MSRI_LANES] at most, are the caller's, who keeps them
 * with the masses; all 0: nothing is known. */
void msri_near_open(msri_near *near, size_t n, double *gone, double *until);

/* A step of h begins. Returns the speed that masses may have in it where they aren't near. */
double msri_near_begin(const msri_pass *pass, double h, const msri_cells *cells, msri_near *near);

/* A mass of the block of a cell was faster than that: how far it can go is unknown. */
void msri_near_forget(const msri_cells *cells, size_t cell, msri_near *near);

/* A mass of the block of a cell may go any way in the step that has begun: it's near. */
void msri_near_mark(const msri_cells *cells, size_t cell, msri_near *near);

#endif
