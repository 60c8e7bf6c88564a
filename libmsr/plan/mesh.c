/* mesh.c - the springs of a scene as runs of constant offset.
 *
 * In reading order the right neighbour of mass i is i + 1 and, along a stretch of a row, the lower
 * one is i + d with d constant: a picture's springs need no memory of their own, only runs. Springs
 * added by a program are sorted so that a lattice built by hand makes long runs too, BAND masses at
 * a time to stay in cache. The order of runs is the order of summation. */
#include "plan/plan.h"

#include "base/pixel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BAND = 1024 };
static const size_t NONE = SIZE_MAX;

/* ---- Runs */

/* Appends the spring i -- j, to the last run if it goes on there. k and L are one value for every
 * spring (stride 0) or this spring's place in an array (stride 1). */
static msr_status append(msri_mesh *mesh, size_t i, size_t j, const double *k, const double *L,
                         size_t stride, msr_error *err) {
  const size_t offset = j - i;
  mesh->springs.n++;
  if (mesh->springs.n_runs > 0) {
    msr_run_of_springs *run = &mesh->run[mesh->springs.n_runs - 1];
    const size_t s = run->count * stride;
    if (run->first + run->count == i && run->offset == offset && run->stride == stride &&
        run->k + s == k && run->L + s == L) {
      run->count++;
      return MSR_OK;
    }
  }
  msr_run_of_springs *grown = msri_grow(mesh->run, &mesh->run_capacity, mesh->springs.n_runs + 1,
                                        sizeof *grown, "springs", err);
  if (!grown) return MSR_ENOMEM;
  mesh->run = grown;
  grown[mesh->springs.n_runs++] = (msr_run_of_springs){i, 1, offset, k, L, stride};
  return MSR_OK;
}

static msr_status append_anchor(msri_mesh *mesh, msr_anchor anchor, msr_error *err) {
  msr_anchor *grown = msri_grow(mesh->anchor, &mesh->anchor_capacity, mesh->springs.n_anchors + 1,
                                sizeof *grown, "anchors", err);
  if (!grown) return MSR_ENOMEM;
  mesh->anchor = grown;
  grown[mesh->springs.n_anchors++] = anchor;
  return MSR_OK;
}

/* ---- The picture's springs */

/* Numbers the masses of a row from `next` on; NONE elsewhere. Returns the next number. */
static size_t number_row(const msr_picture *picture, size_t row, size_t next, size_t *number) {
  for (size_t c = 0; c < picture->width; c++)
    number[c] = msri_pixel_at(picture, c, row) == MSRI_MASS ? next++ : NONE;
  return next;
}

/* Springs from each mass of a row to the one `right` columns further in the row `to`. */
static msr_status tie_rows(msri_mesh *mesh, size_t width, const size_t *from, const size_t *to,
                           int right, size_t side, msr_error *err) {
  const size_t begin = (size_t)(right < 0), end = width - (size_t)(right > 0);
  msr_status status = MSR_OK;
  for (size_t c = begin; c < end && status == MSR_OK; c++) {
    const size_t i = from[c], j = to[c + (size_t)right];
    if (i != NONE && j != NONE)
      status = append(mesh, i, j, &mesh->lattice_k, &mesh->lattice_L[side], 0, err);
  }
  return status;
}

/* Anchors from each mass of a row to the supports around it. */
static msr_status attach_row(msri_mesh *mesh, const msr_scene *scene, size_t row,
                             const size_t *number, msr_error *err) {
  static const int around[8][2] = {{1, 0}, {-1, 0}, {0, 1},  {0, -1},
                                   {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
  const msr_picture *p = scene->picture;
  msr_status status = MSR_OK;
  for (size_t c = 0; c < p->width; c++) {
    for (int n = 0; n < scene->options.neighbours && number[c] != NONE; n++) {
      const size_t nc = c + (size_t)around[n][0], nr = row + (size_t)around[n][1];
      if (nc >= p->width || nr >= p->height || msri_pixel_at(p, nc, nr) != MSRI_SUPPORT) continue;
      const double x = (double)nc + 0.5, y = (double)(p->height - nr) - 0.5;
      const msr_anchor anchor = {number[c], x, y, mesh->lattice_k, mesh->lattice_L[n >= 4]};
      status = append_anchor(mesh, anchor, err);
      if (status != MSR_OK) return status;
    }
  }
  return status;
}

/* All springs between row `above` and the next one, `below`, then those along the latter. */
static msr_status tie_row(msri_mesh *mesh, const msr_scene *scene, const size_t *above,
                          const size_t *below, msr_error *err) {
  const size_t width = scene->picture->width;
  const bool diagonals = scene->options.neighbours == 8;
  msr_status status = tie_rows(mesh, width, above, below, 0, 0, err);
  if (status == MSR_OK && diagonals) status = tie_rows(mesh, width, above, below, -1, 1, err);
  if (status == MSR_OK && diagonals) status = tie_rows(mesh, width, above, below, 1, 1, err);
  if (status == MSR_OK) status = tie_rows(mesh, width, below, below, 1, 0, err);
  return status;
}

static msr_status tie_picture(msri_mesh *mesh, const msr_scene *scene, msr_error *err) {
  const msr_picture *p = scene->picture;
  size_t *numbers = msri_alloc(2 * p->width, sizeof *numbers, "the springs", err);
  if (!numbers) return MSR_ENOMEM;
  size_t *above = numbers, *below = numbers + p->width, next = 0;
  for (size_t c = 0; c < p->width; c++) above[c] = NONE;
  msr_status status = MSR_OK;
  for (size_t row = 0; row < p->height && status == MSR_OK; row++) {
    next = number_row(p, row, next, below);
    status = tie_row(mesh, scene, above, below, err);
    if (status == MSR_OK && scene->options.attach)
      status = attach_row(mesh, scene, row, below, err);
    size_t *swap = above;
    above = below;
    below = swap;
  }
  free(numbers);
  return status;
}

/* ---- The program's springs */

#define COMPARE(a, b)                                                                              \
  if ((a) != (b)) return (a) < (b) ? -1 : 1

static int by_band_offset_and_first(const void *a, const void *b) {
  const msri_scene_spring *p = a, *q = b;
  COMPARE(p->i / BAND, q->i / BAND);
  COMPARE(p->j - p->i, q->j - q->i);
  COMPARE(p->i, q->i);
  COMPARE(p->k, q->k);
  COMPARE(p->L, q->L);
  return 0;
}

static msr_status tie_added(msri_mesh *mesh, const msr_scene *scene, msr_error *err) {
  const size_t n = scene->n_springs;
  mesh->n_added = n;
  msri_scene_spring *sorted = msri_alloc(n, sizeof *sorted, "the springs", err);
  mesh->k = msri_alloc(n, sizeof *mesh->k, "the springs", err);
  mesh->L = msri_alloc(n, sizeof *mesh->L, "the springs", err);
  msr_status status = sorted && mesh->k && mesh->L ? MSR_OK : MSR_ENOMEM;
  if (status == MSR_OK && n > 0) {
    memcpy(sorted, scene->spring, n * sizeof *sorted);
    qsort(sorted, n, sizeof *sorted, by_band_offset_and_first);
  }
  for (size_t s = 0; s < n && status == MSR_OK; s++) {
    mesh->k[s] = sorted[s].k;
    mesh->L[s] = sorted[s].L;
    status = append(mesh, sorted[s].i, sorted[s].j, &mesh->k[s], &mesh->L[s], 1, err);
  }
  free(sorted);
  for (size_t a = 0; a < scene->n_anchors && status == MSR_OK; a++)
    status = append_anchor(mesh, scene->anchor[a], err);
  return status;
}

msr_status msri_mesh_create(const msr_scene *scene, msri_mesh *mesh, msr_error *err) {
  *mesh = (msri_mesh){.lattice_k = scene->conf.stiffness, .lattice_L = {1, sqrt(2)}};
  msr_status status = scene->picture ? tie_picture(mesh, scene, err) : MSR_OK;
  if (status == MSR_OK) status = tie_added(mesh, scene, err);
  if (status != MSR_OK) msri_mesh_clear(mesh);
  mesh->springs.run = mesh->run;
  mesh->springs.anchor = mesh->anchor;
  return status;
}

void msri_mesh_clear(msri_mesh *mesh) {
  free(mesh->run);
  free(mesh->anchor);
  free(mesh->k);
  free(mesh->L);
  *mesh = (msri_mesh){0};
}
