/* walls.c - regions of a picture that supports part: no mass may go from one to another. Pixels
 * that touch by a corner are apart. The ring around the picture is air if the border is open. */
#include "walls.h"

static size_t stride(const walls *w) { return w->width + 2; }

/* Numbers all that can be reached from a pixel. */
static void flood(walls *w, size_t from, unsigned number, size_t *stack) {
  const size_t cells = stride(w) * (w->height + 2);
  const long way[] = {1, -1, (long)stride(w), -(long)stride(w)};
  size_t n = 0;
  stack[n++] = from;
  w->region[from] = number;
  while (n > 0) {
    const size_t at = stack[--n];
    for (size_t d = 0; d < LENGTH(way); d++) {
      const long to = (long)at + way[d];
      if (to < 0 || to >= (long)cells || w->region[to] != UINT32_MAX) continue;
      w->region[to] = number;
      stack[n++] = (size_t)to;
    }
  }
}

static size_t clamp(double at, size_t size) {
  return at < 0 ? 0 : at < (double)size ? (size_t)at + 1 : size + 1;
}

static size_t cell_of(const walls *w, double x, double y) {
  return clamp(y, w->height) * stride(w) + clamp(x, w->width);
}

static void mark(walls *w, const msr_picture *picture) {
  for (size_t row = 0; row < w->height + 2; row++)
    for (size_t column = 0; column < stride(w); column++) {
      const bool inside = row > 0 && column > 0 && row <= w->height && column <= w->width;
      const unsigned char *rgb =
          inside ? picture->rgb + 3 * ((w->height - row) * w->width + column - 1) : NULL;
      const bool solid = rgb ? rgb[0] + rgb[1] + rgb[2] == 0 : w->closed;
      w->region[row * stride(w) + column] = solid ? 0 : UINT32_MAX;
    }
}

walls walls_of(const msr_picture *picture, bool closed, const msr_view *s) {
  if (!picture) return (walls){.region = NULL};
  walls w = {.width = picture->width, .height = picture->height, .closed = closed};
  const size_t cells = (w.width + 2) * (w.height + 2);
  w.region = zeroed(cells, sizeof *w.region);
  w.start = zeroed(s->n, sizeof *w.start);
  size_t *stack = zeroed(cells, sizeof *stack);
  mark(&w, picture);
  unsigned number = 0;
  for (size_t c = 0; c < cells; c++)
    if (w.region[c] == UINT32_MAX) flood(&w, c, ++number, stack);
  free(stack);
  for (size_t i = 0; i < s->n; i++) w.start[i] = w.region[cell_of(&w, s->x[i], s->y[i])];
  return w;
}

void forget_walls(walls *w) {
  free(w->region);
  free(w->start);
}

/* From the nearest side of the pixel. */
static double depth(double x, double y) {
  const double u = x - floor(x), v = y - floor(y);
  return fmin(fmin(u, 1 - u), fmin(v, 1 - v));
}

double deepest(const walls *w, const msr_view *s) {
  double most = 0;
  for (size_t i = 0; w->region && i < s->n; i++) {
    if (!isfinite(s->x[i]) || !isfinite(s->y[i])) continue;
    const unsigned region = w->region[cell_of(w, s->x[i], s->y[i])];
    if (region == 0)
      most = fmax(most, fmax(depth(s->x[i], s->y[i]), DBL_MIN));
    else if (region != w->start[i])
      most = INFINITE;
  }
  return most;
}
