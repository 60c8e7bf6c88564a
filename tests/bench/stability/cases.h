/* cases.h - the hard cases. */
#ifndef CASES_H
#define CASES_H

#include "beside.h"

typedef struct hard_case {
  const char *name, *text;
  void (*make)(problem *p); /* p has the name and what all have in common */
} hard_case;

extern const hard_case hard_cases[]; /* ends in a row of NULL */

/* Makes the problem of a case. */
void problem_create(problem *p, const hard_case *from);
void problem_free(problem *p);

#endif
