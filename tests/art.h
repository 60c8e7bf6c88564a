/* art.h - what all tests of scenes share: what must succeed, scenes drawn in letters, and worlds,
 * which are a plan and a state of it. */
#ifndef TESTS_ART_H
#define TESTS_ART_H

#include "msr.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define LENGTH(array) (sizeof(array) / sizeof *(array))
#define NO_NUMBER     ((double)NAN)
#define INFINITE      ((double)INFINITY)

static msr_error why; /* for every call whose status goes to must() */

static inline void must(msr_status status) {
  if (status != MSR_OK) fail_msg("%s: %s", msr_status_text(status), why.message);
}

/* ---- Messages: what follows a word, and the number there */

static inline const char *text_after(const char *message, const char *word) {
  const char *at = strstr(message, word);
  if (!at) fail_msg("no '%s' in '%s'", word, message);
  return at + strlen(word);
}

static inline double number_after(const char *message, const char *word) {
  return strtod(text_after(message, word), NULL);
}

/* ---- Pictures in letters: each row ends in a line feed */

static const struct colour {
  char letter;
  unsigned char rgb[3];
} colours[] = {{'.', {255, 255, 255}}, {'#', {0, 0, 0}},     {'o', {255, 0, 0}}, {'g', {0, 160, 0}},
               {'b', {0, 0, 255}},     {'y', {200, 200, 0}}, {'d', {0, 0, 64}}};

static inline const unsigned char *rgb_of(char letter) {
  for (size_t i = 0; i < LENGTH(colours); i++)
    if (colours[i].letter == letter) return colours[i].rgb;
  fail_msg("no colour is called '%c'", letter);
  return NULL;
}

static inline msr_picture *paint(const char *art) {
  const size_t width = strcspn(art, "\n"), height = strlen(art) / (width + 1);
  msr_picture *picture;
  must(msr_picture_create(width, height, &picture, &why));
  for (size_t p = 0; p < width * height; p++)
    memcpy(picture->rgb + 3 * p, rgb_of(art[p + p / width]), 3);
  return picture;
}

/* ---- Scenes */

/* The assignment's example, and the same without weight. */
static const msr_conf example = {0.005, 9.8, 0.1, 1500, 20000, 800};
static const msr_conf weightless = {0.005, 0, 0.1, 1500, 20000, 800};

/* A block above two pegs and a floor. */
static const char pegs[] = "....................\n"
                           "...ooooooooo........\n"
                           "...ooooooooo........\n"
                           "...ooooooooo........\n"
                           "....................\n"
                           "....................\n"
                           "....................\n"
                           "......#.......#.....\n"
                           "....................\n"
                           "####################\n";

/* Frees the picture; options may be NULL. */
static inline msr_scene *scene_from(msr_picture *picture, const msr_conf *conf,
                                    const msr_scene_options *options) {
  msr_scene *scene;
  must(msr_scene_from_picture("art", picture, conf, options, &scene, &why));
  msr_picture_free(picture);
  return scene;
}

static inline msr_scene *scene_of(const char *art, const msr_conf *conf,
                                  const msr_scene_options *options) {
  return scene_from(paint(art), conf, options);
}

static inline msr_scene *empty_scene(double dt) {
  msr_scene *scene;
  must(msr_scene_create(&scene, &why));
  must(msr_scene_set_times(scene, dt, 1, 1, &why));
  return scene;
}

static inline void add_mass(msr_scene *scene, double x, double y, double vx, double vy, double m) {
  must(msr_scene_add_mass(scene, &(msr_mass){x, y, vx, vy, m, {200, 0, 0}}, NULL, &why));
}

static inline void add_force(msr_scene *scene, const msr_force *force, const void *params) {
  must(msr_scene_add_force(scene, force, params, &why));
}

/* ---- A force that does nothing: beside it steps are taken by whole vectors, not row by row */

static inline msr_status add_nothing(const void *self, void *scratch, const msr_view *s, double *fx,
                                     double *fy) {
  (void)self, (void)scratch, (void)s, (void)fx, (void)fy;
  return MSR_OK;
}

static inline double no_energy(const void *self, const msr_view *s) {
  (void)self, (void)s;
  return 0;
}

static inline msr_status add_nothing_between(const void *self, void *scratch, const msr_view *s,
                                             const msr_view *to, double *fx, double *fy) {
  (void)to;
  return add_nothing(self, scratch, s, fx, fy);
}

static const msr_force nothing = {.name = "nothing",
                                  .summary = "F = 0",
                                  .conservative = true,
                                  .ignores_start = true,
                                  .add = add_nothing,
                                  .energy = no_energy,
                                  .between = add_nothing_between};

/* ---- Worlds */

typedef struct world {
  msr_plan *plan;
  msr_state *state;
} world;

/* Frees the scene. */
static inline world open_world_with(msr_scene *scene, const msr_plan_options *options) {
  world w;
  must(msr_plan_create(scene, options, &w.plan, &why));
  must(msr_state_create(w.plan, &w.state, &why));
  msr_scene_free(scene);
  return w;
}

static inline world open_world(msr_scene *scene, const msr_integrator *integrator,
                               uint64_t substeps) {
  return open_world_with(scene,
                         &(msr_plan_options){.integrator = integrator, .substeps = substeps});
}

static inline void close_world(world w) {
  msr_state_free(w.state);
  msr_plan_free(w.plan);
}

static inline void advance(const world *w, uint64_t iterations) {
  must(msr_state_step(w->state, iterations, &why));
}

#endif
