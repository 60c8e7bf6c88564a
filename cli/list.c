/* list.c - msr list: the built-ins, from the library's own tables. */
#include "commands.h"
#include "report.h"

#include <math.h>

static const char *yes(bool b) { return b ? "yes" : "-"; }

typedef struct cell {
  char text[16];
} cell;

/* "4 (2)": 4, but 2 where a force depends on velocity. */
static cell order(const msr_integrator *i) {
  cell c;
  const int length = snprintf(c.text, sizeof c.text, "%d", i->order);
  if (!i->damped_order || i->damped_order == i->order) return c;
  snprintf(c.text + length, sizeof c.text - (size_t)length, " (%d)", i->damped_order);
  return c;
}

static cell evaluations(const msr_integrator *i) {
  cell c = {"as needed"};
  if (i->evaluations > 0) snprintf(c.text, sizeof c.text, "%.3g", i->evaluations);
  return c;
}

static cell stability(const msr_integrator *i) {
  cell c = {"none"};
  if (isinf(i->stability)) return (cell){"any"};
  if (i->stability > 0) snprintf(c.text, sizeof c.text, "%.4g", i->stability);
  return c;
}

static const char *steps(const msr_integrator *i) {
  return i->adaptive ? "adaptive" : i->implicit ? "implicit" : "explicit";
}

static void print_integrators(void) {
  printf("%-17s %-6s %-8s  %-10s %-10s %-12s %11s %8s\n", "INTEGRATOR", "order", "steps",
         "symplectic", "reversible", "conservative", "evaluations", "h*omega");
  for (const msr_integrator *const *at = msr_integrators; *at; at++) {
    const msr_integrator *i = *at;
    printf("%-17s %-6s %-8s  %-10s %-10s %-12s %11s %8s\n", i->name, order(i).text, steps(i),
           yes(i->symplectic), yes(i->reversible), yes(i->conservative), evaluations(i).text,
           stability(i).text);
  }
}

static void print_methods(void) {
  for (const msr_integrator *const *at = msr_integrators; *at; at++) {
    printf("%-17s %s\n", (*at)->name, (*at)->summary);
    if ((*at)->reference) printf("%-17s %s\n", "", (*at)->reference);
  }
}

static void print_forces(void) {
  printf("%-17s %-12s  %-11s  %-6s  %s\n", "FORCE", "conservative", "dissipative", "with speed",
         "with time");
  for (const msr_force *const *at = msr_forces; *at; at++) {
    const msr_force *f = *at;
    printf("%-17s %-12s  %-11s  %-6s  %s\n    %s\n", f->name, yes(f->conservative),
           yes(f->dissipative), yes(f->uses_velocity), yes(f->uses_time), f->summary);
  }
}

msr_status list_command(const settings *s, msr_error *err) {
  (void)s;
  print_integrators();
  puts("\nThe order in brackets is that in wind, drag or damping. Adaptive methods choose their "
       "own\n"
       "steps (--atol, --rtol). Evaluations of the forces are per step; h*omega is the largest\n"
       "stable step times the highest angular frequency.\n");
  print_methods();
  puts("");
  print_forces();
  return print_end(err);
}
