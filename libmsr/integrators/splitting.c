/* splitting.c - symplectic splittings of q'' = a(t, q): kicks v += b h a and drifts q += c h v in
 * turn (Hairer, Lubich & Wanner, Geometric Numerical Integration, 2006, II.5, V.3). A method is a
 * row. Where the last kick of a step and the first of the next are at the same place, one
 * evaluation serves both.
 *
 * What depends on v is advanced by its own flow, so that damping doesn't limit the step. In
 * a composition of Verlet steps each of them has a half of its flow at either end (Strang 1968),
 * which keeps the whole one's order. Other symmetric rows have one half at each end of the step,
 * order 2; symplectic Euler has both after its kick (at both ends, damping would lower the limit of
 * kick and drift). A backward half and a forward one make a symmetric contraction of springs that
 * are damped in turn; a single order of them, overdamped, would explode far below the limit. */
#include "integrators/splitting.h"

#include "base/vector.h"

#include <math.h>

typedef struct splitting {
  int drifts;
  bool symmetric;      /* both rows read the same backwards: what is before the middle will do */
  const double *drift; /* [drifts], in units of h */
  const double *kick;  /* [drifts + 1]; NULL: a composition of Verlet steps of drift[] h */
} splitting;

/* Number j of a row of `count`. Of one that reads the same backwards the one in the middle, or
 * both, make up the sum of 1. */
static double coefficient(bool symmetric, const double *row, int count, int j) {
  if (!symmetric) return row[j];
  const int mirror = count - 1 - j, outer = j < mirror ? j : mirror, middle = (count - 1) / 2;
  if (outer < middle) return row[outer];
  double sum = 0;
  for (int i = 0; i < middle; i++) sum += row[i];
  return count % 2 ? 1 - 2 * sum : 0.5 - sum;
}

static double drift_of(const splitting *row, int j) {
  return coefficient(row->symmetric, row->drift, row->drifts, j);
}

static double kick_of(const splitting *row, int j) {
  return coefficient(row->symmetric, row->kick, row->drifts + 1, j);
}

static msri_joint joint_of_composition(const splitting *row, int j) {
  const double back = j > 0 ? drift_of(row, j - 1) / 2 : 0;
  const double forward = j < row->drifts ? drift_of(row, j) / 2 : 0;
  return (msri_joint){back, back, forward, forward};
}

static msri_joint joint_of_splitting(const splitting *row, int j) {
  const double b = kick_of(row, j);
  if (!row->symmetric) return j == 0 ? (msri_joint){b, 0.5, 0.5, 0} : (msri_joint){b, 0, 0, 0};
  if (j == row->drifts) return (msri_joint){b, 0.5, 0, 0};
  return (msri_joint){0, 0, j == 0 ? 0.5 : 0, b};
}

static msri_joint joint_of(const splitting *row, int j) {
  return row->kick ? joint_of_splitting(row, j) : joint_of_composition(row, j);
}

/* The state of a step; t is the time of the joint. */
typedef struct stage {
  const msr_system *system;
  double t, h;
  double *q, *v, *a;
} stage;

static void kick(const stage *s, double b) {
  if (b != 0) msri_add_scaled(s->system->n, b * s->h, s->a, s->v);
}

static msr_status drift(const stage *s, double share) {
  const double h = share * s->h;
  if (s->system->drift) return msr_system_drift(s->system, h, s->v, s->a, s->q, s->v);
  msri_add_scaled(s->system->n, h, s->v, s->q);
  return MSR_OK;
}

static msr_status damp(const stage *s, double share, bool backward) {
  return share == 0 ? MSR_OK
                    : s->system->damp(s->system->self, s->t, share * s->h, backward, s->q, s->v);
}

static msr_status pass(const stage *s, const msri_joint *j) {
  if (!s->system->damp) {
    kick(s, j->kick_before + j->kick_after);
    return MSR_OK;
  }
  kick(s, j->kick_before);
  msr_status status = damp(s, j->damp_back, true);
  if (status == MSR_OK) status = damp(s, j->damp_forward, false);
  if (status == MSR_OK) kick(s, j->kick_after);
  return status;
}

static msr_status accelerate(const stage *s) {
  const msr_system *system = s->system;
  return system->acceleration(system->self, s->t, s->q, system->damp ? NULL : s->v, s->a);
}

/* Does a step begin with the acceleration that the one before ended with? */
static bool shares(const splitting *row) {
  return !row->kick || (row->symmetric && *row->kick != 0);
}

static msr_status begin(const msr_integrator *self, const msr_system *system, double t,
                        const double *q, const double *v, msr_workspace *work) {
  if (!shares(self->coefficients)) return MSR_OK;
  return system->acceleration(system->self, t, q, system->damp ? NULL : v, work->vector);
}

static msr_status step(const msr_integrator *self, const msr_system *system,
                       const msr_interval *interval, double *q, double *v, msr_workspace *work,
                       msr_error *err) {
  const splitting *row = self->coefficients;
  stage s = {system, interval->t, interval->h, q, v, work->vector};
  double share = 0;
  msr_status status = MSR_OK;
  (void)err;
  for (int j = 0; j <= row->drifts && status == MSR_OK; j++) {
    const msri_joint at = joint_of(row, j);
    const bool kicks = at.kick_before != 0 || at.kick_after != 0, has = j == 0 && shares(row);
    s.t = msr_interval_time(interval, j == row->drifts ? 1 : share);
    if (kicks && !has) status = accelerate(&s);
    if (status == MSR_OK) status = pass(&s, &at);
    if (j == row->drifts || status != MSR_OK) break;
    status = drift(&s, drift_of(row, j));
    share += drift_of(row, j);
  }
  return status;
}

/* ---- Taken apart */

int msri_splitting_drifts(const msr_integrator *integrator) {
  return integrator->step == step ? ((const splitting *)integrator->coefficients)->drifts : 0;
}

msri_joint msri_splitting_joint(const msr_integrator *integrator, int j) {
  return joint_of(integrator->coefficients, j);
}

double msri_splitting_drift(const msr_integrator *integrator, int j) {
  return drift_of(integrator->coefficients, j);
}

/* ---- Coefficients; of symmetric rows, those before the middle */

static const double euler_drift[] = {1}, euler_kick[] = {1, 0};
static const double pefrl_drift[] = {0.1786178958448091, -0.06626458266981849};
static const double pefrl_kick[] = {0, 0.5 + 0.2123418310626054};
static const double srkn4_drift[] = {0.245298957184271, 0.604872665711080};
static const double srkn4_kick[] = {0.0829844064174052, 0.396309801498368, -0.0390563049223486};
static const double srkn6_drift[] = {0.123229775946271, 0.290553797799558, -0.127049212625417,
                                     -0.246331761062075, 0.357208872795928};
static const double srkn6_kick[] = {0.0414649985182624, 0.198128671918067, -0.0400061921041533,
                                    0.0752539843015807, -0.0115113874206879};
static const double kahan_li_6_drift[] = {0.39216144400731413928, 0.33259913678935943860,
                                          -0.70624617255763935981, 0.08221359629355080023};
static const double kahan_li_8_drift[] = {0.13020248308889008088,  0.56116298177510838456,
                                          -0.38947496264484728641, 0.15884190655515560090,
                                          -0.39590389413323757734, 0.18453964097831570709,
                                          0.25837438768632204729,  0.29501172360931029887};

static const splitting symplectic_euler = {1, false, euler_drift, euler_kick};
static const splitting verlet = {1, true, NULL, NULL};
static const splitting pefrl = {5, true, pefrl_drift, pefrl_kick};
static const splitting srkn4 = {6, true, srkn4_drift, srkn4_kick};
static const splitting srkn6 = {11, true, srkn6_drift, srkn6_kick};
static const splitting kahan_li_6 = {9, true, kahan_li_6_drift, NULL};
static const splitting kahan_li_8 = {17, true, kahan_li_8_drift, NULL};

/* ---- The methods */

const msr_integrator msr_integrator_symplectic_euler = {
    .name = "symplectic-euler",
    .summary = "kick, then drift: the assignment's five steps",
    .reference = "Euler; de Vogelaere 1956",
    .order = 1,
    .symplectic = true,
    .splits = true,
    .bounces = true,
    .evaluations = 1,
    .stability = 2,
    .damping_stability = (double)INFINITY,
    .vectors = 1,
    .begin = begin,
    .step = step,
    .coefficients = &symplectic_euler,
};

const msr_integrator msr_integrator_verlet = {
    .name = "verlet",
    .summary = "velocity Verlet: half kick, drift, half kick",
    .reference = "Verlet 1967, Phys. Rev. 159, 98; Swope et al. 1982",
    .order = 2,
    .symplectic = true,
    .reversible = true,
    .splits = true,
    .bounces = true,
    .evaluations = 1,
    .stability = 2,
    .damping_stability = (double)INFINITY,
    .vectors = 1,
    .begin = begin,
    .step = step,
    .coefficients = &verlet,
};

const msr_integrator msr_integrator_pefrl = {
    .name = "pefrl",
    .summary = "5 drifts and 4 kicks: small errors at few evaluations",
    .reference = "Omelyan, Mryglod & Folk 2002, Comput. Phys. Commun. 146, 188",
    .order = 4,
    .damped_order = 2,
    .symplectic = true,
    .reversible = true,
    .splits = true,
    .evaluations = 4,
    .stability = 2.989449545907,
    .damping_stability = (double)INFINITY,
    .vectors = 1,
    .begin = begin,
    .step = step,
    .coefficients = &pefrl,
};

const msr_integrator msr_integrator_srkn4 = {
    .name = "srkn4",
    .summary = "Runge-Kutta-Nystrom splitting of 6 stages, S6",
    .reference = "Blanes & Moan 2002, J. Comput. Appl. Math. 142, 313",
    .order = 4,
    .damped_order = 2,
    .symplectic = true,
    .reversible = true,
    .splits = true,
    .evaluations = 6,
    .stability = 3.163465066580,
    .damping_stability = (double)INFINITY,
    .vectors = 1,
    .begin = begin,
    .step = step,
    .coefficients = &srkn4,
};

const msr_integrator msr_integrator_srkn6 = {
    .name = "srkn6",
    .summary = "Runge-Kutta-Nystrom splitting of 11 stages, S11",
    .reference = "Blanes & Moan 2002, J. Comput. Appl. Math. 142, 313",
    .order = 6,
    .damped_order = 2,
    .symplectic = true,
    .reversible = true,
    .splits = true,
    .evaluations = 11,
    .stability = 3.141431087865,
    .damping_stability = (double)INFINITY,
    .vectors = 1,
    .begin = begin,
    .step = step,
    .coefficients = &srkn6,
};

const msr_integrator msr_integrator_kahan_li_6 = {
    .name = "kahan-li-6",
    .summary = "composition of 9 Verlet steps, damped likewise",
    .reference = "Kahan & Li 1997, Math. Comp. 66, 1089",
    .order = 6,
    .symplectic = true,
    .reversible = true,
    .splits = true,
    .evaluations = 9,
    .stability = 2.532627388334,
    .damping_stability = 5, /* alone 15; springs in turn: chains explode from 5.9 on */
    .vectors = 1,
    .begin = begin,
    .step = step,
    .coefficients = &kahan_li_6,
};

const msr_integrator msr_integrator_kahan_li_8 = {
    .name = "kahan-li-8",
    .summary = "composition of 17 Verlet steps, damped likewise",
    .reference = "Kahan & Li 1997, Math. Comp. 66, 1089",
    .order = 8,
    .symplectic = true,
    .reversible = true,
    .splits = true,
    .evaluations = 17,
    .stability = 3.096438680003,
    .damping_stability = 7, /* alone 9.6; springs in turn: chains explode from 8.1 on */
    .vectors = 1,
    .begin = begin,
    .step = step,
    .coefficients = &kahan_li_8,
};
