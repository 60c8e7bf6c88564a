/* library.c - libmsr: a scene, a plan with Verlet and one step per DT, a state that steps; guard
 * and all. */
#include "scene.h"

#include <stdlib.h>

#include <string.h>

static msr_error why;

void must(msr_status status) {
  if (status != MSR_OK) bench_fail("libmsr: %s", why.message);
}

msr_error *reason(void) { return &why; }

/* ---- Scenes */

static msr_scene *scene_drawn(const work *w, const msr_conf *conf) {
  msr_picture *picture;
  msr_scene *scene;
  must(msr_picture_create(w->width, w->height, &picture, &why));
  for (size_t p = 0; p < w->width * w->height; p++)
    if (w->there[p]) memcpy(picture->rgb + 3 * p, "\377\0\0", 3);
  must(msr_scene_from_picture(w->name, picture, conf, NULL, &scene, &why));
  msr_picture_free(picture);
  return scene;
}

static msr_scene *scene_listed(const work *w, const msr_conf *conf) {
  msr_scene *scene;
  must(msr_scene_create(&scene, &why));
  must(msr_scene_set_times(scene, conf->dt, conf->iterations, conf->images, &why));
  for (size_t i = 0; i < w->n; i++) {
    const msr_mass m = {w->x[i], w->y[i], 0, 0, mass, {255, 0, 0}};
    must(msr_scene_add_mass(scene, &m, NULL, &why));
  }
  for (size_t s = 0; s < w->n_springs; s++)
    must(msr_scene_add_spring(scene, w->i[s], w->j[s], stiffness, rest, &why));
  return scene;
}

msr_state *state_of(const work *w, double dt, uint64_t images, const msr_plan_options *options,
                    msr_plan **plan) {
  const msr_conf conf = {.dt = dt,
                         .mass = mass,
                         .stiffness = stiffness,
                         .iterations = images > 1 ? images : (uint64_t)1 << 53,
                         .images = images};
  msr_scene *scene = w->drawn ? scene_drawn(w, &conf) : scene_listed(w, &conf);
  msr_state *state;
  must(msr_plan_create(scene, options, plan, &why));
  msr_scene_free(scene);
  must(msr_state_create(*plan, &state, &why));
  const msr_arrays a = msr_state_edit(state);
  memcpy(a.x, w->x, w->n * sizeof *w->x);
  memcpy(a.y, w->y, w->n * sizeof *w->y);
  return state;
}

msr_plan_options verlet_with(int threads) {
  return (msr_plan_options){
      .integrator = &msr_integrator_verlet, .substeps = 1, .threads = (unsigned)threads};
}

/* ---- As a contestant */

typedef struct library_run {
  size_t n;
  msr_plan *plan;
  msr_state *state;
} library_run;

static entry open_library(const contestant *c, const work *w, int threads) {
  (void)c;
  library_run *r = need(1, sizeof *r);
  const msr_plan_options options = verlet_with(threads);
  r->n = w->n;
  r->state = state_of(w, step, 1, &options, &r->plan);
  const msr_plan_figures f = msr_plan_describe(r->plan);
  if (f.masses != w->n || f.springs != w->n_springs) bench_fail("libmsr has another scene");
  return (entry){r, w->n_springs, (double)(f.plan_bytes + f.state_bytes), true, NULL};
}

static double run_library(void *self, size_t steps) {
  const library_run *r = self;
  const double begin = seconds_now();
  must(msr_state_step(r->state, steps, &why));
  return seconds_now() - begin;
}

static void read_library(void *self, double *x, double *y) {
  const library_run *r = self;
  const msr_view s = msr_state_view(r->state);
  memcpy(x, s.x, r->n * sizeof *x);
  memcpy(y, s.y, r->n * sizeof *y);
}

static void close_library(void *self) {
  library_run *r = self;
  msr_state_free(r->state);
  msr_plan_free(r->plan);
  free(r);
}

const contestant library = {
    .name = "libmsr",
    .grain = 16,
    .threads = MOST_THREADS,
    .open = open_library,
    .run = run_library,
    .read = read_library,
    .close = close_library,
};
