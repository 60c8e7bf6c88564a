/* field.c - see field.h. */
#include "sweep/field.h"

#include "base/machine.h"
#include "forces/motion.h"

#include <string.h>

/* ---- Memory: x, y, vx, vy, each with what is around it; blocks and how many there are */

static size_t blocks_size(size_t n) {
  const size_t bytes = n / MSRI_LANES * sizeof(msri_block) + sizeof(size_t);
  return msri_round_up(bytes, MSRI_MARGIN * sizeof(double)) / sizeof(double);
}

size_t msri_field_size(size_t n, size_t around) { return 4 * (n + 2 * around) + blocks_size(n); }

msri_field msri_field_place(size_t n, size_t around, double *memory) {
  const size_t stride = n + 2 * around;
  double *x = memory + around;
  msri_block *block = (void *)(memory + 4 * stride);
  return (msri_field){.n = n,
                      .x = x,
                      .y = x + stride,
                      .vx = x + 2 * stride,
                      .vy = x + 3 * stride,
                      .block = block,
                      .blocks = (void *)(block + n / MSRI_LANES)};
}

msri_cells msri_field_cells(const msri_field *f) {
  return (msri_cells){.n = f->n,
                      .x = f->x,
                      .y = f->y,
                      .vx = f->vx,
                      .vy = f->vy,
                      .block = f->block,
                      .blocks = *f->blocks};
}

/* ---- Masses */

enum { LONG = 64 };

/* Most pieces are short: calls would take longer than copies. */
MSRI_INLINE void copy(double *to, const double *from, size_t n) {
  if (n >= LONG) {
    memcpy(to, from, n * sizeof *to);
    return;
  }
  for (; n >= 8; n -= 8, to += 8, from += 8) memcpy(to, from, 8 * sizeof *to);
  for (size_t few = 4; few > 0; few /= 2) {
    if (n < few) continue;
    memcpy(to, from, few * sizeof *to);
    n -= few, to += few, from += few;
  }
}

void msri_field_clear(const msri_field *f, size_t from) {
  double *const array[] = {f->x, f->y, f->vx, f->vy};
  for (size_t n = 0; n < sizeof array / sizeof *array; n++)
    memset(array[n] + from, 0, (f->n - from) * sizeof *array[n]);
}

void msri_field_fill(const msri_field *f, const msri_objects *objects, size_t row,
                     const msri_swept *from, size_t at) {
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

void msri_field_fetch(const msri_swept *state, size_t begin, size_t end) {
  for (size_t i = begin; i < end; i += MSRI_MARGIN) {
    msri_prefetch(state->x + i), msri_prefetch(state->y + i);
    msri_prefetch(state->vx + i), msri_prefetch(state->vy + i);
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

size_t msri_marks_bytes(size_t n, size_t around) { return n / 8 + 2 * (around / 8 + 1); }

void msri_marks_set(const msri_marks *marks, const msri_objects *objects, size_t row, size_t at) {
  for (size_t s = objects->row[row]; s < objects->row[row + 1]; s++) {
    size_t bit = marks->first + at + objects->piece[s].column, left = objects->piece[s].count;
    for (size_t n; left > 0; bit += n, left -= n) {
      n = msri_lesser(left, 8 - bit % 8);
      marks->bits[bit / 8] |= (uint8_t)(((1U << n) - 1) << bit % 8);
    }
  }
}

/* Those of 8 cells, from some bit on. */
static unsigned eight(const uint8_t *bits, size_t bit) {
  return ((unsigned)bits[bit / 8] | (unsigned)bits[bit / 8 + 1] << 8) >> bit % 8;
}

void msri_field_tie(const msri_field *f, int ways, const msri_marks *masses,
                    const msri_marks *above, const msri_marks *below) {
  size_t n = 0;
  for (size_t c = 0; c < f->n; c += MSRI_LANES) {
    const size_t at = masses->first + c, up = above->first + c, down = below->first + c;
    const unsigned mass = eight(masses->bits, at);
    if (mass % 256 == 0) continue;
    msri_block *b = &f->block[n++];
    b->cell = (uint32_t)c;
    b->mass = (uint8_t)mass;
    b->tie[MSRI_RIGHT] = (uint8_t)(mass & eight(masses->bits, at + 1));
    for (int way = MSRI_BELOW; way < ways; way++) {
      b->tie[way] = (uint8_t)(mass & eight(below->bits, down + (size_t)msri_lattice_shift(way)));
      b->tied[way] = (uint8_t)(mass & eight(above->bits, up - (size_t)msri_lattice_shift(way)));
    }
  }
  *f->blocks = n;
}

/* ---- Steps */

double msri_field_step(const msri_pass *pass, const msri_stage *stage, const msri_cells *cells) {
  const msri_motion *motion = &stage->motion;
  if (stage->forces) {
    pass->loops->advance[msri_field_besides(pass, stage)](cells, motion);
  } else {
    msri_coast(cells->n, motion, 0, cells->vx, cells->x);
    msri_coast(cells->n, motion, 1, cells->vy, cells->y);
  }
  return stage->tells ? pass->fastest(cells) : 0;
}
