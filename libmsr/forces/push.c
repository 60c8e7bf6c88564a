/* push.c - a constant force on one mass, from the place where it began: U = -F.(x - x0). */
#include "base/base.h"
#include "base/number.h"

#include <math.h>
#include <stdlib.h>

typedef struct push {
  msr_push of;
  double x0, y0; /* [px] */
} push;

static msr_status check(const void *params, msr_error *err) {
  const msr_push *of = params;
  if (isfinite(of->fx) && isfinite(of->fy)) return MSR_OK;
  return msri_fail(err, MSR_EUSAGE, "a push must be a finite force");
}

static bool idle(const void *params, const msr_view *s, char *why, size_t size) {
  (void)s;
  const msr_push *of = params;
  if (of->fx != 0 || of->fy != 0) return false;
  msri_format(why, size, "its force is 0");
  return true;
}

static void describe(const void *params, const msr_view *s, char *text, size_t size) {
  (void)s;
  const msr_push *of = params;
  msri_format(text, size, "asked for: (%g, %g) on mass %zu", of->fx, of->fy, of->mass);
}

static msr_status prepare(const void *params, const msr_view *s, void **self, msr_error *err) {
  const msr_push *of = params;
  if (of->mass >= s->n)
    return msri_fail(err, MSR_EUSAGE, "a push is on mass %zu, and there are %zu masses", of->mass,
                     s->n);
  push *made = msri_alloc(1, sizeof *made, "a push", err);
  if (!made) return MSR_ENOMEM;
  *made = (push){*of, s->x[of->mass], s->y[of->mass]};
  *self = made;
  return MSR_OK;
}

static msr_status add(const void *self, void *scratch, const msr_view *s, double *fx, double *fy) {
  (void)scratch, (void)s;
  const msr_push *of = &((const push *)self)->of;
  fx[of->mass] += of->fx;
  fy[of->mass] += of->fy;
  return MSR_OK;
}

static msr_status between(const void *self, void *scratch, const msr_view *s, const msr_view *to,
                          double *fx, double *fy) {
  (void)to;
  return add(self, scratch, s, fx, fy);
}

static double energy(const void *self, const msr_view *s) {
  const push *p = self;
  const size_t i = p->of.mass;
  return -(p->of.fx * (s->x[i] - p->x0) + p->of.fy * (s->y[i] - p->y0));
}

const msr_force msr_force_push = {
    .name = "push",
    .summary = "a constant force F on one mass",
    .conservative = true,
    .params_size = sizeof(msr_push),
    .check = check,
    .idle = idle,
    .describe = describe,
    .prepare = prepare,
    .release = free,
    .add = add,
    .energy = energy,
    .between = between,
    .add_load = {.call = 2, .call_bytes = 32},
};
