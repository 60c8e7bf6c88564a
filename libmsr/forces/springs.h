/* springs.h - the kernels of the spring force. */
#ifndef MSRI_SPRINGS_H
#define MSRI_SPRINGS_H

#include "base/base.h"
#include "base/machine.h"

enum { MSRI_SPRINGS_BLOCK = 256 };

/* Where springs begin and end: [count] each. */
typedef struct msri_ends {
  const double *xi, *yi, *xj, *yj;
} msri_ends;

MSRI_INLINE msri_ends msri_ends_of(const msr_view *s, size_t i, size_t j) {
  return (msri_ends){s->x + i, s->y + i, s->x + j, s->y + j};
}

MSRI_INLINE msri_ends msri_ends_of_anchor(const msr_view *s, const msr_anchor *a) {
  return (msri_ends){s->x + a->i, s->y + a->i, &a->x, &a->y};
}

/* Adds a block of forces to masses i .. i+count-1, and takes them from masses j on; this comes
 * first, so that sums are those of a loop over the springs: where a mass ends one of a run and
 * begins another, the one that it ends comes first. */
MSRI_INLINE void msri_add_to_ends(size_t count, size_t i, size_t j, const double *bx,
                                  const double *by, double *fx, double *fy) {
  for (size_t n = 0; n < count; n++) fx[j + n] -= bx[n];
  for (size_t n = 0; n < count; n++) fy[j + n] -= by[n];
  for (size_t n = 0; n < count; n++) fx[i + n] += bx[n];
  for (size_t n = 0; n < count; n++) fy[i + n] += by[n];
}

/* Springs one after the other, of some runs; masses are counted from `base` on. */
typedef struct msri_bundle {
  const msr_run_of_springs *run; /* [n_runs]: */
  size_t n_runs;
  size_t skip, stop; /* without the first so many springs of the first, and those of the last from
                        there on */
  size_t base;
} msri_bundle;

/* All springs, of all masses. */
msri_bundle msri_bundle_of_all(const msr_springs *springs);

/* Adds the forces of a bundle, compiled for vectors of some width: the same bits by each of them.
 */
typedef struct msri_springs_kernel {
  const char *name;
  bool (*runs_here)(void); /* has this machine got such vectors? NULL: every one has */
  void (*add)(const msri_bundle *bundle, const double *x, const double *y, double *fx, double *fy);
} msri_springs_kernel;

/* Widest first; the last runs anywhere. */
extern const msri_springs_kernel msri_springs_kernels[];

/* The widest that runs here. */
const msri_springs_kernel *msri_springs_widest(void);

/* msr_force's between. */
msr_status msri_springs_between(const void *self, void *scratch, const msr_view *s,
                                const msr_view *to, double *fx, double *fy);

#endif
