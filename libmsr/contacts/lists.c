/* lists.c - lists of the pairs of each body, with a skin (Verlet 1967, Phys. Rev. 159, 98), kept in
 * a pool; see lists.h. */
#include "contacts/lists.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* ---- Memory */

msri_lists msri_lists_place(const msri_bodies *bodies, double diameter, const msri_ties *ties,
                            char *block, size_t *end) {
  const size_t n = bodies->n_masses;
  msri_lists w = {.bodies = bodies, .diameter = diameter};
  w.near = msri_near_place(n, diameter, ties, block, end);
  w.kept = msri_near_part(block, end, sizeof *w.kept);
  w.body = msri_near_part(block, end, bodies->n * sizeof *w.body);
  w.box = msri_near_part(block, end, bodies->n * sizeof *w.box);
  w.rank = msri_near_part(block, end, bodies->n * sizeof *w.rank);
  w.at = msri_near_part(block, end, 2 * n * sizeof *w.at);
  w.pool = msri_near_part(block, end, w.near.capacity * sizeof *w.pool);
  w.chosen = msri_near_part(block, end, w.near.capacity * sizeof *w.chosen);
  return w;
}

/* ---- The pool */

static void keep(msri_lists *w, msri_range *range, size_t *used) {
  const size_t n = range->end - range->begin;
  if (n > 0) memcpy(w->chosen + *used, w->pool + range->begin, n * sizeof *w->pool);
  *range = (msri_range){*used, *used + n};
  *used += n;
}

/* Closes the gaps that lists have left which are no longer good. */
static void close_gaps(msri_lists *w) {
  size_t used = 0;
  for (size_t b = 0; b < w->bodies->n; b++) keep(w, &w->body[b].pairs, &used);
  keep(w, &w->kept->outer, &used);
  if (used > 0) memcpy(w->pool, w->chosen, used * sizeof *w->pool);
  w->kept->used = used;
}

bool msri_lists_store(msri_lists *w, msri_range *range) {
  const size_t found = w->near.found;
  if (w->kept->used + found > w->near.capacity) close_gaps(w);
  if (w->near.full || w->kept->used + found > w->near.capacity) return false;
  if (range->begin == range->end) range->begin = w->kept->used;
  if (found > 0) memcpy(w->pool + w->kept->used, w->near.pair, found * sizeof *w->pool);
  range->end = w->kept->used += found;
  return true;
}

/* ---- Pairs of one body */

/* Where form changes fast a larger skin holds longer, at the price of more pairs to look at. */
static double skin_for(const msri_lists *w, const msri_listed *body, double path) {
  const double most = msri_most_skin * w->diameter, least = msri_least_skin * w->diameter;
  const bool again =
      body->inner.skin > 0 && (double)(w->kept->drifts - body->listed) < msri_many_drifts;
  return msri_max(1.25 * path, again ? msri_min(2 * body->inner.skin, most) : least);
}

static void list_inner(msri_lists *w, size_t b, const double *q0, double skin) {
  msri_listed *const body = &w->body[b];
  const size_t members = msri_bodies_masses(w->bodies, b, w->near.set);
  msri_near_list_at(&w->near, q0, (w->diameter + 2 * skin) * msri_more, w->near.set, members);
  body->pairs = (msri_range){0, 0};
  body->inner = (msri_reach){msri_lists_store(w, &body->pairs), skin, 0};
  body->listed = w->kept->drifts;
  body->far = 0;
  for (size_t s = w->bodies->first[b]; s < w->bodies->first[b + 1]; s++) {
    const msri_stretch r = w->bodies->stretch[s];
    for (size_t d = 0; d <= w->near.n; d += w->near.n)
      for (size_t i = r.begin + d; i < r.end + d; i++) {
        w->at[i] = q0[i];
        body->far = msri_max(body->far, fabs(q0[i]));
      }
  }
}

/* How far its masses are from where they would be in the form that it had. */
static void look_again(msri_lists *w, size_t b, const double *q0) {
  msri_reach *const inner = &w->body[b].inner;
  if (inner->known) inner->used = msri_displacement_change(w->bodies, b, w->at, q0);
}

/* False: there's no room for the pairs. */
static bool cover_inner(msri_lists *w, size_t b, const double *q0, double path) {
  const msri_reach *inner = &w->body[b].inner;
  if (msri_reach_covers(inner, path)) return true;
  look_again(w, b, q0);
  if (!msri_reach_covers(inner, path)) list_inner(w, b, q0, skin_for(w, &w->body[b], path));
  return inner->known;
}

/* All lists go, for others to have room. */
static void forget(msri_lists *w) {
  for (size_t b = 0; b < w->bodies->n; b++) {
    w->body[b].inner.known = w->body[b].outer.known = false;
    w->body[b].pairs = (msri_range){0, 0};
  }
  w->kept->outer = (msri_range){0, 0}, w->kept->used = 0;
}

/* ---- A drift */

void msri_lists_set_paths(msri_lists *lists) {
  const size_t n = lists->bodies->n;
  double mean[2] = {0, 0}, sound = 0;
  for (size_t b = 0; b < n; b++) {
    const msri_displacement m = lists->body[b].displacement = msri_displacement_of(&lists->box[b]);
    if (m.spread < (double)INFINITY) mean[0] += m.path[0], mean[1] += m.path[1], sound++;
  }
  for (size_t b = 0; b < n; b++) {
    const msri_displacement m = lists->body[b].displacement;
    const double x = m.path[0] - mean[0] / sound, y = m.path[1] - mean[1] / sound;
    lists->body[b].away = n > 1 ? sqrt(x * x + y * y) * msri_more + m.spread : 0;
  }
}

void msri_lists_begin(msri_lists *lists, const double *q0, const double *q) {
  const bool moved = !q || lists->kept->q != q;
  msri_lists_set_paths(lists);
  for (size_t b = 0; b < lists->bodies->n; b++) {
    lists->body[b].hot = false;
    if (!moved) continue;
    lists->body[b].outer.known = false;
    look_again(lists, b, q0);
  }
}

static bool cover_paths(msri_lists *w, const double *q0) {
  bool room = true;
  for (size_t b = 0; b < w->bodies->n; b++) {
    const double spread = w->body[b].displacement.spread;
    const bool slow = spread <= msri_most_skin * w->diameter;
    w->body[b].swift = !slow || !cover_inner(w, b, q0, spread);
    room &= !slow || !w->body[b].swift;
  }
  return msri_lists_cover_outer(w, q0, 0) && room;
}

void msri_lists_cover_paths(msri_lists *lists, const double *q0) {
  if (cover_paths(lists, q0)) return;
  forget(lists);
  cover_paths(lists, q0);
}

/* So are swift ones: for all that is known. */
static void warm_clusters(msri_lists *w) {
  for (size_t b = 0; b < w->bodies->n; b++)
    if (w->body[b].hot || w->body[b].swift) w->body[w->body[b].cluster].hot = true;
  for (size_t b = 0; b < w->bodies->n; b++) w->body[b].hot = w->body[w->body[b].cluster].hot;
}

bool msri_lists_cover_pushes(msri_lists *w, const double *q0, double most) {
  bool room = msri_lists_cover_outer(w, q0, most);
  warm_clusters(w);
  for (size_t b = 0; b < w->bodies->n; b++)
    room &= !w->body[b].swift && (!w->body[b].hot || cover_inner(w, b, q0, most));
  if (room) return true;
  forget(w);
  room = msri_lists_cover_outer(w, q0, most);
  warm_clusters(w);
  for (size_t b = 0; b < w->bodies->n && room; b++)
    if (w->body[b].hot) list_inner(w, b, q0, most), room = w->body[b].inner.known;
  return room;
}

bool msri_lists_is_idle(const msri_lists *w, const double *q) {
  bool idle = w->kept->q == q && w->kept->outer.begin == w->kept->outer.end;
  for (size_t b = 0; b < w->bodies->n && idle; b++) {
    const msri_listed *body = &w->body[b];
    idle = body->inner.known && body->pairs.begin == body->pairs.end && !body->swift &&
           (body->outer.known || w->bodies->n == 1);
  }
  return idle;
}

/* Places are rounded, and paths with them. */
static double rounding_of(const msri_listed *body) {
  return 8 * DBL_EPSILON *
         (body->far + fabs(body->displacement.path[0]) + fabs(body->displacement.path[1]));
}

bool msri_lists_foresees(msri_lists *w, double h) {
  const size_t n = w->bodies->n;
  bool good = true;
  for (size_t b = 0; b < n; b++)
    for (int d = 0; d < 2; d++) {
      const double one = h * w->box[b].low[d], other = h * w->box[b].high[d];
      w->box[b].low[d] = msri_min(one, other), w->box[b].high[d] = msri_max(one, other);
    }
  msri_lists_set_paths(w);
  for (size_t b = 0; b < n && good; b++) {
    msri_listed *const body = &w->body[b];
    const double rounding = rounding_of(body);
    body->displacement.spread += rounding, body->away += rounding;
    good = msri_reach_covers(&body->inner, body->displacement.spread) &&
           (n == 1 || msri_reach_covers(&body->outer, body->away));
  }
  return good;
}

void msri_lists_end(msri_lists *lists, const double *q) {
  for (size_t b = 0; b < lists->bodies->n; b++) {
    lists->body[b].inner.used += lists->body[b].displacement.spread;
    lists->body[b].outer.used += lists->body[b].away;
    lists->body[b].far += fabs(lists->body[b].displacement.path[0]) +
                          fabs(lists->body[b].displacement.path[1]) +
                          lists->body[b].displacement.spread;
  }
  lists->kept->drifts++;
  lists->kept->q = q;
}
