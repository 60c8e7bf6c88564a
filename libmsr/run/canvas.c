/* canvas.c - where masses are among the pixels, and their squares.
 *
 * Three passes: places to numbers of pixels, squares in their order, pixels to bytes. The first and
 * the last are plain loops over contiguous memory, compiled for vectors of several widths; the one
 * between them is a store per mass and pixel, which need not be tested, as who is outside falls
 * into the margin. */
#include "run/canvas.h"

#include "base/machine.h"

#include <stdlib.h>
#include <string.h>

static const uint32_t white = 0xffffff;

msr_status msri_canvas_create(size_t width, size_t height, size_t scale, msri_canvas *canvas,
                              msr_error *err) {
  const size_t most = INT32_MAX / scale;
  if (width + 2 > most || height + 2 > most ||
      (height + 2) * scale > INT32_MAX / ((width + 2) * scale))
    return msri_fail(err, MSR_EUSAGE, "scale %zu makes the frames too large", scale);
  const size_t n = (width + 2) * scale * (height + 2) * scale;
  uint32_t *pixel = msri_alloc(n, sizeof *pixel, "the pixels of a frame", err);
  if (!pixel) return MSR_ENOMEM;
  for (size_t p = 0; p < n; p++) pixel[p] = white;
  *canvas = (msri_canvas){scale, width * scale, height * scale, (double)height, pixel};
  return MSR_OK;
}

void msri_canvas_clear(msri_canvas *canvas) {
  free(canvas->pixel);
  *canvas = (msri_canvas){.pixel = NULL};
}

/* ---- Places */

/* For what is no number the lower bound. */
MSRI_INLINE double within(double least, double u, double most) {
  u = u > least ? u : least;
  return u < most ? u : most;
}

/* As floor and ceil, for what fits; these would keep gcc from vectorising. */
MSRI_INLINE int32_t round_down(double u) {
  const int32_t i = (int32_t)u;
  return i - ((double)i > u);
}

MSRI_INLINE int32_t round_up(double u) {
  const int32_t i = (int32_t)u;
  return i + ((double)i < u);
}

/* As for supports, a pixel owns its left and lower edges. */
MSRI_INLINE void find(const msri_canvas *canvas, size_t n, const double *restrict x,
                      const double *restrict y, int32_t *restrict at) {
  const double scale = (double)canvas->scale, top = canvas->top;
  const double width = (double)canvas->width, height = (double)canvas->height;
  const int32_t line = (int32_t)msri_canvas_line(canvas);
  const int32_t first = (int32_t)canvas->scale * (line + 1);
  for (size_t i = 0; i < n; i++) {
    const double column = within(-scale, (x[i] - 0.5) * scale + 0.5, width);
    const double row = within(-scale, (top - y[i] - 0.5) * scale - 0.5, height);
    at[i] = round_up(row) * line + round_down(column) + first;
  }
}

/* ---- Squares */

void msri_canvas_fill(const msri_canvas *canvas, size_t n, const int32_t *at,
                      const uint32_t *colour, size_t stride) {
  const size_t scale = canvas->scale, line = msri_canvas_line(canvas);
  uint32_t *restrict pixel = canvas->pixel;
  if (scale == 1) {
    for (size_t i = 0; i < n; i++) pixel[at[i]] = colour[i * stride];
    return;
  }
  for (size_t i = 0; i < n; i++)
    for (size_t row = 0; row < scale; row++)
      for (size_t column = 0; column < scale; column++)
        pixel[(size_t)at[i] + row * line + column] = colour[i * stride];
}

/* ---- Bytes */

MSRI_INLINE void move_row(size_t n, uint32_t *restrict pixel, unsigned char *restrict rgb) {
  for (size_t p = 0; p < n; p++) {
    rgb[3 * p] = (unsigned char)pixel[p];
    rgb[3 * p + 1] = (unsigned char)(pixel[p] >> 8);
    rgb[3 * p + 2] = (unsigned char)(pixel[p] >> 16);
  }
  for (size_t p = 0; p < n; p++) pixel[p] = white;
}

MSRI_INLINE void move(const msri_canvas *canvas, size_t row, size_t count, unsigned char *rgb) {
  const size_t line = msri_canvas_line(canvas), scale = canvas->scale, width = canvas->width;
  uint32_t *pixel = canvas->pixel + (row + scale) * line + scale;
  for (size_t r = 0; r < count; r++) move_row(width, pixel + r * line, rgb + 3 * r * width);
}

/* ---- Kernels */

#if MSRI_WIDE
MSRI_AVX512 static void find_avx512(const msri_canvas *canvas, size_t n, const double *x,
                                    const double *y, int32_t *at) {
  find(canvas, n, x, y, at);
}

MSRI_AVX512 static void move_avx512(const msri_canvas *canvas, size_t row, size_t count,
                                    unsigned char *rgb) {
  move(canvas, row, count, rgb);
}

MSRI_AVX2 static void find_avx2(const msri_canvas *canvas, size_t n, const double *x,
                                const double *y, int32_t *at) {
  find(canvas, n, x, y, at);
}

MSRI_AVX2 static void move_avx2(const msri_canvas *canvas, size_t row, size_t count,
                                unsigned char *rgb) {
  move(canvas, row, count, rgb);
}
#endif

static void find_anywhere(const msri_canvas *canvas, size_t n, const double *x, const double *y,
                          int32_t *at) {
  find(canvas, n, x, y, at);
}

static void move_anywhere(const msri_canvas *canvas, size_t row, size_t count, unsigned char *rgb) {
  move(canvas, row, count, rgb);
}

const msri_canvas_kernel msri_canvas_kernels[] = {
#if MSRI_WIDE
    {"AVX-512", msri_has_avx512, find_avx512, move_avx512},
    {"AVX2", msri_has_avx2, find_avx2, move_avx2},
#endif
    {"any", NULL, find_anywhere, move_anywhere},
};

static const msri_canvas_kernel *widest(void) {
  const msri_canvas_kernel *kernel = msri_canvas_kernels;
  while (kernel->runs_here && !kernel->runs_here()) kernel++;
  return kernel;
}

void msri_canvas_find(const msri_canvas *canvas, size_t n, const double *x, const double *y,
                      int32_t *at) {
  widest()->find(canvas, n, x, y, at);
}

void msri_canvas_move(const msri_canvas *canvas, size_t row, size_t count, unsigned char *rgb) {
  widest()->move(canvas, row, count, rgb);
}
