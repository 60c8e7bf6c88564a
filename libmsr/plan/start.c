/* start.c - where every mass of a plan begins: at its pixel, or where a program put it. */
#include "plan/plan.h"

#include "base/number.h"
#include "base/pixel.h"

#include <math.h>
#include <string.h>

void msri_plan_start(const msr_plan *plan, double *x, double *y, double *vx, double *vy) {
  const size_t width = plan->figures.width, height = plan->figures.height;
  size_t i = 0;
  for (size_t row = 0; row < height; row++)
    for (size_t column = 0; column < width; column++) {
      if (msri_pixel_at(plan->picture, column, row) != MSRI_MASS) continue;
      x[i] = (double)column + 0.5;
      y[i] = (double)(height - row) - 0.5;
      vx[i] = vy[i] = 0;
      i++;
    }
  for (const msr_mass *mass = plan->mass; i < plan->figures.masses; i++, mass++) {
    x[i] = mass->x, y[i] = mass->y;
    vx[i] = mass->vx, vy[i] = mass->vy;
  }
}

void msri_plan_colours(const msr_plan *plan, unsigned char *rgb) {
  const size_t pixels = plan->figures.width * plan->figures.height;
  for (size_t p = 0; p < pixels; p++) {
    const unsigned char *pixel = plan->picture->rgb + 3 * p;
    if (msri_pixel_of(pixel) != MSRI_MASS) continue;
    memcpy(rgb, pixel, 3);
    rgb += 3;
  }
  for (size_t i = plan->n_picture; i < plan->figures.masses; i++, rgb += 3)
    memcpy(rgb, plan->mass[i - plan->n_picture].rgb, 3);
}

msr_view msri_plan_view(const msr_plan *plan, double t, const double *q, const double *v) {
  const size_t n = plan->figures.masses;
  return (msr_view){
      .n = n,
      .t = t,
      .x = q,
      .y = q + n,
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

/* The pixel of the n-th mass of the picture. */
bool msr_plan_pixel(const msr_plan *plan, size_t mass, size_t *column, size_t *row) {
  if (mass >= plan->n_picture) return false;
  const size_t width = plan->figures.width;
  for (size_t p = 0;; p++) {
    if (msri_pixel_of(plan->picture->rgb + 3 * p) != MSRI_MASS) continue;
    if (mass-- > 0) continue;
    *column = p % width;
    *row = p / width;
    return true;
  }
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
