/* list.c - msr list: the built-ins, from the library's own tables. */
#include "commands.h"
#include "report.h"

static const char *yes(bool b) { return b ? "yes" : "-"; }

static void print_integrators(void) {
  printf("%-17s %5s  %-10s  %-10s  %11s  %7s\n", "INTEGRATOR", "order", "symplectic", "reversible",
         "evaluations", "h*omega");
  for (const msr_integrator *const *at = msr_integrators; *at; at++) {
    const msr_integrator *i = *at;
    printf("%-17s %5d  %-10s  %-10s  %11.3g", i->name, i->order, yes(i->symplectic),
           yes(i->reversible), i->evaluations);
    if (i->stability > 0) printf("  %7.4g\n", i->stability);
    if (!(i->stability > 0)) printf("  %7s\n", "none");
    printf("    %s\n", i->summary);
    if (i->reference) printf("    %s\n", i->reference);
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
  puts("\nEvaluations of the forces are per step; h*omega is the largest stable step times the\n"
       "highest angular frequency.\n");
  print_forces();
  return print_end(err);
}
