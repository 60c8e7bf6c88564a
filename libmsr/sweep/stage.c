/* stage.c - see stage.h. Forces come first in a stage, so that no acceleration is kept from one to
 * the next: the last half kick of a step and the first of the next use the same. The steps of a
 * course end with a stage without a drift. */
#include "sweep/stage.h"

#include "integrators/splitting.h"

/* The joints of a stage: the end of a step, the beginning or the inside of another. */
typedef struct joints {
  int n;
  msri_joint at[2];
} joints;

static int drifts_of(const msri_course *c) {
  return msri_splitting_drifts(c->plan->figures.integrator);
}

static bool acts(const msri_joint *j) {
  return j->kick_before != 0 || j->kick_after != 0 || j->damp_back != 0 || j->damp_forward != 0;
}

uint64_t msri_course_stages(const msri_course *c) {
  const msri_joint end = msri_splitting_joint(c->plan->figures.integrator, drifts_of(c));
  const bool ends = acts(&end) || msri_plan_settles(c->plan);
  return c->steps * (uint64_t)drifts_of(c) + ends;
}

static joints joints_of(const msri_course *c, uint64_t k) {
  const msr_integrator *integrator = c->plan->figures.integrator;
  const int drifts = drifts_of(c), j = (int)(k % (uint64_t)drifts);
  const msri_joint end = msri_splitting_joint(integrator, drifts);
  joints at = {0};
  if (j == 0 && k > 0 && acts(&end)) at.at[at.n++] = end;
  if (k < c->steps * (uint64_t)drifts) at.at[at.n++] = msri_splitting_joint(integrator, j);
  return at;
}

/* The time of a stage, as a step by itself would have it. */
static double time_of(const msri_course *c, uint64_t k) {
  const msr_plan_figures *f = &c->plan->figures;
  const uint64_t drifts = (uint64_t)drifts_of(c), substep = c->substep + k / drifts;
  const uint64_t iteration = c->iteration + substep / f->substeps;
  const double t = msri_plan_time(f, iteration, substep % f->substeps);
  double share = 0;
  for (uint64_t j = 0; j < k % drifts; j++) share += msri_splitting_drift(f->integrator, (int)j);
  return share == 0 ? t : t + share * f->h;
}

/* A half flow over `share` of a step, in the air there is at time t. */
static void damp(const msri_course *c, double t, double share, const msri_swept *state, double *air,
                 double *keep) {
  const msr_view s = msri_plan_view(c->plan, t, NULL, NULL);
  *keep = 1;
  for (size_t i = 0; i < c->plan->n_terms && share != 0; i++) {
    const msri_term *term = &c->plan->term[i];
    if (!term->force->relax) continue;
    *keep = term->force->relax(term->self, state->scratch + term->scratch, &s,
                               share * c->plan->figures.h, air);
    state->calls[i]++;
  }
}

/* Forces that are the same on each mass, and a call of all that don't depend on velocity. */
static void weigh(const msri_course *c, const msri_swept *state, double *weight) {
  const msr_view s = msri_plan_view(c->plan, 0, NULL, NULL);
  for (size_t i = 0; i < c->plan->n_terms; i++) {
    const msri_term *term = &c->plan->term[i];
    if (term->force->relax) continue;
    if (term->force->uniform) term->force->uniform(term->self, &s, weight);
    state->calls[i]++;
  }
}

static void set_kicks(const joints *at, bool damped, double h, double *kick) {
  for (int n = 0; n < at->n && !damped; n++)
    kick[n] = (at->at[n].kick_before + at->at[n].kick_after) * h;
  if (!damped) return;
  kick[0] = at->at[0].kick_before * h;
  kick[1] = at->at[at->n - 1].kick_after * h;
}

/* Air is between kicks, and debts are paid by accelerations, even if these kick nothing. */
static bool evaluates(const msr_plan *plan, const double *kick) {
  return kick[0] != 0 || kick[1] != 0 || msri_plan_damps(plan) || msri_plan_settles(plan);
}

int msri_course_evaluations(const msr_plan *plan) {
  const msri_course two = {.plan = plan, .steps = 2};
  const int drifts = drifts_of(&two);
  int n = 0;
  for (int j = 0; j < drifts; j++) {
    const joints at = joints_of(&two, (uint64_t)(drifts + j));
    double kick[2] = {0};
    set_kicks(&at, msri_plan_damps(plan), 1, kick);
    n += evaluates(plan, kick);
  }
  return n;
}

msri_stage msri_course_stage(const msri_course *c, uint64_t k, const msri_swept *state) {
  const joints at = joints_of(c, k);
  const bool damped = msri_plan_damps(c->plan);
  const double h = c->plan->figures.h, t = time_of(c, k);
  const uint64_t drifts = (uint64_t)drifts_of(c);
  msri_stage stage = {0};
  msri_motion *m = &stage.motion;
  m->k = c->plan->mesh.lattice_k;
  for (int side = 0; side < 2; side++) m->L[side] = c->plan->mesh.lattice_L[side];
  m->w = 1 / c->plan->uniform_mass;
  if (at.n > 0) set_kicks(&at, damped, h, m->kick);
  stage.forces = evaluates(c->plan, m->kick);
  if (stage.forces) weigh(c, state, m->weight);
  m->keep[0] = m->keep[1] = 1;
  if (damped && at.n > 0) {
    damp(c, t, at.at[0].damp_back, state, m->air[0], &m->keep[0]);
    damp(c, t, at.at[at.n - 1].damp_forward, state, m->air[1], &m->keep[1]);
  }
  if (k < c->steps * drifts)
    m->drift = msri_splitting_drift(c->plan->figures.integrator, (int)(k % drifts)) * h;
  const size_t first = c->plan->n_terms;
  for (size_t e = first; e < first + c->plan->n_contacts && m->drift != 0; e++) state->calls[e]++;
  return stage;
}
