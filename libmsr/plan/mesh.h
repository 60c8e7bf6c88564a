/* mesh.h - the springs of a scene as runs of constant offset, which the plan keeps. */
#ifndef MSRI_PLAN_MESH_H
#define MSRI_PLAN_MESH_H

#include "base/base.h"
#include "scene/scene.h"

/* Springs that a program added are sorted by so many masses where they begin, in turn. */
enum { MSRI_MESH_GROUP = 1024 };

/* The springs, with the memory that their runs point into. */
typedef struct msri_mesh {
  msr_springs springs;
  msr_run_of_springs *run;
  msr_anchor *anchor;
  double *values;      /* [n_values] k, then as many L: of springs that a program added */
  size_t n_values;     /* a run whose springs are all alike needs one, or that of the run before */
  size_t n_added;      /* springs that a program added */
  double lattice_k;    /* of every spring of the picture */
  double lattice_L[2]; /* along a side, along a diagonal */
  size_t run_capacity, anchor_capacity;
} msri_mesh;

/* The springs of a scene. On failure nothing is left. MSR_ENOMEM. */
msr_status msri_mesh_create(const msr_scene *scene, msri_mesh *mesh, msr_error *err);
void msri_mesh_clear(msri_mesh *mesh);

/* Bytes of memory that it points to. */
size_t msri_mesh_bytes(const msri_mesh *mesh);

/* Appends a run, to the last one if it goes on there. MSR_ENOMEM. */
msr_status msri_mesh_add_run(msri_mesh *mesh, msr_run_of_springs run, msr_error *err);

/* Appends the springs that a program added. MSR_ENOMEM. */
msr_status msri_mesh_tie_added(msri_mesh *mesh, const msr_scene *scene, msr_error *err);

#endif
