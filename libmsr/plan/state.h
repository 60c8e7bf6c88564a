/* state.h - what moves, and the memory that moving it takes: one block, carved. */
#ifndef MSRI_STATE_H
#define MSRI_STATE_H

#include "contacts/armed.h"
#include "plan/meter.h"
#include "plan/plan.h"
#include "solvers/stiffness.h"
#include "sweep/sweep.h"

/* What the guard compares with: see run/guard.c. */
typedef struct msri_guard {
  bool begun;
  bool stale;            /* what driving forces do where the state is isn't known */
  double energy;         /* kinetic and spring energy at the start, and of a first kick */
  double slack;          /* how much of that there needn't be: the kick, and rounding */
  double gravity, outer; /* potentials of gravity and of the other outer forces at the start */
  double lost;           /* the most that these have lost */
  double work;           /* bound of what driving forces have done since */
  double gain;           /* the most energy from nowhere, over what there was to give */
  double power;          /* bound of what driving forces that tell of it do */
  double most;           /* kinetic energy that calls for a closer look */
  uint64_t looked;       /* steps at the last look at all energies */
} msri_guard;

/* Where state->ahead holds the acceleration, without what depends on v; q NULL: nowhere. */
typedef struct msri_known {
  const double *q;
  double t;
} msri_known;

/* What implicit steps cost, in evaluations of the acceleration; the limit holds if `limited`. */
typedef struct msri_effort {
  bool limited;
  double spent, limit;
  double reach;         /* how far what meets something may be from it [px] */
  unsigned evaluations; /* of the mean force */
} msri_effort;

/* See run/leap.c. */
typedef struct msri_leap_memory {
  double *before;        /* [4n]: q, v before a leap */
  double *vector;        /* of the method: [vectors][2n] */
  uint64_t leaps, leapt; /* so far; and substeps that they took the place of */
  double spent;          /* on leaps and tries, in evaluations of the acceleration */
} msri_leap_memory;

/* See run/care.c. */
typedef struct msri_care {
  bool begun, on;
  uint64_t at;      /* iteration: where it was switched on, or where q, v were kept last; */
  uint64_t substep; /* done of the one that was under way there */
  double *kept;     /* [4n] if plan->cares: q, v there */
  msri_guard guard; /* and what it knew */
  double lost;      /* as the guard's, by looks at iterations that don't depend on who asks */
  void *memory;     /* for steps with care, once there are any */
  msri_graph *graph;
} msri_care;

struct msr_state {
  const msr_plan *plan;
  uint64_t iteration, substep; /* done; substeps of the iteration that is under way */
  bool fresh;                  /* the integrator's workspace fits q and v */
  uint64_t contacts, evaluations;
  uint64_t frames;         /* of a run that went to the sinks */
  const msr_force *failed; /* the force whose status stopped the last step */
  msri_guard guard;
  msr_workspace work;   /* vector [integrator->vectors, 1 at least][2n] */
  double *q, *v;        /* x[n], y[n]; vx[n], vy[n] */
  double *before;       /* [4n] if the library bounces: q, v before the step */
  double *ahead;        /* [2n] if the plan settles: a at the end of a step */
  msri_debts debts;     /* in contacts.c; else empty */
  msri_armed *armed;    /* of all masses, if the plan arms; these three NULL in a state that sweeps,
                           until it takes steps with care */
  msri_armed_rows rows; /* of the objects, if the plan arms and sweeps */
  msri_known known;
  double end; /* of the step under way [s] */
  msri_effort effort;
  msri_care care;
  msri_leap_memory leap;    /* if figures.leaps */
  double *middle;           /* [4n] if plan->midpoint: force, velocity */
  double *between;          /* [4n] if plan->middle: the middle, force */
  double *drive;            /* [2n] if plan->followed: driving forces */
  msri_sweep *sweep;        /* NULL: integrators step it */
  void *discs;              /* memory of plan->discs, if there are */
  char *scratch;            /* [plan->scratch_bytes] */
  msri_meter meter;         /* [plan->n_effects], and one for what is no effect */
  msri_stiffness stiffness; /* if plan->graph */
};

/* Steps since t = 0, modulo 2^64. */
static inline uint64_t msri_state_steps(const msr_state *state) {
  return state->iteration * state->plan->figures.substeps + state->substep;
}

static inline double msri_state_time(const msr_state *state) {
  return msri_plan_time(&state->plan->figures, state->iteration, state->substep);
}

/* Bytes of a state of the plan. */
size_t msri_state_bytes(const msr_plan *plan);

/* The problem that the integrator solves for this state. */
msr_system msri_state_system(msr_state *state);

/* Completes it for implicit integrators. */
void msri_state_solve_implicitly(msr_system *system);

/* f[2n] /= m. */
void msri_state_divide_by_mass(const msr_view *s, double *f);

/* Adds the forces of the terms that `wanted` accepts to fx, fy [n]; `step`: it's for a step, and
 * counts as a call. What a force returns; then state->failed is that force. */
msr_status msri_state_add_forces(msr_state *state, const msr_view *view,
                                 bool (*wanted)(const msr_force *), bool step, double *fx,
                                 double *fy);

/* a[2n] at (t, q, v), counted; v NULL: without what depends on it. What a force returns. */
msr_status msri_state_accelerate(msr_state *state, double t, const double *q, const double *v,
                                 double *a);

/* Does state->ahead hold the acceleration at (t, q)? It's told once. */
bool msri_state_knows(msr_state *state, double t, const double *q);

/* drift and bounce of the system. */
msr_status msri_state_drift(void *self, double h, const double *u, const double *a, double *q,
                            double *v);
msr_status msri_state_bounce(void *self, double h, const double *q0, const double *v0, double *q,
                             double *v, bool *met);

/* hold and rebound of the system. */
msr_status msri_state_hold(void *self, const double *q0, const double *q, bool *held, bool *more);
msr_status msri_state_rebound(void *self, const bool *held, const double *push, double *v);

/* meet and strike of the contact, from state->before to q and v. */
void msri_state_meet(msr_state *state, double h, msri_meeting *meeting);
void msri_state_strike(msr_state *state);

/* As msr_state_energy, without momentum and the longest spring. */
msr_energy msri_state_energies(const msr_state *state);

/* FNV-1a, from a hash so far: of one value, and of 8-byte words. */
#define MSRI_HASH_START UINT64_C(0xcbf29ce484222325)
static inline uint64_t msri_hash(uint64_t hash, uint64_t value) {
  return (hash ^ value) * UINT64_C(0x100000001b3);
}
uint64_t msri_hash_words(uint64_t hash, const void *words, size_t n);

/* Memory for implicit steps of a state whose plan has none, in care->memory. MSR_ENOMEM. */
msr_status msri_state_make_room(msr_state *state, msr_error *err);

/* Copies q and v to kept [4n], and back. */
void msri_state_keep(const msr_state *state, double *kept);
void msri_state_put_back(msr_state *state, const double *kept);

/* Tells that q was changed otherwise than by a drift: all masses are tested against supports. */
void msri_state_disarm(msr_state *state);

/* Tells that q or v were changed from outside. */
void msri_state_touched(msr_state *state);

#endif
