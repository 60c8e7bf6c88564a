/* stage.c - see stage.h. Forces come first in a stage, so that no acceleration is kept from one to
 * the next: the last half kick of a step and the first of the next use the same. The steps of a
 * course end with a stage without a drift. */
#include "sweep/stage.h"

#include <string.h>

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

/* Of drift j of a step, if there is one before, or none any more. */
static joints joints_of(const msri_course *c, uint64_t step, int j) {
  const msr_integrator *integrator = c->plan->figures.integrator;
  const msri_joint end = msri_splitting_joint(integrator, drifts_of(c));
  joints at = {0};
  if (j == 0 && step > 0 && acts(&end)) at.at[at.n++] = end;
  if (step < c->steps) at.at[at.n++] = msri_splitting_joint(integrator, j);
  return at;
}

/* The time before drift j of a step, as a step by itself would have it. */
static double time_of(const msri_course *c, uint64_t step, int j) {
  const msr_plan_figures *f = &c->plan->figures;
  const uint64_t substep = c->substep + step, iteration = c->iteration + substep / f->substeps;
  const double t = msri_plan_time(f, iteration, substep % f->substeps);
  double share = 0;
  for (int before = 0; before < j; before++) share += msri_splitting_drift(f->integrator, before);
  return share == 0 ? t : t + share * f->h;
}

/* The term of the air; n_terms: there is none. */
static size_t air_of(const msr_plan *plan) {
  size_t n = 0;
  while (n < plan->n_terms && !plan->term[n].force->relax) n++;
  return n;
}

/* The half flows in the air there is at time t; where there is none, adding -0 changes nothing. */
static void relax(const msri_course *c, double t, const msri_swept *state, msri_motion *m) {
  const msri_still *still = state->still;
  const msri_term *air = &c->plan->term[still->air];
  const double share[2] = {still->joint.damp_back, still->joint.damp_forward};
  const msr_view s = msri_plan_view(c->plan, t, NULL, NULL);
  for (int n = 0; n < 2; n++) {
    if (share[n] == 0) continue;
    if (n > 0 && share[n] == share[0]) { // the same air for the same time
      m->keep[n] = m->keep[0];
      memcpy(m->push[n], m->push[0], sizeof m->push[n]);
    } else {
      m->keep[n] = air->force->relax(air->self, state->scratch + air->scratch, &s,
                                     share[n] * c->plan->figures.h, m->push[n]);
    }
    state->calls[still->air]++;
    m->relaxes = true;
    m->pushes |= m->push[n][0] != 0 || m->push[n][1] != 0;
  }
}

/* Forces that are the same on each mass. */
static void weigh(const msr_plan *plan, double *weight) {
  const msr_view s = msri_plan_view(plan, 0, NULL, NULL);
  for (size_t i = 0; i < plan->n_terms; i++) {
    const msri_term *term = &plan->term[i];
    if (term->force->uniform) term->force->uniform(term->self, &s, weight);
  }
}

/* Two joints in air: of the first what's before the air, of the second what's after. */
static msri_joint in_air(const joints *at) {
  if (at->n == 0) return (msri_joint){0};
  const msri_joint *end = &at->at[0], *begin = &at->at[at->n - 1];
  return (msri_joint){end->kick_before, end->damp_back, begin->damp_forward, begin->kick_after};
}

static void kick(const msr_plan *plan, const joints *at, const msri_joint *joint, double *kick) {
  const bool air = msri_plan_damps(plan);
  for (int n = 0; n < at->n; n++) kick[n] = at->at[n].kick_before + at->at[n].kick_after;
  if (air) kick[0] = joint->kick_before, kick[1] = joint->kick_after;
  for (int n = 0; n < 2; n++) kick[n] *= plan->figures.h;
}

/* Debts are paid by accelerations, even if these kick nothing. */
static bool evaluates(const msr_plan *plan, const joints *at) {
  bool kicks = false;
  for (int n = 0; n < at->n; n++) kicks |= at->at[n].kick_before != 0 || at->at[n].kick_after != 0;
  return kicks || msri_plan_settles(plan);
}

int msri_course_evaluations(const msr_plan *plan) {
  const msri_course two = {.plan = plan, .steps = 2};
  const int drifts = drifts_of(&two);
  int n = 0;
  for (int j = 0; j < drifts; j++) {
    const joints at = joints_of(&two, 1, j);
    n += evaluates(plan, &at);
  }
  return n;
}

static void find_still(const msri_course *c, uint64_t step, int j, msri_still *still) {
  const msr_plan *plan = c->plan;
  const joints at = joints_of(c, step, j);
  msri_motion *m = &still->stage.motion;
  *still = (msri_still){.joint = in_air(&at), .drift = j};
  for (int n = 0; n < 2; n++) m->keep[n] = 1, m->push[n][0] = m->push[n][1] = -0.0;
  still->inside = (step > 0 || j > 0) && step < c->steps;
  still->air = air_of(plan);
  still->stage.forces = evaluates(plan, &at);
  m->k = plan->mesh.lattice_k;
  for (int side = 0; side < 2; side++) m->L[side] = plan->mesh.lattice_L[side];
  m->w = 1 / plan->uniform_mass;
  if (still->stage.forces) weigh(plan, m->weight);
  kick(plan, &at, &still->joint, m->kick);
  if (step < c->steps)
    m->drift = msri_splitting_drift(plan->figures.integrator, j) * plan->figures.h;
}

/* Calls of forces that don't depend on velocity, and of contacts. */
static void count(const msr_plan *plan, const msri_stage *stage, uint64_t *calls) {
  for (size_t i = 0; i < plan->n_terms && stage->forces; i++)
    calls[i] += !plan->term[i].force->relax;
  const size_t first = plan->n_terms;
  for (size_t e = first; e < first + plan->n_contacts && stage->motion.drift != 0; e++) calls[e]++;
}

msri_stage msri_course_stage(const msri_course *c, uint64_t k, const msri_swept *state) {
  const uint64_t drifts = (uint64_t)drifts_of(c), step = k / drifts;
  const int j = (int)(k - step * drifts);
  msri_still *still = state->still;
  const bool inside = k > 0 && step < c->steps;
  if (!(inside && still->inside && still->drift == j)) find_still(c, step, j, still);
  msri_stage stage = still->stage;
  count(c->plan, &stage, state->calls);
  if (still->air < c->plan->n_terms) relax(c, time_of(c, step, j), state, &stage.motion);
  return stage;
}
