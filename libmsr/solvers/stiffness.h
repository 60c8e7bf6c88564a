/* stiffness.h - the matrix that implicit methods solve with, A = M + c K of masses and of springs,
 * K made positive, and its solution by conjugate gradients with an incomplete factorisation. */
#ifndef MSRI_STIFFNESS_H
#define MSRI_STIFFNESS_H

#include "base/base.h"
#include "solvers/graph.h"

enum { MSRI_MOST_ITERATIONS = 5000 };

/* Symmetric matrices of 2 x 2, side by side. */
typedef struct msri_matrices {
  double *xx, *xy, *yy;
} msri_matrices;

/* The matrix, in memory that it doesn't own. Masses and pairs are in the order of the graph, x and
 * y of all masses one after the other. */
typedef struct msri_stiffness {
  const msri_graph *graph;
  const msr_springs *springs;
  double *m;            /* mass i is m[i * m_stride] */
  double *weight;       /* 1/m^2, likewise */
  size_t m_stride;      /* 0 or 1 */
  double least;         /* stiffness across a spring is no less: A stays positive */
  msri_matrices tie;    /* [graph->pairs]: c K between two masses */
  msri_matrices anchor; /* [n_anchors]: and to fixed points */
  msri_matrices pivot;  /* [n]: D^-1 of the factors L D L^T */
  float *lower;         /* [graph->pairs][4]: -L below its diagonal of ones, strip by strip */
  uint32_t *place;      /* [n_anchors]: the mass of each */
  const bool *held;     /* [2n], as of linearise; NULL: nothing is */
  double *x, *residual, *direction, *image; /* [2n]: of conjugate gradients, */
  double *z, *product;                      /* and what the factors make of the residual, A z */
  int most;                                 /* iterations that a solution may take */
  uint64_t iterations;                      /* of these, so far: what solving takes */
} msri_stiffness;

/* Bytes of its memory, and the object in it. The masses and springs of the view must outlive it. */
size_t msri_stiffness_bytes(const msri_graph *graph, size_t anchors, size_t m_stride);
msri_stiffness msri_stiffness_place(const msri_graph *graph, const msr_view *s, void *memory);

/* As linearise and solve of msr_system. MSR_EUNSTABLE if rounding
 * leaves not even one digit of x. */
void msri_stiffness_linearise(msri_stiffness *a, const double *q0, const double *from,
                              const double *q, double c, const bool *held);
msr_status msri_stiffness_solve(msri_stiffness *a, const double *r, double tolerance, double *x);

/* y[2n] without what is held, for masses from .. to - 1 of the graph's order. */
static inline void msri_stiffness_loosen(const msri_stiffness *a, size_t from, size_t to,
                                         double *y) {
  const size_t n = a->graph->n;
  for (size_t i = from; a->held && i < to; i++) {
    if (a->held[a->graph->order[i]]) y[i] = 0;
    if (a->held[n + a->graph->order[i]]) y[n + i] = 0;
  }
}

/* What is held is as heavy as numbers allow: it moves by nothing that counts. */
static inline void msri_stiffness_weigh_down(const msri_stiffness *a, size_t i, double *xx,
                                             double *yy) {
  const double heavy = 1e60 * (*xx + *yy);
  const uint32_t mass = a->graph->order[i];
  if (a->held[mass]) *xx += heavy;
  if (a->held[a->graph->n + mass]) *yy += heavy;
}

/* Parts of these. */
void msri_stiffness_factorise(msri_stiffness *a);
/* Solves with the factors: z = L^-1 z in blocks from .. to - 1 of the graph, those before done. */
void msri_stiffness_forward(const msri_stiffness *a, size_t from, size_t to, double *z);
/* From r to z = L^-T D^-1 r, in place, and y = A z; returns z.y, and r D^-1 r in rz. */
double msri_stiffness_backward(const msri_stiffness *a, double *z, double *y, double *rz);

#endif
