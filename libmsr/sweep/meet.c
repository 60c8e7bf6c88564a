/* meet.c - see meet.h. Bits are those of a whole kick, a whole drift past the contact, and debts
 * that are paid by the acceleration at the end of the step, before anything else happens there. */
#include "sweep/meet.h"

#include "contacts/armed.h"

#include <math.h>
#include <string.h>

/* A mass may be so much faster, until it's asked again, than the fastest is now; and go so far in a
 * step if all are slow [px]. */
static const double faster = 1.5, slow = 1.0 / 64;

/* How far masses can go is known to the pixel: others than near ones can go one, and some steps. */
enum { STEPS = 8 };

/* With what rounding makes of it, see MSRI_ARMED_ROUNDING, and of a speed's square. */
static double path_of(double h, double speed) {
  return fabs(h) * speed * (1 + 0x1p-40) + MSRI_ARMED_ROUNDING;
}

/* ---- Memory */

enum { DOUBLE = sizeof(double) };

static size_t doubles(size_t bytes) { return (bytes + DOUBLE - 1) / DOUBLE; }

static size_t blocks_of(size_t cells) { return cells / MSRI_LANES; }

size_t msri_meet_size(size_t cells, size_t masses) {
  const size_t blocks = blocks_of(cells);
  return 1 + blocks + 2 * doubles(blocks) + 2 * masses + doubles(masses * sizeof(msri_debt));
}

size_t msri_meet_stage_size(size_t cells) { return 4 * cells; }

msri_meet msri_meet_place(size_t cells, size_t masses, double *kept, double *stage,
                          msri_tally *tally) {
  const size_t blocks = blocks_of(cells), bytes = doubles(blocks);
  double *until = kept + 1, *told = until + blocks, *before = told + 2 * bytes;
  msri_meet meet = {.near = (void *)(told + bytes),
                    .blocks = blocks,
                    .before = before,
                    .debts = {.debt = (void *)(before + 2 * masses), .capacity = masses},
                    .tally = tally};
  meet.watch =
      (msri_lookout){.near = meet.near,
                     .told = (void *)told,
                     .speed = (double)INFINITY,
                     .trace = {stage, stage + cells, stage + 2 * cells, stage + 3 * cells}};
  memset(told, 0, bytes * sizeof *told);
  memset(kept, 0, (1 + blocks) * sizeof *kept);
  msri_meet_open(&meet, kept, until);
  return meet;
}

void msri_meet_open(msri_meet *meet, double *gone, double *until) {
  memset(meet->near, 0, meet->blocks * sizeof *meet->near);
  meet->gone = gone, meet->until = until;
  meet->asked = false;
}

/* ---- Who is near */

/* How far each of some masses side by side can go at least, as one of them can so far. */
static double clearance_around(const msri_contact *contact, const double *x, const double *y) {
  enum { MIDDLE = MSRI_LANES / 2 };
  double far = MSRI_ARMED_ROUNDING;
  for (int k = 0; k < MSRI_LANES; k++) {
    far = msri_max(far, fabs(x[k] - x[MIDDLE]));
    far = msri_max(far, fabs(y[k] - y[MIDDLE]));
  }
  return contact->clearance(contact->self, 1, x + MIDDLE, y + MIDDLE) - far - MSRI_ARMED_ROUNDING;
}

/* Of a block; if that isn't `wish`, maybe more. */
static double clearance_of(const msri_contact *contact, const msri_cells *cells,
                           const msri_block *block, double wish) {
  const double *x = cells->x + block->cell, *y = cells->y + block->cell;
  double least = (double)INFINITY;
  if (block->mass == UINT8_MAX) {
    const double around = clearance_around(contact, x, y);
    return around >= wish ? around : contact->clearance(contact->self, MSRI_LANES, x, y);
  }
  for (unsigned k = 0; k < MSRI_LANES && least >= wish; k++)
    if (block->mass >> k & 1)
      least = msri_min(least, contact->clearance(contact->self, 1, x + k, y + k));
  return least;
}

static void ask_block(const msri_pass *pass, const msri_cells *cells, const msri_block *block,
                      double wish, msri_meet *meet) {
  const size_t b = block->cell / MSRI_LANES;
  if (!(meet->until[b] >= *meet->gone + wish)) {
    const double clearance = clearance_of(&pass->plan->contact, cells, block, wish);
    meet->near[b] = !(clearance >= wish);
    meet->until[b] = meet->near[b] ? 0 : *meet->gone + clearance;
  }
  if (!meet->near[b]) meet->least = msri_min(meet->least, meet->until[b]);
}

/* Sums of paths don't go on for ever. */
static void begin_anew(msri_meet *meet) {
  *meet->gone = 0;
  memset(meet->until, 0, meet->blocks * sizeof *meet->until);
}

/* All are near that might not be able to go some steps of h. */
static void ask(const msri_pass *pass, double h, const msri_cells *cells, msri_meet *meet) {
  const bool arms = pass->plan->contact.clearance;
  meet->pace = msri_max(slow / fabs(h), faster * pass->fastest(cells));
  double wish = 1 + STEPS * path_of(h, meet->pace);
  if (!arms || !(wish <= MSRI_ARMED_LIMIT)) meet->pace = wish = (double)INFINITY;
  if (!(*meet->gone <= MSRI_ARMED_LIMIT)) begin_anew(meet);
  meet->least = (double)INFINITY;
  for (size_t n = 0; n < cells->blocks; n++)
    if (arms)
      ask_block(pass, cells, &cells->block[n], wish, meet);
    else
      meet->near[cells->block[n].cell / MSRI_LANES] = true;
  meet->asked = true;
}

/* How fast may masses be in a step of h? */
static double pace_for(const msri_pass *pass, double h, const msri_cells *cells, msri_meet *meet) {
  if (h == 0) return (double)INFINITY;
  if (!meet->asked || !(*meet->gone + path_of(h, meet->pace) <= meet->least))
    ask(pass, h, cells, meet);
  *meet->gone += path_of(h, meet->pace);
  return meet->pace;
}

/* ---- As if nothing were in the way */

/* What a kernel does to a velocity. */
static double kicked(const msri_motion *m, int axis, double v, double a) {
  v = v + m->kick[0] * a;
  for (int n = 0; n < 2 && m->relaxes; n++)
    v = m->pushes ? m->keep[n] * v + m->push[n][axis] : m->keep[n] * v;
  return v + m->kick[1] * a;
}

/* Whoever is owed something may go any way: its block is near for now. */
static void remember(const msri_cells *cells, msri_meet *meet) {
  for (size_t d = 0; d < meet->debts.n; d++) {
    const size_t c = meet->debts.debt[d].mass;
    meet->before[2 * d] = cells->vx[c];
    meet->before[2 * d + 1] = cells->vy[c];
    meet->near[c / MSRI_LANES] = true;
    meet->until[c / MSRI_LANES] = 0;
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
  meet->watch.speed = pace_for(pass, stage->motion.drift, cells, meet);
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

/* One that went faster than it should have has gone further than is counted. */
static void stop_word(const msri_pass *pass, double h, const msri_cells *cells, size_t first,
                      msri_meet *meet) {
  uint8_t told[sizeof(uint64_t)];
  memcpy(told, meet->watch.told + first, sizeof told);
  memset(meet->watch.told + first, 0, sizeof told);
  for (size_t n = 0; n < sizeof told; n++) {
    if (told[n] == 0) continue;
    if (h != 0) stop(pass, h, cells, (first + n) * MSRI_LANES, told[n], meet);
    if (meet->watch.ran) meet->until[first + n] = 0;
  }
}

static void stop_all(const msri_pass *pass, double h, const msri_cells *cells, msri_meet *meet) {
  uint64_t some;
  for (size_t block = 0; block < meet->blocks; block += sizeof some) {
    memcpy(&some, meet->watch.told + block, sizeof some);
    if (some != 0) stop_word(pass, h, cells, block, meet);
  }
  if (meet->watch.ran) meet->asked = false;
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
