/* meet.c - see meet.h. Bits are those of a whole kick, a whole drift past the contact, and debts
 * that are paid by the acceleration at the end of the step, before anything else happens there. */
#include "sweep/meet.h"

#include <math.h>
#include <string.h>

/* ---- Memory */

enum { DOUBLE = sizeof(double) };

static size_t doubles(size_t bytes) { return (bytes + DOUBLE - 1) / DOUBLE; }

static size_t blocks_of(size_t cells) { return cells / MSRI_LANES; }

size_t msri_meet_size(size_t cells, size_t masses) {
  const size_t blocks = blocks_of(cells);
  return 1 + blocks + 2 * doubles(blocks) + 2 * masses + doubles(masses * sizeof(msri_debt));
}

size_t msri_meet_stage_size(size_t cells) { return 4 * cells; }

msri_meet msri_meet_place(size_t cells, size_t masses, double *stage, double *kept,
                          msri_tally *tally) {
  const size_t blocks = blocks_of(cells), bytes = doubles(blocks);
  double *until = kept + 1, *told = until + blocks, *near = told + bytes, *before = near + bytes;
  msri_meet meet = {.near = {.block = (void *)near},
                    .blocks = blocks,
                    .before = before,
                    .debts = {.debt = (void *)(before + 2 * masses), .capacity = masses},
                    .tally = tally};
  meet.watch =
      (msri_lookout){.near = meet.near.block,
                     .told = (void *)told,
                     .speed = (double)INFINITY,
                     .trace = {stage, stage + cells, stage + 2 * cells, stage + 3 * cells}};
  memset(kept, 0, (size_t)(near - kept) * sizeof *kept);
  msri_near_open(&meet.near, cells, kept, until);
  return meet;
}

/* ---- As if nothing were in the way */

/* What a kernel does to a velocity. */
static double kicked(const msri_motion *m, int axis, double v, double a) {
  v = v + m->kick[0] * a;
  for (int n = 0; n < 2 && m->relaxes; n++)
    v = m->pushes ? m->keep[n] * v + m->push[n][axis] : m->keep[n] * v;
  return v + m->kick[1] * a;
}

static void remember(const msri_cells *cells, msri_meet *meet) {
  for (size_t d = 0; d < meet->debts.n; d++) {
    const size_t c = meet->debts.debt[d].mass;
    meet->before[2 * d] = cells->vx[c];
    meet->before[2 * d + 1] = cells->vy[c];
    msri_near_mark(cells, c, &meet->near);
  }
}

/* The kernel has moved all; those that are owed something are moved again, from where they were. */
static void pay(const msri_motion *m, const msri_cells *cells, msri_meet *meet) {
  const msri_trace *was = &meet->watch.trace;
  for (size_t d = 0; d < meet->debts.n; d++) {
    const msri_debt *debt = &meet->debts.debt[d];
    const size_t c = debt->mass;
    const double ax = was->ax[c], ay = was->ay[c];
    cells->vx[c] = kicked(m, 0, meet->before[2 * d] + debt->x * ax, ax);
    cells->vy[c] = kicked(m, 1, meet->before[2 * d + 1] + debt->y * ay, ay);
    cells->x[c] = was->x[c] + m->drift * cells->vx[c];
    cells->y[c] = was->y[c] + m->drift * cells->vy[c];
    meet->watch.told[c / MSRI_LANES] |= (uint8_t)(1U << c % MSRI_LANES);
  }
  meet->debts.n = 0;
}

static void advance(const msri_pass *pass, const msri_stage *stage, const msri_cells *cells,
                    msri_meet *meet) {
  meet->watch.speed = msri_near_begin(pass, stage->motion.drift, cells, &meet->near);
  remember(cells, meet);
  pass->loops->watch[msri_field_besides(pass, stage)](cells, &stage->motion, &meet->watch);
  pay(&stage->motion, cells, meet);
}

/* ---- What is */

/* In a block of which some are told. */
static void stop(const msri_pass *pass, double h, const msri_cells *cells, size_t c, uint8_t told,
                 msri_meet *meet) {
  const msri_contact *contact = &pass->plan->contact;
  const msri_trace *trace = &meet->watch.trace;
  const msri_places from = {trace->x + c, trace->y + c};
  const msri_flock f = {.n = MSRI_LANES,
                        .first = c,
                        .x = cells->x + c,
                        .y = cells->y + c,
                        .vx = cells->vx + c,
                        .vy = cells->vy + c,
                        .ux = cells->vx + c,
                        .uy = cells->vy + c,
                        .ax = trace->ax + c,
                        .ay = trace->ay + c};
  msri_debts *debts = msri_plan_settles(pass->plan) ? &meet->debts : NULL;
  meet->tally->met += contact->stop_drift(contact->self, h, &f, &from, told, debts);
}

static void stop_word(const msri_pass *pass, double h, const msri_cells *cells, size_t first,
                      msri_meet *meet) {
  uint8_t told[sizeof(uint64_t)];
  memcpy(told, meet->watch.told + first, sizeof told);
  memset(meet->watch.told + first, 0, sizeof told);
  for (size_t n = 0; n < sizeof told; n++) {
    if (told[n] == 0) continue;
    const size_t cell = (first + n) * MSRI_LANES;
    if (h != 0) stop(pass, h, cells, cell, told[n], meet);
    if (meet->watch.ran) msri_near_forget(cells, cell, &meet->near);
  }
}

static void stop_all(const msri_pass *pass, double h, const msri_cells *cells, msri_meet *meet) {
  uint64_t some;
  for (size_t block = 0; block < meet->blocks; block += sizeof some) {
    memcpy(&some, meet->watch.told + block, sizeof some);
    if (some != 0) stop_word(pass, h, cells, block, meet);
  }
}

double msri_meet_step(const msri_pass *pass, const msri_stage *stage, const msri_cells *cells,
                      msri_meet *meet) {
  msri_tally *tally = meet->tally;
  const bool timed = msri_tally_is_turn(tally);
  double start = timed ? msri_clock_now() : 0;
  advance(pass, stage, cells, meet);
  if (timed) start = msri_tally_add(tally, start, &tally->kicks);
  stop_all(pass, stage->motion.drift, cells, meet);
  if (timed) msri_tally_add(tally, start, &tally->drifts);
  return stage->tells ? pass->fastest(cells) : 0;
}
