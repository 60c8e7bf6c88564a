/* scipy.c - SciPy in a Python of its own, scipy_peer.py, which is asked for one run at a time: a
 * line `method tolerance` goes there, q and v at T come back. */
#include "bench.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct scipy_run {
  problem *p;
  const char *name;
  double tolerance;
} scipy_run;

static FILE *question, *answer;
static char version[32];

static void become_python(const int *in, const int *out, const char *python, const char *script,
                          const char *library) {
  dup2(in[0], STDIN_FILENO);
  dup2(out[1], STDOUT_FILENO);
  fclose(stderr); /* where a Python without SciPy would complain */
  for (int end = 0; end < 2; end++) close(in[end]), close(out[end]);
  execlp(python, python, script, library, (char *)NULL);
  _exit(EXIT_FAILURE);
}

/* Its first line is its version; without SciPy there is none. */
static bool try_python(const char *python, const char *script, const char *library) {
  int in[2], out[2];
  if (pipe(in) != 0 || pipe(out) != 0) bench_fail("there is no pipe to Python");
  const pid_t child = fork();
  if (child < 0) bench_fail("Python can't be started");
  if (child == 0) become_python(in, out, python, script, library);
  close(in[0]);
  close(out[1]);
  question = fdopen(in[1], "w");
  answer = fdopen(out[0], "r");
  if (question && answer && fgets(version, sizeof version, answer)) return true;
  fclose(question);
  fclose(answer);
  return false;
}

const char *scipy_begin(const char *script, const char *library) {
  static const char *const pythons[] = {"python3", "/usr/bin/python3"};
  for (size_t i = 0; i < sizeof pythons / sizeof *pythons; i++)
    if (try_python(pythons[i], script, library)) {
      version[strcspn(version, "\n")] = '\0';
      return version;
    }
  return "missing";
}

static void *open_scipy(const method *self, problem *p, double knob) {
  scipy_run *r = need(1, sizeof *r);
  *r = (scipy_run){p, self->name, knob};
  return r;
}

static bool run_scipy(void *object, double *z) {
  const scipy_run *r = object;
  fprintf(question, "%s %.17g\n", r->name, r->tolerance);
  fflush(question);
  return fread(z, sizeof *z, 2 * r->p->n, answer) == 2 * r->p->n;
}

/* LSODA isn't among them: now and then it takes this problem for a stiff one, and spends seconds on
 * a dense Jacobian. */
size_t scipy_methods(method *list) {
  static const char *const names[] = {"RK45", "DOP853"};
  const size_t n = *version ? sizeof names / sizeof *names : 0;
  for (size_t i = 0; i < n; i++)
    list[i] = (method){.family = "SciPy",
                       .name = names[i],
                       .by_tolerance = true,
                       .open = open_scipy,
                       .run = run_scipy,
                       .close = free,
                       .elsewhere = true};
  return n;
}
