/* own_sink.c - a sink of one's own: a ball falls and bounces on the terminal, frame after frame.
 * Introduces msr_sink, which takes the frames of a run; msr_renderer_draw makes its pictures. */
#include <msr.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 16, HEIGHT = 8, PIXELS = WIDTH * HEIGHT, FLOOR = PIXELS - WIDTH };
static const char ball[] = "      ###            #####            ###"; /* three rows */
static msr_error err;

static void check(msr_status status) {
  if (status == MSR_OK) return;
  fprintf(stderr, "own_sink: %s\n", err.message);
  exit(EXIT_FAILURE);
}

static msr_scene *draw(void) {
  const msr_conf conf = {0.01, 20, 1, 3000, 120, 6};
  msr_picture *picture;
  msr_scene *scene;
  check(msr_picture_create(WIDTH, HEIGHT, &picture, &err));
  for (size_t i = FLOOR; i < PIXELS; i++) memset(picture->rgb + 3 * i, 0, 3);
  for (size_t i = 0; i < sizeof ball - 1; i++)
    if (ball[i] == '#') memset(picture->rgb + 3 * i, 0, 2); /* blue */
  check(msr_scene_from_picture("ball", picture, &conf, &(msr_scene_options){.neighbours = 8},
                               &scene, &err));
  msr_picture_free(picture);
  return scene;
}

/* Prints a frame: black, blue and white pixels as characters. */
static msr_status print(void *renderer, const msr_state *state, uint64_t frame, msr_error *e) {
  const unsigned char *rgb = msr_renderer_draw(renderer, state)->rgb;
  (void)e;
  printf("frame %d, t = %g s\n", (int)frame, msr_state_view(state).t);
  for (size_t i = 0; i < PIXELS; i++) {
    const bool air = rgb[3 * i] != 0, floor = rgb[3 * i + 2] == 0;
    putchar(air ? ' ' : floor ? '=' : '#');
    if (i % WIDTH == WIDTH - 1) putchar('\n');
  }
  return MSR_OK;
}

int main(void) {
  msr_plan *plan;
  msr_state *state;
  msr_renderer *renderer;
  msr_scene *scene = draw();
  check(msr_plan_create(scene, NULL, &plan, &err));
  check(msr_state_create(plan, &state, &err));
  check(msr_renderer_create(plan, NULL, &renderer, &err));
  const msr_sink terminal = {.self = renderer, .write = print};
  check(msr_run(state, &(msr_run_options){.sinks = &terminal, .n_sinks = 1}, &err));
  msr_renderer_free(renderer);
  msr_state_free(state);
  msr_plan_free(plan);
  msr_scene_free(scene);
}
