/* rows.c - see rows.h. Several steps a pass over what doesn't fit into cache (temporal blocking:
 * Wolf & Lam 1991, PLDI, 30; in parts that are parallelograms of rows and stages). Rows are worked
 * on where they are, if the object is a whole rectangle, or in a ring of dense copies. */
#include "sweep/rows.h"

#include "base/team.h"
#include "sweep/meet.h"

#include <stdatomic.h>
#include <string.h>

enum { ROWS = MSRI_MOST_STAGES + 3 }; /* of the ring: those of the wave, and one on each side */

static const size_t cache = 1000 * 1024; /* bytes of a core's own, what else is needed left out */
static const size_t none = SIZE_MAX;

/* Neighbouring pieces of a row with few cells between them: columns from .. to-1. */
typedef struct island {
  size_t from, to;
  size_t next; /* piece */
} island;

enum { NEAR = 16 };

/* A row that is worked on, and the first of its islands. */
typedef struct slot {
  size_t row; /* none */
  bool in_place, single;
  msri_field at;
  island first;
  msri_meet meet; /* if something may be in the way */
} slot;

/* A part's work. */
typedef struct wave {
  const msri_pass *pass;
  const msri_object *object;
  const msri_part *part;
  size_t wide; /* cells of a row with what is around them */
  bool whole;  /* rectangle */
  bool in_place;
  slot slot[ROWS];
  double *ring, *pulls, *ties, *edge, *marks;
  size_t marked[2]; /* rows whose marks are known; none */
  double fastest;
} wave;

/* ---- Memory */

static size_t wide(size_t width) { return msri_round_up(width + 2 * MSRI_MARGIN, MSRI_MARGIN); }

/* MSRI_BELOW_RIGHT twice. */
static size_t pulls_of_row(int ways) { return ways < MSRI_WAYS ? 2 : 8; }

static size_t edge_size(size_t width, int stages) { return 2 * (size_t)stages * wide(width); }

static size_t pulls_size(int ways, size_t width, int stages) {
  return (size_t)stages * pulls_of_row(ways) * wide(width);
}

static size_t ties_size(size_t width) { return 4 * wide(width); }

static size_t marks_size(size_t width) { return 2 * wide(width); }

/* Accelerations are those of one row at a time. */
static size_t meet_size(size_t width, int stages) {
  return 2 * wide(width) + (size_t)(stages + 3) * MSRI_MEET_DEBT * wide(width);
}

/* The edge comes first: others look there. */
size_t msri_rows_size(int ways, bool meets, size_t width, int stages) {
  return (meets ? meet_size(width, stages) : 0) + edge_size(width, stages) +
         pulls_size(ways, width, stages) + ties_size(width) + marks_size(width) +
         (size_t)(stages + 3) * msri_field_size(ways, wide(width));
}

int msri_rows_stages(int ways, size_t width) {
  const size_t row = (4 + pulls_of_row(ways)) * wide(width);
  const size_t stages = cache / (row * sizeof(double));
  return stages < 2 ? 2 : stages > MSRI_MOST_STAGES ? MSRI_MOST_STAGES : (int)stages;
}

/* ---- Springs of a whole rectangle: the same in each row */

enum { TO_RIGHT, TO_LEFT, TO_ALL, TO_NONE }; /* from all cells but the last, but the first ... */

static double *ties_at(const wave *w, int which) {
  return w->ties + (size_t)which * w->wide + MSRI_MARGIN;
}

static void set_ties(const wave *w) {
  const double k = w->pass->plan->mesh.lattice_k;
  const size_t n = w->object->width;
  memset(w->ties, 0, ties_size(n) * sizeof *w->ties);
  for (size_t c = 0; c < n; c++) {
    if (c + 1 < n) ties_at(w, TO_RIGHT)[c] = k;
    if (c > 0) ties_at(w, TO_LEFT)[c] = k;
    ties_at(w, TO_ALL)[c] = k;
  }
}

static size_t first_mass(const wave *w, size_t row) {
  const msri_objects *o = &w->pass->plan->objects;
  return o->piece[o->row[w->object->row + row]].first;
}

static void tie_as_all(const wave *w, size_t row, msri_field *f) {
  static const int below[MSRI_WAYS] = {
      [MSRI_BELOW] = TO_ALL, [MSRI_BELOW_LEFT] = TO_LEFT, [MSRI_BELOW_RIGHT] = TO_RIGHT};
  const bool last = row + 1 == w->object->rows;
  f->k[MSRI_RIGHT] = ties_at(w, TO_RIGHT);
  for (int way = MSRI_BELOW; way < w->pass->ways; way++)
    f->k[way] = ties_at(w, last ? TO_NONE : below[way]);
}

static msri_field row_in_place(const wave *w, size_t row) {
  const msri_swept *state = w->pass->state;
  const size_t first = first_mass(w, row);
  msri_field f = {w->wide,           state->x + first,  state->y + first,
                  state->vx + first, state->vy + first, {NULL}};
  tie_as_all(w, row, &f);
  return f;
}

/* ---- The ring */

static size_t place_of(const wave *w, size_t row) { return row % (size_t)(w->pass->stages + 3); }

/* Where a row has masses; below the last one there are none. */
static const double *marks_of(wave *w, size_t row) {
  const size_t turn = row % 2, n = w->object->width;
  double *marks = w->marks + turn * w->wide + MSRI_MARGIN;
  if (w->marked[turn] == row) return marks;
  w->marked[turn] = row;
  if (row < w->object->rows)
    msri_field_mark(marks, &w->pass->plan->objects, w->object->row + row,
                    w->pass->plan->mesh.lattice_k, n);
  else
    memset(marks - 1, 0, (n + 2) * sizeof *marks);
  return marks;
}

static void tie_by_marks(wave *w, size_t row, msri_field *f) {
  const int ways = w->pass->ways;
  msri_field_tie(f, marks_of(w, row), marks_of(w, row + 1), ways, MSRI_MARGIN, w->object->width);
  for (int way = 0; way < ways; way++) f->k[way] += MSRI_MARGIN;
}

static msri_field row_in_ring(wave *w, size_t row) {
  const int ways = w->pass->ways;
  const size_t size = msri_field_size(ways, w->wide);
  msri_field f = msri_field_place(ways, w->wide, w->ring + place_of(w, row) * size);
  msri_field_fill(&f, &w->pass->plan->objects, w->object->row + row, w->pass->state, MSRI_MARGIN,
                  w->object->width);
  f.x += MSRI_MARGIN, f.y += MSRI_MARGIN, f.vx += MSRI_MARGIN, f.vy += MSRI_MARGIN;
  if (w->whole)
    tie_as_all(w, row, &f);
  else
    tie_by_marks(w, row, &f);
  return f;
}

/* Rows are looked at beyond their ends, where other threads may be at work: the part below at those
 * that it has been at; at other objects in what isn't the end of the row before, and the beginning
 * of the next. */
static bool is_at_border(const wave *w, size_t row) {
  const msri_part *part = w->part;
  const size_t n = w->object->width;
  if (w->pass->plan->threads == 1) return false;
  if (part->number + 1 < part->parts && row + 1 >= part->begin[part->number + 1]) return true;
  const bool last = row + 1 == w->object->rows;
  return last || first_mass(w, row + 1) != first_mass(w, row) + n ||
         (row > 0 && first_mass(w, row) != first_mass(w, row - 1) + n);
}

/* The first island of a row from piece s on. */
static bool find_island(const wave *w, size_t row, size_t s, island *i) {
  const msri_objects *o = &w->pass->plan->objects;
  const size_t end = o->row[w->object->row + row + 1];
  if (s == end) return false;
  i->from = o->piece[s].column;
  i->to = i->from + o->piece[s].count;
  for (s++; s < end && o->piece[s].column < i->to + NEAR; s++)
    i->to = (size_t)o->piece[s].column + o->piece[s].count;
  i->next = s;
  return true;
}

static size_t first_piece(const wave *w, size_t row) {
  return w->pass->plan->objects.row[w->object->row + row];
}

/* Makes it one with the next. */
static void join_island(const wave *w, size_t row, island *i) {
  const size_t from = i->from;
  find_island(w, row, i->next, i);
  i->from = from;
}

static const slot *open_row(wave *w, size_t row) {
  slot *s = &w->slot[place_of(w, row)];
  if (s->row == row) return s;
  s->row = row;
  s->in_place = w->in_place && !is_at_border(w, row);
  s->at = s->in_place ? row_in_place(w, row) : row_in_ring(w, row);
  find_island(w, row, first_piece(w, row), &s->first);
  while (w->pass->meets && s->first.next < first_piece(w, row + 1)) /* as if it were one */
    join_island(w, row, &s->first);
  s->single = s->first.next == first_piece(w, row + 1);
  return s;
}

static void close_row(wave *w, size_t row, bool changed) {
  slot *s = &w->slot[place_of(w, row)];
  s->row = none;
  if (s->in_place || !changed) return;
  if (w->part->same && *w->part->same)
    *w->part->same =
        msri_field_is(&s->at, &w->pass->plan->objects, w->object->row + row, w->pass->state, 0);
  msri_field_empty(&s->at, &w->pass->plan->objects, w->object->row + row, w->pass->state, 0);
}

/* ---- Cells */

/* Of a row at a stage; where MSRI_BELOW_RIGHT is, those of the row before are kept, too. */
static msri_pull pull_at(const wave *w, int stage, size_t row, int way) {
  const size_t count = pulls_of_row(w->pass->ways);
  const size_t last = way == MSRI_BELOW_RIGHT ? 2 * (row % 2) : 0;
  const size_t n = (size_t)stage * count + 2 * (size_t)(way - MSRI_BELOW) + last;
  double *x = w->pulls + n * w->wide + MSRI_MARGIN;
  return (msri_pull){x, x + w->wide};
}

/* No forces to cells a .. b-1 of the row below. */
static void clear_pulls(const wave *w, int stage, size_t row, size_t a, size_t b) {
  for (int way = MSRI_BELOW; way < w->pass->ways && a < b; way++) {
    const msri_pull pull = pull_at(w, stage, row, way);
    memset(pull.x + a, 0, (b - a) * sizeof *pull.x);
    memset(pull.y + a, 0, (b - a) * sizeof *pull.y);
  }
}

/* No forces to where the row below will look for some, but where this row has cells. */
static void clear_rest(const wave *w, int stage, size_t row, island here) {
  const size_t beyond = w->pass->ways == MSRI_WAYS ? 1 : 0;
  island below = {.next = first_piece(w, row + 1)};
  bool more = true;
  while (find_island(w, row + 1, below.next, &below)) {
    size_t done = below.from < beyond ? 0 : below.from - beyond;
    const size_t end = below.to + beyond;
    for (; more && here.from < end; more = find_island(w, row, here.next, &here)) {
      clear_pulls(w, stage, row, done, here.from);
      if (here.to > done) done = here.to;
      if (here.to >= end) break;
    }
    clear_pulls(w, stage, row, done, end);
  }
}

/* The same where both are single islands. */
static void clear_sides(const wave *w, int stage, size_t row, const island *here,
                        const island *below) {
  const size_t beyond = w->pass->ways == MSRI_WAYS ? 1 : 0;
  const size_t from = below->from < beyond ? 0 : below->from - beyond, to = below->to + beyond;
  clear_pulls(w, stage, row, from, here->from < to ? here->from : to);
  clear_pulls(w, stage, row, here->to > from ? here->to : from, to);
}

static void clear_around(const wave *w, int stage, size_t row, const slot *here,
                         const slot *below) {
  if (below && here->single && below->single)
    clear_sides(w, stage, row, &here->first, &below->first);
  else
    clear_rest(w, stage, row, here->first);
}

static msri_cells cells_of(const wave *w, int stage, size_t row, const island *i,
                           const msri_field *f, const double *below_x, const double *below_y) {
  static const ptrdiff_t shift[MSRI_WAYS] = {[MSRI_BELOW_LEFT] = 1, [MSRI_BELOW_RIGHT] = -1};
  const ptrdiff_t at = (ptrdiff_t)i->from;
  msri_cells cells = {
      .n = i->to - i->from,
      .x = f->x + at,
      .y = f->y + at,
      .vx = f->vx + at,
      .vy = f->vy + at,
      .below_x = below_x + at,
      .below_y = below_y + at,
      .k = {f->k[MSRI_RIGHT] + at},
  };
  for (int way = MSRI_BELOW; way < w->pass->ways; way++) {
    const msri_pull above = pull_at(w, stage, row + 1, way), below = pull_at(w, stage, row, way);
    cells.k[way] = f->k[way] + at;
    cells.above[way] = (msri_pull){above.x + at + shift[way], above.y + at + shift[way]};
    cells.below[way] = (msri_pull){below.x + at, below.y + at};
  }
  return cells;
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

static double step_past(wave *w, int stage, size_t row, const msri_cells *cells, island i) {
  const msri_pass *pass = w->pass;
  msri_meet *meet = &w->slot[place_of(w, row)].meet;
  msri_tally *tally = meet->tally;
  const bool timed = msri_tally_is_turn(tally);
  double start = timed ? msri_clock_now() : 0;
  const double fastest = msri_meet_kick(pass, &pass->stage[stage], cells, meet);
  if (timed) start = msri_tally_add(tally, start, &tally->kicks);
  if (pass->stage[stage].motion.drift != 0)
    msri_meet_drift(pass, &pass->stage[stage], w->object->row + row, fastest, cells, 0 - i.from,
                    meet);
  if (timed) msri_tally_add(tally, start, &tally->drifts);
  return fastest;
}

static void step_row(wave *w, int stage, size_t row, bool pulls_only) {
  const msri_pass *pass = w->pass;
  const bool last = row + 1 == w->object->rows;
  const bool behind = !pulls_only && is_left_behind(w, stage, row);
  const slot *here = open_row(w, row), *below = last || behind ? NULL : open_row(w, row + 1);
  const double *edge = behind ? edge_at(w, w->part->memory[w->part->number + 1], stage) : NULL;
  const double *x = edge ? edge : below ? below->at.x : here->at.x;
  const double *y = edge ? edge + w->wide : below ? below->at.y : here->at.y;
  island i = here->first;
  do {
    const msri_cells cells = cells_of(w, stage, row, &i, &here->at, x, y);
    if (pulls_only)
      pass->kernel->of[pass->ways > MSRI_BELOW + 1].pull(&cells, &pass->stage[stage].motion);
    else if (pass->meets)
      w->fastest = msri_worse(step_past(w, stage, row, &cells, i), w->fastest);
    else
      w->fastest = msri_worse(msri_field_step(pass, &pass->stage[stage], &cells), w->fastest);
  } while (!here->single && find_island(w, row, i.next, &i));
  if (!last && !w->whole && pass->stage[stage].forces) clear_around(w, stage, row, here, below);
}

/* Before a stage of a part but the first begins: the forces from the row above, which stays behind;
 * and where its first row is now, for the part above. */
static void begin_stage(wave *w, int stage) {
  const size_t row = first_row(w, stage), n = w->object->width;
  if (w->part->number == 0) return;
  const msri_field *f = &open_row(w, row)->at;
  double *x = edge_at(w, w->edge, stage), *y = x + w->wide;
  memcpy(x, f->x, n * sizeof *x);
  memcpy(y, f->y, n * sizeof *y);
  if (w->pass->stage[stage].forces) step_row(w, stage, row - 1, true);
  close_row(w, row - 1, stage > 0);
  if (stage + 1 == w->pass->stages)
    atomic_store_explicit(&w->part->opened[w->part->number], w->part->turn, memory_order_release);
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
      step_row(w, s, row, false);
      if (s + 1 == w->pass->stages) close_row(w, row, true);
    }
  }
}

static void place_slots(wave *w, double *memory, msri_tally *tally) {
  for (int n = 0; n < w->pass->stages + 3; n++) {
    slot *s = &w->slot[n];
    s->row = none;
    if (!w->pass->meets) continue;
    s->meet = msri_meet_place(0, w->wide,
                              memory + 2 * w->wide + (size_t)n * MSRI_MEET_DEBT * w->wide, tally);
    s->meet.ax = memory, s->meet.ay = memory + w->wide;
  }
}

double msri_rows_run(const msri_pass *pass, const msri_object *object, const msri_part *part,
                     msri_tally *tally) {
  const size_t width = object->width;
  double *memory = part->memory[part->number];
  wave w = {.pass = pass, .object = object, .part = part, .wide = wide(width)};
  w.whole = object->masses == object->rows * width;
  w.in_place = w.whole && !part->same;
  if (part->same) *part->same = true;
  w.edge = memory;
  w.pulls = w.edge + edge_size(width, pass->stages);
  w.ties = w.pulls + pulls_size(pass->ways, width, pass->stages);
  w.marks = w.ties + ties_size(width);
  w.marked[0] = w.marked[1] = none;
  w.ring = w.marks + marks_size(width);
  place_slots(&w, memory + msri_rows_size(pass->ways, false, width, pass->stages), tally);
  memset(w.pulls, 0, pulls_size(pass->ways, width, pass->stages) * sizeof *w.pulls);
  if (w.whole) set_ties(&w);
  run(&w);
  return w.fastest;
}
