/* clearance.c - how far masses can go and meet no support: the chessboard distance max(|dx|, |dy|)
 * of every pixel from the nearest support, in two passes over the picture, exact for this distance
 * (Rosenfeld & Pfaltz 1968, Distance functions on digital pictures, Pattern Recognition 1, 33).
 *
 * From anywhere in a pixel at distance d it's d - 1 at least to the nearest support, along one axis
 * or the other, and none is met on a path that is no longer along both. Outside it's as far as to
 * the picture, too. A ring of pixels stands for all that is outside: supports if the border is
 * closed. */
#include "contacts/armed.h"
#include "contacts/supports.h"

#include <string.h>

static unsigned char nearer(unsigned char a, unsigned char b) { return a < b ? a : b; }

/* A pixel further; 255 is that far, or further. */
static unsigned char next(unsigned char d) { return d < UINT8_MAX ? (unsigned char)(d + 1) : d; }

/* From a row to the one beside it. */
static void step_across(size_t width, const unsigned char *restrict from,
                        unsigned char *restrict to) {
  for (size_t c = 1; c + 1 < width; c++)
    to[c] = nearer(to[c], next(nearer(from[c], nearer(from[c - 1], from[c + 1]))));
  const size_t last = width - 1;
  to[0] = nearer(to[0], next(nearer(from[0], from[1])));
  to[last] = nearer(to[last], next(nearer(from[last], from[last - 1])));
}

/* Downwards and to the right, then upwards and to the left, or the other way round. */
static void spread(size_t width, size_t height, unsigned char *d) {
  for (size_t r = 0; r < height; r++) {
    unsigned char *row = d + r * width;
    if (r > 0) step_across(width, row - width, row);
    for (size_t c = 1; c < width; c++) row[c] = nearer(row[c], next(row[c - 1]));
  }
  for (size_t r = height; r-- > 0;) {
    unsigned char *row = d + r * width;
    if (r + 1 < height) step_across(width, row + width, row);
    for (size_t c = width - 1; c-- > 0;) row[c] = nearer(row[c], next(row[c + 1]));
  }
}

void msri_supports_measure(msri_supports *s) {
  const size_t width = s->width + 2, height = s->height + 2;
  memset(s->distance, s->options.closed ? 0 : UINT8_MAX, width * height);
  for (size_t r = 0; r < s->height; r++)
    for (size_t c = 0; c < s->width; c++)
      s->distance[(r + 1) * width + c + 1] =
          msri_supports_solid(s, r * s->width + c) ? 0 : UINT8_MAX;
  spread(width, height, s->distance);
}

static double clearance_at(const msri_supports *s, double x, double y) {
  if (!(fabs(x) <= MSRI_ARMED_LIMIT && fabs(y) <= MSRI_ARMED_LIMIT)) return 0;
  const double gap = msri_supports_gap(s, x, y);
  if (s->options.closed) return gap;
  const double outside_x = msri_max(-x, x - (double)s->width);
  const double outside_y = msri_max(-y, y - (double)s->height);
  return msri_max(gap, msri_max(outside_x, outside_y));
}

double msri_supports_clearance(const void *self, size_t n, const double *x, const double *y) {
  double least = MSRI_ARMED_LIMIT;
  for (size_t k = 0; k < n; k++) {
    const double clearance = clearance_at(self, x[k], y[k]);
    if (!(clearance > 0)) return 0;
    least = msri_min(least, clearance);
  }
  return least;
}
