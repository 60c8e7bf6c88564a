/* accuracy.c - what accuracy costs in time: each integrator at several steps, against a reference.
 * Introduces msr_plan_options.substeps. The scene, a stretched chain that spins, meets no support,
 * so that each error falls with its method's order. */
#include <msr.h>

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { N = 100, ITERATIONS = 100 };

static msr_error err;

static void check(msr_status status) {
  if (status == MSR_OK) return;
  fprintf(stderr, "accuracy: %s\n", err.message);
  exit(EXIT_FAILURE);
}

static msr_scene *chain(void) {
  msr_scene *scene;
  check(msr_scene_create(&scene, &err));
  for (size_t i = 0; i < N; i++) {
    const msr_mass mass = {.x = 1.2 * (double)i, .vy = (double)i - N / 2.0, .m = 0.1};
    check(msr_scene_add_mass(scene, &mass, NULL, &err));
    if (i > 0) check(msr_scene_add_spring(scene, i - 1, i, 200, 1, &err));
  }
  check(msr_scene_set_times(scene, 0.01, ITERATIONS, 1, &err));
  return scene;
}

/* Simulates a second; where the masses are then goes to x [N], how long it took is returned [s]. */
static double simulate(const msr_scene *scene, const msr_integrator *method, uint64_t substeps,
                       double *x) {
  msr_plan *plan;
  msr_state *state;
  check(msr_plan_create(scene, &(msr_plan_options){.integrator = method, .substeps = substeps},
                        &plan, &err));
  check(msr_state_create(plan, &state, &err));
  const clock_t start = clock();
  check(msr_state_step(state, ITERATIONS, &err));
  const double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
  for (size_t i = 0; i < N; i++) x[i] = msr_state_view(state).x[i];
  msr_state_free(state);
  msr_plan_free(plan);
  return seconds;
}

int main(void) {
  double reference[N], x[N];
  msr_scene *scene = chain();
  simulate(scene, &msr_integrator_rk4, 128, reference);
  for (const msr_integrator *const *method = msr_integrators; *method; method++)
    for (unsigned substeps = 2; (*method)->stability > 0 && substeps <= 32; substeps *= 4) {
      const double seconds = simulate(scene, *method, substeps, x);
      double error = 0;
      for (size_t i = 0; i < N; i++) {
        if (x[i] - reference[i] > error) error = x[i] - reference[i];
        if (reference[i] - x[i] > error) error = reference[i] - x[i];
      }
      printf("%-17s%2u substeps: error %.0e px in %5.2f ms\n", (*method)->name, substeps, error,
             1000 * seconds);
    }
  msr_scene_free(scene);
}
