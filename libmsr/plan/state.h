/* state.h - what moves, and the memory that moving it takes: one block, carved. */
#ifndef MSRI_STATE_H
#define MSRI_STATE_H

#include "plan/plan.h"

/* What the guard compares with: see run/guard.c. */
typedef struct msri_guard {
  bool begun;
  double energy;    /* kinetic and spring energy at the start */
  double potential; /* of all other conservative forces at the start */
  double fallen;    /* the most that it has been below that */
  double work;      /* bound of what driving forces have done since */
} msri_guard;

struct msr_state {
  const msr_plan *plan;
  uint64_t iteration, substep; /* done; substeps of the iteration that is under way */
  double t;                    /* [s] */
  bool fresh;                  /* the integrator's workspace fits q and v */
  uint64_t contacts;
  uint64_t frames; /* of a run that went to the sinks */
  msri_guard guard;
  double *q, *v;   /* x[n], y[n]; vx[n], vy[n] */
  double *work;    /* [integrator->vectors][2n] */
  double *middle;  /* [4n] if plan->midpoint: force, velocity */
  double *drive;   /* [6n] if plan->driven: force, and force and q when the guard looked last */
  char *scratch;   /* [plan->scratch_bytes] */
  uint64_t *calls; /* [plan->n_effects] */
};

/* Bytes of a state of the plan. */
size_t msri_state_bytes(const msr_plan *plan);

/* The problem that the integrator solves for this state. */
msr_system msri_state_system(msr_state *state);

/* Adds the forces of the terms that `wanted` accepts to f = fx[n], fy[n], which is zeroed first. */
msr_status msri_state_add_forces(msr_state *state, const msr_view *view,
                                 bool (*wanted)(const msr_force *), double *f);

/* As msr_state_energy, without momentum and the longest spring. */
msr_energy msri_state_energies(const msr_state *state);

/* FNV-1a over 8-byte words, from a hash so far. */
#define MSRI_HASH_START UINT64_C(0xcbf29ce484222325)
uint64_t msri_hash_words(uint64_t hash, const void *words, size_t n);

/* Tells that q, v or t were changed from outside. */
void msri_state_touched(msr_state *state);

#endif
