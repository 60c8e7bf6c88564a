/* figure.c - the work-precision diagram, as a script for gnuplot: time against error, both
 * logarithmic, a line per method, so that what is lower and further left is better. */
#include "figure.h"

#include "curves.h"
#include "gnuplot.h"
#include "inputs.h"
#include "machine.h"

#include <fcntl.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

/* ---- Page */

/* Twice as fine as it is meant to be looked at, so that it stays sharp. */
static void print_terminal(FILE *out, const char *path) {
  const bool svg = strcmp(path + strlen(path) - 4, ".svg") == 0;
  fputs(svg ? "set terminal svg size 800,600 dynamic enhanced background '#ffffff'"
              " font 'DejaVu Sans,Verdana,sans-serif,11'\n"
            : "set terminal pngcairo size 1600,1200 enhanced background '#ffffff'"
              " font 'DejaVu Sans,11' fontscale 2 linewidth 2 pointscale 2.2\n",
        out);
}

/* A string of gnuplot; a character that would end the line is left out. */
static void print_string(FILE *out, const char *text) {
  fputc('\'', out);
  for (; *text; text++) {
    if (*text == '\'') fputc('\'', out);
    fputc((unsigned char)*text < ' ' ? '?' : *text, out);
  }
  fputc('\'', out);
}

static void print_title(FILE *out, const study *st) {
  char text[4096 + 128];
  inputs in;
  msr_error err;
  const msr_accuracy_figures *f = &st->figures;
  if (inputs_find(st->s, &in, &err) != MSR_OK) in.picture = st->s->file[0];
  const char *const slash = strrchr(in.picture, '/');
  const int n = snprintf(text, sizeof text, "%s: %zu masses, T = %.6g s",
                         slash ? slash + 1 : in.picture, f->masses, f->horizon);
  if (f->horizon < f->until * (1 - 1e-9) && n < (int)sizeof text) {
    snprintf(text + n, sizeof text - (size_t)n, " of %.6g s", f->until);
  }
  fputs("set title ", out);
  print_string(out, text);
  fputs(" noenhanced font ',13'\n", out);
}

static void print_footer(FILE *out) {
  char text[512];
  const machine m = machine_describe();
  snprintf(text, sizeof text, "%s; %s; msr %s; %.10s", m.processor, m.compiler, msr_version(),
           m.date);
  fputs("set label 1 ", out);
  print_string(out, text);
  fputs(" at screen 0.015, 0.02 left noenhanced font ',8' textcolor '#555555'\n", out);
}

/* ---- Axes */

/* Powers of ten would be too few for less than three decades: 1, 2, 5, 10, 20 ... */
static void print_tics(FILE *out, char axis, const range *r) {
  static const double steps[] = {1, 2, 5};
  if (r->to / r->from > 1e3) return;
  fprintf(out, "set format %c '%%g'\nset %ctics (", axis, axis);
  const char *separator = "";
  const int first = (int)floor(log10(r->from)), last = (int)floor(log10(r->to));
  for (int decade = first; decade <= last; decade++) {
    for (int i = 0; i < 3; i++, separator = ", ") {
      fprintf(out, "%s%g", separator, steps[i] * pow(10, decade));
    }
  }
  fputs(")\n", out);
}

static void print_axes(FILE *out, const study *st) {
  const double own = st->figures.reference_error;
  const range x = curves_errors(st), y = curves_times(st);
  fprintf(out, "set xrange [%g:%g]\nset yrange [%g:%g]\n", x.from, x.to, y.from, y.to);
  fputs("set logscale xy\nset format '10^{%L}'\nset tics nomirror\nset mxtics 10\nset mytics 10\n"
        "set xlabel 'largest error of a position [px]'\nset ylabel 'time [ms]'\n"
        "set grid xtics ytics linecolor '#e0e0e0' linetype 1 linewidth 0.7\n"
        "set key outside right center vertical Left reverse noenhanced samplen 2.5 spacing 1.15"
        " font ',10'\n"
        "set bmargin 5\n",
        out);
  print_tics(out, 'x', &x);
  print_tics(out, 'y', &y);
  if (!(own > x.from)) return;
  fprintf(out,
          "set arrow from first %g, graph 0 to first %g, graph 1 nohead dashtype 2"
          " linecolor '#606060'\n"
          "set label 2 'the reference''s own error' at first %g, graph 0.03 left rotate by 90"
          " offset -1.5,0 textcolor '#606060' font ',9'\n",
          own, own, own);
}

/* ---- Drawing */

/* Only what doesn't depend on a study: whether gnuplot knows the format, too. */
msr_status figure_check(const settings *s, msr_error *err) {
  gnuplot g;
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  const msr_status status = gnuplot_start(&g, nowhere, err);
  close(nowhere);
  if (status != MSR_OK) return status;
  print_terminal(g.script, s->plot);
  return gnuplot_end(&g, err);
}

msr_status figure_draw(const study *st, int out, msr_error *err) {
  gnuplot g;
  const msr_status status = gnuplot_start(&g, out, err);
  if (status != MSR_OK) return status;
  print_terminal(g.script, st->s->plot);
  print_title(g.script, st);
  print_footer(g.script);
  print_axes(g.script, st);
  curves_print(g.script, st);
  return gnuplot_end(&g, err);
}
