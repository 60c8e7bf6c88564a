/* canvas.h - the frame that is drawn on: squares of `scale` pixels, in order. */
#ifndef MSRI_CANVAS_H
#define MSRI_CANVAS_H

#include "base/base.h"

/* Masses that may be drawn at once. */
enum { MSRI_CANVAS_GROUP = 8 };

typedef struct msri_canvas {
  size_t scale;      /* pixels per unit */
  double top;        /* of the scene [px] */
  bool white;        /* nothing has been drawn */
  msr_picture frame; /* MSRI_PPM_HEADER_SIZE bytes are before it, and a pixel after it, for masses
                        that are outside */
} msri_canvas;

/* Of masses: rgb [n][3]; if all have the same, [MSRI_CANVAS_GROUP][3]. */
typedef struct msri_colours {
  unsigned char *rgb;
  bool alike;
} msri_colours;

/* A white canvas for a scene of width x height, of less than 2^31 pixels. MSR_EUSAGE, MSR_ENOMEM.
 */
msr_status msri_canvas_create(size_t width, size_t height, size_t scale, msri_canvas *canvas,
                              msr_error *err);
void msri_canvas_clear(msri_canvas *canvas);

void msri_canvas_whiten(msri_canvas *canvas);

/* Takes masses at x, y [n], over white, one after the other: draws them if `at` is NULL, which is
 * for scale 1; else finds where their squares begin, at [n], and msri_canvas_complete draws
 * them. */
void msri_canvas_take(msri_canvas *canvas, const msri_colours *colours, size_t n, const double *x,
                      const double *y, int32_t *at);
void msri_canvas_complete(const msri_canvas *canvas, const msri_colours *colours, size_t n,
                          const int32_t *at);

/* Both compiled for one width of vectors. */
typedef struct msri_canvas_kernel {
  const char *name;
  bool (*runs_here)(void); /* NULL: everywhere */
  void (*find)(const msri_canvas *canvas, size_t n, const double *x, const double *y, int32_t *at);
  void (*draw)(const msri_canvas *canvas, const msri_colours *colours, size_t n, const double *x,
               const double *y);
} msri_canvas_kernel;
extern const msri_canvas_kernel
    msri_canvas_kernels[]; /* the widest first; the last runs anywhere */

#endif
