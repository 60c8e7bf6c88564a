/* patch.c - see patch.h. */
#include "sweep/patch.h"

#include "sweep/meet.h"

#include <string.h>

/* Cells of a row and the one after it: no vector holds two neighbours in a column. */
static size_t length(const msri_object *object) {
  return object->width < MSRI_LANES ? MSRI_LANES + 1 : object->width + 1;
}

size_t msri_patch_cells(const msri_object *object) {
  return msri_round_up(object->rows * length(object), MSRI_LANES);
}

/* Cells around those of a patch: for neighbours of the first and the last row that there aren't. */
static size_t around(const msri_object *object) {
  return msri_round_up(length(object) + 1, MSRI_MARGIN);
}

static size_t stride(const msri_object *object) {
  return msri_patch_cells(object) + 2 * around(object);
}

static size_t pulls_size(int ways, const msri_object *object) {
  return 2 * (size_t)(ways - MSRI_BELOW) * stride(object);
}

/* Traces, what is owed, and the velocities before that. */
static size_t meet_size(const msri_object *object) {
  return MSRI_MEET_TRACE * msri_patch_cells(object) + MSRI_MEET_DEBT * object->masses;
}

/* Marks are needed before anything else is. */
size_t msri_patch_size(int ways, bool meets, const msri_object *object) {
  const size_t cells = msri_patch_cells(object);
  const size_t marks = msri_marks_bytes(cells, around(object)) / sizeof(double) + 1;
  const size_t later = pulls_size(ways, object) + (meets ? meet_size(object) : 0);
  return msri_field_size(cells, around(object)) + (later > marks ? later : marks);
}

/* Of a field, and what comes after it in memory. */
typedef struct place {
  msri_field field;
  double *rest;
} place;

static place place_of(const msri_object *object, double *memory) {
  const size_t cells = msri_patch_cells(object);
  return (place){msri_field_place(cells, around(object), memory),
                 memory + msri_field_size(cells, around(object))};
}

static void fill(const msri_pass *pass, const msri_object *object, const place *p) {
  const msri_objects *objects = &pass->plan->objects;
  const size_t row = length(object), cells = p->field.n;
  const msri_marks marks = {(void *)p->rest, around(object) + 8};
  const msri_marks above = {marks.bits, marks.first - row}, below = {marks.bits, marks.first + row};
  double *const array[] = {p->field.x, p->field.y, p->field.vx, p->field.vy};
  for (size_t n = 0; n < 4; n++) memset(array[n], 0, cells * sizeof *array[n]);
  memset(marks.bits, 0, msri_marks_bytes(cells, around(object)));
  for (size_t r = 0; r < object->rows; r++) {
    msri_field_fill(&p->field, objects, object->row + r, pass->state, r * row);
    msri_marks_set(&marks, objects, object->row + r, r * row);
  }
  msri_field_tie(&p->field, pass->ways, &marks, &above, &below);
}

static msri_cells cells_of(const msri_pass *pass, const msri_object *object, const place *p) {
  static const ptrdiff_t shift[MSRI_WAYS] = {[MSRI_BELOW_LEFT] = 1, [MSRI_BELOW_RIGHT] = -1};
  const size_t row = length(object);
  msri_cells cells = msri_field_cells(&p->field);
  double *pulls = p->rest + around(object);
  cells.below_x = cells.x + row, cells.below_y = cells.y + row;
  for (int way = MSRI_BELOW; way < pass->ways; way++, pulls += 2 * stride(object)) {
    cells.pull[way] = (msri_pull){pulls, pulls + stride(object)};
    cells.back[way] = shift[way] - (ptrdiff_t)row;
  }
  return cells;
}

/* A stage past what is in the way. */
static double step_past(const msri_pass *pass, const msri_stage *stage, const msri_object *object,
                        const msri_cells *cells, msri_meet *meet) {
  msri_tally *tally = meet->tally;
  const bool timed = msri_tally_is_turn(tally);
  double start = timed ? msri_clock_now() : 0;
  const double fastest = msri_meet_advance(pass, stage, cells, meet);
  if (timed) start = msri_tally_add(tally, start, &tally->kicks);
  for (size_t r = 0; r < object->rows && stage->motion.drift != 0; r++)
    msri_meet_stop(pass, stage, object->row + r, fastest, cells, r * length(object), meet);
  if (timed) msri_tally_add(tally, start, &tally->drifts);
  return fastest;
}

static bool is_unchanged(const msri_pass *pass, const msri_object *object, const msri_field *f) {
  bool same = true;
  for (size_t r = 0; r < object->rows && same; r++)
    same = msri_field_is(f, &pass->plan->objects, object->row + r, pass->state, r * length(object));
  return same;
}

msri_cells msri_patch_open(const msri_pass *pass, const msri_object *object, double *memory) {
  const place p = place_of(object, memory);
  fill(pass, object, &p);
  return cells_of(pass, object, &p);
}

double msri_patch_run(const msri_pass *pass, const msri_object *object, bool filled, bool kept,
                      double *memory, msri_tally *tally, bool *same) {
  const place p = place_of(object, memory);
  double *meeting = p.rest + pulls_size(pass->ways, object), fastest = 0;
  msri_meet meet = {.tally = tally};
  if (!filled) fill(pass, object, &p);
  const msri_cells cells = cells_of(pass, object, &p);
  if (pass->meets) meet = msri_meet_place(cells.n, object->masses, meeting, tally);
  for (int s = 0; s < pass->stages; s++) {
    const msri_stage *stage = &pass->stage[s];
    const double speed = pass->meets ? step_past(pass, stage, object, &cells, &meet)
                                     : msri_field_step(pass, stage, &cells);
    fastest = msri_worse(speed, fastest);
  }
  if (same) *same = is_unchanged(pass, object, &p.field);
  for (size_t r = 0; r < object->rows && !kept; r++)
    msri_field_empty(&p.field, &pass->plan->objects, object->row + r, pass->state,
                     r * length(object));
  return fastest;
}
