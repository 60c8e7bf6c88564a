/* state.c - making, copying, hashing and reading states. */
#include "plan/state.h"

#include "forces/mesh.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* ---- Memory */

/* Of the arrays: a line of the cache and the widest vector, else loads straddle two lines. */
enum { ALIGNMENT = 64 };

/* Where arrays for implicit steps lie; and, if they are of a state that sweeps else, what steps of
 * the plan's own method take that aren't swept. */
typedef struct room {
  size_t solver, between, before_leap, leap, work, ahead, armed;
  bool own;
} room;

/* Where each array lies after the block's first aligned byte; `end` is after the last. */
typedef struct layout {
  room room;
  size_t q, v, work, before, ahead, armed, middle, drive, discs, scratch, calls, seconds, kept, end;
} layout;

static size_t reserve(size_t *end, size_t bytes) {
  const size_t begin = *end;
  *end = msri_round_up(begin + bytes, ALIGNMENT);
  return begin;
}

/* Bytes of what an integrator keeps, and supports. */
static size_t work_bytes(const msr_plan *plan) {
  const size_t vectors = plan->figures.integrator->vectors;
  return (vectors > 0 ? vectors : 1) * 2 * plan->figures.masses * sizeof(double);
}

static size_t ahead_bytes(const msr_plan *plan) {
  return msri_plan_settles(plan) ? 2 * plan->figures.masses * sizeof(double) : 0;
}

static size_t armed_bytes(const msr_plan *plan) {
  if (!msri_plan_arms(plan)) return 0;
  return msri_flock_blocks(plan->figures.masses) * sizeof(msri_armed);
}

static size_t rows_bytes(const msr_plan *plan) {
  if (!msri_plan_arms(plan)) return 0;
  return (plan->objects.n_rows + plan->objects.n_blocks) * sizeof(double);
}

/* The matrix if there is a graph, and what steps take that aren't the plan's own if it `leaps`. */
static room lay_out_room(const msr_plan *plan, const msri_graph *graph, bool leaps, size_t *end) {
  const size_t vector = 2 * plan->figures.masses * sizeof(double);
  const size_t anchors = plan->mesh.springs.n_anchors;
  room r;
  r.solver = reserve(end, graph ? msri_stiffness_bytes(graph, anchors, plan->m != NULL) : 0);
  r.between = reserve(end, leaps || plan->middle ? 2 * vector : 0);
  r.before_leap = reserve(end, leaps ? 2 * vector : 0);
  r.leap = reserve(end, leaps ? msr_integrator_energy_momentum.vectors * vector : 0);
  r.own = leaps && msri_plan_sweeps(plan);
  r.work = reserve(end, r.own ? work_bytes(plan) : 0);
  r.ahead = reserve(end, r.own ? ahead_bytes(plan) : 0);
  r.armed = reserve(end, r.own ? armed_bytes(plan) : 0);
  return r;
}

static void place_room(msr_state *state, const room *r, const msri_graph *graph, char *arrays) {
  const msr_view now = msr_state_view(state);
  state->between = (void *)(arrays + r->between);
  state->leap.before = (void *)(arrays + r->before_leap);
  state->leap.vector = (void *)(arrays + r->leap);
  if (graph) state->stiffness = msri_stiffness_place(graph, &now, arrays + r->solver);
  if (!r->own) return;
  state->work.vector = (void *)(arrays + r->work);
  state->ahead = (void *)(arrays + r->ahead);
  state->armed = (void *)(arrays + r->armed);
}

static layout lay_out(const msr_plan *plan) {
  const size_t vector = 2 * plan->figures.masses * sizeof(double);
  const bool sweeps = msri_plan_sweeps(plan);
  layout l;
  size_t end = 0;
  reserve(&end, sizeof(msr_state));
  l.room = lay_out_room(plan, plan->graph, plan->figures.leaps, &end);
  l.q = reserve(&end, vector);
  l.v = reserve(&end, vector);
  l.work = reserve(&end, sweeps ? 0 : work_bytes(plan));
  l.before = reserve(&end, msri_plan_bounces(plan) ? 2 * vector : 0);
  l.ahead = reserve(&end, sweeps ? 0 : ahead_bytes(plan));
  l.armed = reserve(&end, sweeps ? rows_bytes(plan) : armed_bytes(plan));
  l.middle = reserve(&end, plan->midpoint ? 2 * vector : 0);
  l.drive = reserve(&end, plan->followed ? vector : 0);
  l.discs = reserve(&end, plan->discs ? msri_discs_room(plan->discs) : 0);
  l.scratch = reserve(&end, plan->scratch_bytes);
  l.kept = reserve(&end, plan->cares ? 2 * vector : 0);
  l.calls = reserve(&end, (plan->n_effects + 1) * sizeof(uint64_t));
  l.seconds = reserve(&end, plan->timed ? (plan->n_effects + 1) * sizeof(double) : 0);
  l.end = end;
  return l;
}

static size_t block_bytes(const layout *l) { return l->end + ALIGNMENT; }

size_t msri_state_bytes(const msr_plan *plan) {
  const layout l = lay_out(plan);
  return block_bytes(&l) + (msri_plan_sweeps(plan) ? msri_sweep_bytes(plan) : 0);
}

static char *first_aligned(char *block) {
  return block + (ALIGNMENT - (uintptr_t)block % ALIGNMENT) % ALIGNMENT;
}

static msr_status open_integrator(msr_state *state, msr_error *err) {
  const msr_integrator *integrator = state->plan->figures.integrator;
  const msr_system system = msri_state_system(state);
  return integrator->open ? integrator->open(integrator, &system, &state->work.object, err)
                          : MSR_OK;
}

msr_status msr_state_create(const msr_plan *plan, msr_state **state, msr_error *err) {
  const layout l = lay_out(plan);
  const bool sweeps = msri_plan_sweeps(plan);
  char *block = msri_alloc(1, block_bytes(&l), "a state", err);
  if (!block) return MSR_ENOMEM;
  char *arrays = first_aligned(block);
  msr_state *made = (void *)block;
  *made = (msr_state){
      .plan = plan,
      .q = (void *)(arrays + l.q),
      .v = (void *)(arrays + l.v),
      .work = {.vector = sweeps ? NULL : (void *)(arrays + l.work)},
      .before = (void *)(arrays + l.before),
      .ahead = sweeps ? NULL : (void *)(arrays + l.ahead),
      .armed = sweeps ? NULL : (void *)(arrays + l.armed),
      .rows = {(void *)(arrays + l.armed),
               (void *)(arrays + l.armed + plan->objects.n_rows * sizeof(double))},
      .care = {.kept = (void *)(arrays + l.kept)},
      .middle = (void *)(arrays + l.middle),
      .drive = (void *)(arrays + l.drive),
      .discs = arrays + l.discs,
      .scratch = arrays + l.scratch,
      .meter = {.calls = (void *)(arrays + l.calls),
                .seconds = plan->timed ? (void *)(arrays + l.seconds) : NULL,
                .effect = plan->n_effects},
  };
  const size_t n = plan->figures.masses;
  msri_plan_start(plan, made->q, made->q + n, made->v, made->v + n);
  place_room(made, &l.room, plan->graph, arrays);
  msr_status status = sweeps ? msri_sweep_create(plan, &made->sweep, err) : MSR_OK;
  if (status == MSR_OK) status = open_integrator(made, err);
  if (status == MSR_OK) {
    *state = made;
    return MSR_OK;
  }
  msri_sweep_free(made->sweep);
  free(made);
  return status;
}

msr_status msri_state_make_room(msr_state *state, msr_error *err) {
  const msr_plan *plan = state->plan;
  msri_care *care = &state->care;
  if (plan->graph || care->memory) return MSR_OK;
  if (!care->graph) { /* else what came after it has failed before */
    const msr_status status =
        msri_graph_create(plan->figures.masses, &plan->mesh.springs, &care->graph, err);
    if (status != MSR_OK) return status;
  }
  size_t end = 0;
  const room r = lay_out_room(plan, care->graph, true, &end);
  care->memory = msri_alloc(1, end + ALIGNMENT, "steps with care", err);
  if (!care->memory) return MSR_ENOMEM;
  place_room(state, &r, care->graph, first_aligned(care->memory));
  return MSR_OK;
}

void msr_state_free(msr_state *state) {
  if (!state) return;
  const msr_integrator *integrator = state->plan->figures.integrator;
  if (integrator->close) integrator->close(state->work.object);
  msri_sweep_free(state->sweep);
  msri_debts_clear(&state->debts);
  free(state->care.memory);
  free(state->care.graph);
  free(state);
}

void msr_state_copy(msr_state *to, const msr_state *from) {
  assert(to->plan == from->plan);
  const layout l = lay_out(from->plan);
  to->iteration = from->iteration;
  to->substep = from->substep;
  to->fresh = from->fresh && !from->plan->figures.integrator->remembers;
  to->known.q = NULL;
  to->contacts = from->contacts;
  to->evaluations = from->evaluations;
  to->work.steps = from->work.steps;
  to->leap.leaps = from->leap.leaps;
  to->leap.leapt = from->leap.leapt;
  to->frames = from->frames;
  to->guard = from->guard;
  to->care.begun = from->care.begun;
  to->care.on = from->care.on;
  to->care.at = from->care.at;
  to->care.substep = from->care.substep;
  to->care.guard = from->care.guard;
  to->care.lost = from->care.lost;
  memcpy(to->q, from->q, l.end - l.q);
  if (to->sweep) msri_sweep_wake(to->sweep);
}

void msri_state_keep(const msr_state *state, double *kept) {
  const size_t n = 2 * state->plan->figures.masses;
  memcpy(kept, state->q, n * sizeof *kept);
  memcpy(kept + n, state->v, n * sizeof *kept);
}

/* q may be elsewhere than where the last drift left it. */
static void moved(msr_state *state) {
  state->fresh = false;
  state->known.q = NULL;
  if (state->plan->discs) msri_discs_moved(state->plan->discs, state->discs);
  if (state->sweep) msri_sweep_wake(state->sweep);
}

void msri_state_put_back(msr_state *state, const double *kept) {
  const size_t n = 2 * state->plan->figures.masses;
  memcpy(state->q, kept, n * sizeof *kept);
  memcpy(state->v, kept + n, n * sizeof *kept);
  moved(state);
  msri_state_disarm(state);
}

void msri_state_disarm(msr_state *state) {
  if (state->armed) memset(state->armed, 0, armed_bytes(state->plan));
  if (state->sweep) memset(state->rows.gone, 0, rows_bytes(state->plan));
}

void msri_state_touched(msr_state *state) {
  moved(state);
  state->guard.begun = state->care.begun = state->care.on = false;
  msri_state_disarm(state);
}

/* ---- Reading */

uint64_t msri_hash_words(uint64_t hash, const void *words, size_t n) {
  for (size_t i = 0; i < n; i++) {
    uint64_t word;
    memcpy(&word, (const char *)words + i * sizeof word, sizeof word);
    hash = msri_hash(hash, word);
  }
  return hash;
}

uint64_t msr_state_hash(const msr_state *state) {
  const size_t n = state->plan->figures.masses;
  const double t = msri_state_time(state);
  uint64_t hash = msri_hash_words(MSRI_HASH_START, &t, 1);
  hash = msri_hash_words(hash, state->q, 2 * n);
  return msri_hash_words(hash, state->v, 2 * n);
}

msr_view msr_state_view(const msr_state *state) {
  return msri_plan_view(state->plan, msri_state_time(state), state->q, state->v);
}

msr_arrays msr_state_edit(msr_state *state) {
  const size_t n = state->plan->figures.masses;
  msri_state_touched(state);
  return (msr_arrays){state->q, state->q + n, state->v, state->v + n};
}

uint64_t msr_state_iteration(const msr_state *state) { return state->iteration; }

uint64_t msr_state_contacts(const msr_state *state) { return state->contacts; }

size_t msr_state_resting(const msr_state *state) {
  return state->sweep ? msri_sweep_resting(state->sweep) : 0;
}

msr_work msr_state_work(const msr_state *state) {
  return (msr_work){.steps = state->work.steps,
                    .evaluations = state->evaluations,
                    .leaps = state->leap.leaps,
                    .leapt = state->leap.leapt,
                    .careful = state->care.on ? state->care.at : UINT64_MAX};
}

uint64_t msr_state_calls(const msr_state *state, size_t effect) {
  return effect < state->plan->n_effects ? state->meter.calls[effect] : 0;
}

double msr_state_seconds(const msr_state *state, size_t effect) {
  const msri_meter *meter = &state->meter;
  return meter->seconds && effect < state->plan->n_effects ? meter->seconds[effect] : 0;
}

/* ---- Energy */

msr_energy msri_state_energies(const msr_state *state) {
  const msr_view s = msr_state_view(state);
  msr_energy e = {.kinetic = msri_kinetic(&s)};
  e.total = e.kinetic;
  for (size_t i = 0; i < state->plan->n_terms; i++) {
    const msri_term *term = &state->plan->term[i];
    const double potential = term->force->energy ? term->force->energy(term->self, &s) : 0;
    e.total += potential;
    if (term->force == &msr_force_springs) e.spring += potential;
    if (term->force == &msr_force_gravity) e.gravity += potential;
  }
  return e;
}

msr_energy msr_state_energy(const msr_state *state) {
  const msr_view s = msr_state_view(state);
  msr_energy e = msri_state_energies(state);
  e.longest = msri_mesh_longest(&s);
  for (size_t i = 0; i < s.n; i++) {
    e.px += msr_view_mass(&s, i) * s.vx[i];
    e.py += msr_view_mass(&s, i) * s.vy[i];
  }
  return e;
}
