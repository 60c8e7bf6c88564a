/* encounters.c - of the pairs that are listed (lists.h), those that meet, that are close or that
 * overlap; and where lists are no good, those that meet on their paths (near_paths.c). */
#include "contacts/encounters.h"

/* ---- Does anything meet? */

static bool concerns(const msri_drift *d, const msri_pair *pair) {
  const msri_disc_pair p = msri_drift_pair(d, pair->i, pair->j);
  return p.from.x * p.from.x + p.from.y * p.from.y < d->diameter * d->diameter ||
         msri_disc_pair_meets(&p);
}

static bool meet_or_overlap(const void *self, const msri_paths *paths, size_t i, size_t j) {
  (void)paths;
  return concerns(self, &(msri_pair){(uint32_t)i, (uint32_t)j});
}

/* What is further away than the masses of a body go against each other isn't met. */
static double reach_in(const msri_encounters *c, size_t b) {
  return (c->d->diameter + 2 * c->lists->body[b].displacement.spread) * msri_more;
}

static bool any_inside(const msri_encounters *c, size_t b) {
  const msri_listed *body = &c->lists->body[b];
  const double reach = reach_in(c, b);
  for (size_t k = body->pairs.begin; k < body->pairs.end; k++) {
    const msri_pair *p = &c->lists->pool[k];
    if (msri_distance2(c->d, p->i, p->j) <= reach * reach && concerns(c->d, p)) return true;
  }
  return false;
}

static bool are_swift(const msri_lists *w, const msri_pair *p) {
  return w->body[w->bodies->of[p->i]].swift && w->body[w->bodies->of[p->j]].swift;
}

/* Pairs of bodies for which lists are no good, on their paths: to near.pair. */
static size_t list_swift(const msri_encounters *c,
                         bool (*meet)(const void *, const msri_paths *, size_t, size_t)) {
  msri_lists *w = c->lists;
  size_t members = 0;
  for (size_t b = 0; b < w->bodies->n; b++)
    if (w->body[b].swift) members += msri_bodies_masses(w->bodies, b, w->near.set + members);
  w->near.found = 0;
  if (members > 0)
    msri_near_list_paths(&w->near, &(msri_paths){c->d->q0, c->d->q}, msri_slow * c->d->diameter,
                         &(msri_meets){meet, c->d}, w->near.set, members);
  return w->near.found;
}

bool msri_encounters_are_hot(const msri_encounters *c) {
  msri_lists *w = c->lists;
  bool any = list_swift(c, meet_or_overlap) > 0;
  for (size_t b = 0; b < w->bodies->n; b++)
    if (!w->body[b].swift && any_inside(c, b)) any = w->body[b].hot = true;
  for (size_t k = w->kept->outer.begin; k < w->kept->outer.end; k++) {
    const msri_pair *p = &w->pool[k];
    if (are_swift(w, p) || !concerns(c->d, p)) continue;
    any = w->body[w->bodies->of[p->i]].hot = w->body[w->bodies->of[p->j]].hot = true;
  }
  return any;
}

/* ---- Lists */

static void append(msri_encounters *c, const msri_pair *p) {
  c->full |= c->n == c->lists->near.capacity;
  if (!c->full) c->pair[c->n++] = *p;
}

static void put_in_order(msri_encounters *c) {
  msri_near_order(c->pair, c->n, c->lists->near.pair);
}

static void append_close(msri_encounters *c, msri_range range) {
  const msri_lists *w = c->lists;
  const double reach = (c->d->diameter + 2 * c->d->most) * msri_more;
  for (size_t k = range.begin; k < range.end; k++) {
    const msri_pair *p = &w->pool[k];
    if (w->body[w->bodies->of[p->i]].hot && msri_distance2(c->d, p->i, p->j) <= reach * reach)
      append(c, p);
  }
}

bool msri_encounters_list_close(msri_encounters *c) {
  const msri_lists *w = c->lists;
  c->n = 0, c->full = !msri_lists_cover_pushes(c->lists, c->d->q0, c->d->most);
  if (c->full) return false;
  for (size_t b = 0; b < w->bodies->n; b++)
    if (w->body[b].hot) append_close(c, w->body[b].pairs);
  append_close(c, w->kept->outer);
  put_in_order(c);
  return !c->full;
}

static bool meet_on_paths(const void *self, const msri_paths *paths, size_t i, size_t j) {
  const msri_disc_pair p = msri_drift_pair(self, i, j);
  (void)paths;
  return msri_disc_pair_meets(&p);
}

/* Of those within reach. */
static void append_meeting(msri_encounters *c, msri_range range, double reach) {
  const msri_lists *w = c->lists;
  for (size_t k = range.begin; k < range.end; k++)
    if (msri_distance2(c->d, w->pool[k].i, w->pool[k].j) <= reach * reach &&
        !are_swift(w, &w->pool[k]) && msri_drift_meets(c->d, w->pool[k].i, w->pool[k].j))
      append(c, &w->pool[k]);
}

bool msri_encounters_list_meeting(msri_encounters *c) {
  msri_lists *w = c->lists;
  msri_displacement_measure(w->bodies, c->d->q0, c->d->q, w->box);
  msri_lists_set_paths(w);
  msri_lists_cover_paths(w, c->d->q0);
  c->n = 0, c->full = false;
  const size_t found = list_swift(c, meet_on_paths);
  for (size_t k = 0; k < found; k++) append(c, &w->near.pair[k]);
  for (size_t b = 0; b < w->bodies->n; b++) append_meeting(c, w->body[b].pairs, reach_in(c, b));
  append_meeting(c, w->kept->outer, (double)INFINITY);
  put_in_order(c);
  return c->n > 0;
}
