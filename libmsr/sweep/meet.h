/* meet.h - cells past what is in the way: kicks and drifts as if nothing were, and then a look at
 * those masses that may have come to a support.
 *
 * A block of cells is near what is in the way, or all its masses have a clearance: a path that each
 * can go and meet nothing. Blocks that are near tell who leaves its pixel. Of the others the
 * clearance is used up by the most that a mass may go in a step; who goes further is told, and put
 * right in that very step, so that none is missed. */
#ifndef MSRI_MEET_H
#define MSRI_MEET_H

#include "contacts/debts.h"
#include "sweep/field.h"
#include "sweep/tally.h"

/* What some cells need for that; each mass among them may be owed something. */
typedef struct msri_meet {
  msri_lookout watch;
  size_t blocks;
  bool *near;    /* [blocks]: some of its masses may have a support close by */
  double *gone;  /* how far the fastest mass may have gone, all in all */
  double *until; /* [blocks]: none meets anything until so much is gone; 0: unknown */
  double least,
      pace;         /* the least of that among those that aren't near; speed that masses may have */
  bool asked;       /* all that is known */
  double *before;   /* [2][masses]: velocities of those that are owed something */
  msri_debts debts; /* they name cells */
  msri_tally *tally;
} msri_meet;

/* Doubles of memory, for cells in whole blocks, and for so many of them that are masses: that is
 * kept from stage to stage; and of a stage. */
size_t msri_meet_size(size_t cells, size_t masses);
size_t msri_meet_stage_size(size_t cells);

/* Carves it from both; nobody is owed anything, and nothing is known. */
msri_meet msri_meet_place(size_t cells, size_t masses, double *kept, double *stage,
                          msri_tally *tally);

/* Other cells, of which that is known; it's kept up to date. */
void msri_meet_open(msri_meet *meet, double *gone, double *until);

/* A stage of cells: kicks, those of what is owed first, and a drift past what is in the way.
 * Returns the largest velocity along an axis, if the stage tells; else 0. */
double msri_meet_step(const msri_pass *pass, const msri_stage *stage, const msri_cells *cells,
                      msri_meet *meet);

#endif
