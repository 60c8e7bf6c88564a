/* field.c - see field.h. */
#include "sweep/field.h"

#include "base/vector.h"

#include <string.h>

size_t msri_field_size(int ways, size_t stride) { return (size_t)(4 + ways) * stride; }

msri_field msri_field_place(int ways, size_t stride, double *memory) {
  msri_field f = {stride, memory, memory + stride, memory + 2 * stride, memory + 3 * stride, {0}};
  for (int way = 0; way < ways; way++) f.k[way] = memory + (size_t)(4 + way) * stride;
  return f;
}

/* ---- Masses */

static void clear(double *to, size_t from, size_t end) {
  memset(to + from, 0, (end - from) * sizeof *to);
}

static void copy(double *to, const double *from, size_t n) { memcpy(to, from, n * sizeof *to); }

void msri_field_fill(const msri_field *f, const msri_objects *objects, size_t row,
                     const msri_swept *from, size_t at, size_t width) {
  const double *const source[] = {from->x, from->y, from->vx, from->vy};
  double *const array[] = {f->x, f->y, f->vx, f->vy};
  for (int n = 0; n < 4; n++) {
    size_t done = at;
    for (size_t s = objects->row[row]; s < objects->row[row + 1]; s++) {
      const msri_span *span = &objects->span[s];
      const size_t begin = at + span->column;
      clear(array[n], done, begin);
      copy(array[n] + begin, source[n] + span->first, span->count);
      done = begin + span->count;
    }
    clear(array[n], done, at + width);
  }
}

void msri_field_empty(const msri_field *f, const msri_objects *objects, size_t row,
                      const msri_swept *to, size_t at) {
  for (size_t s = objects->row[row]; s < objects->row[row + 1]; s++) {
    const msri_span *span = &objects->span[s];
    const size_t begin = at + span->column, n = span->count;
    copy(to->x + span->first, f->x + begin, n);
    copy(to->y + span->first, f->y + begin, n);
    copy(to->vx + span->first, f->vx + begin, n);
    copy(to->vy + span->first, f->vy + begin, n);
  }
}

/* ---- Springs */

static void set(double *k, size_t from, size_t end, double value) {
  for (size_t c = from; c < end; c++) k[c] = value;
}

/* From cells of a span to those of the row below, `shift` columns to the right. */
static void tie_below(double *k, size_t at, const msri_span *span, const msri_objects *objects,
                      size_t below, int shift, double value) {
  const ptrdiff_t begin = span->column, end = begin + span->count;
  for (size_t s = objects->row[below]; s < objects->row[below + 1]; s++) {
    const msri_span *other = &objects->span[s];
    const ptrdiff_t first = (ptrdiff_t)other->column - shift, last = first + other->count;
    if (first >= end) return;
    const ptrdiff_t a = first > begin ? first : begin, b = last < end ? last : end;
    if (a < b) set(k, at + (size_t)a, at + (size_t)b, value);
  }
}

void msri_field_tie(const msri_field *f, const msri_objects *objects, size_t row, bool last,
                    double k, int ways, size_t at, size_t width) {
  static const int shift[MSRI_WAYS] = {[MSRI_BELOW_LEFT] = -1, [MSRI_BELOW_RIGHT] = 1};
  for (int way = 0; way < ways; way++) clear(f->k[way], at, at + width);
  for (size_t s = objects->row[row]; s < objects->row[row + 1]; s++) {
    const msri_span *span = &objects->span[s];
    const size_t begin = at + span->column;
    set(f->k[MSRI_RIGHT], begin, begin + span->count - 1, k);
    for (int way = MSRI_BELOW; way < ways && !last; way++)
      tie_below(f->k[way], at, span, objects, row + 1, shift[way], k);
  }
}

/* ---- Steps */

double msri_field_step(const msri_pass *pass, const msri_stage *stage, const msri_cells *cells) {
  const int eight = pass->ways > MSRI_BELOW + 1;
  if (stage->forces) return pass->kernel->of[eight].advance[pass->besides](cells, &stage->motion);
  msri_add_scaled(cells->n, stage->motion.drift, cells->vx, cells->x);
  msri_add_scaled(cells->n, stage->motion.drift, cells->vy, cells->y);
  return 0;
}
