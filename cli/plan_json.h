/* plan_json.h - what msr plan says, for programs. */
#ifndef CLI_PLAN_JSON_H
#define CLI_PLAN_JSON_H

#include "effects.h"

typedef struct plan_data {
  const settings *s;
  const char *picture, *conf;
  const msr_plan *plan;
  msr_plan_figures f;
  msr_stability limits;
  bool damps, contacts; /* does anything depend on velocity, is anything in the way? */
  const effect_list *list;
} plan_data;

void plan_json_print(FILE *out, const plan_data *d);

#endif
