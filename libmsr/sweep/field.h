/* field.h - rows of an object as dense cells, for the kernels of forces/lattice.h. */
#ifndef MSRI_FIELD_H
#define MSRI_FIELD_H

#include "plan/objects.h"
#include "sweep/stage.h"

/* What every part of a sweep knows. */
typedef struct msri_pass {
  const msr_plan *plan;
  const msri_swept *state;
  const msri_loops *loops;
  double (*fastest)(const msri_cells *cells);
  const msri_stage *stage; /* [stages] */
  int stages;
  int ways;    /* of springs: to 4 or to 8 neighbours */
  int besides; /* what acts beside them */
  bool meets;  /* something may be in the way */
} msri_pass;

enum { MSRI_MARGIN = 8 }; /* cells: of a line of the cache */

/* n cells, in whole blocks, and some around them. */
typedef struct msri_field {
  size_t n;
  double *x, *y, *vx, *vy; /* [n] */
  msri_block *block;       /* [blocks]: those that hold masses */
  size_t *blocks;
} msri_field;

/* Doubles of a field with `around` cells, a multiple of MSRI_MARGIN, on each side; carves it from
 * memory. */
size_t msri_field_size(size_t n, size_t around);
msri_field msri_field_place(size_t n, size_t around, double *memory);

/* 0 to all cells from one on. */
void msri_field_clear(const msri_field *f, size_t from);

/* Copies a row's masses to cells `at` + column, and back. */
void msri_field_fill(const msri_field *f, const msri_objects *objects, size_t row,
                     const msri_swept *from, size_t at);
void msri_field_empty(const msri_field *f, const msri_objects *objects, size_t row,
                      const msri_swept *to, size_t at);

/* Asks memory for masses begin .. end-1, soon to be needed. */
void msri_field_fetch(const msri_swept *state, size_t begin, size_t end);

/* Are a row's cells what the state holds, bit by bit? */
bool msri_field_is(const msri_field *f, const msri_objects *objects, size_t row,
                   const msri_swept *state, size_t at);

/* Where there are masses: a bit for each cell, from bit `first` on, and for some around them. */
typedef struct msri_marks {
  uint8_t *bits;
  size_t first; /* a multiple of 8 but for cells above and below others */
} msri_marks;

/* Bytes of the marks of n cells and of `around` on each side, a multiple of 8, with some more that
 * may be read. */
size_t msri_marks_bytes(size_t n, size_t around);

/* Marks the masses of a row, at cells `at` + column. */
void msri_marks_set(const msri_marks *marks, const msri_objects *objects, size_t row, size_t at);

/* Finds the blocks of a field, by the marks of its cells and of those above and below them. */
void msri_field_tie(const msri_field *f, int ways, const msri_marks *masses,
                    const msri_marks *above, const msri_marks *below);

/* The cells of a field, without those below them and what they pull. */
msri_cells msri_field_cells(const msri_field *f);

/* What acts beside the springs in a stage: which kernel it takes. */
static inline int msri_field_besides(const msri_pass *pass, const msri_stage *stage) {
  const msri_motion *m = &stage->motion;
  const int air = (m->relaxes ? MSRI_WITH_AIR : 0) | (m->pushes ? MSRI_WITH_PUSH : 0);
  return (pass->besides & ~MSRI_WITH_AIR) | air;
}

/* Does a stage to cells. Returns the largest velocity along an axis, if the stage tells; else 0. */
double msri_field_step(const msri_pass *pass, const msri_stage *stage, const msri_cells *cells);

#endif
