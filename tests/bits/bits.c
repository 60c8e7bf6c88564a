/* bits.c - the hashes of a scene with every kind of effect, by each integrator that is stable, and
 * with located impacts; and of the picture with what steps row by row, by several threads. */
#include "msr.h"

#include "../processors.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

static msr_error err;

static void check(msr_status status) {
  if (status == MSR_OK) return;
  fprintf(stderr, "%s\n", err.message);
  exit(EXIT_FAILURE);
}

/* What meets nothing tells little. */
static void check_contacts(const msr_state *state) {
  if (msr_state_contacts(state) > 0) return;
  fputs("no support was met\n", stderr);
  exit(EXIT_FAILURE);
}

static msr_scene *load(const char *picture, const char *conf) {
  const msr_scene_options options = {.neighbours = 8, .attach = true, .closed_border = true};
  const msr_wind wind = {.c = 0.01, .speed = 20, .gust = 10, .seed = 7};
  msr_scene *scene;
  check(msr_scene_load(picture, conf, &options, &scene, &err));
  check(msr_scene_add_force(scene, &msr_force_damping, &(msr_damping){0.3}, &err));
  check(msr_scene_add_force(scene, &msr_force_wind, &wind, &err));
  return scene;
}

/* Gravity and gusts; supports, or none. */
static msr_scene *plain(const char *picture, const char *conf, bool supports) {
  const msr_wind wind = {.c = 0.01, .speed = 20, .gust = 10, .seed = 7};
  msr_picture *image;
  msr_conf figures;
  msr_scene *scene;
  check(msr_picture_read(picture, &image, NULL, &err));
  check(msr_conf_read(conf, &figures, &err));
  for (size_t i = 0; i < image->width * image->height && !supports; i++) {
    unsigned char *rgb = image->rgb + 3 * i;
    if (rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0) rgb[0] = rgb[1] = rgb[2] = 255;
  }
  check(msr_scene_from_picture(picture, image, &figures, NULL, &scene, &err));
  check(msr_scene_add_force(scene, &msr_force_wind, &wind, &err));
  msr_picture_free(image);
  return scene;
}

static void print_swept(const msr_scene *scene, const char *name, unsigned threads) {
  msr_plan *plan;
  msr_state *state;
  check(msr_plan_create(
      scene, &(msr_plan_options){.integrator = &msr_integrator_verlet, .threads = threads}, &plan,
      &err));
  check(msr_state_create(plan, &state, &err));
  const msr_arrays s = msr_state_edit(state);
  for (size_t i = 0; i < msr_plan_describe(plan).masses; i++) s.vy[i] = -300;
  check(msr_state_step(state, 50, &err));
  printf("%s %016" PRIx64 "\n", name, msr_state_hash(state));
  msr_state_free(state);
  msr_plan_free(plan);
}

static void print_hash(const msr_scene *scene, const msr_integrator *integrator,
                       msr_impacts impacts) {
  msr_plan *plan;
  msr_state *state;
  check(msr_plan_create(scene, &(msr_plan_options){.integrator = integrator, .impacts = impacts},
                        &plan, &err));
  check(msr_state_create(plan, &state, &err));
  const msr_arrays s = msr_state_edit(state);
  for (size_t i = 0; i < msr_plan_describe(plan).masses; i++)
    s.vy[i] = -300; /* onto the supports */
  check(msr_state_step(state, 20, &err));
  check_contacts(state);
  printf("%s%s %016" PRIx64 "\n", integrator->name, impacts == MSR_IMPACTS_KEPT ? "" : ",located",
         msr_state_hash(state));
  msr_state_free(state);
  msr_plan_free(plan);
}

int main(int argc, char **argv) {
  if (argc != 3) return EXIT_FAILURE;
  msr_scene *scene = load(argv[1], argv[2]);
  for (const msr_integrator *const *i = msr_integrators; *i; i++)
    if ((*i)->stability > 0) print_hash(scene, *i, MSR_IMPACTS_KEPT);
  print_hash(scene, &msr_integrator_verlet, MSR_IMPACTS_LOCATED);
  print_hash(scene, &msr_integrator_pefrl, MSR_IMPACTS_LOCATED);
  msr_scene_free(scene);
  for (int supports = 0; supports < 2; supports++) {
    scene = plain(argv[1], argv[2], supports);
    for (unsigned threads = 1; threads < 4; threads++)
      print_swept(scene, supports ? "swept,supports" : "swept", threads);
    msr_scene_free(scene);
  }
}
