/* steps.c - see steps.h. */
#include "steps.h"

#include "report.h"

#include <inttypes.h>

void steps_print(FILE *out, const settings *s, const msr_plan *plan) {
  const msr_plan_figures f = msr_plan_describe(plan);
  fprintf(out, "threads     %u", f.threads);
  if (s->threads > f.threads) fprintf(out, " of %" PRIu64, s->threads);
  if (f.by_vectors) {
    fprintf(out, ", by whole vectors: %s\n", f.by_vectors);
  } else if (s->threads > f.threads) {
    fputs(", row by row: there are no more processors, objects or parts of one\n", out);
  } else {
    fputs(", row by row\n", out);
  }
}

void steps_note(const settings *s, const msr_plan *plan) {
  const char *const why = msr_plan_describe(plan).by_vectors;
  char text[300];
  if (!why || s->threads < 2) return;
  snprintf(text, sizeof text, "--threads %" PRIu64 " is of no use to steps here: %s%s", s->threads,
           why, s->no_frames ? "" : "; one thread draws beside them");
  tell(s, "note", text);
}
