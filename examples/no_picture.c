/* no_picture.c - a scene without a picture: a chain that hangs from a point, with a weight on it.
 * Introduces msr_scene_add_anchor (and _mass, _spring). It swings until the drag of the air has
 * taken its energy; then each spring must be longer by the weight below it over its stiffness. */
#include <msr.h>

#include <stdio.h>
#include <stdlib.h>

enum { LINKS = 12 };

static const double k = 400, L = 5, g = 10, m = 0.1, weight = 1;

static msr_error err;

static void check(msr_status status) {
  if (status == MSR_OK) return;
  fprintf(stderr, "no_picture: %s\n", err.message);
  exit(EXIT_FAILURE);
}

/* A chain that starts level, held at its left end. */
static void build(msr_scene *scene) {
  for (size_t i = 0; i < LINKS; i++) {
    const msr_mass mass = {.x = (double)(i + 1) * L, .m = i == LINKS - 1 ? weight : m};
    check(msr_scene_add_mass(scene, &mass, NULL, &err));
    if (i > 0) check(msr_scene_add_spring(scene, i - 1, i, k, L, &err));
  }
  check(msr_scene_add_anchor(scene, &(msr_anchor){.i = 0, .x = 0, .y = 0, .k = k, .L = L}, &err));
  check(msr_scene_add_force(scene, &msr_force_gravity, &(msr_gravity){g}, &err));
  check(msr_scene_add_force(scene, &msr_force_drag, &(msr_drag){0.1}, &err));
  check(msr_scene_set_times(scene, 0.01, 20000, 5, &err));
}

int main(void) {
  msr_scene *scene;
  msr_plan *plan;
  msr_state *state;
  check(msr_scene_create(&scene, &err));
  build(scene);
  check(msr_plan_create(scene, NULL, &plan, &err));
  check(msr_state_create(plan, &state, &err));
  check(msr_run(state, &(msr_run_options){0}, &err));

  const msr_view now = msr_state_view(state);
  double above = 0;
  for (size_t i = 0; i < LINKS; i++) {
    const double below = weight + m * (double)(LINKS - 1 - i);
    printf("link %2zu: %.6f px, L + m g / k = %.6f px\n", i, above - now.y[i], L + below * g / k);
    above = now.y[i];
  }
  msr_state_free(state);
  msr_plan_free(plan);
  msr_scene_free(scene);
}
