/* run.c - a run of a scene for callgrind to count: what it says on standard output is the same
 * whenever the trajectory is.
 *   run PICTURE CONF STEPS [WITHOUT]
 * STEPS of Verlet, from a smooth deformation that moves. WITHOUT is `gravity`, `supports` or
 * `springs-only`, which is without both; anything else changes nothing. */
#include "msr.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static msr_error err;

static void must(msr_status status) {
  if (status == MSR_OK) return;
  fprintf(stderr, "%s\n", err.message);
  exit(1);
}

static void whiten_supports(msr_picture *picture) {
  for (unsigned char *p = picture->rgb; p < picture->rgb + 3 * picture->width * picture->height;
       p += 3) {
    if (p[0] == 0 && p[1] == 0 && p[2] == 0) memset(p, 255, 3);
  }
}

static msr_plan *plan_of(char **argv, uint64_t steps, const char *without) {
  const bool bare = strcmp(without, "springs-only") == 0;
  const msr_plan_options options = {.integrator = &msr_integrator_verlet, .substeps = 1};
  msr_picture *picture;
  msr_conf conf;
  msr_scene *scene;
  msr_plan *plan;
  must(msr_picture_read(argv[1], &picture, NULL, &err));
  must(msr_conf_read(argv[2], &conf, &err));
  if (bare || strcmp(without, "supports") == 0) whiten_supports(picture);
  if (bare || strcmp(without, "gravity") == 0) conf.gravity = 0;
  conf.dt = 0.001;
  conf.iterations = steps;
  conf.images = 1;
  must(msr_scene_from_picture(argv[1], picture, &conf, NULL, &scene, &err));
  must(msr_plan_create(scene, &options, &plan, &err));
  msr_picture_free(picture);
  msr_scene_free(scene);
  return plan;
}

static void deform(msr_state *state, size_t n) {
  const msr_arrays a = msr_state_edit(state);
  for (size_t i = 0; i < n; i++) {
    a.vx[i] = sin(0.05 * a.y[i]);
    a.vy[i] = cos(0.03 * a.x[i]) - 1;
  }
}

int main(int argc, char **argv) {
  if (argc < 4) return 2;
  msr_plan *plan = plan_of(argv, strtoull(argv[3], NULL, 10), argc > 4 ? argv[4] : "");
  const msr_plan_figures figures = msr_plan_describe(plan);
  msr_state *state;
  must(msr_state_create(plan, &state, &err));
  deform(state, figures.masses);
  must(msr_run(state, NULL, &err));
  printf("%zu masses, %zu springs, hash %016" PRIx64 "\n", figures.masses, figures.springs,
         msr_state_hash(state));
  msr_state_free(state);
  msr_plan_free(plan);
  return 0;
}
