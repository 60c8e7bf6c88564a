/* field.h - rows of an object as dense cells, for the kernels of forces/lattice.h. */
#ifndef MSRI_FIELD_H
#define MSRI_FIELD_H

#include "plan/objects.h"
#include "sweep/stage.h"

/* What every part of a sweep knows. */
typedef struct msri_pass {
  const msr_plan *plan;
  const msri_swept *state;
  const msri_lattice_kernel *kernel;
  const msri_stage *stage; /* [stages] */
  int stages;
  int ways;    /* of springs: to 4 or to 8 neighbours */
  int besides; /* what acts beside them */
  bool meets;  /* something may be in the way */
} msri_pass;

/* Dense arrays, each as long as `stride`; what is around the cells of use is there to be read. */
typedef struct msri_field {
  size_t stride;
  double *x, *y, *vx, *vy, *k[MSRI_WAYS];
} msri_field;

enum { MSRI_MARGIN = 8 }; /* cells around those of use: of a line of the cache */

/* Doubles of a field; carves it from memory. */
size_t msri_field_size(int ways, size_t stride);
msri_field msri_field_place(int ways, size_t stride, double *memory);

/* Copies a row's masses to cells `at` + column, and back; 0 in all other of its `width` cells. */
void msri_field_fill(const msri_field *f, const msri_objects *objects, size_t row,
                     const msri_swept *from, size_t at, size_t width);
void msri_field_empty(const msri_field *f, const msri_objects *objects, size_t row,
                      const msri_swept *to, size_t at);

/* Are a row's cells what the state holds, bit by bit? */
bool msri_field_is(const msri_field *f, const msri_objects *objects, size_t row,
                   const msri_swept *state, size_t at);

/* k where a row has a mass, in marks[width]; 0 elsewhere, from -1 to width. */
void msri_field_mark(double *marks, const msri_objects *objects, size_t row, double k,
                     size_t width);

/* Stiffness of the springs from a row's cells `at` + column, by its marks and those of the row
 * below. */
void msri_field_tie(const msri_field *f, const double *marks, const double *below, int ways,
                    size_t at, size_t width);

/* What acts beside the springs in a stage: which kernel it takes. */
static inline int msri_field_besides(const msri_pass *pass, const msri_stage *stage) {
  const msri_motion *m = &stage->motion;
  const int air = (m->relaxes ? MSRI_WITH_AIR : 0) | (m->pushes ? MSRI_WITH_PUSH : 0);
  return (pass->besides & ~MSRI_WITH_AIR) | air;
}

/* Does a stage to cells. Returns the largest velocity along an axis; 0 if they only drift. */
double msri_field_step(const msri_pass *pass, const msri_stage *stage, const msri_cells *cells);

#endif
