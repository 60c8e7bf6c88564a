/* pixel.c - the stretches of a row. Pixels beside each other mostly have the same colour, which is
 * seen eight bytes at a time: they equal those three bytes before. */
#include "base/pixel.h"

#include <string.h>

static inline uint64_t word_at(const unsigned char *bytes) {
  uint64_t word;
  memcpy(&word, bytes, sizeof word);
  return word;
}

/* How many of n > 0 pixels, from the first on, have its colour. */
static inline size_t alike(const unsigned char *rgb, size_t n) {
  size_t at = 3;
  while (at + 8 <= 3 * n && word_at(rgb + at) == word_at(rgb + at - 3)) at += 8;
  while (at < 3 * n && rgb[at] == rgb[at - 3]) at++;
  return at / 3;
}

bool msri_span_next(const msr_picture *picture, size_t row, msri_span *s, msri_pixel *kind) {
  const unsigned char *rgb = msri_pixel_rgb(picture, 0, row);
  const size_t width = picture->width;
  size_t end = s->end;
  if (end == width) return false;
  *kind = msri_pixel_of(rgb + 3 * end);
  s->begin = end;
  do end += alike(rgb + 3 * end, width - end);
  while (end < width && msri_pixel_of(rgb + 3 * end) == *kind);
  s->end = end;
  return true;
}

bool msri_span_of(const msr_picture *picture, size_t row, msri_pixel wanted, msri_span *s) {
  msri_pixel kind;
  while (msri_span_next(picture, row, s, &kind))
    if (kind == wanted) return true;
  return false;
}
