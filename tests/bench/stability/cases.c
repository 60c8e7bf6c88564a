/* cases.c - hard cases, and one of bodies that collide. All but the first are blocks of
 * 16 x 10 masses in a room whose walls are one pixel thick. */
#include "cases.h"

#include "msr.h"

#include <math.h>
#include <stdlib.h>

enum { WIDTH = 48, HEIGHT = 40, COLUMNS = 16, ROWS = 10, MASSES = COLUMNS * ROWS };

/* ---- Building */

static void make_room(problem *p, size_t most, size_t width, size_t height) {
  p->width = width, p->height = height;
  p->black = need(width * height, sizeof *p->black);
  double **arrays[] = {&p->x, &p->y, &p->vx, &p->vy, &p->m};
  for (size_t a = 0; a < 5; a++) *arrays[a] = need(most, sizeof(double));
  p->bonds = need(3 * most, sizeof *p->bonds);
}

static void fill(problem *p, size_t left, size_t bottom, size_t columns, size_t rows) {
  for (size_t r = bottom; r < bottom + rows; r++)
    for (size_t c = left; c < left + columns; c++) p->black[r * p->width + c] = true;
}

static void make_walls(problem *p, size_t most, size_t height) {
  make_room(p, most, WIDTH, height);
  p->closed = true;
  fill(p, 0, 0, WIDTH, 1);
  fill(p, 0, height - 1, WIDTH, 1);
  fill(p, 0, 0, 1, height);
  fill(p, WIDTH - 1, 0, 1, height);
}

static size_t add_mass(problem *p, double x, double y, double m) {
  const size_t i = p->n++;
  p->x[i] = x, p->y[i] = y, p->m[i] = m;
  return i;
}

static void add_bond(problem *p, size_t i, size_t j, double k, double L) {
  p->bonds[p->n_bonds++] = (bond){i, j, k, L};
}

/* A block of COLUMNS x ROWS from its lower left pixel; springs are of length L, masses 1 apart. */
static void add_block(problem *p, size_t left, size_t bottom, double L) {
  const size_t first = p->n;
  const double k = p->stiffness;
  for (size_t r = ROWS; r-- > 0;)
    for (size_t c = 0; c < COLUMNS; c++)
      add_mass(p, (double)(left + c) + 0.5, (double)(bottom + r) + 0.5, p->mass);
  for (size_t r = 0; r < ROWS; r++)
    for (size_t c = 0; c < COLUMNS; c++) {
      const size_t i = first + r * COLUMNS + c;
      if (c + 1 < COLUMNS) add_bond(p, i, i + 1, k, L);
      if (r + 1 < ROWS) add_bond(p, i, i + COLUMNS, k, L);
    }
}

/* A block above two pegs, with room for twins. */
static void drop_from(problem *p, size_t bottom, size_t height) {
  make_walls(p, 2 * MASSES, height);
  fill(p, 16, 10, 2, 2);
  fill(p, 29, 10, 2, 2);
  add_block(p, 15, bottom, 1);
}

static void drop(problem *p) { drop_from(p, 24, HEIGHT); }

/* ---- Cases */

static bool is_mass(const unsigned char *rgb) { return rgb[0] > 128 && rgb[1] < 128; }

/* The picture's masses, each bound to those to its right and below. */
static void read_picture(problem *p, const msr_picture *picture) {
  size_t *index = need(picture->width * picture->height, sizeof *index);
  for (size_t r = 0; r < picture->height; r++)
    for (size_t c = 0; c < picture->width; c++) {
      const size_t at = r * picture->width + c, up = p->height - 1 - r;
      const unsigned char *rgb = picture->rgb + 3 * at;
      p->black[up * p->width + c] = rgb[0] + rgb[1] + rgb[2] == 0;
      if (!is_mass(rgb)) continue;
      const size_t i = add_mass(p, (double)c + 0.5, (double)up + 0.5, p->mass);
      index[at] = i + 1;
      if (c > 0 && index[at - 1]) add_bond(p, index[at - 1] - 1, i, p->stiffness, 1);
      if (r > 0 && index[at - picture->width])
        add_bond(p, index[at - picture->width] - 1, i, p->stiffness, 1);
    }
  free(index);
}

static void make_example(problem *p) {
  msr_picture *picture;
  msr_error err;
  if (msr_picture_read("examples/scenes/assignment.ppm", &picture, NULL, &err) != MSR_OK)
    bench_fail("%s", err.message);
  make_room(p, picture->width * picture->height, picture->width, picture->height);
  read_picture(p, picture);
  msr_picture_free(picture);
}

static void make_long_fall(problem *p) { drop_from(p, 208, 220); }

static void make_long_steps(problem *p) {
  drop(p);
  p->dt *= 10;
  p->iterations /= 10;
}

static void make_stiff(problem *p) {
  p->stiffness = 1e9;
  drop(p);
  p->iterations = 400;
}

/* Every other mass is a millionth. */
static void make_unequal(problem *p) {
  p->drawn = false;
  drop(p);
  for (size_t i = 0; i < MASSES; i++)
    if ((i % COLUMNS + i / COLUMNS) % 2) p->m[i] *= 1e-6;
  p->iterations = 400;
}

/* Each mass has a twin at its place, on a spring of no length or of one that it doesn't have. */
static void make_coincident(problem *p) {
  p->drawn = false;
  drop(p);
  for (size_t i = 0; i < MASSES; i++) {
    const size_t twin = add_mass(p, p->x[i], p->y[i], p->mass);
    add_bond(p, i, twin, p->stiffness, i % 2 ? 1 : 0);
  }
}

static void throw_block(problem *p, double speed) {
  p->drawn = false;
  make_walls(p, MASSES, HEIGHT);
  add_block(p, 15, 15, 1);
  for (size_t i = 0; i < MASSES; i++) p->vx[i] = speed, p->vy[i] = speed / 10;
  p->gravity = 0;
}

static void make_impact(problem *p) { throw_block(p, 100); }

static void make_fast_impact(problem *p) { throw_block(p, 1e4); }

/* Springs twice as long as there is room for. */
static void make_squeezed(problem *p) {
  p->drawn = false;
  make_walls(p, MASSES, HEIGHT);
  fill(p, 14, 14, COLUMNS + 2, 1);
  fill(p, 14, 15 + ROWS, COLUMNS + 2, 1);
  fill(p, 14, 15, 1, ROWS);
  fill(p, 15 + COLUMNS, 15, 1, ROWS);
  add_block(p, 15, 15, 2);
}

/* Critical is 2 sqrt(k m). */
static void make_overdamped(problem *p) {
  drop(p);
  p->damping = 1e6 * 2 * sqrt(p->stiffness * p->mass);
  p->elastic = false;
}

static void make_wind(problem *p) {
  drop(p);
  p->air = p->mass;
  p->wind = 1e6;
  p->scale = MASSES * p->mass * p->wind * p->wind / 2;
  p->allowed = 1.1;
  p->elastic = false;
}

static void make_rest(problem *p) {
  make_walls(p, MASSES, HEIGHT);
  add_block(p, 15, 11, 1);
  p->restitution = 0.5;
  p->damping = 1;
  p->iterations = 100000;
  p->elastic = false;
  p->rests = true;
}

static void make_collision(problem *p) {
  make_walls(p, 2 * MASSES, HEIGHT);
  add_block(p, 20, 24, 1);
  add_block(p, 15, 1, 1);
  p->diameter = 1;
}

const hard_case hard_cases[] = {
    {"example", "the assignment's example, 9620 masses, DT 0.005 s, 100 s", make_example},
    {"long fall", "a block dropped on pegs from 200 px, all as the example says, 100 s",
     make_long_fall},
    {"long steps", "a block dropped on pegs from 12 px, DT x 10, 100 s", make_long_steps},
    {"stiff", "the same, DT 0.005 s, k 1e9, 2 s", make_stiff},
    {"mass ratio", "the same, every other mass a millionth, 2 s", make_unequal},
    {"coincident", "the same, each mass doubled in place, springs of length 0 there",
     make_coincident},
    {"impact", "a block at 100 px/s against walls 1 px thick, no weight, 100 s", make_impact},
    {"fast impact", "the same at 10^4 px/s", make_fast_impact},
    {"squeezed", "a block between supports, its springs twice too long, 100 s", make_squeezed},
    {"overdamped", "damping along springs 10^6 times the critical, 100 s", make_overdamped},
    {"wind", "wind of 10^6 px/s, 100 s", make_wind},
    {"rest", "dropped, damped, restitution 0.5: 10^5 steps", make_rest},
    {"collision", "a block falls on another, discs of 1 px, 100 s", make_collision},
    {NULL, NULL, NULL}};
