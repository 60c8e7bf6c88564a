/* patch.c - see patch.h. */
#include "sweep/patch.h"

#include "sweep/meet.h"

#include <string.h>

/* Cells of a row and the one after it: no vector holds two neighbours in a column. */
static size_t length(const msri_object *object) {
  return object->width < MSRI_LANES ? MSRI_LANES + 1 : object->width + 1;
}

size_t msri_patch_cells(const msri_object *object) { return object->rows * length(object); }

/* Of an array, with the row before the first, or after the last, for neighbours that there aren't.
 */
static size_t stride(size_t cells, size_t row) { return cells + row + 2 * MSRI_MARGIN; }

static size_t marks_size(const msri_object *object) {
  return 2 * (length(object) + 2 * MSRI_MARGIN);
}

/* Accelerations, what is owed, and the velocities before that. */
static size_t meet_size(const msri_object *object) {
  return 2 * msri_patch_cells(object) + MSRI_MEET_DEBT * object->masses;
}

size_t msri_patch_size(int ways, bool meets, const msri_object *object) {
  const size_t pulls = 2 * (size_t)(ways - MSRI_BELOW);
  const size_t all = stride(msri_patch_cells(object), length(object));
  return msri_field_size(ways, all) + pulls * all + marks_size(object) +
         (meets ? meet_size(object) : 0);
}

/* Marks of a row and of the one below it take turns. */
static void fill(const msri_pass *pass, const msri_object *object, const msri_field *f,
                 double *marks) {
  const msri_objects *objects = &pass->plan->objects;
  const size_t row = length(object), wide = row + 2 * MSRI_MARGIN;
  const double k = pass->plan->mesh.lattice_k;
  double *const turn[] = {marks + MSRI_MARGIN, marks + wide + MSRI_MARGIN};
  msri_field_mark(turn[0], objects, object->row, k, row);
  for (size_t r = 0; r < object->rows; r++) {
    const size_t at = MSRI_MARGIN + r * row;
    double *here = turn[r % 2], *below = turn[(r + 1) % 2];
    msri_field_fill(f, objects, object->row + r, pass->state, at, row);
    if (r + 1 < object->rows)
      msri_field_mark(below, objects, object->row + r + 1, k, row);
    else
      memset(below - 1, 0, (row + 2) * sizeof *below);
    msri_field_tie(f, here, below, pass->ways, at, row);
  }
}

/* Forces from the row above the first: none. */
static void place_pulls(const msri_pass *pass, const msri_object *object, double *memory,
                        msri_cells *cells) {
  static const ptrdiff_t shift[MSRI_WAYS] = {[MSRI_BELOW_LEFT] = 1, [MSRI_BELOW_RIGHT] = -1};
  const size_t row = length(object), all = stride(cells->n, row), before = MSRI_MARGIN + row;
  for (int way = MSRI_BELOW; way < pass->ways; way++, memory += 2 * all) {
    double *x = memory + before, *y = memory + all + before;
    memset(memory, 0, before * sizeof *x);
    memset(memory + all, 0, before * sizeof *y);
    const ptrdiff_t back = shift[way] - (ptrdiff_t)row;
    cells->below[way] = (msri_pull){x, y};
    cells->above[way] = (msri_pull){x + back, y + back};
  }
}

static msri_cells cells_of(const msri_field *f, const msri_object *object, int ways) {
  const size_t at = MSRI_MARGIN, row = length(object);
  msri_cells cells = {
      .n = msri_patch_cells(object),
      .x = f->x + at,
      .y = f->y + at,
      .vx = f->vx + at,
      .vy = f->vy + at,
      .below_x = f->x + at + row,
      .below_y = f->y + at + row,
  };
  for (int way = 0; way < ways; way++) cells.k[way] = f->k[way] + at;
  return cells;
}

/* A stage past what is in the way. */
static double step_past(const msri_pass *pass, const msri_stage *stage, const msri_object *object,
                        const msri_cells *cells, msri_meet *meet) {
  msri_tally *tally = meet->tally;
  const bool timed = msri_tally_is_turn(tally);
  double start = timed ? msri_clock_now() : 0;
  const double fastest = msri_meet_kick(pass, stage, cells, meet);
  if (timed) start = msri_tally_add(tally, start, &tally->kicks);
  for (size_t r = 0; r < object->rows && stage->motion.drift != 0; r++)
    msri_meet_drift(pass, stage, object->row + r, fastest, cells, r * length(object), meet);
  if (timed) msri_tally_add(tally, start, &tally->drifts);
  return fastest;
}

static bool is_unchanged(const msri_pass *pass, const msri_object *object, const msri_field *f) {
  bool same = true;
  for (size_t r = 0; r < object->rows && same; r++)
    same = msri_field_is(f, &pass->plan->objects, object->row + r, pass->state,
                         MSRI_MARGIN + r * length(object));
  return same;
}

static msri_field place(const msri_pass *pass, const msri_object *object, double *memory,
                        msri_cells *cells) {
  const size_t all = stride(msri_patch_cells(object), length(object));
  const msri_field f = msri_field_place(pass->ways, all, memory);
  *cells = cells_of(&f, object, pass->ways);
  place_pulls(pass, object, memory + msri_field_size(pass->ways, all), cells);
  return f;
}

static double *end_of(const msri_pass *pass, const msri_object *object, double *memory) {
  return memory + msri_patch_size(pass->ways, false, object);
}

msri_cells msri_patch_open(const msri_pass *pass, const msri_object *object, double *memory) {
  msri_cells cells;
  const msri_field f = place(pass, object, memory, &cells);
  fill(pass, object, &f, end_of(pass, object, memory) - marks_size(object));
  return cells;
}

double msri_patch_run(const msri_pass *pass, const msri_object *object, bool filled, bool kept,
                      double *memory, msri_tally *tally, bool *same) {
  const msri_objects *objects = &pass->plan->objects;
  msri_cells cells;
  const msri_field f = place(pass, object, memory, &cells);
  double *end = end_of(pass, object, memory), fastest = 0;
  msri_meet meet = {.tally = tally};
  if (pass->meets) meet = msri_meet_place(cells.n, object->masses, end, tally);
  if (!filled) fill(pass, object, &f, end - marks_size(object));
  for (int s = 0; s < pass->stages; s++) {
    const msri_stage *stage = &pass->stage[s];
    const double speed = pass->meets ? step_past(pass, stage, object, &cells, &meet)
                                     : msri_field_step(pass, stage, &cells);
    fastest = msri_worse(speed, fastest);
  }
  if (same) *same = is_unchanged(pass, object, &f);
  for (size_t r = 0; r < object->rows && !kept; r++)
    msri_field_empty(&f, objects, object->row + r, pass->state, MSRI_MARGIN + r * length(object));
  return fastest;
}
