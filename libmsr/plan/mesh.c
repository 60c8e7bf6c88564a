/* mesh.c - the springs of a scene as runs of constant offset.
 *
 * In reading order the right neighbour of mass i is i + 1 and, along a stretch of a row, the lower
 * one is i + d with d constant: a picture's springs need no memory of their own, only runs, one for
 * every stretch of masses that lies beside another. The order of runs is the order of summation. */
#include "plan/mesh.h"

#include <math.h>
#include <stdlib.h>

/* ---- Runs */

static bool goes_on(const msr_run_of_springs *run, const msr_run_of_springs *next) {
  return run->first + run->count == next->first && run->offset == next->offset &&
         run->stride == 0 && next->stride == 0 && run->k == next->k && run->L == next->L;
}

msr_status msri_mesh_add_run(msri_mesh *mesh, msr_run_of_springs run, msr_error *err) {
  msr_springs *springs = &mesh->springs;
  msr_run_of_springs *last = springs->n_runs > 0 ? &mesh->run[springs->n_runs - 1] : NULL;
  springs->n += run.count;
  if (last && goes_on(last, &run)) {
    last->count += run.count;
    return MSR_OK;
  }
  msr_run_of_springs *grown =
      msri_grow(mesh->run, &mesh->run_capacity, springs->n_runs + 1, sizeof *grown, "springs", err);
  if (!grown) return MSR_ENOMEM;
  mesh->run = grown;
  grown[springs->n_runs++] = run;
  return MSR_OK;
}

static msr_status add_anchor(msri_mesh *mesh, const msr_anchor *anchor, msr_error *err) {
  msr_anchor *grown = msri_grow(mesh->anchor, &mesh->anchor_capacity, mesh->springs.n_anchors + 1,
                                sizeof *grown, "anchors", err);
  if (!grown) return MSR_ENOMEM;
  mesh->anchor = grown;
  grown[mesh->springs.n_anchors++] = *anchor;
  return MSR_OK;
}

/* ---- The picture's springs */

/* Masses beside each other in a row. */
typedef struct block {
  size_t begin, end; /* columns */
  size_t first;      /* number of the one at `begin` */
} block;

typedef struct row {
  size_t n;
  block *block; /* [(width + 1) / 2] */
} row;

static void read_row(const msri_grid *grid, size_t at, row *r) {
  size_t first = grid->before[at];
  r->n = 0;
  for (msri_span s = {0, 0}; msri_span_of(grid->picture, at, MSRI_MASS, &s);) {
    r->block[r->n++] = (block){s.begin, s.end, first};
    first += s.end - s.begin;
  }
}

/* Springs from the masses of a block to those of another, `right` - 1 columns further. */
static msr_status tie_blocks(msri_mesh *mesh, const block *from, const block *to, size_t right,
                             msr_error *err) {
  const double *L = &mesh->lattice_L[right != 1];
  const size_t above = from->begin + right, below = to->begin + 1;
  const size_t begin = above > below ? above : below;
  const size_t end = from->end + right < to->end + 1 ? from->end + right : to->end + 1;
  if (begin >= end) return MSR_OK;
  const size_t i = from->first + (begin - above), j = to->first + (begin - below);
  const msr_run_of_springs run = {i, end - begin, j - i, &mesh->lattice_k, L, 0};
  return msri_mesh_add_run(mesh, run, err);
}

/* Springs from each mass of a row to the one `right` - 1 columns further in the next row. */
static msr_status tie_rows(msri_mesh *mesh, const row *from, const row *to, size_t right,
                           msr_error *err) {
  msr_status status = MSR_OK;
  for (size_t f = 0, t = 0; f < from->n && t < to->n && status == MSR_OK;) {
    const bool ends_first = from->block[f].end + right < to->block[t].end + 1;
    status = tie_blocks(mesh, &from->block[f], &to->block[t], right, err);
    *(ends_first ? &f : &t) += 1;
  }
  return status;
}

/* Springs from each mass of a row to its right neighbour. */
static msr_status tie_along(msri_mesh *mesh, const row *r, msr_error *err) {
  msr_status status = MSR_OK;
  for (size_t n = 0; n < r->n && status == MSR_OK; n++) {
    const block *b = &r->block[n];
    const size_t springs = b->end - b->begin - 1;
    const msr_run_of_springs run = {b->first, springs, 1, &mesh->lattice_k, mesh->lattice_L, 0};
    if (springs > 0) status = msri_mesh_add_run(mesh, run, err);
  }
  return status;
}

/* All springs between a row and the next one, `below`, then those along the latter. */
static msr_status tie_row(msri_mesh *mesh, bool diagonals, const row *above, const row *below,
                          msr_error *err) {
  msr_status status = tie_rows(mesh, above, below, 1, err);
  if (status == MSR_OK && diagonals) status = tie_rows(mesh, above, below, 0, err);
  if (status == MSR_OK && diagonals) status = tie_rows(mesh, above, below, 2, err);
  if (status == MSR_OK) status = tie_along(mesh, below, err);
  return status;
}

/* Anchors from a mass to the supports around its pixel. */
static msr_status attach_mass(msri_mesh *mesh, const msr_scene *scene, size_t mass, size_t column,
                              size_t at, msr_error *err) {
  static const int around[8][2] = {{1, 0}, {-1, 0}, {0, 1},  {0, -1},
                                   {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
  const msr_picture *p = scene->picture;
  msr_status status = MSR_OK;
  for (int n = 0; n < scene->options.neighbours && status == MSR_OK; n++) {
    const size_t nc = column + (size_t)around[n][0], nr = at + (size_t)around[n][1];
    if (nc >= p->width || nr >= p->height || msri_pixel_at(p, nc, nr) != MSRI_SUPPORT) continue;
    const double x = (double)nc + 0.5, y = (double)(p->height - nr) - 0.5;
    const msr_anchor anchor = {mass, x, y, mesh->lattice_k, mesh->lattice_L[n >= 4]};
    status = add_anchor(mesh, &anchor, err);
  }
  return status;
}

/* Is there a support in the row, or in one beside it? */
static bool near_supports(const msr_picture *picture, size_t at) {
  for (size_t r = at > 0 ? at - 1 : 0; r < picture->height && r <= at + 1; r++)
    if (msri_span_of(picture, r, MSRI_SUPPORT, &(msri_span){0, 0})) return true;
  return false;
}

static msr_status attach_row(msri_mesh *mesh, const msr_scene *scene, size_t at, const row *r,
                             msr_error *err) {
  msr_status status = MSR_OK;
  if (!scene->options.attach || !near_supports(scene->picture, at)) return MSR_OK;
  for (const block *b = r->block; b < r->block + r->n; b++)
    for (size_t c = b->begin; c < b->end && status == MSR_OK; c++)
      status = attach_mass(mesh, scene, b->first + (c - b->begin), c, at, err);
  return status;
}

static msr_status tie_picture(msri_mesh *mesh, const msr_scene *scene, msr_error *err) {
  const size_t most = (scene->picture->width + 1) / 2;
  block *blocks = msri_alloc(2 * most, sizeof *blocks, "the springs", err);
  if (!blocks) return MSR_ENOMEM;
  row rows[2] = {{0, blocks}, {0, blocks + most}};
  msr_status status = MSR_OK;
  for (size_t at = 0; at < scene->picture->height && status == MSR_OK; at++) {
    const row *above = &rows[(at + 1) % 2];
    row *below = &rows[at % 2];
    read_row(scene->grid, at, below);
    status = tie_row(mesh, msri_has_diagonals(scene->options.neighbours), above, below, err);
    if (status == MSR_OK) status = attach_row(mesh, scene, at, below, err);
  }
  free(blocks);
  return status;
}

/* ---- All of them */

/* Gives back what memory of n elements holds beyond them. NULL: it couldn't. */
static void *trim(void *old, size_t *capacity, size_t n, size_t size, msr_error *err) {
  if (n == *capacity || n == 0) return old;
  void *trimmed = realloc(old, n * size);
  if (trimmed)
    *capacity = n;
  else
    msri_fail(err, MSR_ENOMEM, "out of memory for springs (%zu x %zu bytes)", n, size);
  return trimmed;
}

/* The runs and anchors of a mesh that is whole. */
static msr_status settle(msri_mesh *mesh, msr_error *err) {
  msr_springs *s = &mesh->springs;
  msr_run_of_springs *run = trim(mesh->run, &mesh->run_capacity, s->n_runs, sizeof *run, err);
  if (s->n_runs > 0 && !run) return MSR_ENOMEM;
  s->run = mesh->run = run;
  s->anchor = mesh->anchor;
  return MSR_OK;
}

msr_status msri_mesh_create(const msr_scene *scene, msri_mesh *mesh, msr_error *err) {
  *mesh = (msri_mesh){.lattice_k = scene->conf.stiffness, .lattice_L = {1, sqrt(2)}};
  msr_status status = scene->picture ? tie_picture(mesh, scene, err) : MSR_OK;
  if (status == MSR_OK) status = msri_mesh_tie_added(mesh, scene, err);
  for (size_t a = 0; a < scene->n_anchors && status == MSR_OK; a++)
    status = add_anchor(mesh, &scene->anchor[a], err);
  if (status == MSR_OK) status = settle(mesh, err);
  if (status != MSR_OK) msri_mesh_clear(mesh);
  return status;
}

void msri_mesh_clear(msri_mesh *mesh) {
  free(mesh->run);
  free(mesh->anchor);
  free(mesh->values);
  *mesh = (msri_mesh){0};
}

size_t msri_mesh_bytes(const msri_mesh *mesh) {
  return mesh->run_capacity * sizeof *mesh->run + mesh->anchor_capacity * sizeof *mesh->anchor +
         2 * mesh->n_values * sizeof *mesh->values;
}
