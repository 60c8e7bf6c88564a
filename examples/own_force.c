/* own_force.c - a force of one's own: a spring of no length to the point (0, 0), F = -k x.
 * Introduces msr_scene_add_force. With energy() the total energy counts it, with rates() the plan
 * knows a stable step; a mass under it alone is back after 2 pi sqrt(m / k). */
#include <msr.h>

#include <stdio.h>

static msr_status add(const void *k, void *scratch, const msr_view *s, double *fx, double *fy) {
  (void)scratch;
  for (size_t i = 0; i < s->n; i++) fx[i] -= *(const double *)k * s->x[i];
  for (size_t i = 0; i < s->n; i++) fy[i] -= *(const double *)k * s->y[i];
  return MSR_OK;
}

static double energy(const void *k, const msr_view *s) {
  double sum = 0;
  for (size_t i = 0; i < s->n; i++) sum += s->x[i] * s->x[i] + s->y[i] * s->y[i];
  return *(const double *)k * sum / 2;
}

static msr_status rates(const void *k, const msr_view *s, double *omega2, double *gamma) {
  (void)gamma;
  for (size_t i = 0; i < s->n; i++) {
    const double of_mass = *(const double *)k / msr_view_mass(s, i);
    if (of_mass > *omega2) *omega2 = of_mass;
  }
  return MSR_OK;
}

static const msr_force attraction = {.name = "attraction",
                                     .summary = "F = -k x",
                                     .conservative = true,
                                     .params_size = sizeof(double), /* k: all that it needs */
                                     .add = add,
                                     .energy = energy,
                                     .rates = rates};

int main(void) {
  const double k = 4;
  msr_scene *scene = NULL;
  msr_plan *plan = NULL;
  msr_state *state = NULL;
  msr_error err = {MSR_OK, ""};
  if (msr_scene_create(&scene, &err) ||
      msr_scene_add_mass(scene, &(msr_mass){.x = 100, .vy = 50, .m = 1}, NULL, &err) ||
      msr_scene_add_force(scene, &attraction, &k, &err) ||
      msr_scene_set_times(scene, 3.14159265 / 1000, 1000, 1, &err) ||
      msr_plan_create(scene, NULL, &plan, &err) || msr_state_create(plan, &state, &err) ||
      msr_run(state, NULL, &err))
    fprintf(stderr, "own_force: %s\n", err.message);
  else
    printf("after a period at (%.3f, %.3f), as at first (100, 0); energy %.3f, as 20000 + 1250\n",
           msr_state_view(state).x[0], msr_state_view(state).y[0], msr_state_energy(state).total);
  msr_state_free(state);
  msr_plan_free(plan);
  msr_scene_free(scene);
  return err.status != MSR_OK;
}
