/* start.c - where every mass of a plan begins: at its pixel, or where a program put it. */
#include "plan/plan.h"

#include "base/number.h"

#include <math.h>
#include <string.h>

static bool move(const msr_scene *scene) {
  for (size_t i = 0; i < scene->n_masses; i++)
    if (scene->mass[i].vx != 0 || scene->mass[i].vy != 0) return true;
  return false;
}

msr_status msri_plan_keep_start(msr_plan *plan, const msr_scene *scene, msr_error *err) {
  const size_t n = scene->n_masses;
  plan->added_move = move(scene);
  plan->added = msri_alloc(plan->added_move ? 4 * n : 2 * n, sizeof *plan->added, "masses", err);
  plan->added_rgb = msri_alloc(n, 3, "the masses", err);
  if (!plan->added || !plan->added_rgb) return MSR_ENOMEM;
  for (size_t i = 0; i < n; i++) {
    const msr_mass *mass = &scene->mass[i];
    const double start[] = {mass->x, mass->y, mass->vx, mass->vy};
    for (size_t d = 0; d < (plan->added_move ? 4 : 2); d++) plan->added[d * n + i] = start[d];
    memcpy(plan->added_rgb + 3 * i, mass->rgb, 3);
  }
  return MSR_OK;
}

static void copy(size_t n, const double *from, double *to) { memcpy(to, from, n * sizeof *to); }

/* From mass i on: those of a row of the picture. Returns the mass after them. */
static size_t start_row(const msr_plan *plan, size_t row, size_t i, double *x, double *y) {
  const double height = (double)(plan->figures.height - row) - 0.5;
  for (msri_span s = {0, 0}; msri_span_of(plan->picture, row, MSRI_MASS, &s);)
    for (size_t column = s.begin; column < s.end; column++, i++) {
      x[i] = (double)column + 0.5;
      y[i] = height;
    }
  return i;
}

void msri_plan_start(const msr_plan *plan, double *x, double *y, double *vx, double *vy) {
  size_t i = 0;
  for (size_t row = 0; row < plan->figures.height; row++) i = start_row(plan, row, i, x, y);
  const size_t n = plan->figures.masses - i;
  copy(n, plan->added, x + i);
  copy(n, plan->added + n, y + i);
  if (!plan->added_move) return;
  copy(n, plan->added + 2 * n, vx + i);
  copy(n, plan->added + 3 * n, vy + i);
}

static unsigned char *colour_row(const msr_plan *plan, size_t row, unsigned char *rgb) {
  for (msri_span s = {0, 0}; msri_span_of(plan->picture, row, MSRI_MASS, &s);) {
    const size_t size = 3 * (s.end - s.begin);
    memcpy(rgb, msri_pixel_rgb(plan->picture, s.begin, row), size);
    rgb += size;
  }
  return rgb;
}

void msri_plan_colours(const msr_plan *plan, unsigned char *rgb) {
  for (size_t row = 0; row < plan->figures.height; row++) rgb = colour_row(plan, row, rgb);
  memcpy(rgb, plan->added_rgb, 3 * (plan->figures.masses - plan->n_picture));
}

msr_view msri_plan_view(const msr_plan *plan, double t, const double *q, const double *v) {
  const size_t n = plan->figures.masses;
  return (msr_view){
      .n = n,
      .t = t,
      .x = q,
      .y = q ? q + n : NULL,
      .vx = v,
      .vy = v ? v + n : NULL,
      .m = plan->m ? plan->m : &plan->uniform_mass,
      .m_stride = plan->m ? 1 : 0,
      .springs = &plan->mesh.springs,
  };
}

double msri_kinetic(const msr_view *s) {
  double sum = 0;
  for (size_t i = 0; i < s->n; i++)
    sum += msr_view_mass(s, i) * (s->vx[i] * s->vx[i] + s->vy[i] * s->vy[i]);
  return sum / 2;
}

bool msr_plan_pixel(const msr_plan *plan, size_t mass, size_t *column, size_t *row) {
  if (mass >= plan->n_picture) return false;
  msri_grid_pixel(plan->grid, mass, column, row);
  return true;
}

const char *msri_plan_mass_name(const msr_plan *plan, size_t mass, char *text, size_t size) {
  size_t column, row;
  if (msr_plan_pixel(plan, mass, &column, &row))
    msri_format(text, size, "the mass of pixel (%zu,%zu)", column, row);
  else
    msri_format(text, size, "mass %zu", mass);
  return text;
}

uint64_t msr_plan_frame_iteration(const msr_plan *plan, uint64_t frame) {
  const uint64_t iterations = plan->figures.iterations, images = plan->figures.images;
  /* i * iterations / images without overflow */
  return iterations / images * frame + iterations % images * frame / images;
}
