/* csv.c - what a study found, for a program: numbers with all their digits. */
#include "csv.h"

#include "command_line.h"
#include "machine.h"
#include "texts.h"

#include <inttypes.h>
#include <math.h>

static void print_origin(FILE *out, const study *st) {
  const machine m = machine_describe();
  fputs("# msr accuracy: work and precision\n# command: ", out);
  command_line_print(out, st->s);
  fprintf(out, "\n# date: %s\n# machine: %s\n# compiler: %s\n# msr: %s\n# GSL: %s\n", m.date,
          m.processor, m.compiler, msr_version(), machine_gsl());
}

static void print_figures(FILE *out, const study *st) {
  const msr_accuracy_figures *f = &st->figures;
  fprintf(out, "# scene hash: %016" PRIx64 "\n# masses: %zu\n# springs: %zu\n", f->scene_hash,
          f->masses, f->springs);
  fprintf(out, "# until [s]: %s\n# horizon [s]: %s\n# instants: %" PRIu64 "\n",
          number_exact(f->until).text, number_exact(f->horizon).text, f->frames);
  fprintf(out, "# reference: %s\n# witness: %s\n# reference error [px]: %s\n",
          reference_name(f).text, witness_name(f).text, number_exact(f->reference_error).text);
  fprintf(out, "# impacts: %s\n# complete: %s\n", st->contacts ? "located" : "none",
          f->complete ? "yes" : "no");
}

/* 0 or 1, as programs like it. */
static void print_point(FILE *out, const study *st, size_t i) {
  const msr_accuracy_point *p = &st->point[i];
  const double values[] = {p->seconds, p->rms, p->max, p->drift, p->pixels, study_order(st, i)};
  fprintf(out, "%s,%" PRIu64 ",", p->integrator->name, p->substeps);
  if (p->integrator->adaptive) fputs(number_exact(p->atol).text, out);
  fprintf(out, ",%d,%" PRIu64 ",%" PRIu64, p->stable, p->steps, p->evaluations);
  for (size_t j = 0; j < sizeof values / sizeof values[0]; j++) {
    fprintf(out, ",%s", isfinite(values[j]) ? number_exact(values[j]).text : "");
  }
  fprintf(out, ",%d\n", p->front);
}

void csv_print(FILE *out, const study *st) {
  print_origin(out, st);
  print_figures(out, st);
  fputs(
      "method,substeps,tolerance,stable,steps,evaluations,seconds,rms_px,max_px,drift,pixels,order,"
      "front\n",
      out);
  for (size_t i = 0; i < st->n; i++) print_point(out, st, i);
}
