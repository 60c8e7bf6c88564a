/* falls.c - a block that falls so far, or is thrown so fast, that an impact crushes it: 16 x 10
 * masses in a closed room of the assignment's numbers. Its picture doesn't tell: it's seen in the
 * run. */
#include "suite.h"

#include <stdio.h>

enum { WIDTH = 48, BLOCK_WIDTH = 16, BLOCK_HEIGHT = 10, LOW = 60 };

static void put(msr_picture *picture, size_t column, size_t row, char colour) {
  memcpy(picture->rgb + 3 * (row * picture->width + column), rgb_of(colour), 3);
}

static msr_picture *draw_room(size_t height) {
  msr_picture *picture;
  must(msr_picture_create(WIDTH, height, &picture, &why));
  for (size_t row = 1; row <= BLOCK_HEIGHT; row++)
    for (size_t i = 0; i < BLOCK_WIDTH; i++) put(picture, (WIDTH - BLOCK_WIDTH) / 2 + i, row, 'o');
  return picture;
}

/* Falls by `parameter`, onto the floor. */
static msr_picture *draw_flat(const hard_case *row) {
  return draw_room((size_t)row->parameter + BLOCK_HEIGHT + 1);
}

/* The same, past three pegs. */
static msr_picture *draw_pegs(const hard_case *row) {
  msr_picture *picture = draw_flat(row);
  for (size_t i = 0; i < 3; i++) put(picture, 18 + 6 * i, picture->height - 6 - 3 * (i % 2), '#');
  return picture;
}

static msr_picture *draw_low(const hard_case *row) {
  (void)row;
  return draw_room(LOW);
}

/* At the speed `parameter`, downwards and to the side. */
static void throw(const hard_case *row, const world *w) {
  const msr_arrays s = msr_state_edit(w->state);
  for (size_t i = 0; i < msr_plan_describe(w->plan).masses; i++)
    s.vx[i] = 0.6 * row->parameter, s.vy[i] = -0.8 * row->parameter;
}

static void add_heights(suite *s) {
  static const double heights[] = {140, 200, 300, 400};
  for (size_t i = 0; i < LENGTH(heights); i++)
    for (int over_pegs = 0; over_pegs <= 1; over_pegs++) {
      hard_case row = {.draw = over_pegs ? draw_pegs : draw_flat,
                       .conf = conf_of_assignment,
                       .scene = {.closed_border = true},
                       .parameter = heights[i],
                       .brief = 2000,
                       .full = 20000,
                       .growth = 0.025,
                       .loss = 0.025,
                       .why = why_care};
      snprintf(row.name, sizeof row.name, "long fall, %g px, %s", heights[i],
               over_pegs ? "pegs" : "flat");
      add_case(s, &row);
    }
}

static void add_throws(suite *s) {
  static const double speeds[] = {60, 75, 100, 300, 1000, 3000};
  for (size_t i = 0; i < LENGTH(speeds); i++) {
    hard_case row = {.draw = draw_low,
                     .conf = conf_of_assignment,
                     .scene = {.closed_border = true},
                     .arrange = throw,
                     .parameter = speeds[i],
                     .brief = 400,
                     .full = 10000,
                     .growth = 0.025,
                     .loss = 0.025,
                     .why = why_care};
    snprintf(row.name, sizeof row.name, "thrown at %g px/s", speeds[i]);
    add_case(s, &row);
  }
}

void add_falls(suite *s) {
  add_heights(s);
  add_throws(s);
}
