/* springs.h - the kernels of the spring force. */
#ifndef MSRI_SPRINGS_H
#define MSRI_SPRINGS_H

#include "base/base.h"

/* The forces of all runs, compiled for vectors of some width: the same bits by each of them. */
typedef struct msri_springs_kernel {
  const char *name;
  bool (*runs_here)(void); /* has this machine got such vectors? NULL: every one has */
  void (*add_runs)(const msr_view *s, double *fx, double *fy);
} msri_springs_kernel;

/* Widest first; the last runs anywhere. */
extern const msri_springs_kernel msri_springs_kernels[];

#endif
