/* across.c - pairs of two bodies: where boxes meet, from left to right (Baraff 1992, Dynamic
 * simulation of non-penetrating rigid bodies: sort and sweep), the masses that are in both. */
#include "contacts/cells.h"
#include "contacts/lists.h"

#include <math.h>

/* ---- Skins: for many drifts; for few */

/* Where boxes are apart lists are made for so many drifts. */
static const double many = 64;

/* Beyond this, in diameters, masses are better looked at on their paths. */
static const double longest_skin = 1.6;

static double loose(const msri_lists *w, double away) {
  return msri_max(msri_least_skin * w->diameter, many * away);
}

static double tight(const msri_lists *w, double away) {
  const double some = msri_many_drifts * away;
  return msri_max(1.25 * away, msri_min(msri_most_skin * w->diameter,
                                        msri_max(msri_least_skin * w->diameter, some)));
}

/* How near two masses of these bodies are that belong in the list. */
static double reach_of(const msri_lists *w, size_t a, size_t b) {
  return (w->diameter + w->body[a].outer.skin + w->body[b].outer.skin) * msri_more;
}

/* ---- From left to right */

static double left(const msri_lists *w, size_t b) {
  const double at = w->box[b].low[0] - w->body[b].outer.skin;
  return at - 1e-15 * fabs(at);
}

static double right(const msri_lists *w, size_t b) {
  const double at = w->box[b].high[0] + (w->body[b].outer.skin + w->diameter) * msri_more;
  return at + 1e-15 * fabs(at);
}

/* In the order that they had they are nearly sorted (Shell 1959, Comm. ACM 2, 30). */
static void sort_bodies(msri_lists *w) {
  const size_t n = w->bodies->n;
  size_t *const rank = w->rank;
  if (rank[0] == rank[n - 1])
    for (size_t b = 0; b < n; b++) rank[b] = b;
  for (size_t gap = n / 2; gap > 0; gap /= 2)
    for (size_t k = gap; k < n; k++) {
      const size_t moved = rank[k];
      size_t to = k;
      for (; to >= gap && left(w, moved) < left(w, rank[to - gap]); to -= gap)
        rank[to] = rank[to - gap];
      rank[to] = moved;
    }
}

static bool boxes_meet(const msri_lists *w, size_t a, size_t b) {
  const msri_box *p = &w->box[a], *q = &w->box[b];
  const double reach = reach_of(w, a, b);
  return !(p->low[0] - q->high[0] > reach || q->low[0] - p->high[0] > reach ||
           p->low[1] - q->high[1] > reach || q->low[1] - p->high[1] > reach);
}

typedef bool meeting(msri_lists *w, const double *q0, size_t a, size_t b);

/* Was there room for all? */
static bool sweep(msri_lists *w, const double *q0, meeting *act) {
  const size_t n = w->bodies->n;
  bool room = true;
  sort_bodies(w);
  for (size_t k = 0; k < n; k++) {
    const double end = right(w, w->rank[k]);
    for (size_t l = k + 1; l < n && !(left(w, w->rank[l]) > end); l++)
      if (boxes_meet(w, w->rank[k], w->rank[l])) room &= act(w, q0, w->rank[k], w->rank[l]);
  }
  return room;
}

/* ---- Two bodies whose boxes meet */

static bool tighten(msri_lists *w, const double *q0, size_t a, size_t b) {
  (void)q0;
  w->body[a].outer.known = w->body[b].outer.known = false;
  return true;
}

static size_t cluster_of(const msri_lists *w, size_t b) {
  while (w->body[b].cluster != b) b = w->body[b].cluster;
  return b;
}

/* Masses of a that are within reach of the box of b, to set. */
static size_t choose(const msri_lists *w, const double *q0, size_t a, size_t b, uint32_t *set) {
  const double *x = q0, *y = q0 + w->near.n, reach = reach_of(w, a, b);
  const msri_box *box = &w->box[b];
  size_t members = 0;
  for (size_t s = w->bodies->first[a]; s < w->bodies->first[a + 1]; s++)
    for (size_t i = w->bodies->stretch[s].begin; i < w->bodies->stretch[s].end; i++) {
      set[members] = (uint32_t)i;
      members += x[i] - box->high[0] <= reach && box->low[0] - x[i] <= reach &&
                 y[i] - box->high[1] <= reach && box->low[1] - y[i] <= reach;
    }
  return members;
}

static bool are_swift(const msri_lists *w, size_t a, size_t b) {
  const double longest = longest_skin * w->diameter;
  return !(w->body[a].outer.skin <= longest && w->body[b].outer.skin <= longest);
}

static bool list_two(msri_lists *w, const double *q0, size_t a, size_t b) {
  uint32_t *const set = w->near.set;
  const bool swift = are_swift(w, a, b);
  bool listed = !swift;
  if (listed) {
    const size_t n_a = choose(w, q0, a, b, set);
    const size_t n_b = n_a > 0 ? choose(w, q0, b, a, set + n_a) : 0;
    if (n_b == 0) return true;
    msri_near_list_between(&w->near, q0, reach_of(w, a, b), set, n_a, set + n_a, n_b);
    listed = msri_lists_store(w, &w->kept->outer);
  }
  if (!listed) w->body[a].swift = w->body[b].swift = true;
  if (!listed || w->near.found > 0) w->body[cluster_of(w, a)].cluster = cluster_of(w, b);
  return swift || listed;
}

/* ---- The list */

/* First boxes are widened for many drifts; where then they meet, for few. */
static bool list_all(msri_lists *w, const double *q0, double most) {
  const size_t n = w->bodies->n;
  msri_displacement_measure(w->bodies, NULL, q0, w->box);
  w->kept->outer = (msri_range){0, 0};
  for (size_t b = 0; b < n; b++) {
    const double path = msri_max(w->body[b].away, most);
    w->body[b].outer = (msri_reach){true, msri_max(loose(w, path), tight(w, path)), 0};
    w->body[b].cluster = b;
  }
  sweep(w, q0, tighten);
  for (size_t b = 0; b < n; b++)
    if (!w->body[b].outer.known)
      w->body[b].outer = (msri_reach){true, tight(w, msri_max(w->body[b].away, most)), 0};
  const bool room = sweep(w, q0, list_two);
  for (size_t b = 0; b < n; b++) w->body[b].cluster = cluster_of(w, b);
  for (size_t b = 0; b < n; b++) w->body[b].outer.known = !w->body[b].swift;
  return room;
}

bool msri_lists_cover_outer(msri_lists *w, const double *q0, double most) {
  bool good = true;
  if (w->bodies->n == 1) return true;
  for (size_t b = 0; b < w->bodies->n; b++)
    good &= msri_reach_covers(&w->body[b].outer, msri_max(w->body[b].away, most));
  return good || list_all(w, q0, most);
}
