/* meet.h - cells past what is in the way: kicks and drifts as if nothing were, and then a look at
 * those masses that may have come to a support. In blocks that are near one those are told that
 * leave their pixel, elsewhere those that are faster than was reckoned with; they are put right in
 * that very step, so that none is missed. */
#ifndef MSRI_MEET_H
#define MSRI_MEET_H

#include "contacts/debts.h"
#include "sweep/near.h"
#include "sweep/tally.h"

/* What some cells need for that; each mass among them may be owed something. */
typedef struct msri_meet {
  msri_lookout watch;
  msri_near near;
  size_t blocks;
  double *before;   /* [masses][2]: velocities of those that are owed something */
  msri_debts debts; /* they name cells */
  msri_tally *tally;
} msri_meet;

/* Doubles of memory, for cells in whole blocks, and for so many of them that are masses: of a
 * stage, a multiple of MSRI_MARGIN; and that is kept from stage to stage. */
size_t msri_meet_stage_size(size_t cells);
size_t msri_meet_size(size_t cells, size_t masses);

/* Carves it from both; nobody is owed anything, and nothing is known. */
msri_meet msri_meet_place(size_t cells, size_t masses, double *stage, double *kept,
                          msri_tally *tally);

/* A stage of cells: kicks, those of what is owed first, and a drift past what is in the way.
 * Returns the largest velocity along an axis, if the stage tells; else 0. */
double msri_meet_step(const msri_pass *pass, const msri_stage *stage, const msri_cells *cells,
                      msri_meet *meet);

#endif
