/* step.c - steps of an integrator: on any system, and on a state, iteration by iteration.
 * Each step begins at the very time at which the one before ended. */
#include "run/step.h"

#include "run/care.h"
#include "run/guard.h"
#include "run/impacts.h"
#include "run/leap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { A_MOMENT = 100000000 }; /* masses times steps: tenths of a second */

typedef struct course {
  double t, h;
  uint64_t steps;
} course;

static msr_status go(const msr_integrator *integrator, const msr_system *system, const course *c,
                     double *q, double *v, msr_workspace *work, msr_error *err) {
  msr_status status = MSR_OK;
  if (integrator->begin) status = integrator->begin(integrator, system, c->t, q, v, work);
  for (uint64_t s = 0; s < c->steps && status == MSR_OK; s++) {
    const double t = c->t + (double)s * c->h, end = c->t + (double)(s + 1) * c->h;
    status = integrator->step(integrator, system, &(msr_interval){t, c->h, end}, q, v, work, err);
  }
  return status;
}

msr_status msr_integrate(const msr_integrator *integrator, const msr_system *system, double t,
                         double h, uint64_t steps, double *q, double *v, msr_error *err) {
  msr_workspace work = {0};
  msr_error said = {MSR_OK, ""};
  if (!isfinite(t) || !isfinite(h))
    return msri_fail(err, MSR_EUSAGE, "%s: t is %g and h %g; both must be finite", integrator->name,
                     t, h);
  if (h == 0) steps = 0;
  work.vector =
      msri_alloc(integrator->vectors * system->n, sizeof *work.vector, "an integrator", err);
  if (!work.vector) return MSR_ENOMEM;
  msr_status status = MSR_OK;
  if (integrator->open) status = integrator->open(integrator, system, &work.object, &said);
  if (status == MSR_OK) {
    status = go(integrator, system, &(course){t, h, steps}, q, v, &work, &said);
    if (integrator->close) integrator->close(work.object);
  }
  free(work.vector);
  if (status == MSR_OK) return MSR_OK;
  return msri_hand_on(err, status, &said, "%s: %s", integrator->name, msr_status_text(status));
}

static msr_status begin(msr_state *state, const msr_system *system, double t) {
  const msr_integrator *integrator = state->plan->figures.integrator;
  if (state->fresh || !integrator->begin) return MSR_OK;
  const msr_status status =
      integrator->begin(integrator, system, t, state->q, state->v, &state->work);
  state->fresh = status == MSR_OK;
  return status;
}

msr_status msri_step_once(msr_state *state, const msr_system *system, const msr_interval *interval,
                          msr_error *err) {
  const msr_integrator *integrator = state->plan->figures.integrator;
  const msr_status status = begin(state, system, interval->t);
  if (status != MSR_OK) return status;
  if (!integrator->adaptive) state->work.steps++;
  state->end = interval->end;
  state->meter.calls[state->plan->row.integrator]++;
  return integrator->step(integrator, system, interval, state->q, state->v, &state->work, err);
}

/* A step as if nothing were in the way, then what was. */
static msr_status step_and_bounce(msr_state *state, const msr_system *system,
                                  const msr_interval *interval, msr_error *err) {
  msri_state_keep(state, state->before);
  const msr_status status = msri_step_once(state, system, interval, err);
  return status == MSR_OK ? msri_bounce(state, interval->h) : status;
}

/* Who sees to what is in the way? */
static msr_status step(msr_state *state, const msr_system *system, const msr_interval *interval,
                       msr_error *err) {
  if (!msri_plan_bounces(state->plan)) return msri_step_once(state, system, interval, err);
  return msri_plan_ends_at_impacts(state->plan) ? msri_step_by_impacts(state, system, interval, err)
                                                : step_and_bounce(state, system, interval, err);
}

/* One substep. */
static msr_status substep(msr_state *state, const msr_system *system, const msri_poll *poll,
                          msr_error *err) {
  const msr_plan_figures *f = &state->plan->figures;
  const msr_interval interval = {msri_state_time(state), f->h,
                                 msri_plan_time(f, state->iteration, state->substep + 1)};
  msr_status status = msri_poll_call(poll, state);
  if (status == MSR_OK) status = step(state, system, &interval, err);
  if (status != MSR_OK) return status;
  state->substep++;
  return msri_guard_follow(state, f->h);
}

static void end_iteration(msr_state *state) {
  if (state->substep < state->plan->figures.substeps) return;
  state->substep = 0;
  state->iteration++;
}

/* A leap, or a substep; the last of an iteration ends it. */
static msr_status advance(msr_state *state, const msr_system *system, const msri_poll *poll,
                          msr_error *err) {
  const uint64_t before = state->substep;
  msr_status status = msri_leaps(state) ? msri_leap(state, system, poll) : MSR_OK;
  if (status == MSR_OK && state->substep == before) status = substep(state, system, poll, err);
  if (status == MSR_OK) end_iteration(state);
  return status;
}

/* ---- Sweeps */

static uint64_t least(uint64_t a, uint64_t b) { return a < b ? a : b; }

/* As many steps as there are up to the end of an iteration or the next look, or as take a moment.
 */
static uint64_t steps_to(const msr_state *state, uint64_t end, const msri_poll *poll) {
  const uint64_t substeps = state->plan->figures.substeps, iterations = end - state->iteration;
  const uint64_t all = iterations > UINT64_MAX / substeps ? UINT64_MAX : iterations * substeps;
  const uint64_t takes = 1 + A_MOMENT / (state->plan->figures.masses + 1);
  const uint64_t moment = poll->call && poll->most > 0 ? least(takes, poll->most) : takes;
  const uint64_t look = least(msri_guard_patience(state), msri_care_patience(state));
  return least(least(all - state->substep, moment), look);
}

/* Takes note of steps that were taken. What a force returns. */
static msr_status follow(msr_state *state, uint64_t steps) {
  msr_status status = MSR_OK;
  for (; steps > 0 && status == MSR_OK; steps--) {
    state->substep++;
    status = msri_guard_follow(state, state->plan->figures.h);
    end_iteration(state);
  }
  return status;
}

static msri_progress sweep_timed(msr_state *state, const msri_swept *swept, msri_course ahead,
                                 double most) {
  msri_meter *m = &state->meter;
  const size_t integrator = state->plan->row.integrator;
  msri_meter_turn(m, integrator);
  const double before = m->seconds ? m->seconds[integrator] : 0;
  const msri_progress progress = msri_sweep_run(state->sweep, swept, ahead, most, state->fresh);
  state->fresh = progress.known;
  msri_meter_turn(m, integrator);
  if (m->seconds) msri_sweep_split(state->sweep, m->seconds[integrator] - before, m->seconds);
  return progress;
}

static msr_status sweep(msr_state *state, uint64_t end, const msri_poll *poll, bool *fast) {
  const size_t n = state->plan->figures.masses;
  const double most = sqrt(2 * state->guard.most / state->plan->uniform_mass);
  msri_still still = {0};
  const msri_swept swept = {state->q,       state->q + n,       state->v,    state->v + n,
                            state->scratch, state->meter.calls, state->rows, &still};
  const msri_course ahead = {state->plan, state->iteration, state->substep,
                             steps_to(state, end, poll)};
  msr_status status = msri_poll_call(poll, state);
  if (status != MSR_OK) return status;
  const msri_progress progress = sweep_timed(state, &swept, ahead, most);
  state->work.steps += progress.steps;
  state->meter.calls[state->plan->row.integrator] += progress.steps;
  state->evaluations += progress.evaluations;
  state->contacts += progress.met;
  *fast = progress.fast;
  return follow(state, progress.steps);
}

/* ---- Iterations */

static bool sweeps(const msr_state *state) { return state->sweep && !state->care.on; }

/* Which iteration a status stopped, and why: what the integrator said, or which force it was. */
static msr_status explain(const msr_state *state, msr_status status, const msr_error *said,
                          msr_error *err) {
  const bool told = said->message[0] != '\0', force = !told && state->failed;
  return msri_fail(err, status, "iteration %llu: %s%s%s", (unsigned long long)state->iteration,
                   force ? state->failed->name : "", force ? ": " : "",
                   told ? said->message : msr_status_text(status));
}

static msr_status advance_by(msr_state *state, uint64_t iterations, const msri_poll *poll,
                             msr_error *err) {
  const uint64_t left = UINT64_MAX - state->iteration;
  const uint64_t end = state->iteration + (iterations < left ? iterations : left);
  state->failed = NULL;
  msr_status status = msri_guard_begin(state, err);
  if (status == MSR_OK) status = msri_care_begin(state, err);
  msr_system system = msri_state_system(state);
  while (status == MSR_OK && state->iteration < end) {
    msr_error said = {MSR_OK, ""};
    bool fast = false;
    status = sweeps(state) ? sweep(state, end, poll, &fast) : advance(state, &system, poll, &said);
    if (status != MSR_OK) return explain(state, status, &said, err);
    const msr_status verdict = msri_guard_watch(state, fast, &said);
    bool turned = false;
    status = msri_care_watch(state, verdict == MSR_EUNSTABLE, &turned, err);
    if (turned) system = msri_state_system(state);
    if (status == MSR_OK && !turned && verdict != MSR_OK)
      return msri_fail(err, verdict, "%s", said.message);
  }
  return status;
}

/* What no effect says it's its own is the integrator's. */
msr_status msri_step(msr_state *state, uint64_t iterations, const msri_poll *poll, msr_error *err) {
  const size_t was = msri_meter_turn(&state->meter, state->plan->row.integrator);
  const msr_status status = advance_by(state, iterations, poll, err);
  msri_meter_turn(&state->meter, was);
  return status;
}

msr_status msr_state_step(msr_state *state, uint64_t iterations, msr_error *err) {
  return msri_step(state, iterations, &(msri_poll){NULL, NULL, 0}, err);
}
