/* curves.c - the curves of a work-precision diagram: a line per method, the Pareto front beneath,
 * unstable runs as crosses at the right edge. */
#include "curves.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* ---- Ranges */

static void widen(range *r, double value) {
  if (!(value > 0) || !isfinite(value)) return;
  r->from = fmin(r->from, value);
  r->to = fmax(r->to, value);
}

static range finish(range r) {
  if (r.from > r.to) return (range){0.1, 10};
  const double margin = r.to / r.from < 20 ? 5 : 1.6;
  return (range){r.from / margin, r.to * margin};
}

/* A run without any error can't be shown on a logarithmic axis; rounding makes this much. */
static double error_of(const msr_accuracy_point *p) { return fmax(p->max, 1e-14); }

static double time_of(const msr_accuracy_point *p) { return 1e3 * p->seconds; }

static bool measured(const msr_accuracy_point *p) { return p->stable && isfinite(p->seconds); }

/* What an unstable run would take is known from the stable one with the next number of substeps. */
static double would_take(const study *st, size_t i) {
  const msr_accuracy_point *p = &st->point[i];
  for (size_t j = i + 1; j < st->n && st->point[j].integrator == p->integrator; j++) {
    const msr_accuracy_point *q = &st->point[j];
    if (measured(q)) return time_of(q) * (double)p->substeps / (double)q->substeps;
  }
  return 0;
}

static bool any_unstable(const study *st) {
  size_t i = 0;
  while (i < st->n && st->point[i].stable) i++;
  return i < st->n;
}

/* What is far below the reference's own error means nothing; some room is left there for words, and
 * at the right for unstable runs. */
range curves_errors(const study *st) {
  range r = {DBL_MAX, 0};
  for (size_t i = 0; i < st->n; i++) {
    if (measured(&st->point[i])) widen(&r, error_of(&st->point[i]));
  }
  widen(&r, st->figures.reference_error / 3);
  r = finish(r);
  r.from = fmax(r.from, st->figures.reference_error / 10);
  if (any_unstable(st)) r.to *= 3;
  return r;
}

range curves_times(const study *st) {
  range r = {DBL_MAX, 0};
  for (size_t i = 0; i < st->n; i++) {
    if (measured(&st->point[i])) widen(&r, time_of(&st->point[i]));
    if (!st->point[i].stable) widen(&r, would_take(st, i));
  }
  return finish(r);
}

/* ---- Styles */

/* Colours told apart by most eyes (Okabe & Ito 2008, darker yellow; brown, grey); with the forms,
 * whose number has no factor in common with theirs, 99 different methods. */
static const char *const colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00",
                                      "#56b4e9", "#000000", "#b8a800", "#8c510a"};
static const int forms[] = {7, 5, 9, 11, 13, 6, 4, 8, 10, 12, 15};

typedef struct style {
  const char *colour;
  int form, dashes;
} style;

/* The same in every figure: by the place in the library's table. Dashes tell the kind. */
static style style_of(const msr_integrator *integrator) {
  size_t i = 0;
  while (msr_integrators[i] && msr_integrators[i] != integrator) i++;
  return (style){.colour = colours[i % (sizeof colours / sizeof colours[0])],
                 .form = forms[i % (sizeof forms / sizeof forms[0])],
                 .dashes = integrator->adaptive   ? 2
                           : integrator->implicit ? 4
                                                  : 1};
}

/* ---- Data */

typedef struct place {
  double error, time;
} place;

static int by_error(const void *a, const void *b) {
  const place *p = a, *q = b;
  return (p->error > q->error) - (p->error < q->error);
}

/* The Pareto front, from the smallest error. */
static void print_front(FILE *out, const study *st) {
  size_t n = 0;
  place *front = malloc((st->n + 1) * sizeof *front);
  for (size_t i = 0; front && i < st->n; i++) {
    const msr_accuracy_point *p = &st->point[i];
    if (p->front) front[n++] = (place){error_of(p), time_of(p)};
  }
  if (front) qsort(front, n, sizeof *front, by_error);
  fputs("$front << END\nNaN NaN\n", out);
  for (size_t i = 0; i < n; i++) fprintf(out, "%g %g\n", front[i].error, front[i].time);
  fputs("END\n", out);
  free(front);
}

/* Each data block begins with a point that isn't shown, since gnuplot wants one at least. */
static void print_method(FILE *out, const study *st, size_t first, size_t end) {
  fprintf(out, "$method%zu << END\nNaN NaN\n", first);
  for (size_t i = first; i < end; i++) {
    const msr_accuracy_point *p = &st->point[i];
    if (measured(p)) fprintf(out, "%g %g\n", error_of(p), time_of(p));
  }
  fputs("END\n", out);
}

/* At the right edge, inside. */
static void print_unstable(FILE *out, const study *st) {
  const double edge = curves_errors(st).to / 1.6;
  fputs("$unstable << END\nNaN NaN 0\n", out);
  for (size_t i = 0; i < st->n; i++) {
    const double time = st->point[i].stable ? 0 : would_take(st, i);
    if (!(time > 0)) continue;
    fprintf(out, "%g %g 0x%s\n", edge, time, style_of(st->point[i].integrator).colour + 1);
  }
  fputs("END\n", out);
}

/* ---- Command */

static size_t end_of_method(const study *st, size_t first) {
  size_t end = first;
  while (end < st->n && st->point[end].integrator == st->point[first].integrator) end++;
  return end;
}

static void print_plot(FILE *out, const study *st) {
  fputs("plot $front with lines linewidth 9 linecolor '#cfcfcf' title 'Pareto front'", out);
  for (size_t i = 0; i < st->n; i = end_of_method(st, i)) {
    const style look = style_of(st->point[i].integrator);
    fprintf(out,
            ", $method%zu with linespoints linewidth 1.4 pointsize 0.8 linecolor '%s' pointtype %d"
            " dashtype %d title '%s'",
            i, look.colour, look.form, look.dashes, st->point[i].integrator->name);
  }
  if (any_unstable(st)) {
    fputs(", $unstable using 1:2:3 with points pointtype 2 pointsize 1 linewidth 1.6"
          " linecolor rgb variable notitle, NaN with points pointtype 2 pointsize 1 linewidth 1.6"
          " linecolor '#000000' title 'unstable'",
          out);
  }
  fputc('\n', out);
}

void curves_print(FILE *out, const study *st) {
  print_front(out, st);
  for (size_t i = 0; i < st->n; i = end_of_method(st, i)) {
    print_method(out, st, i, end_of_method(st, i));
  }
  print_unstable(out, st);
  print_plot(out, st);
}
