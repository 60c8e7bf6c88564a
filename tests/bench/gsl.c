/* gsl.c - the explicit steppers of GSL's odeiv2, by their own drivers. */
#include "bench.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_version.h>
#include <stdlib.h>
#include <string.h>

typedef struct gsl_run {
  problem *p;
  gsl_odeiv2_system system;
  gsl_odeiv2_driver *driver;
} gsl_run;

static int right_hand_side(double t, const double *y, double *dy, void *self) {
  (void)t;
  return differentiate(self, y, dy) ? GSL_SUCCESS : GSL_EBADFUNC;
}

static const double first_step = 1e-3;

static void *open_gsl(const method *self, problem *p, double knob) {
  const gsl_odeiv2_step_type *const *type = self->row;
  gsl_run *r = need(1, sizeof *r);
  gsl_set_error_handler_off();
  r->p = p;
  r->system = (gsl_odeiv2_system){right_hand_side, NULL, 2 * p->n, p};
  r->driver = gsl_odeiv2_driver_alloc_y_new(&r->system, *type, first_step, knob, 0);
  if (!r->driver) bench_fail("GSL has no driver for %s", self->name);
  return r;
}

static bool run_gsl(void *object, double *z) {
  gsl_run *r = object;
  double t = 0;
  memcpy(z, r->p->start, 2 * r->p->n * sizeof *z);
  return gsl_odeiv2_driver_reset_hstart(r->driver, first_step) == GSL_SUCCESS &&
         gsl_odeiv2_driver_apply(r->driver, &t, r->p->T, z) == GSL_SUCCESS;
}

static void close_gsl(void *object) {
  gsl_odeiv2_driver_free(((gsl_run *)object)->driver);
  free(object);
}

size_t gsl_methods(method *list) {
  static const struct {
    const char *name;
    const gsl_odeiv2_step_type *const *type;
  } rows[] = {{"rkf45", &gsl_odeiv2_step_rkf45},
              {"rkck", &gsl_odeiv2_step_rkck},
              {"rk8pd", &gsl_odeiv2_step_rk8pd},
              {"msadams", &gsl_odeiv2_step_msadams}};
  const size_t n = sizeof rows / sizeof *rows;
  for (size_t i = 0; i < n; i++)
    list[i] = (method){.family = "GSL",
                       .name = rows[i].name,
                       .by_tolerance = true,
                       .row = rows[i].type,
                       .open = open_gsl,
                       .run = run_gsl,
                       .close = close_gsl};
  return n;
}

const char *gsl_version_text(void) { return gsl_version; }
