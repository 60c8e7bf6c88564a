/* renderer.c - state to picture: a square of a pixel's size, in its colour, where each mass is.
 *
 * Masses are drawn in their order over white; supports stay on top. At scale 1 a mass colours the
 * pixel that it is in, so that the state at the start gives the scene's own picture. */
#include "run/renderer.h"

#include "base/clock.h"

#include "base/pixel.h"
#include "formats/ppm.h"
#include "plan/state.h"
#include "run/canvas.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Pixels of the frame, side by side. */
typedef struct stretch {
  uint32_t first, count;
} stretch;

struct msr_renderer {
  msri_canvas canvas;
  stretch *support; /* [n_supports] */
  size_t n_supports, support_capacity;
  size_t masses;
  msri_colours colours;
  int32_t *at; /* [masses] if the scale isn't 1: where squares begin */
};

/* ---- Colours */

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

static msr_status stripe_masses(const msr_plan *plan, const msr_style *style, unsigned char *rgb,
                                msr_error *err) {
  const size_t n = plan->figures.masses;
  if (style->stripes == 0) return MSR_OK;
  double *q = msri_alloc(4 * n, sizeof *q, "the stripes", err);
  if (!q) return MSR_ENOMEM;
  msri_plan_start(plan, q, q + n, q + 2 * n, q + 3 * n);
  stripe(plan, style, rgb, q + n);
  free(q);
  return MSR_OK;
}

/* One colour is kept a few times only. */
static msr_status keep_colours(msr_renderer *renderer, const unsigned char *rgb, msr_error *err) {
  const size_t n = renderer->masses;
  size_t same = n > 0;
  while (same < n && memcmp(rgb, rgb + 3 * same, 3) == 0) same++;
  const bool alike = same == n;
  const size_t kept = alike ? MSRI_CANVAS_GROUP : n;
  renderer->colours = (msri_colours){msri_alloc(kept, 3, "the colours", err), alike};
  if (!renderer->colours.rgb) return MSR_ENOMEM;
  if (!alike) memcpy(renderer->colours.rgb, rgb, 3 * n);
  for (size_t i = 0; alike && n > 0 && i < kept; i++) memcpy(renderer->colours.rgb + 3 * i, rgb, 3);
  return MSR_OK;
}

static msr_status colour_masses(msr_renderer *renderer, const msr_plan *plan,
                                const msr_style *style, msr_error *err) {
  unsigned char *rgb = msri_alloc(renderer->masses, 3, "the colours", err);
  if (!rgb) return MSR_ENOMEM;
  msri_plan_colours(plan, rgb);
  msr_status status = stripe_masses(plan, style, rgb, err);
  if (status == MSR_OK) status = keep_colours(renderer, rgb, err);
  free(rgb);
  return status;
}

/* ---- Supports */

/* The next stretch of supports of a row from a column on; false: there is none. */
static bool next_support(const msr_plan *plan, size_t row, size_t *from, size_t *to) {
  const size_t width = plan->figures.width;
  while (*from < width && msri_pixel_at(plan->picture, *from, row) != MSRI_SUPPORT) ++*from;
  *to = *from;
  while (*to < width && msri_pixel_at(plan->picture, *to, row) == MSRI_SUPPORT) ++*to;
  return *from < width;
}

/* As every row of pixels in the scene's row has it. */
static msr_status add_support(msr_renderer *renderer, size_t row, size_t from, size_t to,
                              msr_error *err) {
  const size_t scale = renderer->canvas.scale, line = renderer->canvas.frame.width;
  stretch *grown = msri_grow(renderer->support, &renderer->support_capacity,
                             renderer->n_supports + scale, sizeof *grown, "the supports", err);
  if (!grown) return MSR_ENOMEM;
  renderer->support = grown;
  for (size_t r = row * scale; r < (row + 1) * scale; r++)
    grown[renderer->n_supports++] =
        (stretch){(uint32_t)(r * line + from * scale), (uint32_t)((to - from) * scale)};
  return MSR_OK;
}

static msr_status find_supports(msr_renderer *renderer, const msr_plan *plan, msr_error *err) {
  msr_status status = MSR_OK;
  for (size_t row = 0; row < plan->figures.height; row++)
    for (size_t from = 0, to; status == MSR_OK && next_support(plan, row, &from, &to); from = to)
      status = add_support(renderer, row, from, to, err);
  return status;
}

/* ---- Making */

static msr_status prepare(msr_renderer *renderer, const msr_plan *plan, const msr_style *style,
                          msr_error *err) {
  const size_t scale = style->scale ? style->scale : 1;
  renderer->masses = plan->figures.masses;
  msr_status status =
      msri_canvas_create(plan->figures.width, plan->figures.height, scale, &renderer->canvas, err);
  if (status != MSR_OK) return status;
  if (scale > 1) {
    renderer->at = msri_alloc(renderer->masses, sizeof *renderer->at, "the places", err);
    if (!renderer->at) return MSR_ENOMEM;
  }
  status = find_supports(renderer, plan, err);
  return status == MSR_OK ? colour_masses(renderer, plan, style, err) : status;
}

msr_status msr_renderer_create(const msr_plan *plan, const msr_style *style,
                               msr_renderer **renderer, msr_error *err) {
  static const msr_style plain = {0};
  if (!plan->picture) return msri_fail(err, MSR_EUSAGE, "a scene without a picture has no frames");
  msr_renderer *made = msri_alloc(1, sizeof *made, "a renderer", err);
  if (!made) return MSR_ENOMEM;
  const msr_status status = prepare(made, plan, style ? style : &plain, err);
  if (status == MSR_OK)
    *renderer = made;
  else
    msr_renderer_free(made);
  return status;
}

void msr_renderer_free(msr_renderer *renderer) {
  if (!renderer) return;
  msri_canvas_clear(&renderer->canvas);
  free(renderer->support);
  free(renderer->colours.rgb);
  free(renderer->at);
  free(renderer);
}

/* ---- Drawing */

void msri_renderer_take(msr_renderer *renderer, const msr_state *state) {
  const msr_view s = msr_state_view(state);
  msri_canvas_take(&renderer->canvas, &renderer->colours, s.n, s.x, s.y, renderer->at);
}

/* What doesn't need the state. */
static void complete(const msr_renderer *renderer) {
  const msri_canvas *canvas = &renderer->canvas;
  if (renderer->at)
    msri_canvas_complete(canvas, &renderer->colours, renderer->masses, renderer->at);
  for (const stretch *s = renderer->support; s < renderer->support + renderer->n_supports; s++)
    memset(canvas->frame.rgb + 3 * (size_t)s->first, 0, 3 * (size_t)s->count);
}

const msr_picture *msr_renderer_draw(msr_renderer *renderer, const msr_state *state) {
  msri_renderer_take(renderer, state);
  complete(renderer);
  return &renderer->canvas.frame;
}

/* Header and pixels. Between pieces who reads a pipe can have his turn. */
static msr_status write_frame(const msr_picture *frame, msri_file *file, msr_error *err) {
  enum { PIECE = 1 << 18 };
  char header[MSRI_PPM_HEADER_SIZE];
  const size_t n = msri_ppm_header(frame, header), size = n + 3 * frame->width * frame->height;
  const unsigned char *bytes = memcpy(frame->rgb - n, header, n);
  msr_status status = MSR_OK;
  for (size_t at = 0; at < size && status == MSR_OK; at += PIECE)
    status = msri_file_write(file, bytes + at, size - at < PIECE ? size - at : PIECE, err);
  return status;
}

/* Made white again while the next frame isn't waited for. */
msr_status msri_renderer_write(msr_renderer *renderer, msri_file *file, double *drawing,
                               msr_error *err) {
  const double start = msri_clock_now();
  complete(renderer);
  const double drawn = msri_clock_now();
  const msr_status status = write_frame(&renderer->canvas.frame, file, err);
  const double written = msri_clock_now();
  msri_canvas_whiten(&renderer->canvas);
  *drawing += drawn - start + msri_clock_now() - written;
  return status;
}
