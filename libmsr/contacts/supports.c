/* supports.c - fixed supports: the black pixels of a picture, and the first of them on a path,
 * found by walking the path pixel by pixel through their sides (Amanatides & Woo 1987, A fast voxel
 * traversal algorithm for ray tracing). */
#include "contacts/supports.h"

#include "base/pixel.h"

#include <stdlib.h>

/* Where `at` lies; all that is outside is in the ring of pixels around the picture. */
static long cell_of(double at, size_t size) {
  return at < 0 ? -1 : at < (double)size ? (long)at : (long)size;
}

static bool is_solid(const msri_supports *s, const long *cell) {
  const bool inside =
      cell[0] >= 0 && cell[0] < (long)s->width && cell[1] >= 0 && cell[1] < (long)s->height;
  return inside ? msri_supports_solid(s, (size_t)cell[1] * s->width + (size_t)cell[0])
                : s->options.closed;
}

bool msri_supports_face(const msri_supports *s, const double *from, const double *to,
                        msri_face *met) {
  const size_t size[] = {s->width, s->height};
  long cell[MSRI_AXES], end[MSRI_AXES], steps = 0;
  for (int d = 0; d < MSRI_AXES; d++) {
    if (!(isfinite(from[d]) && isfinite(to[d]))) return false;
    cell[d] = cell_of(from[d], size[d]), end[d] = cell_of(to[d], size[d]);
    steps += labs(end[d] - cell[d]);
  }
  for (; steps > 0; steps--) {
    double t[MSRI_AXES]; // when the next side is crossed, as a share of the path
    for (int d = 0; d < MSRI_AXES; d++)
      t[d] = cell[d] == end[d]
                 ? (double)INFINITY
                 : ((double)(cell[d] + (end[d] > cell[d])) - from[d]) / (to[d] - from[d]);
    const int axis = t[1] < t[0] ? 1 : 0;
    const bool up = end[axis] > cell[axis];
    const double edge = (double)(cell[axis] + up);
    cell[axis] += up ? 1 : -1;
    if (!is_solid(s, cell)) continue;
    *met = (msri_face){axis, up ? nextafter(edge, -(double)INFINITY) : edge, up ? 1 : -1};
    return true;
  }
  return false;
}

static void mark(msri_supports *s, const msr_picture *picture) {
  for (size_t row = 0; row < s->height; row++)
    for (msri_span black = {0, 0}; msri_span_of(picture, row, MSRI_SUPPORT, &black);)
      for (size_t column = black.begin; column < black.end; column++) {
        const size_t bit = (s->height - 1 - row) * s->width + column;
        s->solid[bit / MSRI_WORD] |= (uint64_t)1 << (bit % MSRI_WORD);
      }
}

/* msri_contact's stop. */
static bool stop(const void *self, const double *from, double *to) {
  msri_leg leg = {.x = {from[0], from[1]}};
  const unsigned met = msri_supports_keep(self, to, &leg);
  to[0] = leg.x[0], to[1] = leg.x[1];
  return met > 0;
}

msr_status msri_supports_create(const msr_picture *picture, const msri_supports_options *options,
                                msri_contact *contact, msr_error *err) {
  const size_t words = picture->width * picture->height / MSRI_WORD + 1;
  const size_t distances = (picture->width + 2) * (picture->height + 2);
  const size_t bytes = sizeof(msri_supports) + words * sizeof(uint64_t) + distances;
  msri_supports *s = msri_alloc(1, bytes, "the supports", err);
  if (!s) return MSR_ENOMEM;
  s->width = picture->width;
  s->height = picture->height;
  s->options = *options;
  s->kernel = msri_flock_widest();
  s->distance = (unsigned char *)(s->solid + words);
  mark(s, picture);
  msri_supports_measure(s);
  *contact = options->impacts == MSR_IMPACTS_LOCATED ? msri_impacts_located : msri_impacts_kept;
  contact->self = s;
  contact->bytes = bytes;
  contact->clearance = msri_supports_clearance;
  contact->stop = stop;
  contact->release = free;
  return MSR_OK;
}
