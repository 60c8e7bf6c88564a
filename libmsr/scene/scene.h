/* scene.h - what a scene holds: read by the plan, which compiles it. */
#ifndef MSRI_SCENE_H
#define MSRI_SCENE_H

#include "base/base.h"
#include "base/notes.h"
#include "scene/grid.h"

typedef struct msri_scene_spring {
  size_t i, j; /* i < j */
  double k, L;
} msri_scene_spring;

typedef struct msri_scene_force {
  const msr_force *force;
  void *params; /* [force->params_size], owned */
} msri_scene_force;

/* The picture's masses and springs stay implicit: only what a program adds is listed. */
struct msr_scene {
  msr_conf conf;
  msr_scene_options options;
  double restitution, friction;
  double diameter;            /* of masses that collide; 0: they don't */
  msri_grid *grid;            /* NULL: no picture */
  const msr_picture *picture; /* the grid's; NULL: none */
  size_t n_picture;           /* masses of the picture; the program's follow */
  size_t n_supports;          /* black pixels */
  msr_mass *mass;             /* [n_masses] */
  msri_scene_spring *spring;  /* [n_springs] */
  msr_anchor *anchor;         /* [n_anchors] */
  msri_scene_force *force;    /* [n_forces] */
  size_t n_masses, n_springs, n_anchors, n_forces;
  size_t mass_capacity, spring_capacity, anchor_capacity, force_capacity;
  msri_notes notes;
};

#endif
