/* first_scene.c - a scene that is painted in memory falls, and its frames go to first_scene/.
 * Introduces msr_run: picture + conf -> scene -> plan -> state -> frames. */
#include <msr.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 120, HEIGHT = 90 };

static msr_error err;

static void check(msr_status status) {
  if (status == MSR_OK) return;
  fprintf(stderr, "first_scene: %s\n", err.message);
  exit(EXIT_FAILURE);
}

static void paint(msr_picture *p, size_t left, size_t top, size_t width, size_t height,
                  const unsigned char *rgb) {
  for (size_t row = top; row < top + height; row++)
    for (size_t column = left; column < left + width; column++)
      memcpy(p->rgb + 3 * (row * p->width + column), rgb, 3);
}

int main(void) {
  static const unsigned char red[3] = {255, 0, 0}, black[3] = {0, 0, 0};
  msr_picture *picture;
  check(msr_picture_create(WIDTH, HEIGHT, &picture, &err));
  paint(picture, 40, 10, 40, 20, red);
  paint(picture, 54, 50, 12, 12, black);
  paint(picture, 0, HEIGHT - 4, WIDTH, 4, black);

  const msr_conf conf = {
      .dt = 0.005, .gravity = 60, .mass = 0.1, .stiffness = 6000, .iterations = 800, .images = 50};
  const msr_scene_options options = {.neighbours = 8};
  msr_scene *scene;
  msr_plan *plan;
  msr_state *state;
  msr_sink frames;
  check(msr_scene_from_picture("first scene", picture, &conf, &options, &scene, &err));
  check(msr_plan_create(scene, NULL, &plan, &err));
  check(msr_state_create(plan, &state, &err));
  check(msr_frames_open(plan, "first_scene", NULL, true, &frames, &err));

  const double before = msr_state_energy(state).total;
  check(msr_run(state, &(msr_run_options){.sinks = &frames, .n_sinks = 1}, &err));
  check(msr_sink_close(&frames, &err));
  printf("50 frames in first_scene/; the total energy is %.4f of what it was\n",
         msr_state_energy(state).total / before);

  msr_state_free(state);
  msr_plan_free(plan);
  msr_scene_free(scene);
  msr_picture_free(picture);
}
