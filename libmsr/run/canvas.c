/* canvas.c - where masses are among the pixels, and their squares.
 *
 * Places to numbers of pixels is a plain loop, compiled for vectors of several widths; squares
 * follow in their order. At scale 1 all is done some masses at a time, while these numbers are in
 * the fastest cache, and masses that follow each other in the frame as well are drawn eight at
 * once. */
#include "run/canvas.h"

#include "base/machine.h"
#include "formats/ppm.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { AT_ONCE = 256, GROUP = MSRI_CANVAS_GROUP };

msr_status msri_canvas_create(size_t width, size_t height, size_t scale, msri_canvas *canvas,
                              msr_error *err) {
  const size_t most = INT32_MAX / scale;
  if (width + 2 > most || height + 2 > most ||
      (height + 2) * scale > INT32_MAX / ((width + 2) * scale))
    return msri_fail(err, MSR_EUSAGE, "scale %zu makes the frames too large", scale);
  const size_t columns = width * scale, rows = height * scale;
  const size_t pixels = MSRI_PPM_HEADER_SIZE + columns * rows + 1;
  unsigned char *block = msri_alloc(pixels, 3, "the pixels of a frame", err);
  if (!block) return MSR_ENOMEM;
  *canvas = (msri_canvas){.scale = scale,
                          .top = (double)height,
                          .frame = {columns, rows, block + MSRI_PPM_HEADER_SIZE}};
  msri_canvas_whiten(canvas);
  return MSR_OK;
}

void msri_canvas_clear(msri_canvas *canvas) {
  if (canvas->frame.rgb) free(canvas->frame.rgb - MSRI_PPM_HEADER_SIZE);
  canvas->frame.rgb = NULL;
}

void msri_canvas_whiten(msri_canvas *canvas) {
  const msr_picture *frame = &canvas->frame;
  memset(frame->rgb, 255, 3 * frame->width * frame->height);
  canvas->white = true;
}

/* ---- Places
 *
 * A square is seen while its first pixel is in the frame or less than `scale` to the left of it or
 * above: pixels of a grid with a margin there, which are numbered row by row. All others have the
 * number after the last. */

typedef struct grid {
  double scale, top;
  double margin, width, height; /* [pixels] of the margin, of the frame */
  double line, outside;         /* pixels of a row; their number in all */
} grid;

MSRI_INLINE grid grid_of(const msri_canvas *canvas) {
  grid g = {.scale = (double)canvas->scale, .top = canvas->top};
  g.margin = g.scale - 1;
  g.width = (double)canvas->frame.width;
  g.height = (double)canvas->frame.height;
  g.line = g.width + g.margin;
  g.outside = g.line * (g.height + g.margin);
  return g;
}

/* As for supports, a pixel owns its left and lower edges. */
MSRI_INLINE void find(grid g, size_t n, const double *restrict x, const double *restrict y,
                      int32_t *restrict at) {
  for (size_t i = 0; i < n; i++) {
    const double column = floor((x[i] - 0.5) * g.scale + 0.5);
    const double row = ceil((g.top - y[i] - 0.5) * g.scale - 0.5);
    const double number = (row + g.margin) * g.line + (column + g.margin);
    const int seen =
        (column >= -g.margin) & (column < g.width) & (row >= -g.margin) & (row < g.height);
    at[i] = (int32_t)(seen ? number : g.outside);
  }
}

/* Where does the next one not follow in the frame? */
MSRI_INLINE void find_breaks(size_t n, const int32_t *restrict at, unsigned char *restrict breaks) {
  for (size_t i = 0; i + 1 < n; i++) breaks[i] = at[i + 1] - at[i] != 1;
}

/* ---- Squares */

/* Their colours follow each other, too. */
MSRI_INLINE void set_pixels(size_t n, const int32_t *at, const unsigned char *breaks,
                            const unsigned char *colour, size_t stride, unsigned char *rgb) {
  static const unsigned char none[GROUP - 1] = {0};
  size_t i = 0;
  for (; i + GROUP <= n; i += GROUP, colour += GROUP * stride) {
    unsigned char *first = rgb + 3 * (size_t)at[i];
    if (memcmp(breaks + i, none, sizeof none) == 0) {
      memcpy(first, colour, 3 * (size_t)GROUP);
      continue;
    }
    for (size_t k = 0; k < GROUP; k++) memcpy(rgb + 3 * (size_t)at[i + k], colour + k * stride, 3);
  }
  for (; i < n; i++, colour += stride) memcpy(rgb + 3 * (size_t)at[i], colour, 3);
}

static size_t at_least_0(ptrdiff_t a) { return a < 0 ? 0 : (size_t)a; }

static size_t at_most(size_t most, ptrdiff_t a) { return a < (ptrdiff_t)most ? (size_t)a : most; }

/* What of it is in the frame. */
static void set_square(const msri_canvas *canvas, int32_t at, const unsigned char *colour) {
  const msr_picture *frame = &canvas->frame;
  const ptrdiff_t scale = (ptrdiff_t)canvas->scale, line = (ptrdiff_t)frame->width + scale - 1;
  const ptrdiff_t column = at % line - (scale - 1), row = at / line - (scale - 1);
  const size_t left = at_least_0(column), right = at_most(frame->width, column + scale);
  const size_t top = at_least_0(row), bottom = at_most(frame->height, row + scale);
  for (size_t r = top; r < bottom; r++)
    for (size_t c = left; c < right; c++)
      memcpy(frame->rgb + 3 * (r * frame->width + c), colour, 3);
}

static size_t stride_of(const msri_colours *colours) { return colours->alike ? 0 : 3; }

MSRI_INLINE void draw(const msri_canvas *canvas, const msri_colours *colours, size_t n,
                      const double *x, const double *y) {
  const grid g = grid_of(canvas);
  const size_t stride = stride_of(colours);
  for (size_t i = 0; i < n; i += AT_ONCE) {
    int32_t at[AT_ONCE];
    unsigned char breaks[AT_ONCE];
    const size_t count = n - i < AT_ONCE ? n - i : AT_ONCE;
    find(g, count, x + i, y + i, at);
    find_breaks(count, at, breaks);
    set_pixels(count, at, breaks, colours->rgb + i * stride, stride, canvas->frame.rgb);
  }
}

/* ---- Kernels */

#if MSRI_WIDE
MSRI_AVX512 static void find_avx512(const msri_canvas *canvas, size_t n, const double *x,
                                    const double *y, int32_t *at) {
  find(grid_of(canvas), n, x, y, at);
}

MSRI_AVX512 static void draw_avx512(const msri_canvas *canvas, const msri_colours *colours,
                                    size_t n, const double *x, const double *y) {
  draw(canvas, colours, n, x, y);
}

MSRI_AVX2 static void find_avx2(const msri_canvas *canvas, size_t n, const double *x,
                                const double *y, int32_t *at) {
  find(grid_of(canvas), n, x, y, at);
}

MSRI_AVX2 static void draw_avx2(const msri_canvas *canvas, const msri_colours *colours, size_t n,
                                const double *x, const double *y) {
  draw(canvas, colours, n, x, y);
}
#endif

static void find_anywhere(const msri_canvas *canvas, size_t n, const double *x, const double *y,
                          int32_t *at) {
  find(grid_of(canvas), n, x, y, at);
}

static void draw_anywhere(const msri_canvas *canvas, const msri_colours *colours, size_t n,
                          const double *x, const double *y) {
  draw(canvas, colours, n, x, y);
}

const msri_canvas_kernel msri_canvas_kernels[] = {
#if MSRI_WIDE
    {"AVX-512", msri_has_avx512, find_avx512, draw_avx512},
    {"AVX2", msri_has_avx2, find_avx2, draw_avx2},
#endif
    {"any", NULL, find_anywhere, draw_anywhere},
};

void msri_canvas_take(msri_canvas *canvas, const msri_colours *colours, size_t n, const double *x,
                      const double *y, int32_t *at) {
  const msri_canvas_kernel *kernel = msri_canvas_kernels;
  while (kernel->runs_here && !kernel->runs_here()) kernel++;
  if (!canvas->white) msri_canvas_whiten(canvas);
  canvas->white = false;
  if (at)
    kernel->find(canvas, n, x, y, at);
  else
    kernel->draw(canvas, colours, n, x, y);
}

void msri_canvas_complete(const msri_canvas *canvas, const msri_colours *colours, size_t n,
                          const int32_t *at) {
  const size_t stride = stride_of(colours);
  for (size_t i = 0; i < n; i++) set_square(canvas, at[i], colours->rgb + i * stride);
}
