/* damping.c - damping along the springs: F_ij = z (v_ij . n) n, with n the spring's direction.
 *
 * Alone on one spring it is solved exactly: the axial speed of two masses decays as exp(-z h / mu),
 * 1 / mu = 1 / m_i + 1 / m_j. The flow does that spring after spring, or in the opposite order, so
 * that a forward half step and a backward one make a symmetric step (order 2, stable for any z). */
#include "forces/mesh.h"

#include "base/number.h"

#include <math.h>

static msr_status check(const void *params, msr_error *err) {
  const double z = ((const msr_damping *)params)->z;
  if (isfinite(z) && z >= 0) return MSR_OK;
  return msri_fail(err, MSR_EUSAGE, "damping must be a finite number of kg/s, 0 or more");
}

static bool idle(const void *params, const msr_view *s, char *why, size_t size) {
  const bool none = s->springs->n + s->springs->n_anchors == 0;
  if (((const msr_damping *)params)->z > 0 && !none) return false;
  msri_format(why, size, none ? "there is no spring" : "its coefficient is 0");
  return true;
}

static void describe(const void *params, const msr_view *s, char *text, size_t size) {
  (void)s;
  msri_format(text, size, "asked for: z = %g kg/s on every spring",
              ((const msr_damping *)params)->z);
}

/* (r . n) n for a spring along d: its part of r, (0, 0) if it has no direction. */
static inline void along(double dx, double dy, double *rx, double *ry) {
  const double l2 = dx * dx + dy * dy;
  const double part = l2 > 0 ? (*rx * dx + *ry * dy) / l2 : 0;
  *rx = part * dx;
  *ry = part * dy;
}

static void add_spring(const msr_view *s, size_t i, size_t j, double z, double *fx, double *fy) {
  double rx = s->vx[j] - s->vx[i], ry = s->vy[j] - s->vy[i];
  along(s->x[j] - s->x[i], s->y[j] - s->y[i], &rx, &ry);
  fx[i] += z * rx, fy[i] += z * ry;
  fx[j] -= z * rx, fy[j] -= z * ry;
}

static msr_status add(const void *self, void *scratch, const msr_view *s, double *fx, double *fy) {
  (void)scratch;
  const double z = ((const msr_damping *)self)->z;
  for (size_t r = 0; r < s->springs->n_runs; r++) {
    const msr_run_of_springs *run = &s->springs->run[r];
    for (size_t i = run->first; i < run->first + run->count; i++)
      add_spring(s, i, i + run->offset, z, fx, fy);
  }
  for (size_t n = 0; n < s->springs->n_anchors; n++) {
    const msr_anchor *a = &s->springs->anchor[n];
    double rx = s->vx[a->i], ry = s->vy[a->i];
    along(a->x - s->x[a->i], a->y - s->y[a->i], &rx, &ry);
    fx[a->i] -= z * rx, fy[a->i] -= z * ry;
  }
  return MSR_OK;
}

/* What a flow needs to know of a pair of masses, kept while they stay the same. */
typedef struct decay {
  double zh, mi, mj;
  double gain_i, gain_j; /* share of the axial speed that each takes up */
} decay;

/* An anchor is a mass without end: mj = INFINITY. */
static inline void set_masses(decay *d, double mi, double mj) {
  if (mi == d->mi && mj == d->mj) return;
  const double mu = 1 / (1 / mi + 1 / mj), lost = -expm1(-d->zh / mu);
  *d = (decay){d->zh, mi, mj, lost * mu / mi, lost * mu / mj};
}

static inline void damp_spring(const msr_view *s, size_t i, size_t j, decay *d, double *vx,
                               double *vy) {
  double rx = vx[j] - vx[i], ry = vy[j] - vy[i];
  along(s->x[j] - s->x[i], s->y[j] - s->y[i], &rx, &ry);
  set_masses(d, msr_view_mass(s, i), msr_view_mass(s, j));
  vx[i] += d->gain_i * rx, vy[i] += d->gain_i * ry;
  vx[j] -= d->gain_j * rx, vy[j] -= d->gain_j * ry;
}

static void damp_run(const msr_view *s, const msr_run_of_springs *run, decay *d, bool backward,
                     double *vx, double *vy) {
  for (size_t n = 0; n < run->count; n++) {
    const size_t i = run->first + (backward ? run->count - 1 - n : n);
    damp_spring(s, i, i + run->offset, d, vx, vy);
  }
}

static void damp_anchor(const msr_view *s, const msr_anchor *a, decay *d, double *vx, double *vy) {
  double rx = vx[a->i], ry = vy[a->i];
  along(a->x - s->x[a->i], a->y - s->y[a->i], &rx, &ry);
  set_masses(d, msr_view_mass(s, a->i), (double)INFINITY);
  vx[a->i] -= d->gain_i * rx, vy[a->i] -= d->gain_i * ry;
}

static msr_status flow(const void *self, void *scratch, const msr_view *s, double h, bool backward,
                       double *vx, double *vy) {
  (void)scratch;
  const msr_springs *springs = s->springs;
  decay d = {.zh = ((const msr_damping *)self)->z * h};
  for (size_t n = 0; backward && n < springs->n_anchors; n++)
    damp_anchor(s, &springs->anchor[springs->n_anchors - 1 - n], &d, vx, vy);
  for (size_t r = 0; r < springs->n_runs; r++)
    damp_run(s, &springs->run[backward ? springs->n_runs - 1 - r : r], &d, backward, vx, vy);
  for (size_t n = 0; !backward && n < springs->n_anchors; n++)
    damp_anchor(s, &springs->anchor[n], &d, vx, vy);
  return MSR_OK;
}

static msr_status rates(const void *self, const msr_view *s, double *omega2, double *gamma) {
  (void)omega2;
  return msri_mesh_bound(s, &((const msr_damping *)self)->z, gamma);
}

const msr_force msr_force_damping = {
    .name = "damping",
    .summary = "F = z (v_ij . n) n along each spring",
    .dissipative = true,
    .uses_velocity = true,
    .ignores_start = true,
    .params_size = sizeof(msr_damping),
    .check = check,
    .idle = idle,
    .describe = describe,
    .add = add,
    .flow = flow,
    .rates = rates,
    .add_load = {.spring = 19, .mass_bytes = 64},
    .flow_load = {.spring = 21, .mass_bytes = 48},
};
