/* table.c - what a study found, for a reader: head, table, answer. */
#include "table.h"

#include "command_line.h"
#include "machine.h"
#include "texts.h"

#include <inttypes.h>
#include <math.h>

typedef struct cell {
  char text[24];
} cell;

/* "0.0123", "12.3", "12345". */
static cell figure(double value) {
  cell c = {"-"};
  if (isfinite(value)) snprintf(c.text, sizeof c.text, value < 1000 ? "%.3g" : "%.0f", value);
  return c;
}

static cell error(double value) {
  cell c = {"-"};
  if (isfinite(value)) snprintf(c.text, sizeof c.text, value > 0 ? "%.1e" : "%.0f", value);
  return c;
}

/* ---- Head */

static void print_truth(FILE *out, const msr_accuracy_figures *f) {
  fprintf(out, "reference   %s; within %.2g px of %s\n", reference_name(f).text, f->reference_error,
          witness_name(f).text);
}

static void print_time(FILE *out, const study *st) {
  const msr_accuracy_figures *f = &st->figures;
  const bool all = f->horizon >= f->until * (1 - 1e-9);
  fprintf(out, "time        %.6g s, compared at %" PRIu64 " instant%s up to %.6g s%s\n", f->until,
          f->frames, f->frames == 1 ? "" : "s", f->horizon,
          all ? "" : ": beyond, the reference is not sure");
}

static void print_head(FILE *out, const study *st) {
  const msr_accuracy_figures *f = &st->figures;
  const machine m = machine_describe();
  fprintf(out, "scene       %s %s, hash %016" PRIx64 "\n", st->s->file[0], st->s->file[1],
          f->scene_hash);
  fprintf(out, "object      masses %zu, springs %zu\n", f->masses, f->springs);
  print_time(out, st);
  print_truth(out, f);
  fprintf(out, "machine     %s; %s; msr %s, GSL %s\n", m.processor, m.compiler, msr_version(),
          machine_gsl());
  fprintf(out, "study       %zu point%s in %s s%s\n", st->n, st->n == 1 ? "" : "s",
          figure(f->seconds).text, f->complete ? "" : ", not all that there are to measure");
}

/* ---- Table */

static void print_titles(FILE *out) {
  fprintf(out, "\n   %-17s %8s %8s %9s %7s %8s %8s %8s %8s %6s\n", "METHOD", "substeps", "steps",
          "forces", "ms", "rms px", "max px", "energy", "pixels %", "order");
}

/* An adaptive method has a tolerance where others have substeps. */
static cell step(const msr_accuracy_point *p) {
  cell c;
  if (p->integrator->adaptive) snprintf(c.text, sizeof c.text, "%.0e", p->atol);
  if (!p->integrator->adaptive) snprintf(c.text, sizeof c.text, "%" PRIu64, p->substeps);
  return c;
}

static cell order(double value) {
  cell c = {"-"};
  if (isfinite(value)) snprintf(c.text, sizeof c.text, "%.2f", value);
  return c;
}

static void print_point(FILE *out, const study *st, size_t i) {
  const msr_accuracy_point *p = &st->point[i];
  fprintf(out, "%c%c %-17s %8s %8" PRIu64 " %9" PRIu64 " %7s %8s", p->front ? '*' : ' ',
          st->risky[i] ? '!' : ' ', p->integrator->name, step(p).text, p->steps, p->evaluations,
          figure(1e3 * p->seconds).text, p->stable ? error(p->rms).text : "unstable");
  if (p->stable) {
    fprintf(out, " %8s %8s %8s %6s", error(p->max).text, error(p->drift).text,
            figure(100 * p->pixels).text, order(study_order(st, i)).text);
  }
  fputc('\n', out);
}

static bool any_risky(const study *st) {
  size_t i = 0;
  while (i < st->n && !st->risky[i]) i++;
  return i < st->n;
}

static void print_notes(FILE *out, const study *st) {
  fputs("\n* nothing is both faster and more accurate\n", out);
  if (any_risky(st)) {
    fputs("! above the steps that are safe to the end: the rest of the scene may heat up or "
          "explode\n",
          out);
  }
  fputs("substeps: per DT, or the tolerance of a method that chooses its steps; forces: "
        "evaluations;\n"
        "ms: least of several runs; energy: its error over the largest kinetic and spring energy;\n"
        "order: of the fall from the row above",
        out);
  fputs(st->contacts ? "; impacts are located\n\n" : "\n\n", out);
}

/* ---- Answer */

/* As msr_accuracy_cheapest, but of a step that can be trusted to the end. NULL: there is none. */
static const msr_accuracy_point *cheapest_to_the_end(const study *st, double target) {
  const msr_accuracy_point *best = NULL;
  for (size_t i = 0; i < st->n; i++) {
    const msr_accuracy_point *p = &st->point[i];
    const bool accurate = p->stable && p->max + st->figures.reference_error <= target;
    if (!accurate || st->risky[i] || !isfinite(p->seconds)) continue;
    if (!best || p->seconds < best->seconds) best = p;
  }
  return best;
}

static const double targets[] = {1, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10};
static const size_t n_targets = sizeof targets / sizeof targets[0];

/* NULL: there is none. */
static const msr_accuracy_point *choose(const study *st, size_t target) {
  if (target == n_targets || targets[target] < st->figures.reference_error) return NULL;
  const msr_accuracy_point *const to_the_end = cheapest_to_the_end(st, targets[target]);
  return to_the_end ? to_the_end : msr_accuracy_cheapest(st->result, targets[target]);
}

/* With what it holds for, if that isn't all of the scene. */
static void print_choice(FILE *out, const study *st, double target, const msr_accuracy_point *p) {
  msr_plan_options options = method_of(p);
  const bool brief = study_short(st), risky = st->risky[p - st->point];
  options.impacts = st->contacts ? MSR_IMPACTS_LOCATED : MSR_IMPACTS_KEPT;
  fprintf(out, "cheapest for %g px", target);
  if (brief) fprintf(out, " up to %.6g s%s", st->figures.horizon, risky ? ", no further" : "");
  fprintf(out, ": %s, %s ms%s: ", method_name(&options).text, figure(1e3 * p->seconds).text,
          brief ? " up to there" : "");
  command_line_print_run(out, st->s, &options);
  fputc('\n', out);
}

/* One line per choice, and one for the further targets that it is good for; returns the next. */
static size_t print_cheapest(FILE *out, const study *st, size_t target) {
  const msr_accuracy_point *const p = choose(st, target);
  const size_t second = target + 1;
  size_t next = second;
  print_choice(out, st, targets[target], p);
  while (choose(st, next) == p) next++;
  if (next == second) return next;
  fprintf(out, "cheapest for %g", targets[second]);
  if (next > second + 1) fprintf(out, " .. %g", targets[next - 1]);
  fputs(" px: the same\n", out);
  return next;
}

/* For 1, 0.1, 0.01 px ... down to what the reference resolves. */
static void print_answer(FILE *out, const study *st) {
  size_t i = 0;
  while (choose(st, i)) i = print_cheapest(out, st, i);
  if (i < n_targets && targets[i] >= st->figures.reference_error) {
    fprintf(out, "nothing measured is within %g px\n", targets[i]);
  }
}

void table_print(FILE *out, const study *st) {
  print_head(out, st);
  print_titles(out);
  for (size_t i = 0; i < st->n; i++) print_point(out, st, i);
  print_notes(out, st);
  print_answer(out, st);
}
