/* stability.c [CASE ...] [COLUMN ...] - hard cases put to libmsr, to the assignment's own algorithm
 * and to other libraries, side by side; to the columns named, or to all. */
#include "cases.h"
#include "watch.h"

#include "../machine.h"

#include "msr.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Of the processor, a run [s]. */
static const unsigned limit = 20;

/* A body at rest is slower [px/s]. */
static const double at_rest = 0.01;

/* What loses more than this share, where nothing takes energy away, is damped. */
static const double kept = 0.1;

static const struct column {
  const char *name, *settings;
  const solver *solver;
  bool fine; /* takes as many steps as libmsr's plan */
} columns[] = {
    {"libmsr", "no option but those that describe the case", &solver_library, false},
    {"assignment", "symplectic Euler, one step per DT", &solver_assignment, false},
    {"assignment+", "the same with as many steps as libmsr's plan", &solver_assignment, true},
    {"GSL rkf45", "odeiv2 driver, absolute tolerance 1e-6", &solver_gsl, false},
    {"Chipmunk2D", "a pixel is a unit; one step per DT, 10 iterations", &solver_chipmunk, false},
    {"Chipmunk2D+", "the same with as many steps as libmsr's plan", &solver_chipmunk, true},
    {"Box2D", "a pixel is 0.1 m; one step per DT, 8 and 3 iterations", &solver_box2d, false},
};
enum { COLUMNS = sizeof columns / sizeof *columns, MOST_CASES = 16 };

static void print_machine(void) {
  bench_print_machine();
  printf("; one thread.\nGSL %s, Chipmunk2D %s, Box2D %s.\n", gsl_version_text(),
         chipmunk_version(), box2d_version());
  for (size_t i = 0; i < COLUMNS; i++) printf("  %-11s %s\n", columns[i].name, columns[i].settings);
  printf("A run is given %u s of the processor.\n", limit);
}

/* All that is wrong. */
static void judge(const problem *p, const sight *s, char *text, size_t size) {
  const struct fault {
    bool found;
    const char *name;
  } faults[] = {{s->how == NOT_FINITE, "not finite"},
                {s->how == CRASHED, "crashes"},
                {s->how == STOPPED, "stops"},
                {s->how == RUNAWAY, "explodes"},
                {s->how != RUNAWAY && s->gain > p->allowed, "heats"},
                {s->out > 0, "escapes"},
                {s->in > 0, "sinks in"},
                {s->how == LATE, "too slow"},
                {s->how == DONE && p->rests && s->speed > at_rest, "no rest"},
                {p->elastic && s->loss > kept, "damped"}};
  size_t at = 0;
  text[0] = '\0';
  for (size_t i = 0; i < sizeof faults / sizeof *faults && at < size; i++)
    if (faults[i].found)
      at += (size_t)snprintf(text + at, size - at, "%s%s", at > 0 ? ", " : "", faults[i].name);
  if (at == 0) snprintf(text, size, "%s", s->how == DECLINED ? "-" : "sound");
}

static void print_row(const problem *p, const char *name, const sight *s) {
  printf("%-11s", name);
  if (s->how == DECLINED) {
    printf(" %-67s not put: %s\n", "", s->text);
    return;
  }
  printf(" %+10.2g %10.2g %8.2g %6zu %6zu %9.2g", s->gain, -s->loss, s->depth, s->in, s->out, s->t);
  if (s->how == DONE)
    printf(" %9.2g", s->speed);
  else
    printf(" %9s", "-");
  char text[80];
  judge(p, s, text, sizeof text);
  printf(" %7.2f  %s\n", s->seconds, text);
  if (s->how == STOPPED) printf("%12s%.*s\n", "", (int)strcspn(s->text, ":"), s->text);
}

static void print_head(const problem *p, uint64_t substeps) {
  printf("\n== %s: %s; %zu masses; +: %ju steps per DT\n", p->name, p->text, p->n,
         (uintmax_t)substeps);
  printf("%-11s %10s %10s %8s %6s %6s %9s %9s %7s\n", "", "growth", "loss", "depth", "in", "out",
         "until s", "speed", "CPU s");
}

/* Are none of these names given, or this one? */
static bool is_asked(char **args, const char *name, bool (*is_name)(const char *)) {
  bool none = true;
  for (; *args; args++) {
    if (strcmp(*args, name) == 0) return true;
    none = none && !is_name(*args);
  }
  return none;
}

static bool is_case(const char *name) {
  size_t c = 0;
  while (hard_cases[c].name && strcmp(hard_cases[c].name, name) != 0) c++;
  return hard_cases[c].name;
}

static bool is_column(const char *name) {
  size_t i = 0;
  while (i < COLUMNS && strcmp(columns[i].name, name) != 0) i++;
  return i < COLUMNS;
}

static void put(const hard_case *from, char **args, char (*verdicts)[80]) {
  problem p;
  problem_create(&p, from);
  problem fine = p;
  const uint64_t substeps = library_substeps(&p);
  print_head(&p, substeps);
  fine.dt /= (double)substeps;
  fine.iterations *= substeps;
  for (size_t i = 0; i < COLUMNS; i++) {
    if (!is_asked(args, columns[i].name, is_column)) continue;
    const sight seen = watch(columns[i].solver, columns[i].fine ? &fine : &p, limit);
    print_row(&p, columns[i].name, &seen);
    judge(&p, &seen, verdicts[i], sizeof verdicts[i]);
  }
  problem_free(&p);
}

/* The first fault of each. */
static void print_summary(char **args, char (*verdicts)[COLUMNS][80]) {
  printf("\n%-12s", "In short");
  for (size_t i = 0; i < COLUMNS; i++) printf(" %-13s", columns[i].name);
  printf("\n");
  for (size_t c = 0; hard_cases[c].name; c++) {
    if (!is_asked(args, hard_cases[c].name, is_case)) continue;
    printf("%-12s", hard_cases[c].name);
    for (size_t i = 0; i < COLUMNS; i++)
      printf(" %-13.*s", (int)strcspn(verdicts[c][i], ","), verdicts[c][i]);
    printf("\n");
  }
}

int main(int argc, char **argv) {
  for (int i = 1; i < argc; i++)
    if (!is_case(argv[i]) && !is_column(argv[i]))
      bench_fail("no case or column is called %s", argv[i]);
  static char verdicts[MOST_CASES][COLUMNS][80];
  setvbuf(stdout, NULL, _IOLBF, 0);
  print_machine();
  for (size_t c = 0; hard_cases[c].name; c++)
    if (is_asked(argv + 1, hard_cases[c].name, is_case)) put(&hard_cases[c], argv + 1, verdicts[c]);
  print_summary(argv + 1, verdicts);
}
