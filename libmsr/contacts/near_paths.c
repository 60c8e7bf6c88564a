/* near_paths.c - pairs that meet on paths of any length.
 *
 * Fast paths are sorted into frames: those whose path is near that of one of them are at rest
 * beside it, and are neighbours by the grid; the paths of the others are walked through that grid;
 * then these others are looked at among themselves, in a frame that takes in twice as much. A body
 * that flies is so seen at rest. */
#include "contacts/cells.h"

#include <string.h>

/* ---- Frames */

/* Masses whose path is within `radius` of (x, y). */
typedef struct frame {
  double x, y, radius;
  double low[2], high[2]; /* where they are, widened by the reach of a walk */
} frame;

static bool rests_in(const frame *f, const msri_paths *w, size_t n, size_t i) {
  const double x = w->q[i] - w->q0[i] - f->x, y = w->q[n + i] - w->q0[n + i] - f->y;
  return msri_squared(x, y) <= f->radius * f->radius;
}

/* Puts those that rest in the frame first, in order. Returns their number. */
static size_t divide(msri_near *near, frame *f, const msri_paths *w, uint32_t *set, size_t members,
                     double reach) {
  size_t rest = 0, others = 0;
  for (int d = 0; d < 2; d++) f->low[d] = (double)INFINITY, f->high[d] = -(double)INFINITY;
  for (size_t k = 0; k < members; k++) {
    const size_t i = set[k];
    if (!rests_in(f, w, near->n, i)) {
      near->sorted[others++] = (uint32_t)i;
      continue;
    }
    set[rest++] = (uint32_t)i;
    for (int d = 0; d < 2; d++) {
      const double at = w->q0[i + (size_t)d * near->n];
      f->low[d] = msri_min(f->low[d], at - reach), f->high[d] = msri_max(f->high[d], at + reach);
    }
  }
  if (others > 0) memcpy(set + rest, near->sorted, others * sizeof *set);
  return rest;
}

/* A path through a frame: p + t u, t from `begin` to `end`, looked at in equal steps. */
typedef struct walk {
  size_t i;
  double p[2], u[2], begin, end, steps;
} walk;

/* Clips the path to where the masses of the frame are; false: it doesn't go there. */
static bool clip(walk *w, const frame *f) {
  for (int d = 0; d < 2; d++) {
    if (w->u[d] == 0) {
      if (w->p[d] < f->low[d] || w->p[d] > f->high[d]) return false;
      continue;
    }
    const double a = (f->low[d] - w->p[d]) / w->u[d], b = (f->high[d] - w->p[d]) / w->u[d];
    w->begin = msri_max(w->begin, msri_min(a, b));
    w->end = msri_min(w->end, msri_max(a, b));
  }
  return w->begin <= w->end;
}

/* Where the path comes closest to a point, as a share of the path. */
static double closest(const walk *w, double x, double y) {
  const double t =
      ((x - w->p[0]) * w->u[0] + (y - w->p[1]) * w->u[1]) / msri_squared(w->u[0], w->u[1]);
  return msri_min(msri_max(t, w->begin), w->end);
}

/* Which of the walk's steps is nearest. */
static double step_at(const walk *w, double t) {
  return w->steps > 0 ? floor((t - w->begin) / (w->end - w->begin) * w->steps + 0.5) : 0;
}

static void meet_on_path(msri_near *near, const msri_search *s, const walk *w, size_t j,
                         double step) {
  const double x = s->q0[j], y = s->q0[near->n + j], t = closest(w, x, y);
  if (step >= 0 && step_at(w, t) != step) return; // another step sees to it
  const double dx = w->p[0] + t * w->u[0] - x, dy = w->p[1] + t * w->u[1] - y;
  if (!(msri_squared(dx, dy) <= s->reach * s->reach)) return;
  const size_t i = w->i;
  if (i < j ? msri_search_wants(s, i, j) : msri_search_wants(s, j, i))
    msri_cells_append(near, i, j);
}

static void meet_among(msri_near *near, const msri_search *s, const walk *w, double step,
                       uint32_t begin, uint32_t end) {
  for (uint32_t k = begin; k < end; k++) meet_on_path(near, s, w, near->sorted[k], step);
}

/* The nine cells around a step of the walk. */
static void look_from(msri_near *near, const msri_search *s, const walk *w, double step) {
  const double t = w->steps > 0 ? w->begin + (w->end - w->begin) * (step / w->steps) : w->begin;
  const double at[] = {w->p[0] + t * w->u[0], w->p[1] + t * w->u[1]};
  const msri_cell c = msri_cell_at(at, 1, 0, s->size);
  for (int64_t cy = c.y - 1; cy <= c.y + 1; cy++) {
    const msri_cell first = {c.x - 1, cy};
    const msri_three t3 = msri_cells_three(near, first);
    meet_among(near, s, w, step, t3.begin, t3.end);
    meet_among(near, s, w, step, t3.begin_again, t3.end_again);
  }
}

/* Appends the pairs of a mass that passes through a frame; where its path has more cells than the
 * frame has masses, `rest` of them, it looks at each of these. */
static void walk_through(msri_near *near, const msri_search *s, const frame *f, size_t i,
                         const uint32_t *set, size_t rest) {
  const size_t n = near->n;
  const double *q0 = s->paths->q0, *q = s->paths->q;
  walk w = {.i = i, .p = {q0[i], q0[n + i]}, .end = 1};
  w.u[0] = q[i] - q0[i] - f->x, w.u[1] = q[n + i] - q0[n + i] - f->y;
  if (!clip(&w, f)) return;
  const double length = (w.end - w.begin) * msri_max(fabs(w.u[0]), fabs(w.u[1]));
  w.steps = ceil(length / s->size);
  if (!(w.steps < (double)rest)) {
    for (size_t k = 0; k < rest; k++) meet_on_path(near, s, &w, set[k], -1);
    return;
  }
  const size_t steps = (size_t)w.steps;
  for (size_t k = 0; k <= steps && !near->full; k++) look_from(near, s, &w, (double)k);
}

/* Looks at those that rest in a frame among themselves, and at all others on their way through it.
 * Returns how many rest. */
static size_t look_in(msri_near *near, frame *f, const msri_paths *paths, const msri_meets *meets,
                      uint32_t *set, size_t members) {
  const double reach = near->diameter + f->radius;
  const size_t rest = divide(near, f, paths, set, members, reach);
  const msri_search still = {.q0 = paths->q0,
                             .size = 2 * reach,
                             .reach = near->diameter + 2 * f->radius,
                             .paths = paths,
                             .meets = meets};
  const msri_search passing = {
      .q0 = paths->q0, .size = 2 * reach, .reach = reach, .paths = paths, .meets = meets};
  msri_cells_sort(near, paths->q0, still.size, set, rest);
  for (size_t k = 0; k < rest; k++) msri_cells_look_around(near, &still, set[k]);
  for (size_t k = rest; k < members; k++) walk_through(near, &passing, f, set[k], set, rest);
  return rest;
}

/* ---- The search */

static bool is_finite(const msri_paths *w, size_t n, size_t i) {
  return isfinite(w->q[i] - w->q0[i]) && isfinite(w->q[n + i] - w->q0[n + i]);
}

void msri_near_list_paths(msri_near *near, const msri_paths *paths, double slow,
                          const msri_meets *meets, uint32_t *set, size_t members) {
  size_t left = 0;
  for (size_t k = 0; k < members; k++)
    if (is_finite(paths, near->n, set[k])) set[left++] = set[k];
  near->found = 0, near->full = false;
  frame f = {.radius = slow};
  while (left > 0) {
    const size_t rest = look_in(near, &f, paths, meets, set, left);
    set += rest, left -= rest;
    if (left == 0) break;
    const size_t i = set[left / 2];
    f.x = paths->q[i] - paths->q0[i], f.y = paths->q[near->n + i] - paths->q0[near->n + i];
    f.radius *= 2;
  }
}
