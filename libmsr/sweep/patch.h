/* patch.h - small objects: all cells of one lie in a dense patch that fits into cache, row after
 * row, so that a stage is one loop. */
#ifndef MSRI_PATCH_H
#define MSRI_PATCH_H

#include "sweep/field.h"
#include "sweep/tally.h"

/* Cells of an object in a patch: its rectangle, and one at the end of each row, so that the right
 * neighbour of the last mass of a row isn't the first of the next. */
size_t msri_patch_cells(const msri_object *object);

/* Doubles of memory for an object; `meets`: something may be in its way. */
size_t msri_patch_size(int ways, bool meets, const msri_object *object);

/* Copies an object to memory; its cells there. */
msri_cells msri_patch_open(const msri_pass *pass, const msri_object *object, double *memory);

/* Takes an object through all stages of a pass; what is in memory is `filled` with it already, or
 * is to be `kept` for the next pass. Returns the largest speed along an axis, and counts
 * collisions. `same`, unless it's NULL: has nothing changed, bit by bit? */
double msri_patch_run(const msri_pass *pass, const msri_object *object, bool filled, bool kept,
                      double *memory, msri_tally *tally, bool *same);

#endif
