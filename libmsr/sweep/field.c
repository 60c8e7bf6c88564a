/* field.c - see field.h. */
#include "sweep/field.h"

#include "base/machine.h"
#include "forces/motion.h"

#include <string.h>

size_t msri_field_size(int ways, size_t stride) { return (size_t)(4 + ways) * stride; }

msri_field msri_field_place(int ways, size_t stride, double *memory) {
  msri_field f = {stride, memory, memory + stride, memory + 2 * stride, memory + 3 * stride, {0}};
  for (int way = 0; way < ways; way++) f.k[way] = memory + (size_t)(4 + way) * stride;
  return f;
}

/* ---- Masses */

static void clear(double *to, size_t from, size_t n) { memset(to + from, 0, n * sizeof *to); }

/* Most pieces are short: calls would take longer than copies. */
MSRI_INLINE void copy(double *to, const double *from, size_t n) {
  for (; n >= 8; n -= 8, to += 8, from += 8) memcpy(to, from, 8 * sizeof *to);
  for (size_t few = 4; few > 0; few /= 2) {
    if (n < few) continue;
    memcpy(to, from, few * sizeof *to);
    n -= few, to += few, from += few;
  }
}

void msri_field_fill(const msri_field *f, const msri_objects *objects, size_t row,
                     const msri_swept *from, size_t at, size_t width) {
  clear(f->x, at, width), clear(f->y, at, width);
  clear(f->vx, at, width), clear(f->vy, at, width);
  for (size_t s = objects->row[row]; s < objects->row[row + 1]; s++) {
    const msri_piece *piece = &objects->piece[s];
    const size_t begin = at + piece->column, n = piece->count;
    copy(f->x + begin, from->x + piece->first, n);
    copy(f->y + begin, from->y + piece->first, n);
    copy(f->vx + begin, from->vx + piece->first, n);
    copy(f->vy + begin, from->vy + piece->first, n);
  }
}

void msri_field_empty(const msri_field *f, const msri_objects *objects, size_t row,
                      const msri_swept *to, size_t at) {
  for (size_t s = objects->row[row]; s < objects->row[row + 1]; s++) {
    const msri_piece *piece = &objects->piece[s];
    const size_t begin = at + piece->column, n = piece->count;
    copy(to->x + piece->first, f->x + begin, n);
    copy(to->y + piece->first, f->y + begin, n);
    copy(to->vx + piece->first, f->vx + begin, n);
    copy(to->vy + piece->first, f->vy + begin, n);
  }
}

static bool is_same(const double *a, const double *b, size_t n) {
  return memcmp(a, b, n * sizeof *a) == 0;
}

bool msri_field_is(const msri_field *f, const msri_objects *objects, size_t row,
                   const msri_swept *state, size_t at) {
  bool same = true;
  for (size_t s = objects->row[row]; s < objects->row[row + 1] && same; s++) {
    const msri_piece *piece = &objects->piece[s];
    const size_t c = at + piece->column, i = piece->first, n = piece->count;
    same = is_same(f->x + c, state->x + i, n) && is_same(f->y + c, state->y + i, n) &&
           is_same(f->vx + c, state->vx + i, n) && is_same(f->vy + c, state->vy + i, n);
  }
  return same;
}

/* ---- Springs */

void msri_field_mark(double *marks, const msri_objects *objects, size_t row, double k,
                     size_t width) {
  memset(marks - 1, 0, (width + 2) * sizeof *marks);
  for (size_t s = objects->row[row]; s < objects->row[row + 1]; s++) {
    const msri_piece *piece = &objects->piece[s];
    for (size_t c = 0; c < piece->count; c++) marks[piece->column + c] = k;
  }
}

/* k where both have a mass. */
static void tie(size_t n, const double *restrict a, const double *restrict b, double *restrict k) {
  for (size_t c = 0; c < n; c++) k[c] = a[c] < b[c] ? a[c] : b[c];
}

void msri_field_tie(const msri_field *f, const double *marks, const double *below, int ways,
                    size_t at, size_t width) {
  tie(width, marks, marks + 1, f->k[MSRI_RIGHT] + at);
  tie(width, marks, below, f->k[MSRI_BELOW] + at);
  if (ways < MSRI_WAYS) return;
  tie(width, marks, below - 1, f->k[MSRI_BELOW_LEFT] + at);
  tie(width, marks, below + 1, f->k[MSRI_BELOW_RIGHT] + at);
}

/* ---- Steps */

double msri_field_step(const msri_pass *pass, const msri_stage *stage, const msri_cells *cells) {
  const int eight = pass->ways > MSRI_BELOW + 1;
  if (stage->forces)
    return pass->kernel->of[eight].advance[msri_field_besides(pass, stage)](cells, &stage->motion);
  msri_coast(cells->n, &stage->motion, 0, cells->vx, cells->x);
  msri_coast(cells->n, &stage->motion, 1, cells->vy, cells->y);
  return 0;
}
