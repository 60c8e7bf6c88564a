/* rest.c - see rest.h. A look takes a step that no other is joined to, and costs more than its
 * share of a pass: so there's one every 256 steps, and only if something is slow enough. */
#include "sweep/rest.h"

#include <string.h>

enum { BETWEEN_LOOKS = 256 }; /* steps */

bool msri_rest_is_known(const msr_plan *plan) {
  for (size_t i = 0; i < plan->n_terms; i++)
    if (plan->term[i].force->uses_time) return false;
  return true;
}

void msri_rest_wake(const msr_plan *plan, msri_rest *rest) {
  if (rest->n > 0) memset(rest->how, MSRI_STEPPED, plan->objects.n);
  rest->n = 0;
  rest->met = rest->waits = 0;
}

/* x = x + h v? What is no number never is. */
static bool is_slow(size_t n, double h, const double *x, const double *v) {
  for (size_t i = 0; i < n; i++)
    if (!(x[i] + h * v[i] == x[i])) return false;
  return true;
}

static bool is_still(const msr_plan *plan, const msri_swept *state, const msri_object *object) {
  const msri_objects *o = &plan->objects;
  const double h = plan->figures.h;
  for (size_t p = o->row[object->row]; p < o->row[object->row + object->rows]; p++) {
    const size_t i = o->piece[p].first, n = o->piece[p].count;
    if (!is_slow(n, h, state->x + i, state->vx + i)) return false;
    if (!is_slow(n, h, state->y + i, state->vy + i)) return false;
  }
  return true;
}

bool msri_rest_look(const msr_plan *plan, const msri_swept *state, msri_rest *rest) {
  bool any = false;
  if (rest->waits > 0) return false;
  rest->waits = BETWEEN_LOOKS;
  for (size_t n = 0; n < plan->objects.n; n++) {
    if (rest->how[n] == MSRI_LEFT_OUT || !is_still(plan, state, &plan->objects.object[n])) continue;
    rest->how[n] = MSRI_LOOKED_AT;
    any = true;
  }
  return any;
}

void msri_rest_leave_out(const msr_plan *plan, uint64_t met, msri_rest *rest) {
  for (size_t n = 0; n < plan->objects.n; n++) {
    if (rest->how[n] != MSRI_LOOKED_AT) continue;
    rest->how[n] = rest->same[n] ? MSRI_LEFT_OUT : MSRI_STEPPED;
    rest->n += rest->same[n];
  }
  rest->met += met;
}

void msri_rest_wait(msri_rest *rest, uint64_t steps) {
  rest->waits -= steps < rest->waits ? steps : rest->waits;
}
