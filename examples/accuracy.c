/* accuracy.c - what accuracy costs in time: every integrator at many steps, against a reference.
 * Introduces msr_accuracy_study. The scene, a stretched chain that spins, meets no support, so that
 * each error falls with its method's order; the answers follow the table. */
#include <msr.h>

#include <stdio.h>
#include <stdlib.h>

enum { N = 20, ITERATIONS = 100 };

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
  check(msr_scene_set_times(scene, 0.01, ITERATIONS, ITERATIONS, &err));
  return scene;
}

int main(void) {
  msr_scene *scene = chain();
  msr_accuracy *study;
  check(msr_accuracy_study(scene, &(msr_accuracy_options){.finest = 1e-6}, &study, &err));
  const msr_accuracy_figures f = msr_accuracy_describe(study);
  printf("Up to %g s, against %s, which %s confirms within %.0e px:\n", f.horizon,
         f.reference->name, f.witness->name, f.reference_error);
  size_t n;
  const msr_accuracy_point *p = msr_accuracy_points(study, &n);
  for (size_t i = 0; i < n; i++) {
    printf("%-17s%4llu substeps", p[i].integrator->name, (unsigned long long)p[i].substeps);
    if (p[i].atol > 0) printf(", tolerance %.0e", p[i].atol);
    printf(p[i].stable ? ": error %.0e px in %.3f ms%s\n" : ": unstable\n", p[i].max,
           1000 * p[i].seconds, p[i].front ? " *" : "");
  }
  static const double errors[] = {1, 1e-2, 1e-4};
  for (size_t i = 0; i < sizeof errors / sizeof *errors; i++) {
    const msr_accuracy_point *best = msr_accuracy_cheapest(study, errors[i]);
    if (best) printf("%g px: %s\n", errors[i], best->integrator->name);
  }
  msr_accuracy_free(study);
  msr_scene_free(scene);
}
