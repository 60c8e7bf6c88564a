/* table.c - the list of cases, and the table of what came of them. */
#include "suite.h"

void add_case(suite *s, const hard_case *row) {
  if (s->n == s->room) {
    s->room = s->room > 0 ? 2 * s->room : 64;
    s->row = realloc(s->row, s->room * sizeof *s->row);
    assert_non_null(s->row);
  }
  s->row[s->n++] = *row;
}

void print_head(void) {
  printf("%-40s %-19s %8s %9s %9s %8s %8s %8s  %s\n", "CASE", "integrator", "substeps", "growth",
         "loss", "depth px", "non-fin.", "CPU s", "verdict");
}

void print_outcome(const hard_case *row, const outcome *o) {
  const bool ran = o->integrator[0] != '\0';
  printf("%-40s %-19s %8llu %9.2g %9.2g %8.2g %8llu %8.2f  %s\n", row->name,
         ran ? o->integrator : "-", (unsigned long long)o->substeps, o->growth, o->loss,
         o->penetration, (unsigned long long)o->not_finite, o->seconds, o->verdict);
  fflush(stdout);
}
