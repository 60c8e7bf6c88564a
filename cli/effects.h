/* effects.h - what a run does and doesn't do, and why: the library's effects, then what the command
 * does with the frames. */
#ifndef CLI_EFFECTS_H
#define CLI_EFFECTS_H

#include "options.h"

/* What the command does, after the library's effects and in this order. */
typedef enum task { DRAWING, WRITING, STATS, TRAJECTORY, TASKS } task;

typedef struct effect_row {
  const char *name;
  bool on;
  char why[2 * MSR_MESSAGE_SIZE]; /* the reason, and the options that called for it */
  msr_cost cost;
} effect_row;

typedef struct effect_list {
  size_t n, library;   /* the first `library` are the library's, in its order */
  effect_row effect[]; /* [n] */
} effect_list;

/* NULL: no memory. For free(). */
effect_list *effects_create(const settings *s, const msr_plan *plan);

/* A line per effect: on or off, and why. Those that are on come first. */
void effects_print(FILE *out, const effect_list *list);

/* The same, with what each takes. */
void effects_print_costs(FILE *out, const effect_list *list);

#endif
