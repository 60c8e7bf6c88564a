/* times.h - how long each effect of a run took, and how often it was called. */
#ifndef CLI_TIMES_H
#define CLI_TIMES_H

#include "outputs.h"

typedef struct times {
  double seconds;
  uint64_t calls;
} times;

/* A line per effect that is on, one for looks at the energy, one for all the rest, and their sum,
 * which is `seconds`; what was done beside stands behind. */
void times_print(FILE *out, const effect_list *list, const msr_state *state, const outputs *written,
                 const times *looks, double seconds);

#endif
