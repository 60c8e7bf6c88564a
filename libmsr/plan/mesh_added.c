/* mesh_added.c - the springs that a program added, as runs. They are sorted so that a lattice built
 * by hand makes long runs, too, a group of masses at a time to stay in cache. Stiffnesses and
 * lengths are kept only as far as they differ from those of the spring before. */
#include "plan/mesh.h"

#include <stdlib.h>

#define COMPARE(a, b)                                                                              \
  if ((a) != (b)) return (a) < (b) ? -1 : 1

static int by_offset_and_first(const void *a, const void *b) {
  const msri_scene_spring *p = a, *q = b;
  COMPARE(p->j - p->i, q->j - q->i);
  COMPARE(p->i, q->i);
  COMPARE(p->k, q->k);
  COMPARE(p->L, q->L);
  return 0;
}

/* The scene's springs group by group: a counting sort first, so that what remains is small. */
static msr_status sort(const msr_scene *scene, msri_scene_spring *sorted, msr_error *err) {
  const size_t groups = msr_scene_masses(scene) / MSRI_MESH_GROUP + 1;
  size_t *end = msri_alloc(groups + 1, sizeof *end, "the springs", err);
  if (!end) return MSR_ENOMEM;
  const msri_scene_spring *s = scene->spring, *const last = s + scene->n_springs;
  for (; s < last; s++) end[s->i / MSRI_MESH_GROUP + 1]++;
  for (size_t b = 0; b < groups; b++) end[b + 1] += end[b];
  for (s = scene->spring; s < last; s++) sorted[end[s->i / MSRI_MESH_GROUP]++] = *s;
  for (size_t b = 0, begin = 0; b < groups; begin = end[b++])
    qsort(sorted + begin, end[b] - begin, sizeof *sorted, by_offset_and_first);
  free(end);
  return MSR_OK;
}

/* Springs first .. end-1 of those that are sorted: a run. */
typedef struct stretch {
  size_t first, end;
  bool alike; /* in k and L */
  bool known; /* the values of the first are those of the spring before */
} stretch;

static bool same(const msri_scene_spring *a, const msri_scene_spring *b) {
  return a->k == b->k && a->L == b->L;
}

static bool follows(const msri_scene_spring *a, const msri_scene_spring *b) {
  return b->i == a->i + 1 && b->j == a->j + 1;
}

/* The run that begins at `first`. */
static stretch stretch_from(const msri_scene_spring *s, size_t n, size_t first) {
  stretch run = {first, first + 1, true, first > 0 && same(&s[first - 1], &s[first])};
  for (; run.end < n && follows(&s[run.end - 1], &s[run.end]); run.end++)
    run.alike = run.alike && same(&s[first], &s[run.end]);
  return run;
}

static size_t values_of(const stretch *run) {
  if (run->alike) return run->known ? 0 : 1;
  return run->end - run->first;
}

/* Room for the values of all runs. */
static msr_status allot(msri_mesh *mesh, const msri_scene_spring *s, size_t n, msr_error *err) {
  for (stretch run = {0}; run.end < n;) {
    run = stretch_from(s, n, run.end);
    mesh->n_values += values_of(&run);
  }
  mesh->values = msri_alloc(2 * mesh->n_values, sizeof *mesh->values, "the springs", err);
  return mesh->values ? MSR_OK : MSR_ENOMEM;
}

/* Appends the runs, with their values. */
static msr_status tie(msri_mesh *mesh, const msri_scene_spring *s, size_t n, msr_error *err) {
  double *k = mesh->values, *L = mesh->values + mesh->n_values;
  msr_status status = MSR_OK;
  for (stretch run = {0}; run.end < n && status == MSR_OK;) {
    run = stretch_from(s, n, run.end);
    const size_t count = run.end - run.first, new = values_of(&run);
    for (size_t c = 0; c < new; c++) *k++ = s[run.first + c].k, *L++ = s[run.first + c].L;
    const double *const of_first = k - (new > 0 ? new : 1);
    const msr_run_of_springs added = {s[run.first].i,
                                      count,
                                      s[run.first].j - s[run.first].i,
                                      of_first,
                                      of_first + mesh->n_values,
                                      run.alike ? 0 : 1};
    status = msri_mesh_add_run(mesh, added, err);
  }
  return status;
}

msr_status msri_mesh_tie_added(msri_mesh *mesh, const msr_scene *scene, msr_error *err) {
  const size_t n = mesh->n_added = scene->n_springs;
  if (n == 0) return MSR_OK;
  msri_scene_spring *sorted = msri_alloc(n, sizeof *sorted, "the springs", err);
  if (!sorted) return MSR_ENOMEM;
  msr_status status = sort(scene, sorted, err);
  if (status == MSR_OK) status = allot(mesh, sorted, n, err);
  if (status == MSR_OK) status = tie(mesh, sorted, n, err);
  free(sorted);
  return status;
}
