/* shapes.h - pictures of shapes that are hard on what goes row by row: gaps, islands far apart,
 * rows of one mass, objects within objects. */
#ifndef TESTS_SHAPES_H
#define TESTS_SHAPES_H

#include "scenes.h"

typedef struct shape {
  const char *name;
  /* Does pixel (c, r) of a picture of w x h hold a mass? p is a parameter, 1 or more. */
  bool (*has)(size_t c, size_t r, size_t w, size_t h, size_t p);
} shape;

static inline bool in_full(size_t c, size_t r, size_t w, size_t h, size_t p) {
  (void)c, (void)r, (void)w, (void)h, (void)p;
  return true;
}

/* Rings within each other, p pixels apart. */
static inline bool in_rings(size_t c, size_t r, size_t w, size_t h, size_t p) {
  const size_t x = c < w - 1 - c ? c : w - 1 - c, y = r < h - 1 - r ? r : h - 1 - r;
  return (x < y ? x : y) % (p + 1) == 0;
}

static inline bool in_comb(size_t c, size_t r, size_t w, size_t h, size_t p) {
  (void)w, (void)h;
  return r == 0 || c % (p + 1) == 0;
}

/* Its back is below, so that its teeth are united last. */
static inline bool in_rake(size_t c, size_t r, size_t w, size_t h, size_t p) {
  (void)w;
  return r == h - 1 || c % (p + 1) == 0;
}

/* One line to and fro, p pixels apart. */
static inline bool in_snake(size_t c, size_t r, size_t w, size_t h, size_t p) {
  (void)h;
  if (r % (p + 1) == 0) return true;
  return r / (p + 1) % 2 ? c == 0 : c == w - 1;
}

/* Rings, each cut open and tied to the next: a spiral. */
static inline bool in_spiral(size_t c, size_t r, size_t w, size_t h, size_t p) {
  const size_t x = c < w - 1 - c ? c : w - 1 - c, turn = p + 1;
  if (r > 0 && r < h - 1 && c < w / 2 && r == c + 1 && c % turn == 0) return false;
  if (r > 0 && r < h / 2 && c + 1 == r && c % turn != 0 && x < w / 2) return true;
  return in_rings(c, r, w, h, p);
}

static inline bool in_diagonals(size_t c, size_t r, size_t w, size_t h, size_t p) {
  (void)w, (void)h;
  return (c + r) % (p + 1) == 0;
}

/* Of steps, which touch with 4 neighbours, too. */
static inline bool in_stairs(size_t c, size_t r, size_t w, size_t h, size_t p) {
  (void)w, (void)h;
  return (c + p * r) % (3 * p) <= p;
}

static inline bool in_checkers(size_t c, size_t r, size_t w, size_t h, size_t p) {
  (void)w, (void)h;
  return (c / p + r / p) % 2 == 0;
}

/* Two sides far apart, joined in one row only. */
static inline bool in_bridge(size_t c, size_t r, size_t w, size_t h, size_t p) {
  return c < p || c + p >= w || r == h / 2;
}

static inline bool in_triangle(size_t c, size_t r, size_t w, size_t h, size_t p) {
  (void)w, (void)p;
  return c <= r && c + r >= h / 3;
}

/* Blocks with gaps between them. */
static inline bool in_blocks(size_t c, size_t r, size_t w, size_t h, size_t p) {
  (void)w, (void)h;
  return c % (p + 4) < p + 3 && r % (p + 2) < p + 1;
}

/* A dot in each row, further and further, on a thread. */
static inline bool in_thread(size_t c, size_t r, size_t w, size_t h, size_t p) {
  (void)h;
  return c == 0 || c == w - 1 - (r * p) % w;
}

/* At random; of 8, p hold a mass. */
static inline bool in_noise(size_t c, size_t r, size_t w, size_t h, size_t p) {
  uint64_t dice = c + 1000 * r + 1000000 * (w + 1000 * h);
  return random_bits(&dice) % 8 < p;
}

static const shape shapes[] = {
    {"full", in_full},           {"rings", in_rings},       {"comb", in_comb},
    {"rake", in_rake},           {"snake", in_snake},       {"spiral", in_spiral},
    {"diagonals", in_diagonals}, {"stairs", in_stairs},     {"checkers", in_checkers},
    {"bridge", in_bridge},       {"triangle", in_triangle}, {"blocks", in_blocks},
    {"thread", in_thread},       {"noise", in_noise},
};

static inline const shape *shape_named(const char *name) {
  for (size_t n = 0; n < LENGTH(shapes); n++)
    if (strcmp(shapes[n].name, name) == 0) return &shapes[n];
  fail_msg("there is no shape %s", name);
  return NULL;
}

static inline msr_picture *draw(const shape *s, size_t w, size_t h, size_t p) {
  msr_picture *picture;
  must(msr_picture_create(w, h, &picture, &why));
  for (size_t i = 0; i < w * h; i++)
    memcpy(picture->rgb + 3 * i, rgb_of(s->has(i % w, i / w, w, h, p) ? 'o' : '.'), 3);
  return picture;
}

#endif
