/* renderer.c - state to picture: a square of a pixel's size, in its colour, where each mass is.
 *
 * Masses are drawn in their order over white; supports stay on top. At scale 1 a mass colours the
 * pixel that it is in, so that the state at the start gives the scene's own picture. */
#include "plan/state.h"

#include "base/pixel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct msr_renderer {
  size_t scale;
  double height;           /* of the scene [px] */
  msr_picture *background; /* supports over white */
  msr_picture *frame;
  unsigned char *rgb; /* [masses][3] */
};

static const unsigned char green[3] = {0, 160, 0};

/* Gives every other stripe of the scene's rows another colour. */
static void stripe(const msr_plan *plan, const msr_style *style, unsigned char *rgb, double *y) {
  static const unsigned char none[3] = {0};
  const bool given = memcmp(style->stripe_colour, none, sizeof none) != 0;
  const unsigned char *colour = given ? style->stripe_colour : green;
  for (size_t i = 0; i < plan->figures.masses; i++) {
    const double row = floor((double)plan->figures.height - y[i]);
    if (fmod(floor(row / style->stripes), 2) != 0) memcpy(rgb + 3 * i, colour, 3);
  }
}

static msr_status colour_masses(msr_renderer *renderer, const msr_plan *plan,
                                const msr_style *style, msr_error *err) {
  const size_t n = plan->figures.masses;
  renderer->rgb = msri_alloc(n, 3, "the colours", err);
  if (!renderer->rgb) return MSR_ENOMEM;
  msri_plan_colours(plan, renderer->rgb);
  if (style->stripes == 0) return MSR_OK;
  double *q = msri_alloc(4 * n, sizeof *q, "the stripes", err);
  if (!q) return MSR_ENOMEM;
  msri_plan_start(plan, q, q + n, q + 2 * n, q + 3 * n);
  stripe(plan, style, renderer->rgb, q + n);
  free(q);
  return MSR_OK;
}

/* Paints the scale x scale block of a pixel of the scene. */
static void paint_block(msr_picture *picture, size_t scale, size_t column, size_t row) {
  for (size_t y = row * scale; y < (row + 1) * scale; y++)
    memset(picture->rgb + 3 * (y * picture->width + column * scale), 0, 3 * scale);
}

static msr_status paint_background(msr_renderer *renderer, const msr_plan *plan, msr_error *err) {
  const size_t width = plan->figures.width, height = plan->figures.height, scale = renderer->scale;
  if (width > SIZE_MAX / scale || height > SIZE_MAX / scale)
    return msri_fail(err, MSR_EUSAGE, "scale %zu makes the frames too large", scale);
  msr_status status = msr_picture_create(width * scale, height * scale, &renderer->frame, err);
  if (status == MSR_OK)
    status = msr_picture_create(width * scale, height * scale, &renderer->background, err);
  if (status != MSR_OK) return status;
  for (size_t row = 0; row < height; row++)
    for (size_t column = 0; column < width; column++)
      if (msri_pixel_at(plan->picture, column, row) == MSRI_SUPPORT)
        paint_block(renderer->background, scale, column, row);
  return MSR_OK;
}

msr_status msr_renderer_create(const msr_plan *plan, const msr_style *style,
                               msr_renderer **renderer, msr_error *err) {
  static const msr_style plain = {0};
  if (!style) style = &plain;
  if (!plan->picture) return msri_fail(err, MSR_EUSAGE, "a scene without a picture has no frames");
  msr_renderer *made = msri_alloc(1, sizeof *made, "a renderer", err);
  if (!made) return MSR_ENOMEM;
  made->scale = style->scale ? style->scale : 1;
  made->height = (double)plan->figures.height;
  msr_status status = paint_background(made, plan, err);
  if (status == MSR_OK) status = colour_masses(made, plan, style, err);
  if (status == MSR_OK)
    *renderer = made;
  else
    msr_renderer_free(made);
  return status;
}

void msr_renderer_free(msr_renderer *renderer) {
  if (!renderer) return;
  msr_picture_free(renderer->background);
  msr_picture_free(renderer->frame);
  free(renderer->rgb);
  free(renderer);
}

/* The pixels from..to-1 of `size` that a square of `scale` pixels from `first` on covers; false:
 * none. */
static bool cover(double first, size_t scale, size_t size, size_t *from, size_t *to) {
  const double last = first + (double)scale;
  if (!(last > 0 && first < (double)size)) return false;
  *from = first > 0 ? (size_t)first : 0;
  *to = last < (double)size ? (size_t)last : size;
  return true;
}

/* As for supports, a pixel owns its left and lower edges. */
static void draw_mass(msr_renderer *renderer, double x, double y, const unsigned char *rgb) {
  msr_picture *frame = renderer->frame;
  const double scale = (double)renderer->scale;
  const double first_column = floor((x - 0.5) * scale + 0.5);
  const double first_row = ceil((renderer->height - y - 0.5) * scale - 0.5);
  size_t left, right, top, bottom;
  if (!cover(first_column, renderer->scale, frame->width, &left, &right)) return;
  if (!cover(first_row, renderer->scale, frame->height, &top, &bottom)) return;
  for (size_t row = top; row < bottom; row++)
    for (size_t column = left; column < right; column++) {
      const size_t at = 3 * (row * frame->width + column);
      if (renderer->background->rgb[at] != 0) memcpy(frame->rgb + at, rgb, 3);
    }
}

const msr_picture *msr_renderer_draw(msr_renderer *renderer, const msr_state *state) {
  msr_picture *frame = renderer->frame;
  const msr_view s = msr_state_view(state);
  memcpy(frame->rgb, renderer->background->rgb, 3 * frame->width * frame->height);
  for (size_t i = 0; i < s.n; i++) draw_mass(renderer, s.x[i], s.y[i], renderer->rgb + 3 * i);
  return frame;
}
