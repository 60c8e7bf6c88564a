/* meet.h - cells past what is in the way: kicks and drifts as if nothing were, and then a look at
 * those masses that may have come to a support. */
#ifndef MSRI_MEET_H
#define MSRI_MEET_H

#include "contacts/debts.h"
#include "sweep/field.h"
#include "sweep/tally.h"

/* What some cells need for that; each mass among them may be owed something. */
typedef struct msri_meet {
  msri_trace trace; /* [cells] of a stage */
  double *before;   /* [2][masses]: velocities of those that are owed something */
  msri_debts debts; /* they name cells */
  msri_tally *tally;
} msri_meet;

/* Doubles of memory for a cell's trace, and for what a mass may be owed. */
enum { MSRI_MEET_TRACE = 4, MSRI_MEET_DEBT = 2 + sizeof(msri_debt) / sizeof(double) };

/* Carves a trace from memory. */
msri_trace msri_meet_trace(size_t cells, double *memory);

/* Carves all of it from memory of MSRI_MEET_TRACE cells + MSRI_MEET_DEBT masses doubles; nobody is
 * owed anything. */
msri_meet msri_meet_place(size_t cells, size_t masses, double *memory, msri_tally *tally);

/* A stage of cells as if nothing were in the way; those that are owed something are kicked by that
 * first. Returns the largest velocity along an axis. */
double msri_meet_advance(const msri_pass *pass, const msri_stage *stage, const msri_cells *cells,
                         msri_meet *meet);

/* After that: stops the masses of a row of all objects', whose column 0 is cell `base`, that
 * something is in the way of; none went faster than `fastest`. */
void msri_meet_stop(const msri_pass *pass, const msri_stage *stage, size_t row, double fastest,
                    const msri_cells *cells, size_t base, msri_meet *meet);

#endif
