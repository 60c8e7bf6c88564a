/* gsl.c - GSL's rkf45 as its manual's examples use it: a driver, absolute tolerance 1e-6, relative
 * 0, first step 1e-6. The whole system is one differential equation over each DT, and after each
 * the assignment's rule of contact is applied. */
#include "beside.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_version.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct gsl_run {
  const problem *p;
  gsl_odeiv2_system system;
  gsl_odeiv2_driver *driver;
  double t, *z, *before; /* [4n]: x, y, vx, vy */
} gsl_run;

const char *gsl_version_text(void) { return gsl_version; }

static void pull(const bond *l, double damping, size_t n, const double *z, double *f) {
  const size_t i = l->i, j = l->j;
  const double dx = z[j] - z[i], dy = z[n + j] - z[n + i], d = sqrt(dx * dx + dy * dy);
  if (!(d > 0)) return;
  const double *vx = z + 2 * n, *vy = z + 3 * n;
  const double rate = ((vx[j] - vx[i]) * dx + (vy[j] - vy[i]) * dy) / d;
  const double w = (l->k * (d - l->L) + damping * rate) / d;
  f[i] += w * dx, f[n + i] += w * dy;
  f[j] -= w * dx, f[n + j] -= w * dy;
}

static int differentiate(double t, const double *z, double *dz, void *self) {
  (void)t;
  const problem *p = self;
  const size_t n = p->n;
  double *a = dz + 2 * n;
  memcpy(dz, z + 2 * n, 2 * n * sizeof *dz);
  memset(a, 0, 2 * n * sizeof *a);
  for (size_t i = 0; i < p->n_bonds; i++) pull(&p->bonds[i], p->damping, n, z, a);
  for (size_t i = 0; i < n; i++) {
    a[i] = (a[i] + p->air * (p->wind - z[2 * n + i])) / p->m[i];
    a[n + i] = (a[n + i] - p->air * z[3 * n + i]) / p->m[i] - p->gravity;
  }
  return GSL_SUCCESS;
}

static void *open_gsl(const problem *p) {
  const double tolerance = 1e-6, first_step = 1e-6;
  gsl_run *r = need(1, sizeof *r);
  gsl_set_error_handler_off();
  r->p = p;
  r->z = need(4 * p->n, sizeof *r->z);
  r->before = need(4 * p->n, sizeof *r->before);
  const double *from[] = {p->x, p->y, p->vx, p->vy};
  for (size_t a = 0; a < 4; a++) memcpy(r->z + a * p->n, from[a], p->n * sizeof *r->z);
  memcpy(r->before, r->z, 4 * p->n * sizeof *r->z);
  r->system = (gsl_odeiv2_system){differentiate, NULL, 4 * p->n, (void *)(uintptr_t)p};
  r->driver =
      gsl_odeiv2_driver_alloc_y_new(&r->system, gsl_odeiv2_step_rkf45, first_step, tolerance, 0);
  if (!r->driver) bench_fail("GSL has no memory");
  return r;
}

/* Along one axis, then the other: where a support is, the old coordinate and the velocity back. */
static bool touch(const problem *p, const double *before, double *z) {
  const size_t n = p->n;
  bool met = false;
  for (size_t i = 0; i < n; i++) {
    if (is_black(p, z[i], before[n + i]))
      z[i] = before[i], z[2 * n + i] *= -p->restitution, met = true;
    if (is_black(p, z[i], z[n + i]))
      z[n + i] = before[n + i], z[3 * n + i] *= -p->restitution, met = true;
  }
  return met;
}

static bool advance_gsl(void *self, uint64_t iterations, char *text) {
  gsl_run *r = self;
  for (uint64_t i = 0; i < iterations; i++) {
    const int status = gsl_odeiv2_driver_apply(r->driver, &r->t, r->t + r->p->dt, r->z);
    if (status != GSL_SUCCESS) {
      snprintf(text, 128, "GSL: %s", gsl_strerror(status));
      return false;
    }
    if (touch(r->p, r->before, r->z)) gsl_odeiv2_driver_reset(r->driver);
    memcpy(r->before, r->z, 4 * r->p->n * sizeof *r->z);
  }
  return true;
}

static void read_gsl(void *self, double *x, double *y, double *vx, double *vy) {
  const gsl_run *r = self;
  double *to[] = {x, y, vx, vy};
  for (size_t a = 0; a < 4; a++) memcpy(to[a], r->z + a * r->p->n, r->p->n * sizeof *x);
}

static const char *decline_gsl(const problem *p) {
  return p->diameter > 0 ? "it has no collisions" : NULL;
}

const solver solver_gsl = {decline_gsl, open_gsl, advance_gsl, read_gsl};
