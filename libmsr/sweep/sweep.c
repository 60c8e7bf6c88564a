/* sweep.c - passes of several stages over all objects: a small one goes through all stages of a
 * pass by itself, by one thread; large ones go row by row, by all threads together, as does a mesh
 * that a program built, band by band. */
#include "sweep/sweep.h"

#include "base/pixel.h"
#include "integrators/splitting.h"
#include "sweep/bands.h"
#include "sweep/deal.h"
#include "sweep/patch.h"
#include "sweep/rest.h"
#include "sweep/rows.h"
#include "sweep/shares.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 64 }; /* of the cache, and the widest vector */

/* One thread's; on lines of the cache of its own. */
typedef struct worker {
  _Alignas(LINE) double *patch, *rows; /* for objects that it has to itself */
  double fastest;
  msri_tally tally;
  uint64_t stays; /* collisions of what the step left as it was */
  unsigned turn;  /* see msri_sweep */
} worker;

struct msri_sweep {
  msri_pass pass;
  msri_team *team; /* NULL: one thread */
  msri_deal deal;
  worker *worker;           /* [threads] */
  double **parts;           /* [threads]: memory of each for its parts of objects */
  _Atomic unsigned *opened; /* [threads]: wedges that each has left to the one above, */
  _Atomic unsigned *closed; /* [threads] and parts that each has done */
  unsigned turn;            /* of objects that were shared so far */
  bool alone;               /* no thread has more than one object: */
  bool filled, kept;        /* small ones stay in their patches from one pass to the next */
  msri_shares shares;       /* if the plan is timed */
  bool rests;               /* objects may be left out: */
  msri_rest rest;
  msri_stage stage[MSRI_MOST_STAGES];
};

/* ---- Memory */

unsigned msri_sweep_threads(const msr_plan *plan) { return msri_deal_of(plan).threads; }

/* Doubles of a thread; of all, to measure shares. */
static size_t own_doubles(const msri_deal *d) { return d->patch + d->rows + d->parts; }

static size_t shares_doubles(const msr_plan *plan) {
  return plan->timed ? msri_shares_size(plan, msri_deal_ways(plan)) : 0;
}

static size_t bytes_of(const msr_plan *plan, const msri_deal *d) {
  const size_t thread = sizeof(worker) + own_doubles(d) * sizeof(double) + sizeof(double *) +
                        2 * sizeof(_Atomic unsigned);
  const size_t rest = plan->objects.n * (sizeof(bool) + 1);
  return sizeof(msri_sweep) + d->threads * thread + shares_doubles(plan) * sizeof(double) + rest +
         2 * LINE;
}

size_t msri_sweep_bytes(const msr_plan *plan) {
  const msri_deal deal = msri_deal_of(plan);
  return bytes_of(plan, &deal);
}

static void place(msri_sweep *s, const msr_plan *plan) {
  const double clock = plan->timed ? msri_shares_clock() : 0;
  const size_t threads = s->deal.threads, own = own_doubles(&s->deal);
  char *at = (char *)(s + 1);
  at += (LINE - (uintptr_t)at % LINE) % LINE;
  s->worker = (void *)at;
  double *doubles = (void *)(s->worker + threads);
  double *shares = doubles + threads * own;
  s->shares.memory = plan->timed ? shares : NULL;
  s->parts = (void *)(shares + shares_doubles(plan));
  s->opened = (void *)(s->parts + threads);
  s->closed = s->opened + threads;
  s->rest.same = (void *)((char *)(s->parts + threads) + 2 * threads * sizeof *s->opened);
  s->rest.how = (void *)(s->rest.same + plan->objects.n);
  for (size_t t = 0; t < threads; t++, doubles += own) {
    s->worker[t].patch = doubles;
    s->worker[t].rows = doubles + s->deal.patch;
    s->parts[t] = s->worker[t].rows + s->deal.rows;
    s->worker[t].tally = (msri_tally){.timed = plan->timed, .clock = clock};
  }
}

static int besides_of(const msr_plan *plan) {
  int besides = 0;
  for (size_t i = 0; i < plan->n_terms; i++)
    besides |= (plan->term[i].force->uniform ? MSRI_WITH_WEIGHT : 0) |
               (plan->term[i].force->relax ? MSRI_WITH_AIR : 0);
  return besides;
}

msr_status msri_sweep_create(const msr_plan *plan, msri_sweep **sweep, msr_error *err) {
  const msri_deal deal = msri_deal_of(plan);
  msri_sweep *made = msri_alloc(1, bytes_of(plan, &deal), "a state", err);
  if (!made) return MSR_ENOMEM;
  made->deal = deal;
  made->alone = plan->objects.n <= deal.threads;
  const msri_lattice_kernel *kernel = msri_lattice_widest();
  made->pass =
      (msri_pass){.plan = plan,
                  .loops = msri_has_diagonals(plan->neighbours) ? &kernel->eight : &kernel->four,
                  .fastest = kernel->fastest,
                  .stage = made->stage,
                  .ways = msri_deal_ways(plan),
                  .besides = besides_of(plan),
                  .meets = msri_plan_meets(plan)};
  place(made, plan);
  made->rests =
      msri_rest_is_known(plan) &&
      msri_course_stages(&(msri_course){.plan = plan, .steps = 1}) <= (uint64_t)deal.depth;
  const msr_status status =
      deal.threads > 1 ? msri_team_create(deal.threads, &made->team, err) : MSR_OK;
  if (status == MSR_OK)
    *sweep = made;
  else
    free(made);
  return status;
}

void msri_sweep_free(msri_sweep *sweep) {
  if (!sweep) return;
  msri_team_free(sweep->team);
  free(sweep);
}

size_t msri_sweep_resting(const msri_sweep *sweep) { return sweep->rest.n; }

void msri_sweep_wake(msri_sweep *sweep) { msri_rest_wake(sweep->pass.plan, &sweep->rest); }

/* ---- Passes */

/* A part for a thread, once the one above needs nothing of what is left of the last. */
static double run_part(msri_sweep *s, const msri_object *object, const msri_part *part,
                       msri_tally *tally) {
  const size_t p = part->number;
  if (p > 0) msri_team_wait(&s->closed[p - 1], part->turn - 1);
  const double fastest = msri_rows_run(&s->pass, object, part, tally);
  atomic_store_explicit(&s->closed[p], part->turn, memory_order_release);
  return fastest;
}

/* The first part works on half a wedge more than its rows, the last one on less. */
static void share_out(const msri_sweep *s, size_t rows, size_t parts, size_t *begin) {
  const size_t more = ((size_t)s->pass.stages - 1) / 2;
  for (size_t p = 0; p <= parts; p++) begin[p] = rows * p / parts - (p > 0 && p < parts ? more : 0);
}

static double run_large(msri_sweep *s, const msri_object *object, unsigned thread, unsigned owner,
                        unsigned *turn) {
  const unsigned parts = msri_deal_parts(s->pass.plan, object, s->deal.depth);
  msri_tally *tally = &s->worker[thread].tally;
  size_t begin[MSRI_MOST_THREADS + 1];
  msri_part part = {.parts = parts, .begin = begin, .opened = s->opened, .memory = s->parts};
  share_out(s, object->rows, parts, begin);
  if (parts == 1) {
    part.memory = &s->worker[thread].rows;
    return thread == owner ? msri_rows_run(&s->pass, object, &part, tally) : 0;
  }
  part.turn = ++*turn;
  part.number = thread;
  if (thread < parts) return run_part(s, object, &part, tally);
  atomic_store_explicit(&s->closed[thread], part.turn, memory_order_release);
  return 0;
}

/* A pass of one step for an object that may be at rest. One thread takes it, a large one the first,
 * whose memory for a part no other looks at. */
static double look_at(msri_sweep *s, size_t n, unsigned thread) {
  const msri_object *object = &s->pass.plan->objects.object[n];
  const msri_group alone = msri_group_of(object, 1);
  const bool small = msri_deal_is_small(s->pass.plan, object);
  worker *me = &s->worker[thread];
  const uint64_t met = me->tally.met;
  const size_t begin[] = {0, object->rows};
  bool *same = &s->rest.same[n];
  msri_part all = {.parts = 1, .begin = begin, .memory = &me->rows, .same = same};
  double fastest;
  if (thread != (small ? msri_deal_owner(&s->deal, n) : 0)) return 0;
  if (msri_deal_parts(s->pass.plan, object, s->deal.depth) > 1) all.memory = s->parts;
  if (small)
    fastest = msri_patch_run(&s->pass, &alone, false, false, me->patch, &me->tally, same);
  else
    fastest = msri_rows_run(&s->pass, object, &all, &me->tally);
  if (*same) me->stays += me->tally.met - met;
  return fastest;
}

/* A thread's part of the mesh. */
static double run_mesh(msri_sweep *s, unsigned thread, unsigned *turn) {
  const size_t bands = s->pass.plan->bands.n, parts = s->deal.threads;
  size_t begin[MSRI_MOST_THREADS + 1];
  share_out(s, bands, parts, begin);
  const msri_part part = {.number = thread,
                          .parts = parts,
                          .begin = begin,
                          .opened = s->opened,
                          .turn = ++*turn,
                          .memory = s->parts};
  return msri_bands_run(&s->pass, &part);
}

/* Small objects from the n-th on that are a thread's and are stepped as usual; maybe none. */
static msri_group group_at(const msri_sweep *s, size_t n, unsigned thread) {
  const msr_plan *plan = s->pass.plan;
  const size_t first = n, last = msri_lesser(plan->objects.n, n + s->deal.share);
  while (n < last && s->rest.how[n] == MSRI_STEPPED && msri_deal_owner(&s->deal, n) == thread &&
         msri_deal_is_small(plan, &plan->objects.object[n]))
    n++;
  return msri_group_of(&plan->objects.object[first], n - first);
}

static double run_group(msri_sweep *s, const msri_group *group, unsigned thread) {
  worker *me = &s->worker[thread];
  return msri_patch_run(&s->pass, group, s->filled, s->kept, me->patch, &me->tally, NULL);
}

/* Of an object that isn't small, or is looked at. */
static double run_other(msri_sweep *s, size_t n, unsigned thread, unsigned *turn) {
  const msri_object *object = &s->pass.plan->objects.object[n];
  if (s->rest.how[n] == MSRI_LOOKED_AT) return look_at(s, n, thread);
  if (s->rest.how[n] == MSRI_LEFT_OUT || msri_deal_is_small(s->pass.plan, object)) return 0;
  return run_large(s, object, thread, msri_deal_owner(&s->deal, n), turn);
}

static void work(void *self, unsigned thread) {
  msri_sweep *s = self;
  const size_t objects = s->pass.plan->objects.n;
  worker *me = &s->worker[thread];
  unsigned turn = s->turn;
  me->fastest = 0;
  me->tally.met = me->stays = 0;
  msri_group group = objects > 0 ? group_at(s, 0, thread) : (msri_group){0}, next;
  for (size_t n = 0, taken; n < objects; n += taken, group = next) {
    taken = group.n > 0 ? group.n : 1;
    next = n + taken < objects ? group_at(s, n + taken, thread) : (msri_group){0};
    group.next = next.n > 0 ? &next : NULL;
    const double fastest =
        group.n > 0 ? run_group(s, &group, thread) : run_other(s, n, thread, &turn);
    me->fastest = msri_worse(fastest, me->fastest);
  }
  if (s->pass.plan->bands.n > 0) me->fastest = run_mesh(s, thread, &turn);
  me->turn = turn;
}

/* Takes the stages that are set. Returns the largest speed along an axis. */
static double run_pass(msri_sweep *s, uint64_t *met) {
  double fastest = 0;
  if (s->team)
    msri_team_run(s->team, work, s);
  else
    work(s, 0);
  for (unsigned t = 0; t < s->deal.threads; t++) {
    fastest = msri_worse(s->worker[t].fastest, fastest);
    *met += s->worker[t].tally.met;
  }
  s->turn = s->worker[0].turn;
  return fastest;
}

/* The stages of a pass from k on; none goes beyond the next look at speeds, and those until then
 * are alike. */
static void set_stages(msri_sweep *s, const msri_course *course, uint64_t k, uint64_t end,
                       msri_progress *p) {
  const uint64_t look = k + MSRI_SPEEDS - k % MSRI_SPEEDS, left = (look < end ? look : end) - k;
  const uint64_t passes = (left + (uint64_t)s->deal.depth - 1) / (uint64_t)s->deal.depth;
  const int most = (int)((left + passes - 1) / passes);
  int n = 0;
  for (; n < most; n++) {
    s->stage[n] = msri_course_stage(course, k + (uint64_t)n, s->pass.state);
    p->evaluations += s->stage[n].forces;
  }
  s->pass.stages = n;
  s->stage[n - 1].tells = (uint64_t)n == left;
}

/* The step that is under way after k stages is the last, or the next one if none is: a last pass
 * takes masses out of their patches. */
static void end_early(msri_course *course, uint64_t k) {
  const uint64_t drifts = (uint64_t)msri_splitting_drifts(course->plan->figures.integrator);
  course->steps = (k + drifts - 1) / drifts;
  if (msri_course_stages(course) == k) course->steps++;
}

/* Takes a course or, once a mass moves faster than it may, a part of it. When speeds are looked at
 * doesn't depend on how long passes are, and so not on threads. */
static void run_course(msri_sweep *s, msri_course *course, double fastest, msri_progress *p) {
  const uint64_t drifts = (uint64_t)msri_splitting_drifts(course->plan->figures.integrator);
  double speed = 0;
  for (uint64_t k = 0, end = msri_course_stages(course); k < end;) {
    set_stages(s, course, k, end, p);
    if (k == 0 && p->known && s->stage[0].forces) p->evaluations--;
    k += (uint64_t)s->pass.stages;
    s->kept = s->alone && k < end;
    if (s->shares.memory) msri_shares_measure(&s->shares, &s->pass);
    speed = msri_worse(run_pass(s, &p->met), speed);
    s->filled = s->kept;
    if ((k % MSRI_SPEEDS > 0 && k < end) || speed <= fastest || p->fast) continue;
    p->fast = true;
    if (k == end) continue;
    end_early(course, k);
    end = msri_course_stages(course);
  }
  p->steps += course->steps;
  p->known = msri_course_stages(course) > course->steps * drifts;
}

/* The step that objects were looked at in is done. */
static void end_look(msri_sweep *s) {
  uint64_t met = 0;
  for (unsigned t = 0; t < s->deal.threads; t++) met += s->worker[t].stays;
  msri_rest_leave_out(s->pass.plan, met, &s->rest);
}

/* Debts are paid within a pass: there, courses are as long as that. A look takes one step. */
msri_progress msri_sweep_run(msri_sweep *s, const msri_swept *state, msri_course course,
                             double fastest, bool known) {
  msri_progress progress = {.known = known};
  const uint64_t drifts = (uint64_t)msri_splitting_drifts(course.plan->figures.integrator);
  const uint64_t most = s->pass.meets ? ((uint64_t)s->deal.depth - 1) / drifts : course.steps;
  const uint64_t substeps = course.plan->figures.substeps;
  s->pass.state = state;
  bool looks = s->rests && msri_rest_look(course.plan, state, &s->rest);
  for (uint64_t left = course.steps; left > 0 && !progress.fast; looks = false) {
    course.steps = looks ? 1 : left < most ? left : most;
    const uint64_t steps = course.steps;
    run_course(s, &course, fastest, &progress);
    progress.met += course.steps * s->rest.met;
    if (looks) end_look(s);
    left -= steps;
    course.iteration += (course.substep + steps) / substeps;
    course.substep = (course.substep + steps) % substeps;
  }
  msri_rest_wait(&s->rest, progress.steps);
  return progress;
}

void msri_sweep_split(msri_sweep *s, double spent, double *seconds) {
  double kicks = 0, drifts = 0;
  for (unsigned t = 0; t < s->deal.threads; t++) {
    kicks += s->worker[t].tally.kicks.all;
    drifts += s->worker[t].tally.drifts.all;
  }
  s->shares.drifts = kicks > 0 ? drifts / kicks : 0;
  msri_shares_split(&s->shares, s->pass.plan, spent, seconds);
}
