/* library.c - every integrator of libmsr through its public interface: one iteration of DT = T, in
 * as many substeps as asked for, or as the method chooses by its tolerance. */
#include "bench.h"

#include <stdlib.h>
#include <string.h>

typedef struct library_run {
  const problem *p;
  msr_plan *plan;
  msr_state *state;
} library_run;

static void close_library(void *object) {
  library_run *r = object;
  msr_state_free(r->state);
  msr_plan_free(r->plan);
  free(r);
}

static void *open_library(const method *self, problem *p, double knob) {
  const msr_integrator *integrator = self->row;
  const msr_plan_options options = {.integrator = integrator,
                                    .substeps = self->by_tolerance ? 1 : (uint64_t)knob,
                                    .atol = self->by_tolerance ? knob : 0};
  library_run *r = need(1, sizeof *r);
  r->p = p;
  msr_error err;
  const msr_scene *scene = integrator->adaptive ? p->watched : p->scene;
  if (msr_plan_create(scene, &options, &r->plan, &err) == MSR_OK &&
      msr_state_create(r->plan, &r->state, &err) == MSR_OK)
    return r;
  close_library(r);
  return NULL;
}

static bool run_library(void *object, double *z) {
  const library_run *r = object;
  const size_t half = r->p->n / 2 * sizeof *z, n = r->p->n / 2;
  const msr_arrays s = msr_state_edit(r->state);
  double *to[] = {s.x, s.y, s.vx, s.vy};
  for (size_t a = 0; a < 4; a++) memcpy(to[a], r->p->start + a * n, half);
  if (msr_state_step(r->state, 1, NULL) != MSR_OK) return false;
  const msr_view view = msr_state_view(r->state);
  const double *from[] = {view.x, view.y, view.vx, view.vy};
  for (size_t a = 0; a < 4; a++) memcpy(z + a * n, from[a], half);
  return true;
}

/* All but those that have no stable step. */
size_t library_methods(method *list) {
  size_t n = 0;
  for (const msr_integrator *const *i = msr_integrators; *i; i++)
    if ((*i)->stability > 0 || (*i)->adaptive)
      list[n++] = (method){.family = "libmsr",
                           .name = (*i)->name,
                           .by_tolerance = (*i)->adaptive,
                           .row = *i,
                           .open = open_library,
                           .run = run_library,
                           .close = close_library};
  return n;
}
