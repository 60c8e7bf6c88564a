/* plan.h - a scene compiled: what the state, the evaluation and the run read. */
#ifndef MSRI_PLAN_H
#define MSRI_PLAN_H

#include "base/base.h"
#include "base/notes.h"
#include "contacts/contact.h"
#include "contacts/discs.h"
#include "scene/scene.h"
#include "solvers/graph.h"

/* A force that the scene calls for, compiled. */
typedef struct msri_term {
  const msr_force *force;
  void *params;     /* the plan's copy */
  const void *self; /* what prepare made, or params */
  void *made;       /* what prepare made, for release */
  size_t scratch;   /* offset into the state's scratch */
} msri_term;

/* The springs, with the memory that their runs point into. */
typedef struct msri_mesh {
  msr_springs springs;
  msr_run_of_springs *run;
  msr_anchor *anchor;
  double *k, *L; /* [n_added]: springs that a program added */
  size_t n_added;
  double lattice_k;    /* of every spring of the picture */
  double lattice_L[2]; /* along a side, along a diagonal */
  size_t run_capacity, anchor_capacity;
} msri_mesh;

struct msr_plan {
  msr_plan_figures figures;
  size_t n_picture;
  msr_picture *picture; /* NULL: none */
  msr_mass *mass;       /* [figures.masses - n_picture]: those added by a program */
  double uniform_mass;
  double *m; /* [figures.masses]; NULL: all are uniform_mass */
  msri_mesh mesh;
  msri_term *term; /* [n_terms], in the order in which they act */
  size_t n_terms;
  size_t scratch_bytes; /* of all terms */
  bool midpoint;        /* a force on v has no flow of its own: states have room for one */
  bool driven;          /* a force drives: states follow its work */
  bool middle;          /* a force without between() acts in the middle of a step: likewise */
  msri_graph *graph;    /* of the springs, if the integrator is implicit */
  msri_contact contact; /* drift NULL: nothing stands in the way */
  msri_discs *discs;    /* NULL: masses don't collide with each other */
  msr_effect *effect;   /* [n_effects]; the first n_terms are the terms */
  char (*reason)[MSR_MESSAGE_SIZE]; /* of the effects */
  size_t n_effects;
  msri_notes notes;
};

/* The springs of a scene. On failure nothing is left. MSR_ENOMEM. */
msr_status msri_mesh_create(const msr_scene *scene, msri_mesh *mesh, msr_error *err);
void msri_mesh_clear(msri_mesh *mesh);

/* Can the force bring in energy that no potential tells of? */
static inline bool msri_force_drives(const msr_force *force) {
  return !force->dissipative && (!force->conservative || force->uses_time);
}

/* May anything ever be in the way? */
static inline bool msri_plan_meets(const msr_plan *plan) {
  return plan->contact.drift || plan->discs;
}

/* Do steps end at impacts, of methods that don't see to them as they drift? */
static inline bool msri_plan_ends_at_impacts(const msr_plan *plan) {
  return plan->contact.meet && !plan->discs;
}

/* Does the library see to contacts after each step? Where the integrator doesn't, or where it would
 * do so after each of its own, but impacts are better located by its dense steps. */
static inline bool msri_plan_bounces(const msr_plan *plan) {
  const msr_integrator *integrator = plan->figures.integrator;
  if (!msri_plan_meets(plan)) return false;
  return !integrator->bounces || (integrator->adaptive && msri_plan_ends_at_impacts(plan));
}

/* Does what met something need the acceleration at the end of the step? Implicit methods, whose
 * steps may be too long for what that would say, do without. */
static inline bool msri_plan_settles(const msr_plan *plan) {
  return plan->contact.meet && !plan->figures.integrator->implicit;
}

/* The time after so many iterations and substeps: made of whole numbers, never summed, so that
 * nothing depends on how a run is cut in pieces. */
static inline double msri_plan_time(const msr_plan_figures *f, uint64_t iteration,
                                    uint64_t substep) {
  if (substep == f->substeps) return (double)(iteration + 1) * f->dt;
  return (double)iteration * f->dt + (double)substep * f->h;
}

/* Start of every mass. x, y, vx, vy [masses]. */
void msri_plan_start(const msr_plan *plan, double *x, double *y, double *vx, double *vy);

/* Colours of all masses, rgb [masses][3]. */
void msri_plan_colours(const msr_plan *plan, unsigned char *rgb);

/* A view of the plan's masses with the arrays q = x[n], y[n] and v = vx[n], vy[n] (may be NULL). */
msr_view msri_plan_view(const msr_plan *plan, double t, const double *q, const double *v);

/* "pixel (12,5)" or "mass 7": what a user calls a mass. Returns text. */
const char *msri_plan_mass_name(const msr_plan *plan, size_t mass, char *text, size_t size);

/* Fills the stable step and the substeps in the figures, and what the user should know of them. */
msr_status msri_plan_choose_step(msr_plan *plan, const msr_view *start, uint64_t substeps,
                                 msr_error *err);

#endif
