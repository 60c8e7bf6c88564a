/* meet.h - cells past what is in the way: kicks, then drifts that supports may stop. */
#ifndef MSRI_MEET_H
#define MSRI_MEET_H

#include "contacts/debts.h"
#include "sweep/field.h"
#include "sweep/tally.h"

/* What some cells need for that; each mass among them may be owed something. */
typedef struct msri_meet {
  double *ax, *ay;  /* [cells]: accelerations of a stage */
  double *before;   /* [2][masses]: velocities of those that are owed something */
  msri_debts debts; /* they name cells */
  msri_tally *tally;
} msri_meet;

/* Doubles of memory for what a mass may be owed. */
enum { MSRI_MEET_DEBT = 2 + sizeof(msri_debt) / sizeof(double) };

/* Carves it from memory of 2 cells + MSRI_MEET_DEBT masses doubles; nobody is owed anything. */
msri_meet msri_meet_place(size_t cells, size_t masses, double *memory, msri_tally *tally);

/* Kicks cells, those that are owed something by what they are owed first. Returns the largest
 * velocity along an axis. */
double msri_meet_kick(const msri_pass *pass, const msri_stage *stage, const msri_cells *cells,
                      msri_meet *meet);

/* Drifts the masses of a row of all objects', whose column 0 is cell `base`; none goes faster than
 * `fastest`. */
void msri_meet_drift(const msri_pass *pass, const msri_stage *stage, size_t row, double fastest,
                     const msri_cells *cells, size_t base, msri_meet *meet);

#endif
