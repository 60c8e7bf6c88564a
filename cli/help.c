/* help.c - usage and help, printed from the tables of commands and options. */
#include "help.h"

#include "commands.h"
#include "machine.h"

static const char intro[] =
    "msr simulates mass-spring systems: a picture says what there is, a conf says how\n"
    "it moves, and a numbered sequence of pictures comes out.\n";

static const char examples[] =
    "examples\n"
    "  msr scene.ppm scene.conf                   frames/frame-000000.ppm ...\n"
    "  msr plan scene.ppm scene.conf --wind 40    look before you run\n"
    "  msr scene.ppm scene.conf --accuracy 0.01   within 0.01 px, at least time\n"
    "  msr scene.ppm scene.conf --scale 4 -o - |\n"
    "    ffmpeg -f image2pipe -framerate 25 -i - -pix_fmt yuv420p film.mp4\n\n"
    "'msr COMMAND -h' tells the options of a command, 'man msr' all about them.\n";

void help_print_version(FILE *out) {
  fprintf(out, "msr %s (GSL %s)\nGPL-3.0-or-later: free software, without any warranty\n",
          msr_version(), machine_gsl());
}

void help_print(FILE *out) {
  fprintf(out, "%s\nusage\n  msr %s\n", intro, commands->usage);
  fputs("  msr COMMAND ...\n  msr -h | --version\n\ncommands\n", out);
  for (const command *c = commands; c->name; c++) {
    fprintf(out, "  %-8s %-30s %s\n", c->name, c->usage, c->summary);
  }
  fprintf(out, "\n%s", examples);
}

static void print_option(FILE *out, const option *o) {
  char left[64];
  if (o->group) fprintf(out, "%s\n", o->group);
  const char letter[] = {'-', o->letter, o->name ? ',' : ' ', '\0'};
  snprintf(left, sizeof left, "%s %s%s %s", o->letter ? letter : "   ", o->name ? "--" : "",
           o->name ? o->name : "", o->argument ? o->argument : "");
  fprintf(out, "  %-26s %s\n", left, o->help);
}

void help_print_command(FILE *out, const command *c) {
  fprintf(out, "usage: msr %s%s%s\n%s\n\n", c->name, *c->usage ? " " : "", c->usage, c->summary);
  for (const option *o = all_options; o->help; o++) {
    if (o->commands & c->bit) print_option(out, o);
  }
}
