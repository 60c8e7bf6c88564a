/* work.c - the masses and springs of all contestants: blocks, pictures in which 30 % of the springs
 * are missing, and meshes. */
#include "speed.h"

#include <stdlib.h>
#include <string.h>

static const double share = 0.7; /* of the springs of a block that an irregular picture has */

/* The same pictures every time: a congruence modulo 2^64 (Knuth, MMIX). */
static size_t below(size_t n) {
  static uint64_t seed = 1;
  seed = seed * 6364136223846793005u + 1442695040888963407u;
  return (size_t)(seed >> 33) % n;
}

/* ---- Pictures */

static bool is_there(const work *w, size_t column, size_t row) {
  return column < w->width && row < w->height && w->there[row * w->width + column];
}

static double springs_there(const work *w) {
  size_t n = 0;
  for (size_t row = 0; row < w->height; row++)
    for (size_t c = 0; c < w->width; c++)
      if (is_there(w, c, row)) n += (size_t)is_there(w, c + 1, row) + is_there(w, c, row + 1);
  return (double)n / (double)(w->height * (w->width - 1) + w->width * (w->height - 1));
}

static void stamp(work *w, double x, double y, double radius, bool there) {
  for (size_t row = (size_t)fmax(0, y - radius); row < w->height && (double)row < y + radius; row++)
    for (size_t c = (size_t)fmax(0, x - radius); c < w->width && (double)c < x + radius; c++)
      if (hypot((double)c - x, (double)row - y) < radius) w->there[row * w->width + c] = there;
}

void draw_block(work *w) { memset(w->there, true, w->width * w->height); }

void draw_holes(work *w) {
  draw_block(w);
  while (springs_there(w) > share)
    for (size_t i = 0; i < 1 + w->width * w->height / 20000; i++)
      stamp(w, (double)below(w->width), (double)below(w->height), 2 + (double)below(8), false);
}

/* A branch goes straight on, more or less. */
void draw_branches(work *w) {
  while (springs_there(w) < share) {
    double x = (double)below(w->width), y = (double)below(w->height), angle = (double)below(7);
    for (size_t i = 0; i < w->width / 2; i++) {
      stamp(w, x, y, 3, true);
      angle += ((double)below(101) - 50) / 250;
      x += 2 * cos(angle), y += 2 * sin(angle);
      if (x < 0 || y < 0 || x > (double)w->width || y > (double)w->height) break;
    }
  }
}

/* Rectangles of 4 to 16 columns and 7 rows, a pixel apart. */
void draw_objects(work *w) {
  for (size_t row = 0; row < w->height; row += 8)
    for (size_t c = 0, end; c < w->width; c = end + 1) {
      end = c + 4 + below(13);
      for (size_t r = row; r < row + 7 && r < w->height; r++)
        for (size_t at = c; at < end && at < w->width; at++) w->there[r * w->width + at] = true;
    }
}

/* ---- Masses and springs */

static void place(work *w, double x, double y) {
  w->x[w->n] = x;
  w->y[w->n++] = y;
}

static void tie(work *w, size_t i, size_t j) {
  w->i[w->n_springs] = (uint32_t)i;
  w->j[w->n_springs++] = (uint32_t)j;
}

static work reserve(const char *name, size_t width, size_t height, size_t neighbours) {
  work w = {.name = name, .width = width, .height = height};
  const size_t n = width * height;
  double *all = need(4 * n, sizeof *all);
  w.x = all, w.y = all + n, w.u = all + 2 * n, w.v = all + 3 * n;
  w.there = need(n, sizeof *w.there);
  w.i = need(neighbours * n, sizeof *w.i);
  w.j = need(neighbours * n, sizeof *w.j);
  return w;
}

/* Waves of 0.01 px, two across the width. */
static void deform(work *w) {
  const double turn = 2 * acos(-1), a = 2 * turn / (double)w->width, b = turn / (double)w->height;
  for (size_t i = 0; i < w->n; i++) {
    const double x = w->x[i], y = w->y[i];
    w->x[i] += 0.01 * sin(a * x) * cos(b * y);
    w->y[i] += 0.01 * cos(b * x) * sin(a * y);
  }
}

/* So that steps of velocity, then position, go through Verlet's positions. */
static void stagger(work *w) {
  for (size_t s = 0; s < w->n_springs; s++) {
    const size_t i = w->i[s], j = w->j[s];
    const double dx = w->x[j] - w->x[i], dy = w->y[j] - w->y[i], l = hypot(dx, dy);
    const double f = -step / 2 / mass * stiffness * (l - rest) / l;
    w->u[i] += f * dx, w->v[i] += f * dy;
    w->u[j] -= f * dx, w->v[j] -= f * dy;
  }
}

/* As a scene numbers the pixels of a picture. */
static void number(work *w) {
  size_t *index = need(w->width * w->height, sizeof *index);
  for (size_t p = 0; p < w->width * w->height; p++) {
    const size_t column = p % w->width, row = p / w->width;
    index[p] = w->n;
    if (!w->there[p]) continue;
    if (column > 0 && w->there[p - 1]) tie(w, w->n - 1, w->n);
    if (row > 0 && w->there[p - w->width]) tie(w, index[p - w->width], w->n);
    place(w, (double)column + 0.5, (double)(w->height - row) - 0.5);
  }
  free(index);
}

work work_drawn(const char *name, size_t side, draw *how) {
  work w = reserve(name, side, side, 2);
  w.drawn = true;
  w.full = how == draw_block;
  how(&w);
  number(&w);
  deform(&w);
  stagger(&w);
  return w;
}

work work_lattice(const char *name, size_t side) {
  work w = work_drawn(name, side, draw_block);
  w.drawn = w.full = false;
  return w;
}

/* Every other row begins half a pixel further on. */
work work_disc(const char *name, size_t side) {
  work w = reserve(name, side, side + side / 6, 3);
  const double flat = sqrt(0.75), radius = (double)side / 2, middle = flat * (double)w.height / 2;
  size_t *index = need(w.width * w.height, sizeof *index);
  for (size_t p = 0; p < w.width * w.height; p++) {
    const size_t column = p % w.width, row = p / w.width, odd = row & 1;
    const double x = (double)column + 0.5 * (double)odd, y = flat * (double)row;
    index[p] = w.n;
    w.there[p] = hypot(x - radius, y - middle) < radius - 1;
    if (!w.there[p]) continue;
    const size_t left = p - w.width - 1 + odd;
    if (column > 0 && w.there[p - 1]) tie(&w, w.n - 1, w.n);
    if (row > 0 && w.there[left]) tie(&w, index[left], w.n);
    if (row > 0 && w.there[left + 1]) tie(&w, index[left + 1], w.n);
    place(&w, x, y);
  }
  free(index);
  deform(&w);
  stagger(&w);
  return w;
}

void work_free(work *w) {
  free(w->x);
  free(w->there);
  free(w->i);
  free(w->j);
}
