/* objects.c - connected components of a picture's masses, by its pieces: masses side by side in
 * a row without a gap. Pieces that touch those of the row above are united with them (Rosenfeld
 * & Pfaltz 1966, J. ACM 13, 471). */
#include "plan/objects.h"

#include "base/pixel.h"
#include "base/trees.h"

#include <stdlib.h>
#include <string.h>

/* A piece as it is found, in reading order. */
typedef struct found {
  size_t first;
  uint32_t row, column, count;
} found;

typedef struct finds {
  found *at;        /* [n] */
  uint32_t *parent; /* [n]: trees, whose roots are the first of each object */
  size_t n, capacity, masses;
  msr_error *err;
} finds;

/* ---- Pieces */

static msr_status find_in_row(finds *f, const msr_picture *picture, size_t row) {
  for (msri_span s = {0, 0}; msri_span_of(picture, row, MSRI_MASS, &s);) {
    const uint32_t count = (uint32_t)(s.end - s.begin);
    found *grown = msri_grow(f->at, &f->capacity, f->n + 1, sizeof *grown, "the objects", f->err);
    if (!grown) return MSR_ENOMEM;
    f->at = grown;
    grown[f->n++] = (found){f->masses, (uint32_t)row, (uint32_t)s.begin, count};
    f->masses += count;
  }
  return MSR_OK;
}

/* Unites those of a row, from..to-1, with those above, above..from-1, that they touch; `reach` is 1
 * if corners do. */
static void unite_rows(finds *f, size_t above, size_t from, size_t to, uint32_t reach) {
  const found *at = f->at;
  size_t a = above;
  for (size_t s = from; s < to; s++) {
    const uint32_t end = at[s].column + at[s].count + reach;
    while (a < from && at[a].column + at[a].count + reach <= at[s].column) a++;
    for (size_t b = a; b < from && at[b].column < end; b++)
      msri_trees_join(f->parent, (uint32_t)b, (uint32_t)s);
  }
}

static void unite(finds *f, uint32_t reach) {
  const found *at = f->at;
  msri_trees_plant(f->n, f->parent);
  for (size_t above = 0, from = 0, to = 0; from < f->n; above = from, from = to) {
    while (to < f->n && at[to].row == at[from].row) to++;
    if (at[above].row + 1 == at[from].row) unite_rows(f, above, from, to, reach);
  }
}

static msr_status find(finds *f, const msr_picture *picture, int neighbours) {
  for (size_t row = 0; row < picture->height; row++) {
    const msr_status status = find_in_row(f, picture, row);
    if (status != MSR_OK) return status;
  }
  f->parent = msri_alloc(f->n, sizeof *f->parent, "the objects", f->err);
  if (!f->parent) return MSR_ENOMEM;
  unite(f, msri_has_diagonals(neighbours) ? 1 : 0);
  return MSR_OK;
}

/* ---- Objects */

/* What an object covers, and where its pieces go next. */
typedef struct extent {
  uint32_t top, bottom, left, right; /* inclusive; right is past its last column */
  size_t pieces, next, masses, number;
} extent;

static void extend(extent *e, const found *s) {
  if (e->pieces == 0) *e = (extent){.top = s->row, .left = s->column};
  e->bottom = s->row;
  if (s->column < e->left) e->left = s->column;
  if (s->column + s->count > e->right) e->right = s->column + s->count;
  e->pieces++;
  e->masses += s->count;
}

/* Extents of the objects, at the numbers of their roots. */
static void measure(const finds *f, extent *of) {
  for (size_t s = 0; s < f->n; s++) {
    const uint32_t root = f->parent[s] = msri_trees_root(f->parent, (uint32_t)s);
    extend(&of[root], &f->at[s]);
  }
}

static void number(const finds *f, extent *of, msri_objects *o) {
  size_t next = 0;
  for (size_t s = 0; s < f->n; s++) {
    if (f->parent[s] != s) continue;
    of[s].number = o->n;
    of[s].next = next;
    const size_t rows = of[s].bottom - of[s].top + 1;
    o->object[o->n++] = (msri_object){o->n_rows, rows, of[s].right - of[s].left, of[s].masses};
    o->n_rows += rows;
    next += of[s].pieces;
  }
}

/* Blocks that a piece has cells in. */
static size_t blocks_of(const msri_piece *piece) {
  return (piece->column + piece->count - 1) / MSRI_LANES - piece->column / MSRI_LANES + 1;
}

/* Pieces by object, and the first of each row: an object has one in each of its rows. */
static void arrange(const finds *f, extent *of, msri_objects *o) {
  for (size_t s = 0; s < f->n; s++) {
    const found *from = &f->at[s];
    extent *e = &of[f->parent[s]];
    const size_t row = o->object[e->number].row + (from->row - e->top);
    const bool first = s == f->parent[s] || o->row[row] == SIZE_MAX;
    if (first) o->row[row] = e->next;
    o->piece[e->next++] = (msri_piece){from->first, from->column - e->left, from->count, 0};
  }
  o->row[o->n_rows] = f->n;
  for (msri_piece *piece = o->piece; piece < o->piece + f->n; piece++) {
    piece->block = o->n_blocks;
    o->n_blocks += blocks_of(piece);
  }
}

static size_t count_rows(const finds *f, const extent *of, size_t *objects) {
  size_t rows = 0;
  for (size_t s = 0; s < f->n; s++) {
    if (f->parent[s] != s) continue;
    ++*objects;
    rows += of[s].bottom - of[s].top + 1;
  }
  return rows;
}

static msr_status build(finds *f, msri_objects *o, msr_error *err) {
  extent *of = msri_alloc(f->n, sizeof *of, "the objects", err);
  if (!of) return MSR_ENOMEM;
  measure(f, of);
  size_t objects = 0;
  const size_t rows = count_rows(f, of, &objects);
  o->object = msri_alloc(objects, sizeof *o->object, "the objects", err);
  o->row = msri_alloc(rows + 1, sizeof *o->row, "the objects", err);
  o->piece = msri_alloc(f->n, sizeof *o->piece, "the objects", err);
  const bool room = o->object && o->row && o->piece;
  if (room) {
    memset(o->row, 0xff, (rows + 1) * sizeof *o->row);
    number(f, of, o);
    arrange(f, of, o);
  }
  free(of);
  return room ? MSR_OK : MSR_ENOMEM;
}

msr_status msri_objects_create(const msr_picture *picture, int neighbours, msri_objects *objects,
                               msr_error *err) {
  finds f = {.err = err};
  *objects = (msri_objects){0};
  msr_status status = find(&f, picture, neighbours);
  if (status == MSR_OK) status = build(&f, objects, err);
  if (status != MSR_OK) msri_objects_clear(objects);
  free(f.at);
  free(f.parent);
  return status;
}

void msri_objects_clear(msri_objects *objects) {
  free(objects->object);
  free(objects->row);
  free(objects->piece);
  *objects = (msri_objects){0};
}

size_t msri_objects_bytes(const msri_objects *o) {
  if (!o->row) return 0;
  return o->n * sizeof *o->object + (o->n_rows + 1) * sizeof *o->row +
         o->row[o->n_rows] * sizeof *o->piece;
}
