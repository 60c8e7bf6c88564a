/* bench.h - what accuracy costs in time: a problem, methods that solve it, and what they took.
 *
 * The problem is a free 20 x 20 block, from its start to T. Every method but libmsr's own evaluates
 * the same right-hand side: libmsr's compiled kernel of springs, times 1/m. */
#ifndef BENCH_H
#define BENCH_H

#include "fail.h"

#include "msr.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct problem {
  double k, T;     /* stiffness; end of time [s] */
  double limit;    /* a run that takes longer is given up [s] */
  double deadline; /* of the run under way, by clock_now(false) */
  unsigned evaluations;
  msr_scene *scene, *watched; /* the same; the latter stops when time is up */
  msr_plan *plan;
  msr_state *state; /* owns the springs of the view */
  msr_view view;
  size_t n;      /* coordinates, two a mass */
  double *start; /* [2n]: q, v */
} problem;

typedef enum start { DEFORMED, SPINNING } start;

/* Both end the program if there is no memory. */
void problem_create(problem *p, start how, double k, double limit);
void problem_free(problem *p);

/* a[n] at q[n]; dy[2n] at y[2n] = q, v. False: the run has taken too long. */
bool accelerate(problem *p, const double *q, double *a);
bool differentiate(problem *p, const double *y, double *dy);

/* Largest distance between the masses of q and r, x and y each; infinite if one isn't a number. */
double largest_distance(const double *q, const double *r);

/* [s] of this process, so that others on the machine don't count; of the wall for what is done
 * elsewhere. */
double clock_now(bool elsewhere);

/* Zeroed, at the beginning of a line of the cache; ends the program if there is none. */
void *need(size_t count, size_t size);

/* A method has one knob: the number of its steps, or the tolerance of one. */
typedef struct method {
  const char *family, *name;
  bool by_tolerance;
  const void *row; /* what tells it from others of its family */
  /* NULL: that can't be. */
  void *(*open)(const struct method *self, problem *p, double knob);
  /* z [2n]: q, v at T. False: failed, or took too long. */
  bool (*run)(void *object, double *z);
  void (*close)(void *object);
  bool elsewhere; /* it runs in another process */
} method;

/* Those of each family, after `list`; they return how many there are. */
size_t library_methods(method *list);
size_t prototype_methods(method *list);
size_t odeint_methods(method *list);
size_t sundials_methods(method *list);
size_t sundials_stiff_methods(method *list);
size_t gsl_methods(method *list);
size_t scipy_methods(method *list); /* none before scipy_begin */

/* Starts Python on scipy_peer.py and the library of scipy_rhs.c. The version of SciPy, or
 * "missing". */
const char *scipy_begin(const char *script, const char *library);

/* Versions of the others. */
const char *odeint_version(void);
const char *sundials_version(void);
const char *gsl_version_text(void);

#ifdef __cplusplus
}
#endif

#endif
