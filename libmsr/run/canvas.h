/* canvas.h - the pixels of a frame while it's drawn: squares of `scale` pixels, in order. */
#ifndef MSRI_CANVAS_H
#define MSRI_CANVAS_H

#include "base/base.h"

/* Has margins of `scale` pixels, so that squares of masses outside need no clipping. */
typedef struct msri_canvas {
  size_t scale;         /* pixels per unit */
  size_t width, height; /* [pixels], without the margins */
  double top;           /* of the scene [px] */
  uint32_t *pixel;      /* [height + 2 scale][width + 2 scale]; 0xbbggrr */
} msri_canvas;

/* A white canvas for a scene of width x height, of less than 2^31 pixels. MSR_EUSAGE, MSR_ENOMEM.
 */
msr_status msri_canvas_create(size_t width, size_t height, size_t scale, msri_canvas *canvas,
                              msr_error *err);
void msri_canvas_clear(msri_canvas *canvas);

static inline size_t msri_canvas_line(const msri_canvas *canvas) {
  return canvas->width + 2 * canvas->scale;
}

/* Where the squares of masses at x, y [n] begin: pixels at[n]. */
void msri_canvas_find(const msri_canvas *canvas, size_t n, const double *x, const double *y,
                      int32_t *at);

/* Fills these squares, one after the other: the i-th in colour[i * stride]. */
void msri_canvas_fill(const msri_canvas *canvas, size_t n, const int32_t *at,
                      const uint32_t *colour, size_t stride);

/* Moves `count` rows from `row` on to rgb [count][width][3] and leaves them white. */
void msri_canvas_move(const msri_canvas *canvas, size_t row, size_t count, unsigned char *rgb);

/* The loops compiled for one width of vectors. */
typedef struct msri_canvas_kernel {
  const char *name;
  bool (*runs_here)(void); /* NULL: everywhere */
  void (*find)(const msri_canvas *canvas, size_t n, const double *x, const double *y, int32_t *at);
  void (*move)(const msri_canvas *canvas, size_t row, size_t count, unsigned char *rgb);
} msri_canvas_kernel;
extern const msri_canvas_kernel
    msri_canvas_kernels[]; /* the widest first; the last runs anywhere */

#endif
