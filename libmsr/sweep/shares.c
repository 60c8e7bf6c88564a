/* shares.c - see shares.h. Within the kernels no clock can tell springs from weight, air and kicks:
 * they are one loop, in which all is done while the divider is busy. So now and then all kernels
 * are timed on a copy of some rows. The forces below alone, times springs over springs below, are
 * the springs' share; what a weight, then air, makes a loop longer is theirs, which may be nothing;
 * the rest, and copying rows in and out, the integrator's. Drifts past what is in the way are timed
 * where they are, and so are the kicks before them (tally.h). */
#include "sweep/shares.h"

#include "sweep/meet.h"
#include "sweep/patch.h"

#include <math.h>
#include <string.h>

enum {
  CELLS = 4096, /* that a kernel is timed on: the same ones again, if there are fewer */
  ROUNDS = 3,   /* the fastest of which counts */
  LEAST = 50    /* times as long sweeps as measuring */
};

/* ---- What is measured */

/* Rows of an object from one of them on. */
static msri_object window(const msri_object *object, size_t row) {
  const size_t rows = CELLS / object->width, left = object->rows - row;
  msri_object part = *object;
  part.row += row;
  part.rows = rows < 1 ? 1 : rows < left ? rows : left;
  return part;
}

size_t msri_shares_size(const msr_plan *plan, int ways) {
  size_t most = 0;
  for (size_t n = 0; n < plan->objects.n; n++) {
    const msri_object part = window(&plan->objects.object[n], 0);
    const msri_group alone = msri_group_of(&part, 1);
    const size_t cells = msri_patch_cells(&alone);
    const size_t size = msri_patch_size(ways, false, &alone) + msri_meet_size(cells, 0) +
                        msri_meet_stage_size(cells);
    if (most < size) most = size;
  }
  return most;
}

/* An object, as often as it has masses, and one of its rows. */
static msri_object choose(msri_shares *s, const msri_objects *o) {
  s->turn += UINT32_C(0x9e3779b9);
  const double u = s->turn / 4294967296.0;
  double at = 0;
  size_t n = 0;
  for (size_t i = 0; i < o->n; i++) at += (double)o->object[i].masses;
  for (at *= u; n + 1 < o->n && at >= (double)o->object[n].masses; n++)
    at -= (double)o->object[n].masses;
  const msri_object *object = &o->object[n];
  const size_t row = (size_t)(at / (double)object->masses * (double)object->rows);
  return window(object, row < object->rows ? row : object->rows - 1);
}

/* ---- How long it takes */

typedef struct subject {
  const msri_pass *pass;
  msri_cells cells;
  msri_motion motion;
  msri_lookout *watch;
} subject;

enum { PULL = MSRI_BESIDES, KERNELS }; /* after those of what acts beside the springs */

static void run(const subject *s, int which) {
  const msri_loops *loops = s->pass->loops;
  if (which == PULL)
    loops->pull(&s->cells, &s->motion);
  else if (s->pass->meets)
    loops->watch[which](&s->cells, &s->motion, s->watch);
  else
    loops->advance[which](&s->cells, &s->motion);
}

/* Of once all cells; past supports of cells of which none is near. */
static double time_of(const subject *s, int which) {
  const size_t times = 1 + CELLS / s->cells.n;
  const double start = msri_clock_now();
  for (size_t n = 0; n < times; n++) run(s, which);
  return (msri_clock_now() - start) / (double)times;
}

/* In and out, of what is in cache: rows are, before they are needed. */
static double time_of_copying(const msri_pass *pass, const msri_group *group, double *memory) {
  const double start = msri_clock_now();
  msri_patch_open(pass, group, memory);
  return 2 * (msri_clock_now() - start);
}

double msri_shares_clock(void) {
  double least = 1;
  for (int n = 0; n < CELLS / 64; n++) {
    const double start = msri_clock_now();
    least = msri_min(least, msri_clock_now() - start);
  }
  return least;
}

/* Rows neither move nor gain speed, so that a kernel does the same each time. */
static msri_motion at_rest(const msri_pass *pass) {
  msri_motion m = pass->stage[0].motion;
  m.kick[0] = m.kick[1] = m.drift = 0;
  m.keep[0] = m.keep[1] = 1;
  memset(m.push, 0, sizeof m.push);
  return m;
}

/* Adds shares of a pass: `took` of each kernel once, `copying` of what is before and after it. */
static void add(msri_shares *s, const msri_pass *pass, const double *took, double copying) {
  const int besides = msri_field_besides(pass, pass->stage), weight = besides & MSRI_WITH_WEIGHT;
  const double ways = pass->ways, bare = took[0], heavy = fmax(bare, took[weight]);
  double forces = 0, part[MSRI_SHARES], all = 0;
  for (int n = 0; n < pass->stages; n++) forces += pass->stage[n].forces;
  part[MSRI_SHARE_SPRINGS] = forces * fmin(bare, took[PULL] * ways / (ways - MSRI_BELOW));
  part[MSRI_SHARE_WEIGHT] = forces * (heavy - bare);
  part[MSRI_SHARE_AIR] = forces * fmax(0, took[besides] - heavy);
  part[MSRI_SHARE_MOTION] = pass->stages * bare - part[MSRI_SHARE_SPRINGS] + copying;
  for (int n = 0; n < MSRI_SHARES; n++) all += part[n];
  for (int n = 0; n < MSRI_SHARES; n++) s->share[n] += part[n] / all;
  s->copying += copying / all;
}

void msri_shares_measure(msri_shares *s, const msri_pass *pass) {
  double took[KERNELS];
  if (LEAST * s->measuring > s->sweeping) return;
  const double start = msri_clock_now();
  const msri_object part = choose(s, &pass->plan->objects);
  const msri_group alone = msri_group_of(&part, 1);
  const size_t all = msri_patch_cells(&alone);
  double *stage = s->memory + msri_patch_size(pass->ways, false, &alone);
  msri_meet meet = msri_meet_place(all, 0, stage, stage + msri_meet_stage_size(all), NULL);
  const subject cells = {pass, msri_patch_open(pass, &alone, s->memory), at_rest(pass),
                         &meet.watch};
  double copying = (double)INFINITY;
  for (int n = 0; n < KERNELS; n++) took[n] = (double)INFINITY;
  for (int round = 0; round < ROUNDS; round++) {
    for (int n = 0; n < KERNELS; n++) took[n] = msri_min(took[n], time_of(&cells, n));
    copying = msri_min(copying, time_of_copying(pass, &alone, s->memory));
  }
  add(s, pass, took, copying);
  s->measuring += msri_clock_now() - start;
}

/* ---- Whose time it is */

void msri_shares_split(msri_shares *s, const msr_plan *plan, double spent, double *seconds) {
  double all = 0;
  for (int n = 0; n < MSRI_SHARES; n++) all += s->share[n];
  const double drifts = all > 0 ? s->drifts * (1 - s->copying / all) : 0;
  const double past = drifts / (1 + drifts), kernels = spent * (1 - past);
  double *rest = &seconds[plan->row.integrator];
  for (size_t i = 0; i < plan->n_terms; i++) {
    const msr_force *force = plan->term[i].force;
    const int which = force->uniform ? MSRI_SHARE_WEIGHT
                      : force->relax ? MSRI_SHARE_AIR
                                     : MSRI_SHARE_SPRINGS;
    const double own = all > 0 ? kernels * s->share[which] / all : 0;
    seconds[i] += own;
    *rest -= own;
  }
  seconds[plan->row.contact] += spent * past;
  *rest -= spent * past;
  s->sweeping += spent;
}
