/* texts.c - numbers and methods in words. */
#include "texts.h"

#include <inttypes.h>
#include <stdlib.h>

number number_exact(double value) {
  number n;
  int digits = 6;
  do snprintf(n.text, sizeof n.text, "%.*g", digits, value);
  while (digits++ < 17 && !(strtod(n.text, NULL) == value));
  return n;
}

method method_name(const msr_plan_options *options) {
  method m;
  const int n =
      snprintf(m.text, sizeof m.text, "%s, %" PRIu64 " substep%s", options->integrator->name,
               options->substeps, options->substeps == 1 ? "" : "s");
  if (options->integrator->adaptive) {
    snprintf(m.text + n, sizeof m.text - (size_t)n, ", tolerance %s",
             number_exact(options->atol).text);
  }
  return m;
}

method reference_name(const msr_accuracy_figures *f) {
  return method_name(&(msr_plan_options){
      .integrator = f->reference, .substeps = f->reference_substeps, .atol = f->reference_atol});
}

method witness_name(const msr_accuracy_figures *f) {
  return method_name(&(msr_plan_options){
      .integrator = f->witness, .substeps = f->witness_substeps, .atol = f->witness_atol});
}

msr_plan_options method_of(const msr_accuracy_point *point) {
  return (msr_plan_options){
      .integrator = point->integrator, .substeps = point->substeps, .atol = point->atol};
}

method method_options(const msr_plan_options *options) {
  method m;
  int n = snprintf(m.text, sizeof m.text, " --integrator %s --substeps %" PRIu64,
                   options->integrator->name, options->substeps);
  const double tolerances[] = {options->atol, options->rtol};
  static const char *const names[] = {"--atol", "--rtol"};
  for (int i = 0; i < 2 && options->integrator->adaptive; i++) {
    if (!(tolerances[i] > 0)) continue;
    n += snprintf(m.text + n, sizeof m.text - (size_t)n, " %s %s", names[i],
                  number_exact(tolerances[i]).text);
  }
  if (options->impacts == MSR_IMPACTS_LOCATED) {
    snprintf(m.text + n, sizeof m.text - (size_t)n, " --impacts located");
  }
  return m;
}
