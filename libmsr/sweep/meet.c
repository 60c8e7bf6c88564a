/* meet.c - see meet.h. Bits are those of a whole kick, a whole drift past the contact, and debts
 * that are paid by the acceleration at the end of the step, before anything else happens there. */
#include "sweep/meet.h"

#include "base/vector.h"

#include <math.h>

msri_meet msri_meet_place(size_t cells, size_t masses, double *memory, msri_tally *tally) {
  double *before = memory + 2 * cells, *debts = before + 2 * masses;
  return (msri_meet){.ax = memory,
                     .ay = memory + cells,
                     .before = before,
                     .debts = {.debt = (void *)debts, .capacity = masses},
                     .tally = tally};
}

/* ---- Kicks */

/* What a kernel does to a velocity. */
static double kicked(const msri_motion *m, int axis, double v, double a) {
  v = v + m->kick[0] * a;
  for (int n = 0; n < 2 && m->relaxes; n++)
    v = m->pushes ? m->keep[n] * v + m->push[n][axis] : m->keep[n] * v;
  return v + m->kick[1] * a;
}

/* The kernel kicks all; those that are owed something are kicked again, from where they were. */
double msri_meet_kick(const msri_pass *pass, const msri_stage *stage, const msri_cells *cells,
                      msri_meet *meet) {
  const int eight = pass->ways > MSRI_BELOW + 1;
  const msri_motion *m = &stage->motion;
  msri_debts *debts = &meet->debts;
  for (size_t d = 0; d < debts->n; d++) {
    meet->before[2 * d] = cells->vx[debts->debt[d].mass];
    meet->before[2 * d + 1] = cells->vy[debts->debt[d].mass];
  }
  double fastest =
      pass->kernel->of[eight].kick[msri_field_besides(pass, stage)](cells, m, meet->ax, meet->ay);
  for (size_t d = 0; d < debts->n; d++) {
    const msri_debt *debt = &debts->debt[d];
    const size_t c = debt->mass;
    const double ax = meet->ax[c], ay = meet->ay[c];
    cells->vx[c] = kicked(m, 0, meet->before[2 * d] + debt->x * ax, ax);
    cells->vy[c] = kicked(m, 1, meet->before[2 * d + 1] + debt->y * ay, ay);
    fastest = msri_worse(msri_worse(fabs(cells->vx[c]), fabs(cells->vy[c])), fastest);
  }
  debts->n = 0;
  return fastest;
}

/* ---- Drifts */

static msri_flock flock_of(const msri_cells *cells, const msri_meet *meet, size_t c, size_t n) {
  return (msri_flock){.n = n,
                      .first = c,
                      .x = cells->x + c,
                      .y = cells->y + c,
                      .vx = cells->vx + c,
                      .vy = cells->vy + c,
                      .ux = cells->vx + c,
                      .uy = cells->vy + c,
                      .ax = meet->ax + c,
                      .ay = meet->ay + c};
}

/* Masses of a piece that are armed together, from its k-th on. */
typedef struct block {
  size_t cell, n;
  msri_armed *armed;
} block;

static block block_of(const msri_pass *pass, const msri_piece *piece, size_t base, size_t k) {
  const size_t left = piece->count - k, n = left < MSRI_FLOCK_BLOCK ? left : MSRI_FLOCK_BLOCK;
  return (block){base + piece->column + k, n,
                 &pass->state->armed[piece->block + k / MSRI_FLOCK_BLOCK]};
}

static void drift_freely(double h, const msri_cells *cells, const block *b) {
  msri_add_scaled(b->n, h, cells->vx + b->cell, cells->x + b->cell);
  msri_add_scaled(b->n, h, cells->vy + b->cell, cells->y + b->cell);
}

static void drift_past(const msri_pass *pass, double h, const msri_cells *cells, const block *b,
                       msri_meet *meet) {
  const msri_contact *contact = &pass->plan->contact;
  const msri_flock f = flock_of(cells, meet, b->cell, b->n);
  meet->tally->met +=
      contact->drift(contact->self, h, &f, msri_plan_settles(pass->plan) ? &meet->debts : NULL);
}

static void drift(const msri_pass *pass, double h, double way, const msri_cells *cells,
                  const block *b, msri_meet *meet) {
  const msri_contact *contact = &pass->plan->contact;
  const bool knows = contact->clearance, waits = knows && msri_armed_waits(b->armed);
  if (knows && !waits && msri_armed_covers(b->armed, way)) {
    drift_freely(h, cells, b);
    return;
  }
  drift_past(pass, h, cells, b, meet);
  if (!knows || waits) return;
  const double *x = cells->x + b->cell, *y = cells->y + b->cell;
  msri_armed_earn(b->armed, way, contact->clearance(contact->self, b->n, x, y));
}

void msri_meet_drift(const msri_pass *pass, const msri_stage *stage, size_t row, double fastest,
                     const msri_cells *cells, size_t base, msri_meet *meet) {
  const double h = stage->motion.drift, way = fabs(h) * fastest;
  const msri_objects *o = &pass->plan->objects;
  for (size_t p = o->row[row]; p < o->row[row + 1]; p++)
    for (size_t k = 0; k < o->piece[p].count; k += MSRI_FLOCK_BLOCK) {
      const block b = block_of(pass, &o->piece[p], base, k);
      drift(pass, h, way, cells, &b, meet);
    }
}
