/* rows.c - see rows.h. Several steps a pass over what doesn't fit into cache (temporal blocking:
 * Wolf & Lam 1991, PLDI, 30; in parts that are parallelograms of rows and stages). Rows are worked
 * on in a ring of dense copies. */
#include "sweep/rows.h"

#include "base/machine.h"
#include "base/team.h"
#include "sweep/meet.h"

#include <stdatomic.h>
#include <string.h>

enum { ROWS = MSRI_ROWS_STAGES + 3 }; /* of the ring: those of the wave, and one on each side */

/* Bytes, of a core's own megabyte and beyond: more stages a pass pay for what no longer fits. AMD
 * EPYC of the Zen 5 kind: 3 % slower with 800 kB, 2 % with 1300. */
static const size_t cache = 1100 * 1024;
static const size_t none = SIZE_MAX;

/* A row that is worked on. */
typedef struct slot {
  size_t row; /* none */
  msri_field at;
  msri_cells cells;
  msri_meet meet; /* if something may be in the way */
} slot;

enum { MARKED = 3 }; /* rows: one, the one above and the one below */

/* A part's work. */
typedef struct wave {
  const msri_pass *pass;
  const msri_object *object;
  const msri_part *part;
  size_t wide; /* cells of a row with what is around them */
  slot slot[ROWS];
  double *ring, *pulls, *edge;
  msri_marks marks[MARKED];
  size_t marked[MARKED]; /* rows; none */
  double fastest;
} wave;

/* ---- Memory */

static size_t cells(size_t width) { return msri_round_up(width, MSRI_LANES); }

static size_t wide(size_t width) { return cells(width) + 2 * MSRI_MARGIN; }

/* MSRI_BELOW_RIGHT twice. */
static size_t pulls_of_row(int ways) { return ways < MSRI_WAYS ? 2 : 8; }

/* Rows that a pass has to do with at a time: those of the wave, and one on each side. */
static size_t slots(int stages) { return (size_t)stages + ROWS - MSRI_ROWS_STAGES; }

static size_t edge_size(size_t width, int stages) { return 2 * (size_t)stages * wide(width); }

static size_t pulls_size(int ways, size_t width, int stages) {
  return (size_t)stages * pulls_of_row(ways) * wide(width);
}

static size_t marks_size(size_t width) {
  const size_t bytes = msri_marks_bytes(cells(width), MSRI_MARGIN);
  return msri_round_up(MARKED * bytes, MSRI_MARGIN * sizeof(double)) / sizeof(double);
}

/* Of all rows; a stage is that of one row at a time. */
static size_t meet_size(size_t width, int stages) {
  const size_t n = cells(width);
  return msri_meet_stage_size(n) + slots(stages) * msri_meet_size(n, n);
}

static size_t ring_size(size_t width, int stages) {
  return slots(stages) * msri_field_size(cells(width), MSRI_MARGIN);
}

/* Of a row: how many debts, and these. */
static size_t owed_to_row(size_t width) {
  return MSRI_MARGIN + wide(width) * sizeof(msri_debt) / sizeof(double);
}

static size_t owed_size(size_t width, int stages) { return (size_t)stages * owed_to_row(width); }

/* The edge, then what is owed, come first: others look there. */
size_t msri_rows_size(int ways, bool meets, bool shared, size_t width, int stages) {
  return (meets ? meet_size(width, stages) : 0) + edge_size(width, stages) +
         (meets && shared ? owed_size(width, stages) : 0) + pulls_size(ways, width, stages) +
         marks_size(width) + ring_size(width, stages);
}

int msri_rows_stages(int ways, size_t width) {
  const size_t row = (4 + pulls_of_row(ways)) * wide(width);
  const size_t stages = cache / (row * sizeof(double));
  return stages < 2 ? 2 : stages > MSRI_ROWS_STAGES ? MSRI_ROWS_STAGES : (int)stages;
}

/* ---- Rows */

/* Above the first and below the last one there are no masses. */
static const msri_marks *marks_of(wave *w, size_t row) {
  const size_t turn = (row + MARKED) % MARKED;
  const msri_marks *marks = &w->marks[turn];
  if (w->marked[turn] == row) return marks;
  w->marked[turn] = row;
  memset(marks->bits, 0, msri_marks_bytes(cells(w->object->width), MSRI_MARGIN));
  if (row < w->object->rows)
    msri_marks_set(marks, &w->pass->plan->objects, w->object->row + row, 0);
  return marks;
}

static size_t place_of(const wave *w, size_t row) { return row % slots(w->pass->stages); }

static bool is_whole(const wave *w, size_t row) {
  const msri_objects *o = &w->pass->plan->objects;
  return o->piece[o->row[w->object->row + row]].count == w->object->width;
}

static void fill(wave *w, size_t row, const msri_field *f) {
  msri_field_clear(f, is_whole(w, row) ? w->object->width : 0);
  msri_field_fill(f, &w->pass->plan->objects, w->object->row + row, w->pass->state, 0);
  const msri_marks *above = marks_of(w, row - 1), *below = marks_of(w, row + 1);
  msri_field_tie(f, w->pass->ways, marks_of(w, row), above, below);
}

/* The debts of a row that a part left to the one above before some stage. */
typedef struct owed {
  size_t *n;
  msri_debt *debt;
} owed;

static owed owed_before(const wave *w, double *memory, int stage) {
  double *at = memory + edge_size(w->object->width, w->pass->stages) +
               (size_t)stage * owed_to_row(w->object->width);
  return (owed){(void *)at, (void *)(at + MSRI_MARGIN)};
}

/* Rows from the end on were left to this part by the one below. */
static void take_over(const wave *w, size_t row, msri_debts *debts) {
  const msri_part *part = w->part;
  const size_t end = part->begin[part->number + 1];
  debts->n = 0;
  if (part->number + 1 == part->parts || row < end) return;
  const owed from = owed_before(w, part->memory[part->number + 1], (int)(row - end) + 1);
  debts->n = *from.n;
  memcpy(debts->debt, from.debt, debts->n * sizeof *debts->debt);
}

/* What is known of the row's masses is the state's, if clearances are. */
static void open_near(const wave *w, size_t row, msri_near *near) {
  const msri_objects *o = &w->pass->plan->objects;
  const msri_armed_rows *armed = &w->pass->state->armed;
  const bool arms = w->pass->plan->contact.clearance;
  const size_t at = w->object->row + row, block = o->piece[o->row[at]].block;
  msri_near_open(near, cells(w->object->width), arms ? armed->gone + at : near->gone,
                 arms ? armed->until + block : near->until);
}

static slot *open_row(wave *w, size_t row) {
  slot *s = &w->slot[place_of(w, row)];
  if (s->row == row) return s;
  s->row = row;
  fill(w, row, &s->at);
  s->cells = msri_field_cells(&s->at);
  if (!w->pass->meets) return s;
  open_near(w, row, &s->meet.near);
  take_over(w, row, &s->meet.debts);
  return s;
}

static void close_row(wave *w, size_t row, bool changed) {
  slot *s = &w->slot[place_of(w, row)];
  const size_t at = w->object->row + row;
  s->row = none;
  if (!changed) return;
  if (w->part->same && *w->part->same)
    *w->part->same = msri_field_is(&s->at, &w->pass->plan->objects, at, w->pass->state, 0);
  msri_field_empty(&s->at, &w->pass->plan->objects, at, w->pass->state, 0);
}

/* ---- Cells */

/* Of a row at a stage; where MSRI_BELOW_RIGHT is, those of the row before are kept, too. */
static double *pull_at(const wave *w, int stage, size_t row, int way) {
  const size_t count = pulls_of_row(w->pass->ways);
  const size_t last = way == MSRI_BELOW_RIGHT ? 2 * (row % 2) : 0;
  const size_t n = (size_t)stage * count + 2 * (size_t)(way - MSRI_BELOW) + last;
  return w->pulls + n * w->wide + MSRI_MARGIN;
}

static void point_at_pulls(const wave *w, int stage, size_t row, msri_cells *cells) {
  for (int way = MSRI_BELOW; way < w->pass->ways; way++) {
    double *above = pull_at(w, stage, row + 1, way), *below = pull_at(w, stage, row, way);
    cells->pull[way] = (msri_pull){below, below + w->wide};
    cells->back[way] = above - below - msri_lattice_shift(way);
  }
}

/* ---- The wave */

static size_t first_row(const wave *w, int stage) {
  const msri_part *part = w->part;
  return part->begin[part->number] + (part->number > 0 ? (size_t)stage : 0);
}

static size_t end_row(const wave *w, int stage) {
  const msri_part *part = w->part;
  const bool last = part->number + 1 == part->parts;
  return part->begin[part->number + 1] + (last ? 0 : (size_t)stage);
}

static double *edge_at(const wave *w, double *edge, int stage) {
  return edge + 2 * (size_t)stage * w->wide + MSRI_MARGIN;
}

/* Has the part below been at the row below before this stage? */
static bool is_left_behind(const wave *w, int stage, size_t row) {
  return row + 1 == end_row(w, stage) && w->part->number + 1 < w->part->parts;
}

/* The last row has none below: its own stands there. */
static const msri_cells *cells_at(wave *w, int stage, size_t row, bool behind) {
  slot *here = open_row(w, row);
  msri_cells *cells = &here->cells;
  if (behind) {
    const double *edge = edge_at(w, w->part->memory[w->part->number + 1], stage);
    cells->below_x = edge, cells->below_y = edge + w->wide;
  } else {
    const slot *below = row + 1 == w->object->rows ? here : open_row(w, row + 1);
    cells->below_x = below->at.x, cells->below_y = below->at.y;
  }
  point_at_pulls(w, stage, row, cells);
  return cells;
}

static void step_row(wave *w, int stage, size_t row) {
  const msri_pass *pass = w->pass;
  const msri_cells *cells = cells_at(w, stage, row, is_left_behind(w, stage, row));
  msri_meet *meet = &w->slot[place_of(w, row)].meet;
  const double fastest = pass->meets ? msri_meet_step(pass, &pass->stage[stage], cells, meet)
                                     : msri_field_step(pass, &pass->stage[stage], cells);
  w->fastest = msri_worse(fastest, w->fastest);
}

static void pull_below(wave *w, int stage, size_t row) {
  const msri_cells *cells = cells_at(w, stage, row, false);
  w->pass->loops->pull(cells, &w->pass->stage[stage].motion);
}

/* The row above the first one stays behind. */
static void leave_row(wave *w, int stage, size_t row) {
  const msri_debts *debts = &w->slot[place_of(w, row)].meet.debts;
  if (w->pass->meets && stage > 0) {
    const owed to = owed_before(w, w->edge, stage);
    *to.n = debts->n;
    memcpy(to.debt, debts->debt, debts->n * sizeof *debts->debt);
  }
  close_row(w, row, stage > 0);
}

/* Before a stage of a part but the first begins: the forces from the row above; and where its first
 * row is now, for the part above. */
static void begin_stage(wave *w, int stage) {
  const size_t row = first_row(w, stage), n = w->object->width;
  if (w->part->number == 0) return;
  const msri_field *f = &open_row(w, row)->at;
  double *x = edge_at(w, w->edge, stage), *y = x + w->wide;
  memcpy(x, f->x, n * sizeof *x);
  memcpy(y, f->y, n * sizeof *y);
  if (w->pass->stage[stage].forces) pull_below(w, stage, row - 1);
  leave_row(w, stage, row - 1);
  if (stage + 1 == w->pass->stages)
    atomic_store_explicit(&w->part->opened[w->part->number], w->part->turn, memory_order_release);
}

/* Sees to it that a row is in cache before it's opened: a share of it, so that memory is at work
 * all the time. */
static void fetch(const wave *w, size_t row, size_t share, size_t shares) {
  const msri_objects *o = &w->pass->plan->objects;
  if (row >= w->object->rows) return;
  const msri_piece *first = &o->piece[o->row[w->object->row + row]];
  const msri_piece *last = &o->piece[o->row[w->object->row + row + 1] - 1];
  const size_t begin = first->first, n = last->first + last->count - begin;
  msri_field_fetch(w->pass->state, begin + n * share / shares, begin + n * (share + 1) / shares);
}

static void run(wave *w) {
  const msri_part *part = w->part;
  const bool last = part->number + 1 == part->parts;
  const size_t begin = part->begin[part->number], end = part->begin[part->number + 1];
  const size_t behind = (size_t)w->pass->stages - 1;
  for (size_t front = begin; front < end + behind + (last ? 0 : behind); front++) {
    if (!last && front + 1 == end) msri_team_wait(&part->opened[part->number + 1], part->turn);
    for (int s = 0; s < w->pass->stages && front >= first_row(w, s) + (size_t)s; s++) {
      const size_t row = front - (size_t)s;
      if (row >= end_row(w, s)) continue;
      if (row == first_row(w, s)) begin_stage(w, s);
      fetch(w, front + 2, (size_t)s, (size_t)w->pass->stages);
      step_row(w, s, row);
      if (s + 1 == w->pass->stages) close_row(w, row, true);
    }
  }
}

static void place_slots(wave *w, double *memory, msri_tally *tally) {
  const size_t n = cells(w->object->width), size = msri_field_size(n, MSRI_MARGIN);
  for (size_t k = 0; k < slots(w->pass->stages); k++) {
    slot *s = &w->slot[k];
    s->row = none;
    s->at = msri_field_place(n, MSRI_MARGIN, w->ring + k * size);
    if (!w->pass->meets) continue;
    double *kept = memory + msri_meet_stage_size(n) + k * msri_meet_size(n, n);
    s->meet = msri_meet_place(n, n, memory, kept, tally);
  }
}

static void place_marks(wave *w, double *memory) {
  const size_t bytes = msri_marks_bytes(cells(w->object->width), MSRI_MARGIN);
  for (size_t n = 0; n < MARKED; n++) {
    w->marks[n] = (msri_marks){(uint8_t *)(void *)memory + n * bytes, MSRI_MARGIN + 8};
    w->marked[n] = none - MARKED;
  }
}

double msri_rows_run(const msri_pass *pass, const msri_object *object, const msri_part *part,
                     msri_tally *tally) {
  const size_t width = object->width;
  double *memory = part->memory[part->number];
  wave w = {.pass = pass, .object = object, .part = part, .wide = wide(width)};
  if (part->same) *part->same = true;
  w.edge = memory;
  const bool owes = pass->meets && part->parts > 1;
  w.pulls = memory + edge_size(width, pass->stages) + (owes ? owed_size(width, pass->stages) : 0);
  w.ring = w.pulls + pulls_size(pass->ways, width, pass->stages);
  double *marks = w.ring + ring_size(width, pass->stages);
  place_marks(&w, marks);
  place_slots(&w, marks + marks_size(width), tally);
  run(&w);
  return w.fastest;
}
