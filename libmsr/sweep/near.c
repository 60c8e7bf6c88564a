/* near.c - see near.h. */
#include "sweep/near.h"

#include "contacts/armed.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A mass may be so much faster, until it's asked again, than the fastest is now; and go so far in a
 * step if all are slow [px]. */
static const double faster = 1.5, slow = 1.0 / 64;

/* How far masses can go is known to the pixel: others than near ones can go one, and some steps. */
enum { STEPS = 8 };

/* Squares of speeds between these are numbers, and not 0. */
static const double slowest = 0x1p-500, fastest = 0x1p500;

/* With what rounding makes of it, see MSRI_ARMED_ROUNDING, and of a speed's square. */
static double path_of(double h, double speed) {
  return fabs(h) * speed * (1 + 0x1p-40) + MSRI_ARMED_ROUNDING;
}

void msri_near_open(msri_near *near, size_t n, double *gone, double *until) {
  memset(near->block, 0, n / MSRI_LANES * sizeof *near->block);
  near->gone = gone, near->until = until;
  near->known = false;
}

/* ---- A block */

/* The clearance of the middle one of some masses side by side, less how far the others are from it.
 * Rounding may make the difference a little too large. */
static double clearance_around(const msri_contact *contact, const double *x, const double *y) {
  enum { MIDDLE = MSRI_LANES / 2 };
  double far = 0;
  for (int k = 0; k < MSRI_LANES; k++) {
    far = msri_worse(fabs(x[k] - x[MIDDLE]), far);
    far = msri_worse(fabs(y[k] - y[MIDDLE]), far);
  }
  return contact->clearance(contact->self, 1, x + MIDDLE, y + MIDDLE) - far - MSRI_ARMED_ROUNDING;
}

/* Of a block, at least; only so much is certain as soon as it's less than `wish`. */
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

static void ask_block(const msri_contact *contact, const msri_cells *cells, size_t n, double wish,
                      msri_near *near) {
  const msri_block *block = &cells->block[n];
  bool *is_near = &near->block[block->cell / MSRI_LANES];
  if (!(near->until[n] >= *near->gone + wish)) {
    const double clearance = clearance_of(contact, cells, block, wish);
    *is_near = !(clearance >= wish);
    near->until[n] = *is_near ? 0 : *near->gone + clearance;
  }
  if (!*is_near) near->least = msri_min(near->least, near->until[n]);
}

/* ---- All blocks */

/* At any speed; what is gone is infinite then, and is counted anew when they are asked next. */
static void mark_all(const msri_cells *cells, msri_near *near) {
  near->pace = near->least = (double)INFINITY;
  for (size_t n = 0; n < cells->blocks; n++) {
    near->block[cells->block[n].cell / MSRI_LANES] = true;
    near->until[n] = 0;
  }
}

/* All are near that might not be able to go some steps of h. */
static void ask(const msri_pass *pass, double h, const msri_cells *cells, msri_near *near) {
  const msri_contact *contact = &pass->plan->contact;
  const double least = msri_max(slowest, slow / fabs(h));
  near->pace = msri_max(least, faster * pass->fastest(cells));
  const double wish = 1 + STEPS * path_of(h, near->pace);
  near->known = true;
  if (!contact->clearance || !(wish <= MSRI_ARMED_LIMIT && near->pace <= fastest)) {
    mark_all(cells, near);
    return;
  }
  if (!(*near->gone <= MSRI_ARMED_LIMIT)) {
    *near->gone = 0;
    memset(near->until, 0, cells->blocks * sizeof *near->until);
  }
  near->least = (double)INFINITY;
  for (size_t n = 0; n < cells->blocks; n++) ask_block(contact, cells, n, wish, near);
}

double msri_near_begin(const msri_pass *pass, double h, const msri_cells *cells, msri_near *near) {
  if (h == 0) return (double)INFINITY;
  if (!near->known || !(*near->gone + path_of(h, near->pace) <= near->least))
    ask(pass, h, cells, near);
  *near->gone += path_of(h, near->pace);
  return near->pace;
}

/* ---- One of them */

static int compare(const void *cell, const void *block) {
  const size_t a = *(const size_t *)cell, b = ((const msri_block *)block)->cell;
  return a < b ? -1 : a >= b + MSRI_LANES;
}

/* How far the masses of a cell's block can go isn't known any more. */
static void lose(const msri_cells *cells, size_t cell, msri_near *near) {
  const msri_block *block =
      bsearch(&cell, cells->block, cells->blocks, sizeof *cells->block, compare);
  if (block) near->until[block - cells->block] = 0;
}

void msri_near_forget(const msri_cells *cells, size_t cell, msri_near *near) {
  lose(cells, cell, near);
  near->known = false;
}

void msri_near_mark(const msri_cells *cells, size_t cell, msri_near *near) {
  lose(cells, cell, near);
  near->block[cell / MSRI_LANES] = true;
}
