/* pixel.h - what the colour of a pixel means, and the stretches of a row that mean the same. */
#ifndef MSRI_PIXEL_H
#define MSRI_PIXEL_H

#include "base/base.h"

typedef enum msri_pixel { MSRI_AIR, MSRI_SUPPORT, MSRI_MASS, MSRI_UNCLEAR, MSRI_PIXELS } msri_pixel;

/* White is air, black a support, a colour whose channels differ by a quarter of the range a mass.
 */
static inline msri_pixel msri_pixel_of(const unsigned char *rgb) {
  const int r = rgb[0], g = rgb[1], b = rgb[2];
  const int low = r < g ? (r < b ? r : b) : (g < b ? g : b);
  const int high = r > g ? (r > b ? r : b) : (g > b ? g : b);
  if (low == 255) return MSRI_AIR;
  if (high == 0) return MSRI_SUPPORT;
  return high - low >= 64 ? MSRI_MASS : MSRI_UNCLEAR;
}

static inline const unsigned char *msri_pixel_rgb(const msr_picture *picture, size_t column,
                                                  size_t row) {
  return picture->rgb + 3 * (row * picture->width + column);
}

static inline msri_pixel msri_pixel_at(const msr_picture *picture, size_t column, size_t row) {
  return msri_pixel_of(msri_pixel_rgb(picture, column, row));
}

/* Of 4 or 8 neighbours: are those at the corners among them? */
static inline bool msri_has_diagonals(int neighbours) { return neighbours == 8; }

/* Neighbours in a row, from column `begin` to `end` - 1. */
typedef struct msri_span {
  size_t begin, end;
} msri_span;

/* The next pixels of the row, from s->end on, that are all of one kind, which goes to `kind`. False
 * at the end of the row. A row of one colour takes an eighth of a step a byte. */
bool msri_span_next(const msr_picture *picture, size_t row, msri_span *s, msri_pixel *kind);

/* The same of the kind `wanted`: for (msri_span s = {0, 0}; msri_span_of(..., &s);) visits
 * them all. */
bool msri_span_of(const msr_picture *picture, size_t row, msri_pixel wanted, msri_span *s);

#endif
