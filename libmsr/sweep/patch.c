/* patch.c - see patch.h. */
#include "sweep/patch.h"

#include "sweep/meet.h"

#include <string.h>

enum {
  NARROW = 64,      /* cells of a row that others may follow in the same */
  MOST_CELLS = 2048 /* of more than one object */
};

/* ---- Groups */

/* Cells of a row and the one after it: no vector holds two neighbours in a column. */
static size_t length(const msri_group *group) {
  return group->width < MSRI_LANES ? MSRI_LANES + 1 : group->width + 1;
}

static bool takes(const msri_group *group, const msri_object *object) {
  const size_t rows = object->rows > group->rows ? object->rows : group->rows;
  const bool alike = 2 * object->rows >= rows && 2 * group->rows >= rows;
  return alike && group->width < NARROW && object->width < NARROW &&
         rows * (group->width + object->width + 2) <= MOST_CELLS;
}

msri_group msri_group_of(const msri_object *object, size_t most) {
  if (most == 0) return (msri_group){0};
  msri_group g = {object, 1, object->rows, object->width, object->masses, NULL};
  for (; g.n < most && takes(&g, &object[g.n]); g.n++) {
    const msri_object *next = &object[g.n];
    if (g.rows < next->rows) g.rows = next->rows;
    g.width += 1 + next->width;
    g.masses += next->masses;
  }
  return g;
}

/* ---- Memory */

size_t msri_patch_cells(const msri_group *group) {
  return msri_round_up(group->rows * length(group), MSRI_LANES);
}

/* Cells around those of a patch: for neighbours of the first and the last row that there aren't. */
static size_t around_of(size_t length) { return msri_round_up(length + 1, MSRI_MARGIN); }

static size_t around(const msri_group *group) { return around_of(length(group)); }

static size_t stride(const msri_group *group) {
  return msri_patch_cells(group) + 2 * around(group);
}

static size_t pulls_size(int ways, size_t stride) {
  return 2 * (size_t)(ways - MSRI_BELOW) * stride;
}

/* Marks are needed before what follows. */
static size_t size_of(int ways, bool meets, size_t cells, size_t around, size_t masses) {
  const size_t marks = msri_marks_bytes(cells, around) / sizeof(double) + 1;
  const size_t meeting = meets ? msri_meet_size(cells, masses) + msri_meet_stage_size(cells) : 0;
  const size_t later = pulls_size(ways, cells + 2 * around) + meeting;
  return msri_field_size(cells, around) + (later > marks ? later : marks);
}

size_t msri_patch_size(int ways, bool meets, const msri_group *group) {
  return size_of(ways, meets, msri_patch_cells(group), around(group), group->masses);
}

size_t msri_patch_most(int ways, bool meets) {
  return size_of(ways, meets, MOST_CELLS, around_of(2 * NARROW), MOST_CELLS);
}

/* ---- Rows of objects */

/* One after the other: row r of object k, from cell `at` of its patch on. */
typedef struct walk {
  const msri_group *group;
  size_t k, r, column, row, at;
} walk;

static bool is_on(walk *w) {
  const msri_group *g = w->group;
  if (w->k < g->n && w->r == g->object[w->k].rows)
    w->column += g->object[w->k++].width + 1, w->r = 0;
  if (w->k == g->n) return false;
  w->row = g->object[w->k].row + w->r;
  w->at = w->column + w->r * length(g);
  return true;
}

/* ---- Patches */

/* Of a field, and what comes after it in memory. */
typedef struct place {
  msri_field field;
  double *rest;
} place;

static place place_of(const msri_group *group, double *memory) {
  const size_t cells = msri_patch_cells(group);
  return (place){msri_field_place(cells, around(group), memory),
                 memory + msri_field_size(cells, around(group))};
}

/* From above the first row nothing is taken. But a masked load from a page that nobody has written
 * to is slow each time: the processor has to see that it mustn't fail. */
static void clear_above(const msri_pass *pass, const msri_group *group, const place *p) {
  double *pulls = p->rest;
  for (int n = 0; n < 2 * (pass->ways - MSRI_BELOW); n++, pulls += stride(group))
    memset(pulls, 0, around(group) * sizeof *pulls);
}

static void fill(const msri_pass *pass, const msri_group *group, const place *p) {
  const msri_objects *objects = &pass->plan->objects;
  const size_t row = length(group), cells = p->field.n;
  const msri_marks marks = {(void *)p->rest, around(group) + 8};
  const msri_marks above = {marks.bits, marks.first - row}, below = {marks.bits, marks.first + row};
  msri_field_clear(&p->field, 0);
  memset(marks.bits, 0, msri_marks_bytes(cells, around(group)));
  for (walk w = {.group = group}; is_on(&w); w.r++) {
    msri_field_fill(&p->field, objects, w.row, pass->state, w.at);
    msri_marks_set(&marks, objects, w.row, w.at);
  }
  msri_field_tie(&p->field, pass->ways, &marks, &above, &below);
  clear_above(pass, group, p);
}

static void empty(const msri_pass *pass, const msri_group *group, const msri_field *f) {
  for (walk w = {.group = group}; is_on(&w); w.r++)
    msri_field_empty(f, &pass->plan->objects, w.row, pass->state, w.at);
}

static bool is_unchanged(const msri_pass *pass, const msri_group *group, const msri_field *f) {
  bool same = true;
  for (walk w = {.group = group}; same && is_on(&w); w.r++)
    same = msri_field_is(f, &pass->plan->objects, w.row, pass->state, w.at);
  return same;
}

static msri_cells cells_of(const msri_pass *pass, const msri_group *group, const place *p) {
  const size_t row = length(group);
  msri_cells cells = msri_field_cells(&p->field);
  double *pulls = p->rest + around(group);
  cells.below_x = cells.x + row, cells.below_y = cells.y + row;
  for (int way = MSRI_BELOW; way < pass->ways; way++, pulls += 2 * stride(group)) {
    cells.pull[way] = (msri_pull){pulls, pulls + stride(group)};
    cells.back[way] = -msri_lattice_shift(way) - (ptrdiff_t)row;
  }
  return cells;
}

msri_cells msri_patch_open(const msri_pass *pass, const msri_group *group, double *memory) {
  const place p = place_of(group, memory);
  fill(pass, group, &p);
  return cells_of(pass, group, &p);
}

/* ---- Stages */

/* A row of an object. */
static void fetch_row(const msri_pass *pass, size_t row) {
  const msri_objects *o = &pass->plan->objects;
  for (size_t n = o->row[row]; n < o->row[row + 1]; n++)
    msri_field_fetch(pass->state, o->piece[n].first, o->piece[n].first + o->piece[n].count);
}

/* Some of the rows that come next: all of them, in as many goes as there are stages. */
static void fetch(const msri_pass *pass, walk *next) {
  const size_t rows = next->group ? next->group->n * next->group->rows : 0;
  const size_t stages = (size_t)pass->stages;
  for (size_t n = 0; n < (rows + stages - 1) / stages && is_on(next); n++, next->r++)
    fetch_row(pass, next->row);
}

double msri_patch_run(const msri_pass *pass, const msri_group *group, bool filled, bool kept,
                      double *memory, msri_tally *tally, bool *same) {
  const place p = place_of(group, memory);
  double *meeting = p.rest + pulls_size(pass->ways, stride(group)), fastest = 0;
  msri_meet meet;
  if (!filled) fill(pass, group, &p);
  const msri_cells cells = cells_of(pass, group, &p);
  if (pass->meets)
    meet = msri_meet_place(cells.n, group->masses, meeting, meeting + msri_meet_stage_size(cells.n),
                           tally);
  walk next = {.group = group->next};
  for (int s = 0; s < pass->stages; s++) {
    const msri_stage *stage = &pass->stage[s];
    const double speed = pass->meets ? msri_meet_step(pass, stage, &cells, &meet)
                                     : msri_field_step(pass, stage, &cells);
    fastest = msri_worse(speed, fastest);
    fetch(pass, &next);
  }
  if (same) *same = is_unchanged(pass, group, &p.field);
  if (!kept) empty(pass, group, &p.field);
  return fastest;
}
