/* walls.h - where masses are, as the picture says: in a support, or beyond one. */
#ifndef STABILITY_WALLS_H
#define STABILITY_WALLS_H

#include "suite.h"

typedef struct walls {
  size_t width, height;
  bool closed;
  unsigned *region; /* [height + 2][width + 2], rows from the bottom: 0 support, else its number */
  unsigned *start;  /* [masses]: the region where each began */
} walls;

/* `picture` may be NULL: nothing is in the way. */
walls walls_of(const msr_picture *picture, bool closed, const msr_view *s);
void forget_walls(walls *w);

/* How deep the deepest mass is in a support; INFINITY if one has passed through any. */
double deepest(const walls *w, const msr_view *s);

#endif
