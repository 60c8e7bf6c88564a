/* problem.c - what all that solve a problem ask it. */
#include "cases.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void *need(size_t count, size_t size) {
  void *block = calloc(count ? count : 1, size);
  if (!block) bench_fail("out of memory");
  return block;
}

bool is_black(const problem *p, double x, double y) {
  if (!(x >= 0 && x < (double)p->width && y >= 0 && y < (double)p->height)) return false;
  return p->black[(size_t)y * p->width + (size_t)x];
}

void for_stretches(const problem *p, on_stretch *visit, void *self) {
  for (size_t row = 0; row < p->height; row++)
    for (size_t from = 0, to; from < p->width; from = to + 1) {
      const bool *pixel = p->black + row * p->width;
      for (to = from; to < p->width && pixel[to];) to++;
      if (to > from) visit(self, (double)from, (double)to, (double)row);
    }
}

/* Marks the air that can be reached from the masses, side by side. */
static void flood(problem *p) {
  const size_t size = p->width * p->height;
  size_t *todo = need(size + p->n, sizeof *todo), n = 0;
  for (size_t i = 0; i < p->n; i++) {
    const size_t pixel = (size_t)p->y[i] * p->width + (size_t)p->x[i];
    if (!p->inside[pixel]) todo[n++] = pixel;
    p->inside[pixel] = true;
  }
  while (n > 0) {
    const size_t at = todo[--n], column = at % p->width;
    const size_t next[] = {at - 1, at + 1, at - p->width, at + p->width};
    const bool is[] = {column > 0, column + 1 < p->width, at >= p->width, at + p->width < size};
    for (int i = 0; i < 4; i++) {
      if (!is[i] || p->inside[next[i]] || p->black[next[i]]) continue;
      p->inside[next[i]] = true;
      todo[n++] = next[i];
    }
  }
  free(todo);
}

void problem_create(problem *p, const hard_case *from) {
  *p = (problem){.name = from->name,
                 .text = from->text,
                 .dt = 0.005,
                 .mass = 0.1,
                 .stiffness = 1500,
                 .drawn = true,
                 .gravity = 9.8,
                 .iterations = 20000,
                 .restitution = 1,
                 .allowed = 0.1,
                 .elastic = true};
  from->make(p);
  p->inside = need(p->width * p->height, sizeof *p->inside);
  flood(p);
}

void problem_free(problem *p) {
  void *blocks[] = {p->black, p->inside, p->x, p->y, p->vx, p->vy, p->m, p->bonds};
  for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) free(blocks[i]);
}
