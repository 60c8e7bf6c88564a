/* library.c - libmsr as the command runs it with no option: all that a plan can choose is left to
 * it. */
#include "beside.h"

#include "msr.h"

#include <stdio.h>
#include <string.h>

typedef struct library_run {
  size_t n;
  msr_plan *plan;
  msr_state *state;
} library_run;

static msr_error why;

static void must(msr_status status) {
  if (status != MSR_OK) bench_fail("%s", why.message);
}

static void set_pixel(msr_picture *picture, size_t column, size_t row, const char *rgb) {
  memcpy(picture->rgb + 3 * (row * picture->width + column), rgb, 3);
}

static msr_scene *paint(const problem *p) {
  msr_picture *picture;
  must(msr_picture_create(p->width, p->height, &picture, &why));
  for (size_t row = 0; row < p->height; row++)
    for (size_t c = 0; c < p->width; c++)
      if (p->black[(p->height - 1 - row) * p->width + c]) set_pixel(picture, c, row, "\0\0\0");
  for (size_t i = 0; p->drawn && i < p->n; i++)
    set_pixel(picture, (size_t)p->x[i], p->height - 1 - (size_t)p->y[i], "\377\0\0");
  const msr_conf conf = {.dt = p->dt,
                         .gravity = p->gravity,
                         .mass = p->mass,
                         .stiffness = p->stiffness,
                         .iterations = p->iterations,
                         .images = 1};
  msr_scene *scene;
  must(msr_scene_from_picture(p->name, picture, &conf, NULL, &scene, &why));
  msr_picture_free(picture);
  return scene;
}

static msr_scene *scene_of(const problem *p) {
  msr_scene *scene = paint(p);
  must(msr_scene_set_contact(scene, p->restitution, 0, &why));
  must(msr_scene_set_collisions(scene, p->diameter, &why));
  for (size_t i = 0; !p->drawn && i < p->n; i++) {
    const msr_mass mass = {p->x[i], p->y[i], p->vx[i], p->vy[i], p->m[i], {255, 0, 0}};
    must(msr_scene_add_mass(scene, &mass, NULL, &why));
  }
  for (size_t i = 0; !p->drawn && i < p->n_bonds; i++) {
    const bond *l = &p->bonds[i];
    must(msr_scene_add_spring(scene, l->i, l->j, l->k, l->L, &why));
  }
  const msr_damping damping = {p->damping};
  if (p->damping > 0) must(msr_scene_add_force(scene, &msr_force_damping, &damping, &why));
  const msr_wind wind = {.c = p->air, .speed = p->wind};
  if (p->air > 0) must(msr_scene_add_force(scene, &msr_force_wind, &wind, &why));
  return scene;
}

static void *open_library(const problem *p) {
  library_run *r = need(1, sizeof *r);
  r->n = p->n;
  msr_scene *scene = scene_of(p);
  must(msr_plan_create(scene, NULL, &r->plan, &why));
  must(msr_state_create(r->plan, &r->state, &why));
  msr_scene_free(scene);
  return r;
}

uint64_t library_substeps(const problem *p) {
  msr_scene *scene = scene_of(p);
  msr_plan *plan;
  must(msr_plan_create(scene, NULL, &plan, &why));
  const uint64_t substeps = msr_plan_describe(plan).substeps;
  msr_plan_free(plan);
  msr_scene_free(scene);
  return substeps;
}

static bool advance_library(void *self, uint64_t iterations, char *text) {
  const library_run *r = self;
  msr_error err;
  if (msr_state_step(r->state, iterations, &err) == MSR_OK) return true;
  snprintf(text, 128, "%.127s", err.message);
  return false;
}

static void read_library(void *self, double *x, double *y, double *vx, double *vy) {
  const library_run *r = self;
  const msr_view view = msr_state_view(r->state);
  const double *from[] = {view.x, view.y, view.vx, view.vy};
  double *to[] = {x, y, vx, vy};
  for (size_t a = 0; a < 4; a++) memcpy(to[a], from[a], r->n * sizeof *x);
}

const solver solver_library = {NULL, open_library, advance_library, read_library};
