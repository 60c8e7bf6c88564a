/* meet.c - see meet.h. Bits are those of a whole kick, a whole drift past the contact, and debts
 * that are paid by the acceleration at the end of the step, before anything else happens there. */
#include "sweep/meet.h"

#include <math.h>
#include <string.h>

msri_trace msri_meet_trace(size_t cells, double *memory) {
  return (msri_trace){memory, memory + cells, memory + 2 * cells, memory + 3 * cells};
}

msri_meet msri_meet_place(size_t cells, size_t masses, double *memory, msri_tally *tally) {
  double *before = memory + MSRI_MEET_TRACE * cells, *debts = before + 2 * masses;
  return (msri_meet){.trace = msri_meet_trace(cells, memory),
                     .before = before,
                     .debts = {.debt = (void *)debts, .capacity = masses},
                     .tally = tally};
}

/* ---- As if nothing were in the way */

/* What a kernel does to a velocity. */
static double kicked(const msri_motion *m, int axis, double v, double a) {
  v = v + m->kick[0] * a;
  for (int n = 0; n < 2 && m->relaxes; n++)
    v = m->pushes ? m->keep[n] * v + m->push[n][axis] : m->keep[n] * v;
  return v + m->kick[1] * a;
}

/* The kernel moves all; those that are owed something are moved again, from where they were. */
double msri_meet_advance(const msri_pass *pass, const msri_stage *stage, const msri_cells *cells,
                         msri_meet *meet) {
  const msri_motion *m = &stage->motion;
  const msri_trace *was = &meet->trace;
  msri_debts *debts = &meet->debts;
  for (size_t d = 0; d < debts->n; d++) {
    meet->before[2 * d] = cells->vx[debts->debt[d].mass];
    meet->before[2 * d + 1] = cells->vy[debts->debt[d].mass];
  }
  double fastest = pass->loops->trace[msri_field_besides(pass, stage)](cells, m, was);
  for (size_t d = 0; d < debts->n; d++) {
    const msri_debt *debt = &debts->debt[d];
    const size_t c = debt->mass;
    const double ax = was->ax[c], ay = was->ay[c];
    cells->vx[c] = kicked(m, 0, meet->before[2 * d] + debt->x * ax, ax);
    cells->vy[c] = kicked(m, 1, meet->before[2 * d + 1] + debt->y * ay, ay);
    cells->x[c] = was->x[c] + m->drift * cells->vx[c];
    cells->y[c] = was->y[c] + m->drift * cells->vy[c];
    fastest = msri_worse(msri_worse(fabs(cells->vx[c]), fabs(cells->vy[c])), fastest);
  }
  debts->n = 0;
  return fastest;
}

/* ---- What is */

/* Of n masses from cell c on. */
static void stop(const msri_pass *pass, double h, const msri_cells *cells, size_t c, size_t n,
                 msri_meet *meet) {
  const msri_contact *contact = &pass->plan->contact;
  const msri_trace *trace = &meet->trace;
  const msri_places from = {trace->x + c, trace->y + c};
  const msri_flock f = {.n = n,
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
  meet->tally->met += contact->stop_drift(contact->self, h, &f, &from, debts);
}

/* A block of a row that is armed. */
static void stop_armed(const msri_pass *pass, double h, double path, const msri_cells *cells,
                       size_t c, size_t n, const msri_armed_row *row, msri_armed_block *block,
                       msri_meet *meet) {
  const msri_contact *contact = &pass->plan->contact;
  if (row->gone <= block->until) return;
  stop(pass, h, cells, c, n, meet);
  if (row->steps < block->asks) return;
  msri_armed_block_earn(block, row, path,
                        contact->clearance(contact->self, n, cells->x + c, cells->y + c));
}

/* Odometers don't go on for ever: the row and its blocks begin anew. */
static void forget(const msri_pass *pass, size_t row) {
  const msri_objects *o = &pass->plan->objects;
  const msri_armed_rows *armed = &pass->state->armed;
  armed->row[row] = (msri_armed_row){0};
  for (size_t p = o->row[row]; p < o->row[row + 1]; p++)
    memset(&armed->block[o->piece[p].block], 0,
           msri_flock_blocks(o->piece[p].count) * sizeof *armed->block);
}

void msri_meet_stop(const msri_pass *pass, const msri_stage *stage, size_t row, double fastest,
                    const msri_cells *cells, size_t base, msri_meet *meet) {
  const double h = stage->motion.drift, path = fabs(h) * fastest;
  const msri_objects *o = &pass->plan->objects;
  const bool arms = pass->plan->contact.clearance;
  msri_armed_row *armed = arms ? &pass->state->armed.row[row] : NULL;
  if (arms && !msri_armed_row_goes(armed, path)) return;
  double until = (double)INFINITY;
  for (size_t p = o->row[row]; p < o->row[row + 1]; p++) {
    const msri_piece *piece = &o->piece[p];
    msri_armed_block *block = &pass->state->armed.block[piece->block];
    for (size_t k = 0; k < piece->count; k += MSRI_FLOCK_BLOCK, block++) {
      const size_t rest = piece->count - k, n = rest < MSRI_FLOCK_BLOCK ? rest : MSRI_FLOCK_BLOCK;
      const size_t c = base + piece->column + k;
      if (!arms) {
        stop(pass, h, cells, c, n, meet);
        continue;
      }
      stop_armed(pass, h, path, cells, c, n, armed, block, meet);
      until = msri_min(until, block->until);
    }
  }
  if (!arms) return;
  armed->until = until;
  if (!(armed->gone <= MSRI_ARMED_LIMIT)) forget(pass, row);
}
