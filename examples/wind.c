/* wind.c - the statistics of the random wind, measured with a mass too heavy to be moved by it.
 * Introduces msr_state_forces: at rest the force of the wind is F = c w(t), so that F / c is w. */
#include <msr.h>

#include <stdio.h>
#include <stdlib.h>

enum { SAMPLES = 40000, LAG = 20 }; /* of 0.05 s; LAG: the correlation time, 1 s */

static msr_error err;

static void check(msr_status status) {
  if (status == MSR_OK) return;
  fprintf(stderr, "wind: %s\n", err.message);
  exit(EXIT_FAILURE);
}

static void measure(msr_state *state, double *wind) {
  for (size_t i = 0; i < SAMPLES; i++) {
    double fy;
    check(msr_state_forces(state, &wind[i], &fy, &err));
    check(msr_state_step(state, 1, &err));
  }
}

int main(void) {
  static double wind[SAMPLES];
  const msr_wind blow = {.c = 1, .speed = 30, .gust = 10, .gust_time = 1, .seed = 2024};
  msr_scene *scene;
  msr_plan *plan;
  msr_state *state;
  check(msr_scene_create(&scene, &err));
  check(msr_scene_add_mass(scene, &(msr_mass){.m = 1e12}, NULL, &err));
  check(msr_scene_add_force(scene, &msr_force_wind, &blow, &err));
  check(msr_scene_set_times(scene, 0.05, SAMPLES, 1, &err));
  check(msr_plan_create(scene, NULL, &plan, &err));
  check(msr_state_create(plan, &state, &err));
  measure(state, wind);

  double mean = 0, variance = 0, product = 0;
  for (size_t i = 0; i < SAMPLES; i++) mean += wind[i] / SAMPLES;
  for (size_t i = 0; i < SAMPLES; i++) variance += (wind[i] - mean) * (wind[i] - mean) / SAMPLES;
  for (size_t i = 0; i + LAG < SAMPLES; i++)
    product += (wind[i] - mean) * (wind[i + LAG] - mean) / (SAMPLES - LAG);
  printf("%d s of wind: mean %.1f px/s (asked: 30), variance %.0f (100), autocorrelation after the "
         "correlation time %.2f (1/e = 0.37)\n",
         SAMPLES / 20, mean, variance, product / variance);
  msr_state_free(state);
  msr_plan_free(plan);
  msr_scene_free(scene);
}
