/* values.h - kinds of values that options take. */
#ifndef CLI_VALUES_H
#define CLI_VALUES_H

#include "options.h"

typedef struct named_value {
  const char *name;
  uint64_t value;
} named_value;

typedef struct kind {
  const char *wants; /* completes "--scale takes " */
  bool (*read)(const struct kind *k, const char *text, void *field);
  double min, max;                          /* of a real number */
  uint64_t least, most;                     /* of a whole number; both 0: none is allowed */
  const named_value *names;                 /* that stand for a whole number; ends with NULL */
  const char *(*nearest)(const char *text); /* what a text that isn't right was meant to be */
} kind;

extern const kind a_flag, a_path, a_directory, a_real, a_positive, a_size, a_share, a_count, a_team,
    a_seed, a_degree, a_border, a_substeps, a_rule, an_integrator, integrators, a_push, a_stripe,
    a_figure;

#endif
