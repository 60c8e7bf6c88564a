/* grid.c - the picture of a scene, and where its masses are: numbers of those before each row, from
 * which one row tells the rest. */
#include "scene/grid.h"

#include <stdlib.h>

/* Pixels of each kind. */
typedef struct census {
  size_t of[MSRI_PIXELS];
  size_t row, column; /* of the first unclear one */
} census;

static void count_row(const msr_picture *picture, size_t row, census *c) {
  msri_pixel kind;
  for (msri_span s = {0, 0}; msri_span_next(picture, row, &s, &kind);) {
    if (kind == MSRI_UNCLEAR && c->of[kind] == 0) c->row = row, c->column = s.begin;
    c->of[kind] += s.end - s.begin;
  }
}

static msr_status check(const char *name, const msr_picture *picture, const census *c,
                        msr_error *err) {
  const size_t unclear = c->of[MSRI_UNCLEAR];
  if (unclear == 0) return MSR_OK;
  const unsigned char *rgb = msri_pixel_rgb(picture, c->column, c->row);
  return msri_fail(err, MSR_EINPUT,
                   "%s:%zu:%zu: pixel (%zu,%zu) is %d,%d,%d, neither white, black nor a clear "
                   "colour (%zu such pixel%s in all); paint it white (255,255,255) for air, black "
                   "(0,0,0) for a support, or a colour such as red for a mass",
                   name, c->row + 1, c->column + 1, c->column, c->row, rgb[0], rgb[1], rgb[2],
                   unclear, unclear == 1 ? "" : "s");
}

static msr_status fill(msri_grid *grid, const char *name, const msr_picture *picture,
                       msr_error *err) {
  census c = {{0}, 0, 0};
  grid->before = msri_alloc(picture->height + 1, sizeof *grid->before, "the rows", err);
  if (!grid->before) return MSR_ENOMEM;
  for (size_t row = 0; row < picture->height; row++) {
    count_row(picture, row, &c);
    grid->before[row + 1] = c.of[MSRI_MASS];
  }
  grid->masses = c.of[MSRI_MASS];
  grid->supports = c.of[MSRI_SUPPORT];
  return check(name, picture, &c, err);
}

msr_status msri_grid_create(const char *name, msr_picture *picture, msri_grid **grid,
                            msr_error *err) {
  msri_grid *made = msri_alloc(1, sizeof *made, "a picture", err);
  if (!made) return MSR_ENOMEM;
  atomic_init(&made->owners, 1);
  const msr_status status = fill(made, name, picture, err);
  if (status != MSR_OK) {
    msri_grid_free(made);
    return status;
  }
  made->picture = picture;
  *grid = made;
  return MSR_OK;
}

msri_grid *msri_grid_share(msri_grid *grid) {
  atomic_fetch_add(&grid->owners, 1);
  return grid;
}

void msri_grid_free(msri_grid *grid) {
  if (!grid || atomic_fetch_sub(&grid->owners, 1) > 1) return;
  msr_picture_free(grid->picture);
  free(grid->before);
  free(grid);
}

size_t msri_grid_bytes(const msri_grid *grid) {
  if (!grid) return 0;
  const msr_picture *p = grid->picture;
  return sizeof *grid + sizeof *p + 3 * p->width * p->height +
         (p->height + 1) * sizeof *grid->before;
}

size_t msri_grid_mass(const msri_grid *grid, size_t column, size_t row) {
  size_t mass = grid->before[row];
  for (msri_span s = {0, 0}; msri_span_of(grid->picture, row, MSRI_MASS, &s);) {
    if (column < s.end) return mass + (column - s.begin);
    mass += s.end - s.begin;
  }
  return mass;
}

/* The row of a mass: the last that has none of it and those after it before. */
static size_t row_of(const msri_grid *grid, size_t mass) {
  size_t row = 0, below = grid->picture->height;
  while (below - row > 1) {
    const size_t middle = row + (below - row) / 2;
    *(grid->before[middle] <= mass ? &row : &below) = middle;
  }
  return row;
}

void msri_grid_pixel(const msri_grid *grid, size_t mass, size_t *column, size_t *row) {
  *row = row_of(grid, mass);
  size_t left = mass - grid->before[*row];
  msri_span s = {0, 0};
  while (msri_span_of(grid->picture, *row, MSRI_MASS, &s) && left >= s.end - s.begin)
    left -= s.end - s.begin;
  *column = s.begin + left;
}

/* Has the row nothing but the masses of a span? */
static bool has_only(const msri_grid *grid, size_t row, const msri_span *only) {
  msri_span s = {0, 0};
  const size_t masses = grid->before[row + 1] - grid->before[row];
  return masses == only->end - only->begin && msri_span_of(grid->picture, row, MSRI_MASS, &s) &&
         s.begin == only->begin && s.end == only->end;
}

bool msri_grid_is_rectangle(const msri_grid *grid, size_t side[2]) {
  if (grid->masses == 0) return false;
  const size_t top = row_of(grid, 0), end = row_of(grid, grid->masses - 1) + 1;
  msri_span first = {0, 0};
  msri_span_of(grid->picture, top, MSRI_MASS, &first);
  for (size_t row = top; row < end; row++)
    if (!has_only(grid, row, &first)) return false;
  side[0] = first.end - first.begin;
  side[1] = end - top;
  return true;
}
