/* measure.h - work-precision of methods on a problem: for each error the cheapest knob that reaches
 * it, then the time that it takes, all of them in turn. */
#ifndef MEASURE_H
#define MEASURE_H

#include "bench.h"

enum { MOST_ERRORS = 5, MOST_METHODS = 64, MOST_REPEATS = 4096 };

/* What a method takes to come within an error of the truth. */
typedef struct point {
  bool reached, repeated; /* as the point before */
  double knob, error;
  double minimum, median; /* [s] */
  double spent;           /* on all repeats [s] */
  void *object;           /* open */
  size_t repeats;
  float *time; /* [MOST_REPEATS] [s] */
} point;

typedef struct table {
  problem *p;
  size_t n_errors, n_methods;
  const double *error; /* [n_errors], falling [px] */
  const double *truth; /* [2n]: q, v at T */
  double loosest;      /* tolerance [px] */
  double share;        /* of time, after which a point has been timed enough [s] */
  method method[MOST_METHODS];
  point point[MOST_METHODS][MOST_ERRORS];
  double *z; /* [2n]: where timed runs end */
} table;

/* Knobs, by runs that aren't timed; then times, by `rounds` over all
 * points. */
void table_search(table *t);
void table_time(table *t, int rounds);

#endif
