/* beside.h - the same hard cases put to several programs: a problem, those who solve it, and what
 * is seen of it from outside. */
#ifndef BESIDE_H
#define BESIDE_H

#include "../fail.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bond {
  size_t i, j;
  double k, L;
} bond;

/* In pixels, y up; of its own, so that no one's reading of a scene favours anyone. */
typedef struct problem {
  const char *name, *text;
  size_t width, height;
  bool *black;  /* [height][width], rows from the bottom: supports */
  bool *inside; /* [height][width]: air that is within reach of the masses at the start */
  size_t n, n_bonds;
  double *x, *y, *vx, *vy, *m; /* [n] */
  bond *bonds;                 /* [n_bonds] */
  bool drawn;             /* masses in reading order, at rest, springs of 1 px to 4 neighbours */
  double mass, stiffness; /* of all, if drawn; of most, if not */
  double dt, gravity;
  uint64_t iterations;
  double damping;     /* along springs [kg/s] */
  double air, wind;   /* F = air (wind - v) along x */
  double restitution; /* of supports */
  double diameter;    /* of masses that collide with each other; 0: they don't */
  double scale;       /* of energy; 0: that at the start */
  double allowed;     /* growth of the energy, over the scale */
  bool closed;        /* supports all round: no mass may leave the picture */
  bool elastic;       /* nothing takes energy away */
  bool rests;         /* it should come to rest */
} problem;

bool is_black(const problem *p, double x, double y);

/* Ends the program if there is no memory. */
void *need(size_t count, size_t size);

/* Calls for each stretch of black pixels of a row: columns from .. to - 1. */
typedef void on_stretch(void *self, double from, double to, double row);
void for_stretches(const problem *p, on_stretch *visit, void *self);

typedef struct solver {
  /* Why the problem can't be put to it; NULL: it can. */
  const char *(*declines)(const problem *p);
  void *(*open)(const problem *p);
  /* False: it has stopped, and says why in `text` [128]. */
  bool (*advance)(void *self, uint64_t iterations, char *text);
  /* To arrays of n. */
  void (*read)(void *self, double *x, double *y, double *vx, double *vy);
} solver;

/* Steps per DT of libmsr's plan: of Verlet, before any care or leap. */
uint64_t library_substeps(const problem *p);

extern const solver solver_library, solver_assignment, solver_gsl, solver_chipmunk, solver_box2d;

const char *gsl_version_text(void);
const char *chipmunk_version(void);
const char *box2d_version(void);

#ifdef __cplusplus
}
#endif

#endif
