/* accuracy.c SCRIPT LIBRARY - what accuracy costs in time: libmsr against bare loops and against
 * other libraries, on a smooth problem and on two stiff ones. */
#include "machine.h"
#include "measure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Printing */

static void print_machine(const char *scipy) {
  bench_print_machine();
  printf("; one thread.\nBoost.Odeint %s, SUNDIALS %s, GSL %s, SciPy %s.\n", odeint_version(),
         sundials_version(), gsl_version_text(), scipy);
  printf("The vectors of SUNDIALS are the benchmark's: Debian's package isn't optimised.\n\n");
}

static void print_row(const table *t, size_t k) {
  printf("%-9s %-19s", t->method[k].family, t->method[k].name);
  for (size_t e = 0; e < t->n_errors; e++) {
    const point *x = &t->point[k][e];
    if (x->reached)
      printf(" %11.3g", 1e3 * x->minimum);
    else
      printf(" %11s", "-");
  }
  printf("\n");
}

static void print_head(const table *t, const char *what) {
  printf("%-29s", what);
  for (size_t e = 0; e < t->n_errors; e++) printf(" %8.0e px", t->error[e]);
  printf("\n");
}

static void print_table(const table *t) {
  print_head(t, "ms to come within");
  for (size_t k = 0; k < t->n_methods; k++) print_row(t, k);
  printf("\n");
}

/* ---- Fronts */

/* The fastest of a family at an error; NULL: none gets there. */
static const point *front(const table *t, const char *family, size_t e, const char **name) {
  const point *best = NULL;
  for (size_t k = 0; k < t->n_methods; k++) {
    const point *x = &t->point[k][e];
    if (strcmp(t->method[k].family, family) != 0 || !x->reached) continue;
    if (best && best->minimum <= x->minimum) continue;
    best = x;
    *name = t->method[k].name;
  }
  return best;
}

/* Time of one family's front over another's; infinite if `over` isn't there, 0 if `under` isn't. */
static double ratio(const table *t, const char *over, const char *under, size_t e) {
  const char *name;
  const point *a = front(t, over, e, &name), *b = front(t, under, e, &name);
  if (!b) return 0;
  return a ? a->minimum / b->minimum : (double)INFINITY;
}

static void print_front(const table *t, const char *family) {
  printf("%-29s", family);
  for (size_t e = 0; e < t->n_errors; e++) {
    const char *name = "-";
    front(t, family, e, &name);
    printf(" %11.11s", name);
  }
  printf("\n");
}

static void print_ratios(const table *t, const char *over, const char *under) {
  char title[64];
  snprintf(title, sizeof title, "%s / %s", over, under);
  printf("%-29s", title);
  for (size_t e = 0; e < t->n_errors; e++) printf(" %11.2f", ratio(t, over, under, e));
  printf("\n");
}

static void judge(bool passed, const char *what, double value) {
  printf("%-7s %s: %.2f\n", passed ? "PASS" : "MISSED", what, value);
}

/* How far medians are above minima: what the machine was busy with beside. */
static void print_spread(const table *t) {
  double worst = 0, sum = 0;
  size_t n = 0;
  for (size_t k = 0; k < t->n_methods; k++)
    for (size_t e = 0; e < t->n_errors; e++) {
      const point *x = &t->point[k][e];
      if (!x->reached) continue;
      const double excess = x->median / x->minimum - 1;
      worst = fmax(worst, excess), sum += excess, n++;
    }
  printf("Times are minima; medians are %.0f %% above on average, %.0f %% at most.\n\n",
         100 * sum / (double)n, 100 * worst);
}

/* ---- Truth */

static void solve(problem *p, const method *list, size_t n, const char *name, double knob,
                  double *z) {
  for (size_t k = 0; k < n; k++) {
    if (strcmp(list[k].name, name) != 0) continue;
    void *object = list[k].open(&list[k], p, knob);
    p->deadline = (double)INFINITY;
    if (!list[k].run(object, z)) bench_fail("no reference by %s", name);
    list[k].close(object);
  }
}

/* By two methods that have nothing in common but the right-hand side. */
static double *find_truth(problem *p, double steps, double tolerance) {
  method list[MOST_METHODS];
  double *z = need(2 * p->n, sizeof *z), *other = need(2 * p->n, sizeof *other);
  solve(p, list, prototype_methods(list), "Kahan-Li 8", steps, z);
  solve(p, list, gsl_methods(list), "rk8pd", tolerance, other);
  printf("Truth: Kahan-Li 8, %.0f steps; rk8pd, tolerance %g, is %.2g px away from it.\n", steps,
         tolerance, largest_distance(z, other));
  free(other);
  return z;
}

/* ---- Tables */

static void measure(table *t, int rounds) {
  const double begin = clock_now(true);
  table_search(t);
  table_time(t, rounds);
  printf("Measured in %.0f s; -: not within %g s a run. ", clock_now(true) - begin, t->p->limit);
  print_spread(t);
  print_table(t);
}

static const char *const peers[] = {"Odeint", "SUNDIALS", "GSL", "SciPy"};
enum { PEERS = sizeof peers / sizeof *peers };

static void judge_peers(const table *t) {
  static const double bar[] = {0, 0, 1.5, 2, 3};
  for (size_t e = 0; e < t->n_errors; e++) {
    if (bar[e] <= 0) continue;
    double least = (double)INFINITY;
    for (size_t i = 0; i < PEERS; i++) least = fmin(least, ratio(t, peers[i], "libmsr", e));
    char what[80];
    snprintf(what, sizeof what, "every peer at least %.1f times libmsr at %.0e px", bar[e],
             t->error[e]);
    judge(least >= bar[e], what, least);
  }
}

static void judge_fronts(const table *t) {
  print_head(t, "Fastest of");
  print_front(t, "libmsr");
  print_front(t, "prototype");
  for (size_t i = 0; i < PEERS; i++) print_front(t, peers[i]);
  print_head(t, "Ratios of these");
  print_ratios(t, "libmsr", "prototype");
  for (size_t i = 0; i < PEERS; i++) print_ratios(t, peers[i], "libmsr");
  double most = 0;
  for (size_t e = 0; e < t->n_errors; e++) most = fmax(most, ratio(t, "libmsr", "prototype", e));
  judge(most <= 1.2, "libmsr at most 1.2 times the best bare loop", most);
  judge_peers(t);
  printf("\n");
}

static void compare_on_smooth(void) {
  static const double errors[] = {1e-2, 1e-4, 1e-6, 1e-8, 1e-10};
  static table t;
  problem p;
  problem_create(&p, DEFORMED, 1500, 1.2);
  printf("== A free block of 20 x 20 masses, deformed by four waves of up to 0.01 px: k 1500, "
         "m 0.1, T 1 s\n");
  double *truth = find_truth(&p, 2000, 1e-14);
  t = (table){.p = &p, .n_errors = 5, .error = errors, .truth = truth, .loosest = 10, .share = 0.2};
  method *next = t.method;
  next += library_methods(next);
  next += prototype_methods(next);
  next += odeint_methods(next);
  next += sundials_methods(next);
  next += gsl_methods(next);
  next += scipy_methods(next);
  t.n_methods = (size_t)(next - t.method);
  measure(&t, 20);
  judge_fronts(&t);
  free(truth);
  problem_free(&p);
}

static void name_implicit(method *list, size_t n) {
  for (size_t k = 0; k < n; k++)
    list[k].family = ((const msr_integrator *)list[k].row)->implicit ? "implicit" : "explicit";
}

static void compare_on_stiff(double k) {
  static const double errors[] = {1e-1, 1e-2, 1e-3};
  static table t;
  problem p;
  problem_create(&p, SPINNING, k, 4);
  printf("== The block at rest length, spinning at 2 rad/s: k %.1e, m 0.1, T 1 s\n", k);
  double *truth = find_truth(&p, ceil(0.8 * sqrt(k / 0.1)), 1e-8);
  t = (table){
      .p = &p, .n_errors = 3, .error = errors, .truth = truth, .loosest = 1e-2, .share = 0.2};
  size_t n = library_methods(t.method);
  name_implicit(t.method, n);
  t.n_methods = n + sundials_stiff_methods(t.method + n);
  measure(&t, 5);
  print_head(&t, "Fastest of");
  print_front(&t, "explicit");
  print_front(&t, "implicit");
  print_front(&t, "SUNDIALS");
  print_head(&t, "Ratios of these");
  print_ratios(&t, "explicit", "implicit");
  print_ratios(&t, "SUNDIALS", "implicit");
  const double gain = ratio(&t, "explicit", "implicit", 1);
  if (k > 1e9) judge(gain >= 5, "explicit at least 5 times implicit at 1e-02 px", gain);
  printf("\n");
  free(truth);
  problem_free(&p);
}

int main(int argc, char **argv) {
  setvbuf(stdout, NULL, _IOLBF, 0);
  if (argc != 3) bench_fail("usage: accuracy SCRIPT LIBRARY");
  print_machine(scipy_begin(argv[1], argv[2]));
  compare_on_smooth();
  compare_on_stiff(1.5e6);
  compare_on_stiff(1.5e9);
}
