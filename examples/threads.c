/* threads.c - two threads, each with a state of its own, share one plan and get the same bits.
 * Introduces msr_state_hash. (With a C library older than glibc 2.34, link with -pthread.) */
#include <msr.h>

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

static void check(msr_status status, const msr_error *err) {
  if (status == MSR_OK) return;
  fprintf(stderr, "threads: %s\n", err->message);
  exit(EXIT_FAILURE);
}

/* A chain of masses that starts level, held at its first one. */
static msr_plan *chain(size_t n) {
  msr_error err;
  msr_scene *scene;
  msr_plan *plan;
  check(msr_scene_create(&scene, &err), &err);
  for (size_t i = 0; i < n; i++) {
    check(msr_scene_add_mass(scene, &(msr_mass){.x = (double)i, .m = 0.1}, NULL, &err), &err);
    if (i > 0) check(msr_scene_add_spring(scene, i - 1, i, 1500, 1, &err), &err);
  }
  check(msr_scene_add_anchor(scene, &(msr_anchor){0, -1, 0, 1500, 1}, &err), &err);
  check(msr_scene_add_force(scene, &msr_force_gravity, &(msr_gravity){9.8}, &err), &err);
  check(msr_scene_set_times(scene, 0.005, 4000, 1, &err), &err);
  check(msr_plan_create(scene, NULL, &plan, &err), &err);
  msr_scene_free(scene);
  return plan;
}

typedef struct job {
  const msr_plan *plan;
  uint64_t hash;
} job;

static void *simulate(void *self) {
  job *j = self;
  msr_error err;
  msr_state *state;
  check(msr_state_create(j->plan, &state, &err), &err);
  check(msr_run(state, &(msr_run_options){0}, &err), &err);
  j->hash = msr_state_hash(state);
  msr_state_free(state);
  return NULL;
}

int main(void) {
  msr_plan *plan = chain(200);
  job first = {plan, 0}, second = {plan, 0};
  pthread_t thread;
  if (pthread_create(&thread, NULL, simulate, &second) != 0) return EXIT_FAILURE;
  simulate(&first);
  pthread_join(thread, NULL);
  printf("%016llx and %016llx\n", (unsigned long long)first.hash, (unsigned long long)second.hash);
  msr_plan_free(plan);
  return first.hash == second.hash ? EXIT_SUCCESS : EXIT_FAILURE;
}
