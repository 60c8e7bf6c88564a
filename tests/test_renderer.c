/* test_renderer.c - drawing: the first frame is the scene, a scaled one its magnification, and no
 * state, however far astray, does harm; to the byte as pixel by pixel, by every kernel. */
#include "art.h"
#include "run/canvas.h"

#include <limits.h>
#include <math.h>

/* ---- Pictures */

static msr_picture *random_picture(size_t most) {
  msr_picture *picture;
  const size_t width = 1 + (size_t)rand() % most, height = 1 + (size_t)rand() % most;
  must(msr_picture_create(width, height, &picture, &why));
  for (size_t p = 0; p < width * height; p++)
    memcpy(picture->rgb + 3 * p, colours[(size_t)rand() % LENGTH(colours)].rgb, 3);
  return picture;
}

static void assert_same_picture(const msr_picture *a, const msr_picture *b) {
  assert_true(a->width == b->width && a->height == b->height);
  assert_memory_equal(a->rgb, b->rgb, 3 * a->width * a->height);
}

/* ---- A state and its renderer */

typedef struct drawing {
  msr_plan *plan;
  msr_state *state;
  msr_renderer *renderer;
} drawing;

static drawing drawing_of_scene(msr_scene *scene, const msr_style *style) {
  drawing d;
  must(msr_plan_create(scene, NULL, &d.plan, &why));
  must(msr_state_create(d.plan, &d.state, &why));
  must(msr_renderer_create(d.plan, style, &d.renderer, &why));
  msr_scene_free(scene);
  return d;
}

/* The picture is left alone. */
static msr_scene *scene_in(const msr_picture *picture) {
  msr_scene *scene;
  must(msr_scene_from_picture("art", picture, &example, NULL, &scene, &why));
  return scene;
}

static drawing drawing_of(const char *art, const msr_style *style) {
  return drawing_of_scene(scene_of(art, &example, NULL), style);
}

static void end(drawing d) {
  msr_renderer_free(d.renderer);
  msr_state_free(d.state);
  msr_plan_free(d.plan);
}

static void assert_draws(drawing d, const char *art) {
  msr_picture *due = paint(art);
  assert_same_picture(msr_renderer_draw(d.renderer, d.state), due);
  msr_picture_free(due);
}

/* ---- The start */

static void the_first_frame_is_the_scene(void **unused) {
  (void)unused;
  for (int i = 0; i < 200; i++) {
    msr_picture *picture = random_picture(12);
    const drawing d = drawing_of_scene(scene_in(picture), i % 2 ? &(msr_style){.scale = 1} : NULL);
    assert_same_picture(msr_renderer_draw(d.renderer, d.state), picture);
    assert_same_picture(msr_renderer_draw(d.renderer, d.state), picture); // and again
    end(d);
    msr_picture_free(picture);
  }
}

/* At scale N each pixel of the scene is a block of N x N. */
static void a_scaled_frame_is_a_magnification(void **unused) {
  (void)unused;
  for (unsigned scale = 1; scale < 9; scale++)
    for (int i = 0; i < 10; i++) {
      msr_picture *picture = random_picture(8);
      const drawing d = drawing_of_scene(scene_in(picture), &(msr_style){.scale = scale});
      const msr_picture *frame = msr_renderer_draw(d.renderer, d.state);
      assert_true(frame->width == scale * picture->width);
      assert_true(frame->height == scale * picture->height);
      for (size_t p = 0; p < frame->width * frame->height; p++) {
        const size_t column = p % frame->width / scale, row = p / frame->width / scale;
        const unsigned char *due = picture->rgb + 3 * (row * picture->width + column);
        assert_memory_equal(frame->rgb + 3 * p, due, 3);
      }
      end(d);
      msr_picture_free(picture);
    }
}

/* ---- Anywhere else */

/* A mass colours the pixel that it is in: y is up, and a pixel owns its lower and left edges, as
 * it does where supports are met. */
static void a_mass_is_drawn_where_it_is(void **unused) {
  (void)unused;
  static const struct {
    double x, y;
    const char *art;
  } rows[] = {
      {0.5, 2.5, "o..\n...\n###\n"},     {1.5, 1.5, "...\n.o.\n###\n"},
      {1.999, 1.001, "...\n.o.\n###\n"}, {2.999, 2.999, "..o\n...\n###\n"},
      {0, 1.5, "...\no..\n###\n"},       {2, 1.5, "...\n..o\n###\n"},
      {1.5, 2, ".o.\n...\n###\n"},       {1.5, 1, "...\n.o.\n###\n"}, // on the floor, not in it
      {1.5, 0.5, "...\n...\n###\n"},                                  // supports stay on top
  };
  const drawing d = drawing_of("o..\n...\n###\n", NULL);
  for (size_t i = 0; i < LENGTH(rows); i++) {
    const msr_arrays a = msr_state_edit(d.state);
    a.x[0] = rows[i].x, a.y[0] = rows[i].y;
    assert_draws(d, rows[i].art);
  }
  end(d);
}

/* Its square is clipped at each side; further away nothing is seen of it. */
static void masses_outside_are_clipped(void **unused) {
  (void)unused;
  static const struct {
    double x, y;
    size_t seen; /* pixels of the 4 x 4 block that are in the frame */
  } rows[] = {{2, 2, 16},  {0, 2, 8},    {4, 2, 8},     {2, 0, 8},       {2, 4, 8},
              {0, 0, 4},   {4, 4, 4},    {-0.25, 2, 4}, {4.25, 4.25, 1}, {-0.5, 2, 0},
              {4.5, 2, 0}, {2, -0.5, 0}, {2, 4.5, 0},   {-7, 2, 0},      {2, 1e9, 0}};
  const drawing d = drawing_of("o...\n....\n....\n....\n", &(msr_style){.scale = 4});
  for (size_t i = 0; i < LENGTH(rows); i++) {
    const msr_arrays a = msr_state_edit(d.state);
    a.x[0] = rows[i].x, a.y[0] = rows[i].y;
    const msr_picture *frame = msr_renderer_draw(d.renderer, d.state);
    size_t seen = 0;
    for (size_t p = 0; p < frame->width * frame->height; p++)
      seen += memcmp(frame->rgb + 3 * p, rgb_of('o'), 3) == 0;
    assert_int_equal(seen, rows[i].seen);
  }
  end(d);
}

/* What is no place, or too far for any integer, is drawn nowhere. */
static void places_that_are_none_are_not_drawn(void **unused) {
  (void)unused;
  static const double odd[] = {NO_NUMBER, INFINITE, -INFINITE, DBL_MAX, -DBL_MAX,
                               1e18,      -1e18,    0x1p63,    0x1p64,  -0x1p64};
  for (unsigned scale = 1; scale < 4; scale += 2) {
    const drawing d = drawing_of("oo\n##\n", &(msr_style){.scale = scale});
    for (size_t i = 0; i < LENGTH(odd); i++)
      for (int which = 1; which < 4; which++) {
        msr_arrays a = msr_state_edit(d.state);
        a.x[0] = which & 1 ? odd[i] : 0.5;
        a.y[0] = which & 2 ? odd[i] : 1.5;
        const msr_picture *frame = msr_renderer_draw(d.renderer, d.state);
        size_t red = 0;
        for (size_t p = 0; p < frame->width * frame->height; p++)
          red += memcmp(frame->rgb + 3 * p, rgb_of('o'), 3) == 0;
        assert_int_equal(red, scale * scale); // the other mass
      }
    end(d);
  }
}

/* Masses are drawn in their order, the last on top. */
static void later_masses_are_on_top(void **unused) {
  (void)unused;
  const drawing d = drawing_of("og.\n", NULL);
  msr_arrays a = msr_state_edit(d.state);
  a.x[0] = a.x[1] = 2.5;
  assert_draws(d, "..g\n");
  end(d);
}

static void masses_by_hand_have_their_colours(void **unused) {
  (void)unused;
  msr_scene *scene = scene_of("o..\n", &example, NULL);
  msr_mass mass = {.x = 1.5, .y = 0.5, .m = 1};
  memcpy(mass.rgb, rgb_of('b'), 3);
  must(msr_scene_add_mass(scene, &mass, NULL, &why));
  const drawing d = drawing_of_scene(scene, NULL);
  assert_draws(d, "ob.\n");
  end(d);
}

/* ---- Stripes */

static void every_other_stripe_has_another_colour(void **unused) {
  (void)unused;
  static const struct {
    unsigned stripes;
    unsigned char colour[3];
    const char *art;
  } rows[] = {
      {0, {0, 0, 255}, "oo#\noo.\noyo\n.oo\noo.\n"},
      {1, {0}, "oo#\ngg.\noyo\n.gg\noo.\n"},
      {2, {0}, "oo#\noo.\nggg\n.gg\noo.\n"},
      {2, {0, 0, 255}, "oo#\noo.\nbbb\n.bb\noo.\n"},
      {3, {0, 0, 255}, "oo#\noo.\noyo\n.bb\nbb.\n"},
      {UINT_MAX, {0, 0, 255}, "oo#\noo.\noyo\n.oo\noo.\n"},
  };
  for (size_t i = 0; i < LENGTH(rows); i++) {
    msr_style style = {.stripes = rows[i].stripes};
    memcpy(style.stripe_colour, rows[i].colour, 3);
    const drawing d = drawing_of("oo#\noo.\noyo\n.oo\noo.\n", &style);
    assert_draws(d, rows[i].art);
    end(d);
  }
}

/* A stripe's colour goes with the mass; rows of the scene count, above the picture too. */
static void stripes_move_with_their_masses(void **unused) {
  (void)unused;
  msr_scene *scene = scene_of("oo.\noo.\n", &example, NULL);
  msr_mass above = {.x = 2.5, .y = 2.5, .m = 1}; // one row above the picture: the stripe before
  memcpy(above.rgb, rgb_of('o'), 3);
  must(msr_scene_add_mass(scene, &above, NULL, &why));
  const drawing d = drawing_of_scene(scene, &(msr_style){.stripes = 1});
  assert_draws(d, "oo.\ngg.\n");
  msr_arrays a = msr_state_edit(d.state);
  for (size_t i = 0; i < 4; i++) a.y[i] = 2 - a.y[i];
  a.y[4] = 1.5;
  assert_draws(d, "ggg\noo.\n");
  end(d);
}

/* ---- Pixel by pixel */

/* Is pixel `p` among the `scale` from `first` on? */
static bool covers(double first, unsigned scale, size_t p) {
  return (double)p >= first && (double)p < first + scale;
}

/* The simplest way to draw a mass: every pixel is asked whether its square is there. */
static void draw_mass(msr_picture *frame, const msr_picture *scene, unsigned scale, double x,
                      double y, const unsigned char *rgb) {
  const double column = floor((x - 0.5) * scale + 0.5);
  const double row = ceil(((double)scene->height - y - 0.5) * scale - 0.5);
  for (size_t p = 0; p < frame->width * frame->height; p++) {
    const size_t c = p % frame->width, r = p / frame->width;
    const unsigned char *under = scene->rgb + 3 * (r / scale * scene->width + c / scale);
    const bool support = memcmp(under, rgb_of('#'), 3) == 0;
    if (!support && covers(column, scale, c) && covers(row, scale, r))
      memcpy(frame->rgb + 3 * p, rgb, 3);
  }
}

static void draw_supports(msr_picture *frame, const msr_picture *scene, unsigned scale) {
  for (size_t p = 0; p < frame->width * frame->height; p++) {
    const size_t c = p % frame->width / scale, r = p / frame->width / scale;
    const unsigned char *under = scene->rgb + 3 * (r * scene->width + c);
    if (memcmp(under, rgb_of('#'), 3) == 0) memcpy(frame->rgb + 3 * p, under, 3);
  }
}

static msr_picture *drawn_simply(const msr_picture *scene, const msr_style *style,
                                 const msr_view *s) {
  static const unsigned char green[] = {0, 160, 0};
  msr_picture *frame;
  const unsigned scale = style->scale ? style->scale : 1;
  must(msr_picture_create(scale * scene->width, scale * scene->height, &frame, &why));
  draw_supports(frame, scene, scale);
  size_t i = 0;
  for (size_t p = 0; p < scene->width * scene->height; p++) {
    const unsigned char *rgb = scene->rgb + 3 * p;
    if (memcmp(rgb, rgb_of('#'), 3) == 0 || memcmp(rgb, rgb_of('.'), 3) == 0) continue;
    if (style->stripes && p / scene->width / style->stripes % 2 == 1) rgb = green;
    draw_mass(frame, scene, scale, s->x[i], s->y[i], rgb);
    i++;
  }
  assert_int_equal(i, s->n);
  return frame;
}

/* Inside and about the picture, on edges and next to them, and anywhere. */
static double anywhere(size_t size) {
  static const double odd[] = {0,   -0.0,  5e-324,  -5e-324,  1e300,    -1e300,
                               1e9, -1e18, DBL_MAX, -DBL_MAX, INFINITE, NO_NUMBER};
  const int wide = 4 * ((int)size + 6);
  const double edge = (double)(rand() % wide) / 4 - 3;
  switch (rand() % 4) {
  case 0:
    return edge;
  case 1:
    return nextafter(edge, rand() % 2 ? 1e3 : -1e3);
  case 2:
    return rand() % 8 ? edge : odd[(size_t)rand() % LENGTH(odd)];
  default:
    return edge + (double)rand() / RAND_MAX / 4;
  }
}

/* A part of the masses, at random. */
static void scatter(msr_state *state, const msr_picture *scene, int part) {
  const msr_arrays a = msr_state_edit(state);
  const size_t n = msr_state_view(state).n;
  for (size_t i = 0; i < n; i++)
    if (rand() % part == 0) a.x[i] = anywhere(scene->width), a.y[i] = anywhere(scene->height);
}

static void frames_are_those_drawn_simply(void **unused) {
  (void)unused;
  for (unsigned trial = 0; trial < 700; trial++) {
    const msr_style style = {.scale = trial % 8, .stripes = trial % 3};
    msr_picture *scene = random_picture(trial % 8 < 3 ? 24 : 8);
    if (trial % 5 == 0)
      for (size_t p = 0; p < scene->width * scene->height; p++)
        if (p % 7) memcpy(scene->rgb + 3 * p, rgb_of('o'), 3);
    const drawing d = drawing_of_scene(scene_in(scene), &style);
    for (int again = 1; again >= 0; again--) { // first most stay where they follow each other
      scatter(d.state, scene, 1 + 20 * again);
      const msr_view s = msr_state_view(d.state);
      msr_picture *due = drawn_simply(scene, &style, &s);
      assert_same_picture(msr_renderer_draw(d.renderer, d.state), due);
      msr_picture_free(due);
    }
    end(d);
    msr_picture_free(scene);
  }
}

/* ---- Kernels */

enum { PLACES = 1003, SIDE = 37 };

/* What a kernel makes of places: many in a row follow each other in the frame as well, and ends
 * of such stretches are anywhere among them. */
static void put_in_rows(double *x, double *y) {
  for (size_t i = 0, column = 0, row = 0; i < PLACES; i++, column++) {
    if (rand() % 12 == 0) column = (size_t)rand() % SIDE, row = (size_t)rand() % (SIDE + 1);
    x[i] = (double)column + 0.5;
    y[i] = SIDE - (double)row - 0.5;
  }
}

static void put_anywhere(double *x, double *y) {
  for (size_t i = 0; i < PLACES; i++) x[i] = anywhere(SIDE), y[i] = anywhere(SIDE);
}

/* The frame that a kernel draws. */
static void make(const msri_canvas_kernel *kernel, size_t scale, const double *x, const double *y,
                 const msri_colours *paints, unsigned char *rgb) {
  msri_canvas canvas;
  must(msri_canvas_create(SIDE, SIDE, scale, &canvas, &why));
  static int32_t at[PLACES];
  if (scale == 1) kernel->draw(&canvas, paints, PLACES, x, y);
  if (scale > 1) kernel->find(&canvas, PLACES, x, y, at);
  if (scale > 1) msri_canvas_complete(&canvas, paints, PLACES, at);
  memcpy(rgb, canvas.frame.rgb, 3 * scale * scale * SIDE * SIDE);
  msri_canvas_clear(&canvas);
}

static void assert_kernels_agree(size_t scale, const double *x, const double *y,
                                 const msri_colours *paints) {
  static unsigned char any[3 * 9 * SIDE * SIDE], wide[sizeof any];
  const msri_canvas_kernel *last = msri_canvas_kernels;
  while (last->runs_here) last++;
  make(last, scale, x, y, paints, any);
  for (const msri_canvas_kernel *k = msri_canvas_kernels; k < last; k++) {
    if (!k->runs_here()) continue;
    make(k, scale, x, y, paints, wide);
    assert_memory_equal(any, wide, 3 * scale * scale * SIDE * SIDE);
  }
}

static void kernels_agree(void **unused) {
  (void)unused;
  static double x[PLACES], y[PLACES];
  static unsigned char rgb[3 * PLACES];
  for (size_t i = 0; i < sizeof rgb; i++) rgb[i] = (unsigned char)rand();
  for (unsigned trial = 0; trial < 12; trial++) {
    (trial % 2 ? put_anywhere : put_in_rows)(x, y);
    assert_kernels_agree(1 + trial % 3, x, y, &(msri_colours){rgb, trial % 4 > 1});
  }
}

/* ---- What can't be drawn */

static void frames_that_cannot_be_are_refused(void **unused) {
  (void)unused;
  msr_scene *scene;
  msr_plan *plan;
  msr_renderer *renderer = NULL;
  msr_error err;
  must(msr_scene_create(&scene, &why));
  must(msr_plan_create(scene, NULL, &plan, &why));
  assert_int_equal(msr_renderer_create(plan, NULL, &renderer, &err), MSR_EUSAGE);
  assert_string_equal(err.message, "a scene without a picture has no frames");
  msr_plan_free(plan);
  msr_scene_free(scene);
  const drawing d = drawing_of("o\n", NULL);
  assert_int_equal(msr_renderer_create(d.plan, &(msr_style){.scale = UINT_MAX}, &renderer, &err),
                   MSR_EUSAGE);
  assert_true(strlen(err.message) > 0);
  assert_null(renderer);
  end(d);
  msr_renderer_free(NULL);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_first_frame_is_the_scene),
      cmocka_unit_test(a_scaled_frame_is_a_magnification),
      cmocka_unit_test(a_mass_is_drawn_where_it_is),
      cmocka_unit_test(masses_outside_are_clipped),
      cmocka_unit_test(places_that_are_none_are_not_drawn),
      cmocka_unit_test(later_masses_are_on_top),
      cmocka_unit_test(masses_by_hand_have_their_colours),
      cmocka_unit_test(every_other_stripe_has_another_colour),
      cmocka_unit_test(stripes_move_with_their_masses),
      cmocka_unit_test(frames_are_those_drawn_simply),
      cmocka_unit_test(kernels_agree),
      cmocka_unit_test(frames_that_cannot_be_are_refused),
  };
  return cmocka_run_group_tests_name("renderer", tests, NULL, NULL);
}
