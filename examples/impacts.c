/* impacts.c - a block falls on a row of round pegs, elastic and undamped: what 40 s of impacts, by
 * either rule and in smaller and smaller steps, do to its energy. Introduces msr_impacts. */
#include <msr.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static msr_error err;

static void check(msr_status status) {
  if (status == MSR_OK) return;
  fprintf(stderr, "impacts: %s\n", err.message);
  exit(EXIT_FAILURE);
}

/* The assignment's parameters; 50 x 20 red pixels fall by 18. */
static msr_scene *pegs(double dt) {
  const msr_conf conf = {dt, 9.8, 0.1, 1500, (uint64_t)(40 / dt + 0.5), 1};
  msr_picture *picture;
  msr_scene *scene;
  check(msr_picture_create(120, 90, &picture, &err));
  for (size_t i = 0; i < 120 * 90; i++) {
    const int x = (int)(i % 120), y = (int)(i / 120), dx = x % 18 - 6, dy = y - 44;
    if (dx * dx + dy * dy <= 36 || y > 86) memset(picture->rgb + 3 * i, 0, 3);
    if (x >= 35 && x < 85 && y < 20) memset(picture->rgb + 3 * i + 1, 0, 2);
  }
  check(msr_scene_from_picture("pegs", picture, &conf, NULL, &scene, &err));
  msr_picture_free(picture);
  return scene;
}

static void run(const char *rule, msr_impacts impacts, const msr_scene *scene) {
  const msr_plan_options options = {.substeps = 1, .impacts = impacts};
  msr_plan *plan;
  msr_state *state;
  check(msr_plan_create(scene, &options, &plan, &err));
  check(msr_state_create(plan, &state, &err));
  const double start = msr_state_energy(state).total;
  double least = 0, most = 0;
  for (uint64_t n = 0; n < msr_plan_describe(plan).iterations; n += 40) {
    check(msr_state_step(state, 40, &err));
    const double gain = msr_state_energy(state).total / start - 1;
    if (gain < least) least = gain;
    if (gain > most) most = gain;
  }
  printf("DT %-8g %-7s %+.3f %% .. %+.3f %%\n", msr_plan_describe(plan).dt, rule, 100 * least,
         100 * most);
  msr_state_free(state);
  msr_plan_free(plan);
}

int main(void) {
  for (int n = 1; n <= 4; n *= 2) {
    msr_scene *scene = pegs(0.005 / n);
    run("kept", MSR_IMPACTS_KEPT, scene);
    run("located", MSR_IMPACTS_LOCATED, scene);
    msr_scene_free(scene);
  }
}
