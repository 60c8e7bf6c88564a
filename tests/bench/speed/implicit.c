/* implicit.c - what a long step costs by implicit methods at 10^6 masses, at K = k h^2 / m; beside
 * the steps of Verlet that would go as far at K = 1/2, its largest at any stretch. */
#include "scene.h"

static const double stiffnesses[] = {1, 100, 1e4}; /* K */
static const double largest = 0.5;                 /* of Verlet */
enum { STEPS = 2, SIDE = 1000 };

static const msr_integrator *const methods[] = {&msr_integrator_energy_momentum,
                                                &msr_integrator_backward_euler};
enum { METHODS = sizeof methods / sizeof *methods };

/* Seconds of a step of Verlet. */
static double verlet_step(const work *w) {
  double each[ROUNDS];
  entry e = library.open(&library, w, 1);
  library.run(e.self, 16);
  for (int i = 0; i < ROUNDS; i++) each[i] = library.run(e.self, 16) / 16;
  library.close(e.self);
  return spread_of(each, ROUNDS).median;
}

static void print_steps(const work *w, const msr_integrator *method, double K, double verlet) {
  msr_plan *plan;
  const msr_plan_options options = {.integrator = method, .substeps = 1};
  msr_state *state = state_of(w, sqrt(K * mass / stiffness), 1, &options, &plan);
  const double as_many = sqrt(K / largest), beside = as_many * verlet;
  double most = 0;
  printf("%-16s %8g", method->name, K);
  for (int i = 0; i < STEPS; i++) {
    const uint64_t before = msr_state_work(state).evaluations;
    const double begin = seconds_now();
    must(msr_state_step(state, 1, reason()));
    const double seconds = seconds_now() - begin;
    most = fmax(most, seconds);
    printf(" %10ju %9.3f", (uintmax_t)(msr_state_work(state).evaluations - before), seconds);
  }
  printf(" %9.0f %9.3f %9.2f\n", as_many, beside, most / beside);
  fflush(stdout);
  if (K >= 1e4)
    bar_at_most(most / beside, 1, "%s at K = %g / as many Verlet steps", method->name, K);
  msr_state_free(state);
  msr_plan_free(plan);
}

void implicit_table(void) {
  work w = work_drawn("block", SIDE, draw_block);
  const double verlet = verlet_step(&w);
  printf("\n== Implicit steps, block of %zu masses, one thread: evaluations and seconds of the "
         "first and of the second\n",
         w.n);
  printf("%-16s %8s %10s %9s %10s %9s %9s %9s %9s\n", "", "K", "evals", "s", "evals", "s",
         "Verlet's", "s", "ratio");
  for (int m = 0; m < METHODS; m++)
    for (size_t i = 0; i < sizeof stiffnesses / sizeof *stiffnesses; i++)
      print_steps(&w, methods[m], stiffnesses[i], verlet);
  work_free(&w);
}
