/* energy.c - how well each integrator keeps the energy of a soft block that bounces on the floor.
 * Introduces msr_integrators, the table of all methods, and msr_state_energy. */
#include <msr.h>

#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 40, PIXELS = SIDE * SIDE };

static msr_error err;

static void check(msr_status status) {
  if (status == MSR_OK) return;
  fprintf(stderr, "energy: %s\n", err.message);
  exit(EXIT_FAILURE);
}

/* The assignment's parameters, 20 s: 20 x 10 red pixels, ten above a black floor. */
static msr_scene *block(void) {
  const msr_conf conf = {0.005, 9.8, 0.1, 1500, 4000, 1};
  msr_picture *picture;
  msr_scene *scene;
  check(msr_picture_create(SIDE, SIDE, &picture, &err));
  for (size_t i = 0; i < PIXELS; i++) {
    const size_t x = i % SIDE, y = i / SIDE;
    const bool floor = y >= 38, mass = y >= 18 && y < 28 && x >= 10 && x < 30;
    if (floor) picture->rgb[3 * i] = 0;
    if (floor || mass) picture->rgb[3 * i + 1] = picture->rgb[3 * i + 2] = 0;
  }
  check(msr_scene_from_picture("a block", picture, &conf, NULL, &scene, &err));
  msr_picture_free(picture);
  return scene;
}

int main(void) {
  msr_scene *scene = block();
  for (size_t i = 0; msr_integrators[i]; i++) {
    msr_plan *plan;
    msr_state *state;
    check(msr_plan_create(
        scene, &(msr_plan_options){.integrator = msr_integrators[i], .substeps = 0}, &plan, &err));
    check(msr_state_create(plan, &state, &err));
    const double start = msr_state_energy(state).total;
    double least = 1, most = 1;
    msr_status status = MSR_OK;
    for (int k = 0; k < 400 && status == MSR_OK; k++) {
      status = msr_state_step(state, 10, &err);
      const double share = msr_state_energy(state).total / start;
      if (share < least) least = share;
      if (share > most) most = share;
    }
    printf("%-17s%+8.3g %% .. %+.3g %%%s%s\n", msr_integrators[i]->name, 100 * (least - 1),
           100 * (most - 1),
           status == MSR_OK ? "" : "; stopped: ", status == MSR_OK ? "" : msr_status_text(status));
    msr_state_free(state);
    msr_plan_free(plan);
  }
  msr_scene_free(scene);
}
