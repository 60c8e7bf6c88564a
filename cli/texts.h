/* texts.h - numbers and methods in words, in the C locale. */
#ifndef CLI_TEXTS_H
#define CLI_TEXTS_H

#include "options.h"

typedef struct number {
  char text[32];
} number;

/* As few digits as give the same number back. */
number number_exact(double value);

typedef struct method {
  char text[192];
} method;

/* "verlet, 2 substeps"; of an adaptive one, its tolerance: "rk8pd, 2 substeps, tolerance 1e-08". */
method method_name(const msr_plan_options *options);

/* Likewise those that a study compared with. */
method reference_name(const msr_accuracy_figures *figures);
method witness_name(const msr_accuracy_figures *figures);

/* What a point of a study was run with. */
msr_plan_options method_of(const msr_accuracy_point *point);

/* The options that ask for it: " --integrator verlet --substeps 2". */
method method_options(const msr_plan_options *options);

#endif
