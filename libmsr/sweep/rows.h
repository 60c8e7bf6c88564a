/* rows.h - large objects: a wave runs down their rows, each stage one row behind the one before,
 * so that a row goes through all stages of a pass while it is in cache. */
#ifndef MSRI_ROWS_H
#define MSRI_ROWS_H

#include "sweep/field.h"
#include "sweep/tally.h"

/* Of a pass; of one with rows or bands. */
enum { MSRI_MOST_STAGES = 64, MSRI_ROWS_STAGES = 32 };

/* A part of an object's rows, for one thread. Stage s of part p goes over rows begin[p] + s up to
 * begin[p+1] + s: each part leaves a wedge to the one above, which finds there the rows as they
 * were at each stage and, beyond its end, in `edge`, where the next one's first row was, and what
 * masses are owed there. So parts
 * need wait for each other once a pass only. */
typedef struct msri_part {
  size_t number, parts;
  const size_t *begin;      /* [parts + 1] rows of the object */
  _Atomic unsigned *opened; /* [parts]: wedges left so far; */
  unsigned turn;            /* this is the one of that number */
  double *const *memory;    /* [parts]: of each */
  bool *same;               /* of the only part: has nothing changed, bit by bit? NULL: who cares */
} msri_part;

/* Doubles of memory for a part of an object of such width; `meets`: something may be in its way;
 * `shared`: it's one of several. */
size_t msri_rows_size(int ways, bool meets, bool shared, size_t width, int stages);

/* As many stages as keep rows in cache. */
int msri_rows_stages(int ways, size_t width);

/* Takes a part through all stages of a pass. Returns the largest speed along an axis, and counts
 * collisions. */
double msri_rows_run(const msri_pass *pass, const msri_object *object, const msri_part *part,
                     msri_tally *tally);

#endif
