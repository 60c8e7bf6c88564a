/* objects.h - the picture's separate objects: masses that springs tie together, row by row. */
#ifndef MSRI_OBJECTS_H
#define MSRI_OBJECTS_H

#include "forces/lattice.h"

/* Masses first .. first+count-1, side by side in a row from a column of the object on. */
typedef struct msri_piece {
  size_t first;
  uint32_t column, count;
  size_t block; /* of MSRI_LANES columns of the object: the first of the piece's */
} msri_piece;

/* Rows row .. row+rows-1 of msri_objects.row. */
typedef struct msri_object {
  size_t row, rows;
  size_t width; /* in columns, of the smallest rectangle around it */
  size_t masses;
} msri_object;

typedef struct msri_objects {
  msri_object *object; /* [n] in the order of their first masses */
  size_t *row;         /* [n_rows + 1]: the first piece of each row, from the top */
  msri_piece *piece;   /* [row[n_rows]] from the left */
  size_t n, n_rows, n_blocks;
} msri_objects;

/* Those of a picture, with springs to 4 or 8 neighbours. MSR_ENOMEM: then nothing is left. */
msr_status msri_objects_create(const msr_picture *picture, int neighbours, msri_objects *objects,
                               msr_error *err);
void msri_objects_clear(msri_objects *objects);
size_t msri_objects_bytes(const msri_objects *objects);

#endif
