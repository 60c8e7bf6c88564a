/* stiffness.h - the matrix that implicit methods solve with, A = M + c K of masses and of springs,
 * K made positive, and its solution by conjugate gradients with an incomplete factorisation. */
#ifndef MSRI_STIFFNESS_H
#define MSRI_STIFFNESS_H

#include "solvers/block.h"
#include "solvers/graph.h"

enum { MSRI_MOST_ITERATIONS = 5000 };

/* The matrix, in memory that it doesn't own. */
typedef struct msri_stiffness {
  const msri_graph *graph;
  const msr_springs *springs;
  const double *m;    /* mass i is m[i * m_stride] */
  double *weight;     /* 1/m^2, likewise */
  size_t m_stride;    /* 0 or 1 */
  double least;       /* stiffness across a spring is no less: A stays positive */
  msri_block *tie;    /* [graph->pairs]: c K between two masses */
  msri_block *anchor; /* [n_anchors]: and to fixed points */
  msri_block *pivot;  /* [n]: D^-1 of the factors L D L^T */
  const bool *held;   /* [2n], as of linearise; NULL: nothing is */
  msri_square *lower; /* [graph->pairs]: -L below its diagonal of ones */
  msri_vector *x, *residual, *direction, *image; /* [n]: of conjugate gradients */
  int most;                                      /* iterations that a solution may take */
  uint64_t iterations;                           /* of these, so far: what solving takes */
} msri_stiffness;

/* Bytes of its memory, and the object in it. The masses and springs of the view must outlive it. */
size_t msri_stiffness_bytes(const msri_graph *graph, size_t anchors, size_t m_stride);
msri_stiffness msri_stiffness_place(const msri_graph *graph, const msr_view *s, void *memory);

/* As linearise and solve of msr_system. MSR_EUNSTABLE if rounding
 * leaves not even one digit of x. */
void msri_stiffness_linearise(msri_stiffness *a, const double *q0, const double *from,
                              const double *q, double c, const bool *held);
msr_status msri_stiffness_solve(msri_stiffness *a, const double *r, double tolerance, double *x);

/* v of mass i without what is held. */
static inline msri_vector msri_stiffness_loose(const msri_stiffness *a, size_t i, msri_vector v) {
  if (!a->held) return v;
  return (msri_vector){a->held[i] ? 0 : v.x, a->held[a->graph->n + i] ? 0 : v.y};
}

/* Parts of these. */
void msri_stiffness_factorise(msri_stiffness *a);
/* z = (L D L^T)^-1 r; returns r.z */
double msri_stiffness_precondition(const msri_stiffness *a, const msri_vector *r, msri_vector *z);

#endif
