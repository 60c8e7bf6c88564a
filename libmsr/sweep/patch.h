/* patch.h - small objects: all cells of some lie in a dense patch that fits into cache, row after
 * row, so that a stage is one loop. */
#ifndef MSRI_PATCH_H
#define MSRI_PATCH_H

#include "sweep/field.h"
#include "sweep/tally.h"

/* Objects that lie in a patch side by side, top rows in line: one row of it holds a row of each,
 * and so is long, even if they are narrow. What a row leaves for the next one has then reached
 * memory when it's needed. */
typedef struct msri_group {
  const msri_object *object; /* [n], one after the other */
  size_t n;
  size_t rows, width, masses;    /* with what is between them */
  const struct msri_group *next; /* the one that comes after it, fetched from memory meanwhile */
} msri_group;

/* Of an object, and narrow ones of those after it, `most` in all; none if that is 0. */
msri_group msri_group_of(const msri_object *object, size_t most);

/* Cells of a group in a patch: its rectangle, and one at the end of each row, so that the right
 * neighbour of the last mass of a row isn't the first of the next. */
size_t msri_patch_cells(const msri_group *group);

/* Doubles of memory for a group; for any that msri_group_of makes of more than one. `meets`:
 * something may be in its way. */
size_t msri_patch_size(int ways, bool meets, const msri_group *group);
size_t msri_patch_most(int ways, bool meets);

/* Copies a group to memory; its cells there. */
msri_cells msri_patch_open(const msri_pass *pass, const msri_group *group, double *memory);

/* Takes a group through all stages of a pass; what is in memory is `filled` with it already, or
 * is to be `kept` for the next pass. Returns the largest speed along an axis, and counts
 * collisions. `same`, unless it's NULL: has nothing changed, bit by bit? */
double msri_patch_run(const msri_pass *pass, const msri_group *group, bool filled, bool kept,
                      double *memory, msri_tally *tally, bool *same);

#endif
