/* damping.c - damping along the springs: F_ij = z (v_ij . n) n, with n the spring's direction.
 *
 * Alone on one spring it is solved exactly: the axial speed of two masses decays as exp(-z h / mu),
 * mu = m_i m_j / (m_i + m_j). The flow does that spring after spring, or in the opposite order, so
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

/* Direction of a spring, (0, 0) if it has none. */
static inline void direction(double dx, double dy, double *nx, double *ny) {
  const double l = sqrt(dx * dx + dy * dy);
  *nx = l > 0 ? dx / l : 0;
  *ny = l > 0 ? dy / l : 0;
}

static msr_status add(const void *self, void *scratch, const msr_view *s, double *fx, double *fy) {
  (void)scratch;
  const double z = ((const msr_damping *)self)->z;
  double nx, ny;
  for (size_t r = 0; r < s->springs->n_runs; r++) {
    const msr_run_of_springs *run = &s->springs->run[r];
    for (size_t i = run->first; i < run->first + run->count; i++) {
      const size_t j = i + (size_t)run->offset;
      direction(s->x[j] - s->x[i], s->y[j] - s->y[i], &nx, &ny);
      const double f = z * ((s->vx[j] - s->vx[i]) * nx + (s->vy[j] - s->vy[i]) * ny);
      fx[i] += f * nx, fy[i] += f * ny;
      fx[j] -= f * nx, fy[j] -= f * ny;
    }
  }
  for (size_t n = 0; n < s->springs->n_anchors; n++) {
    const msr_anchor *a = &s->springs->anchor[n];
    direction(a->x - s->x[a->i], a->y - s->y[a->i], &nx, &ny);
    const double f = z * (s->vx[a->i] * nx + s->vy[a->i] * ny);
    fx[a->i] -= f * nx, fy[a->i] -= f * ny;
  }
  return MSR_OK;
}

/* What a flow of h needs to know of a spring's reduced mass, kept while it stays the same. */
typedef struct decay {
  double zh, mu, lost; /* lost: share of the axial momentum, 1 - exp(-z h / mu) */
} decay;

static inline double lost(decay *d, double mu) {
  if (mu != d->mu) {
    d->mu = mu;
    d->lost = -expm1(-d->zh / mu);
  }
  return d->lost;
}

static inline void damp_spring(const msr_view *s, size_t i, size_t j, decay *d, double *vx,
                               double *vy) {
  double nx, ny;
  direction(s->x[j] - s->x[i], s->y[j] - s->y[i], &nx, &ny);
  const double mi = msr_view_mass(s, i), mj = msr_view_mass(s, j), mu = mi / (mi + mj) * mj;
  const double p = lost(d, mu) * mu * ((vx[j] - vx[i]) * nx + (vy[j] - vy[i]) * ny);
  vx[i] += p * nx / mi, vy[i] += p * ny / mi;
  vx[j] -= p * nx / mj, vy[j] -= p * ny / mj;
}

static void damp_run(const msr_view *s, const msr_run_of_springs *run, decay *d, bool backward,
                     double *vx, double *vy) {
  for (size_t n = 0; n < run->count; n++) {
    const size_t i = run->first + (backward ? run->count - 1 - n : n);
    damp_spring(s, i, i + (size_t)run->offset, d, vx, vy);
  }
}

static void damp_anchor(const msr_view *s, const msr_anchor *a, decay *d, double *vx, double *vy) {
  double nx, ny;
  direction(a->x - s->x[a->i], a->y - s->y[a->i], &nx, &ny);
  const double v = lost(d, msr_view_mass(s, a->i)) * (vx[a->i] * nx + vy[a->i] * ny);
  vx[a->i] -= v * nx, vy[a->i] -= v * ny;
}

static msr_status flow(const void *self, void *scratch, const msr_view *s, double h, bool backward,
                       double *vx, double *vy) {
  (void)scratch;
  const msr_springs *springs = s->springs;
  decay d = {((const msr_damping *)self)->z * h, 0, 0};
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
    .params_size = sizeof(msr_damping),
    .check = check,
    .idle = idle,
    .describe = describe,
    .add = add,
    .flow = flow,
    .rates = rates,
};
