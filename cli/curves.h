/* curves.h - the curves of a work-precision diagram, for gnuplot. */
#ifndef CLI_CURVES_H
#define CLI_CURVES_H

#include "study.h"

typedef struct range {
  double from, to;
} range;

/* What the axes should hold: errors [px] and times [ms]. */
range curves_errors(const study *st);
range curves_times(const study *st);

/* The data, and the command that draws them on axes of these ranges. */
void curves_print(FILE *out, const study *st);

#endif
