/* speed.h - how fast libmsr is beside others on the same work: what there is to compute, who
 * computes it, and what is measured. Springs of k, L and masses of m are all alike. */
#ifndef SPEED_H
#define SPEED_H

#include "../fail.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

static const double stiffness = 1500, mass = 0.1, rest = 1, step = 0.001;

/* ---- Measuring */

enum { ROUNDS = 7, MOST_THREADS = 2, MOST_ENTRIES = 16 };

/* Of `n` samples, which are put into order. */
typedef struct spread {
  double low, median, high; /* quartiles */
} spread;
spread spread_of(double *sample, size_t n);

double seconds_now(void);

/* Ends the program if there is no memory; zeroed. */
void *need(size_t count, size_t size);

/* A line for the end of the program: PASS, or FAIL, `value` at least (at most) `bar`. */
void bar_at_least(double value, double bar, const char *what, ...)
    __attribute__((format(printf, 3, 4)));
void bar_at_most(double value, double bar, const char *what, ...)
    __attribute__((format(printf, 3, 4)));
void bars_print(void);

/* ---- Work */

/* Masses in reading order, [px], y up, a few long waves away from rest. */
typedef struct work {
  const char *name;
  bool drawn; /* a picture; else masses and springs one by one */
  bool full;  /* a picture without a hole */
  size_t width, height;
  bool *there; /* [height][width], rows from the top, if drawn */
  size_t n, n_springs;
  double *x, *y;   /* [n] at t = 0 */
  double *u, *v;   /* [n] velocities half a step before, at rest at t = 0 */
  uint32_t *i, *j; /* [n_springs] */
} work;

typedef void draw(work *w);
draw draw_block, draw_holes, draw_branches, draw_objects;

/* A picture of `side` x `side`; a lattice as a mesh; a disc of triangles, `side` across. */
work work_drawn(const char *name, size_t side, draw *how);
work work_lattice(const char *name, size_t side);
work work_disc(const char *name, size_t side);
void work_free(work *w);

/* ---- Who does it */

/* One of them at work. */
typedef struct entry {
  void *self;
  size_t springs;      /* updated in a step */
  double bytes;        /* that it takes; NAN: unknown */
  bool alike;          /* it does this very work: positions can be compared */
  const char *missing; /* why there is none; NULL: there is */
} entry;

typedef struct contestant {
  const char *name;
  size_t grain;  /* runs are multiples of so many steps */
  int parameter; /* its own */
  int threads;   /* at most */
  entry (*open)(const struct contestant *c, const work *w, int threads);
  double (*run)(void *self, size_t steps); /* [s] */
  void (*read)(void *self, double *x, double *y);
  void (*close)(void *self);
} contestant;

extern const contestant library, assignment, lammps, numba, limit_1, limit_8, limit_16;

/* "Numba 0.68.1", or what is there instead. */
const char *numba_version(void);
const char *lammps_version(void);
const char *limit_vectors(void);

/* ---- Tables */

/* Where files may be put, and the program itself. */
extern const char *scratch, *myself;

void contest(const work *w);
void triad_table(void);
void growth_table(void);
void frames_table(void);
void implicit_table(void);
void startup_table(void);
/* What startup_table starts this program for, in a process of its own. */
int startup_once(void);

#endif
