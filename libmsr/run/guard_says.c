/* guard_says.c - what the guard says of a state that can't be true: which mass and spring, when,
 * how much energy, and a step that works. */
#include "run/guard.h"

#include "base/number.h"

#include <math.h>

/* ---- Where */

static double speed(const msr_view *s, size_t i) { return hypot(s->vx[i], s->vy[i]); }

static bool is_finite(const msr_view *s, size_t i) {
  return isfinite(speed(s, i)) && isfinite(s->x[i]) && isfinite(s->y[i]);
}

/* The first mass that isn't finite, else the fastest. */
static size_t culprit(const msr_view *s) {
  size_t fastest = 0;
  for (size_t i = 0; i < s->n; i++) {
    if (!is_finite(s, i)) return i;
    if (speed(s, i) > speed(s, fastest)) fastest = i;
  }
  return fastest;
}

/* The spring of a mass that is stretched most. */
typedef struct worst {
  size_t other; /* its other end, or */
  const msr_anchor *anchor;
  double length, rest; /* [px]; rest < 0: there is no spring */
} worst;

static void consider(worst *w, const worst *spring) {
  const double more = spring->length * w->rest, less = w->length * spring->rest;
  if (w->rest < 0 || more > less || isnan(more)) *w = *spring;
}

static worst worst_of(const msr_view *s, size_t mass) {
  worst w = {.rest = -1};
  for (size_t r = 0; r < s->springs->n_runs; r++) {
    const msr_run_of_springs *run = &s->springs->run[r];
    for (size_t end = 0; end < 2; end++) {
      const size_t c = mass - run->first - end * run->offset;
      if (c >= run->count) continue;
      const size_t i = run->first + c, j = i + run->offset;
      const double length = hypot(s->x[j] - s->x[i], s->y[j] - s->y[i]);
      consider(&w, &(worst){end ? i : j, NULL, length, run->L[c * run->stride]});
    }
  }
  for (size_t a = 0; a < s->springs->n_anchors; a++) {
    const msr_anchor *anchor = &s->springs->anchor[a];
    if (anchor->i != mass) continue;
    const double length = hypot(anchor->x - s->x[mass], anchor->y - s->y[mass]);
    consider(&w, &(worst){0, anchor, length, anchor->L});
  }
  return w;
}

/* "; its spring to pixel (4,5) is 3.2 times its rest length", or nothing. */
static void say_spring(const msr_state *state, const msr_view *s, size_t mass, char *text,
                       size_t size) {
  const worst w = worst_of(s, mass);
  char end[96];
  size_t column, row;
  text[0] = '\0';
  if (w.rest < 0) return;
  if (w.anchor)
    msri_format(end, sizeof end, "the fixed point (%g,%g)", w.anchor->x, w.anchor->y);
  else if (msr_plan_pixel(state->plan, w.other, &column, &row))
    msri_format(end, sizeof end, "pixel (%zu,%zu)", column, row);
  else
    msri_format(end, sizeof end, "mass %zu", w.other);
  if (!isfinite(w.length))
    msri_format(text, size, "; its spring to %s has no finite length", end);
  else if (w.rest > 0)
    msri_format(text, size, "; its spring to %s is %.3g times its rest length", end,
                w.length / w.rest);
  else
    msri_format(text, size, "; its spring to %s is %.3g px long", end, w.length);
}

/* ---- What to do */

/* In the user's terms, rounded down. */
static void say_step(const msr_plan_figures *f, double step, const char *before, char *text,
                     size_t size) {
  msri_format(text, size, "%sDT %.3g, or %.10g substeps", before, 0.995 * step, ceil(f->dt / step));
}

/* A quarter of the step, where it should have been stable. */
static void advise_quarter(const msr_plan_figures *f, const char *before, char *text, size_t size) {
  say_step(f, f->h / 4, before, text, size);
}

/* Order 1 isn't enough where springs are overdamped: what turns stretches them, step by step, and
 * they don't come back. */
static bool creeps(const msr_plan *plan) {
  const msr_integrator *method = plan->figures.integrator;
  return msri_plan_damps(plan) && method->splits && method->order == 1;
}

/* What to do: a step that is stable. */
static void advise(const msr_plan *plan, char *text, size_t size) {
  const msr_plan_figures *f = &plan->figures;
  char before[128];
  if (f->integrator->adaptive) {
    msri_format(text, size,
                "any step is stable, but errors are too large: lower atol, %g, and rtol, %g",
                f->atol, f->rtol);
  } else if (f->stable_step == 0 || creeps(plan)) {
    msri_format(before, sizeof before, "%s %s; use verlet: ", f->integrator->name,
                f->stable_step == 0 ? "has no stable step here" : "is too coarse for damping");
    say_step(f, msri_plan_verlet_step(plan), before, text, size);
  } else if (f->h > f->safe_step) {
    say_step(f, f->safe_step, "stable: ", text, size);
  } else if (isinf(f->stable_step)) {
    advise_quarter(f, "any step is stable, but this one follows too little: try ", text, size);
  } else {
    msri_format(before, sizeof before, "the step is below the limit of stability, %.3g s: try ",
                f->stable_step);
    advise_quarter(f, before, text, size);
  }
}

/* ---- The sentence */

/* What isn't finite though the step is stable comes from something else. */
static void advise_values(const msr_plan *plan, bool numbers, char *text, size_t size) {
  if (plan->figures.h > plan->figures.safe_step || plan->figures.stable_step == 0)
    advise(plan, text, size);
  else
    msri_format(text, size, "%s",
                numbers ? "use units of mass, length and time in which energies are smaller"
                        : "the step is stable: look for a force or a value that is too large");
}

msr_status msri_guard_refuse(const msr_state *state, double ratio, msr_error *err) {
  const msr_view view = msr_state_view(state);
  const size_t mass = culprit(&view);
  const bool finite = view.n == 0 || is_finite(&view, mass);
  char name[64], what[128] = "is no longer finite", spring[160], advice[224];
  if (!isnan(ratio))
    msri_format(what, sizeof what,
                "has run away, with %.3g times the energy that the scene had to give", ratio);
  else if (finite)
    msri_format(what, sizeof what,
                "goes at %.3g px/s, and energies are beyond the range of numbers, 1.8e308",
                view.n > 0 ? speed(&view, mass) : 0);
  msri_plan_mass_name(state->plan, mass, name, sizeof name);
  say_spring(state, &view, mass, spring, sizeof spring);
  if (isnan(ratio))
    advise_values(state->plan, finite, advice, sizeof advice);
  else
    advise(state->plan, advice, sizeof advice);
  return msri_fail(err, MSR_EUNSTABLE, "unstable at iteration %llu, t = %g s: %s %s%s; %s",
                   (unsigned long long)state->iteration, view.t, name, what, spring, advice);
}
