/* collide.c - the pairs that are put right, and how often.
 *
 * Each pair whose straight ways meet is put right, one after the other in the order of their
 * numbers, a few times over; who still meets another goes the same way as that other (zones.c). As
 * the old places were free, that ends, and no disc is ever inside or beyond another, at any speed.
 *
 * Which pairs are looked at depends on the past; what becomes of them doesn't, and those that are
 * left out don't meet. */
#include "contacts/collide.h"

#include "contacts/zones.h"

#include <string.h>

enum { MOST_PASSES = 12, REST_PASSES = 6, MOST_LISTS = 6, MOST_JOINS = 64 };

/* Discs that overlap part at so many diameters a second, by no more than a share of one in a step.
 */
static const double parting_speed = 10, most_parting = 0.02;

/* Longer ways than this, in diameters, have lists of their own. */
static const double slow = 0.3;

/* A drift, and which pairs may meet. */
typedef struct course {
  msri_drift *d;
  msri_lists *lists;
  msri_pair *pair; /* those that are close, or that meet */
  size_t n;
  bool full; /* there are more */
} course;

/* ---- Does anything meet? */

/* Or overlap? */
static bool concerns(const msri_drift *d, const msri_pair *pair) {
  const msri_disc_pair p = msri_drift_pair(d, pair->i, pair->j);
  return p.from.x * p.from.x + p.from.y * p.from.y < d->diameter * d->diameter ||
         msri_disc_pair_meets(&p);
}

static bool meet_or_overlap(const void *self, const msri_ways *ways, size_t i, size_t j) {
  (void)ways;
  return concerns(self, &(msri_pair){(uint32_t)i, (uint32_t)j});
}

static double distance2(const msri_drift *d, const msri_pair *p) {
  const double *x = d->q0, *y = x + d->n, rx = x[p->j] - x[p->i], ry = y[p->j] - y[p->i];
  return rx * rx + ry * ry;
}

/* What is further away than the masses of a body go against each other isn't met. */
static double reach_in(const course *c, size_t b) {
  return (c->d->diameter + 2 * c->lists->body[b].motion.spread) * msri_more;
}

static bool any_inside(const course *c, size_t b) {
  const msri_listed *body = &c->lists->body[b];
  const double reach = reach_in(c, b);
  for (size_t k = body->pairs.begin; k < body->pairs.end; k++) {
    const msri_pair *p = &c->lists->pool[k];
    if (distance2(c->d, p) <= reach * reach && concerns(c->d, p)) return true;
  }
  return false;
}

static bool are_swift(const msri_lists *w, const msri_pair *p) {
  return w->body[w->bodies->of[p->i]].swift && w->body[w->bodies->of[p->j]].swift;
}

/* Pairs of bodies for which lists are no good, on their ways: to near.pair. */
static size_t list_swift(const course *c,
                         bool (*meet)(const void *, const msri_ways *, size_t, size_t)) {
  msri_lists *w = c->lists;
  size_t members = 0;
  for (size_t b = 0; b < w->bodies->n; b++)
    if (w->body[b].swift) members += msri_bodies_masses(w->bodies, b, w->near.set + members);
  w->near.found = 0;
  if (members > 0)
    msri_near_list_ways(&w->near, &(msri_ways){c->d->q0, c->d->q}, slow * c->d->diameter,
                        &(msri_meets){meet, c->d}, w->near.set, members);
  return w->near.found;
}

/* Bodies of which masses meet or overlap become hot. */
static bool find_hot(const course *c) {
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

/* ---- All pairs of a list */

typedef bool pair_act(msri_drift *d, size_t i, size_t j);

static bool for_each(const course *c, pair_act *act) {
  bool any = false;
  for (size_t k = 0; k < c->n; k++) any |= act(c->d, c->pair[k].i, c->pair[k].j);
  return any;
}

static bool is_any(const course *c, pair_act *act) {
  for (size_t k = 0; k < c->n; k++)
    if (act(c->d, c->pair[k].i, c->pair[k].j)) return true;
  return false;
}

static bool meets(msri_drift *d, size_t i, size_t j) {
  const msri_disc_pair p = msri_drift_pair(d, i, j);
  return msri_disc_pair_meets(&p);
}

/* Did they overlap by more than rounding? */
static bool overlapped(msri_drift *d, size_t i, size_t j) {
  const double least2 = d->diameter * d->diameter * (1 - msri_disc_rounding / 2);
  return distance2(d, &(msri_pair){(uint32_t)i, (uint32_t)j}) < least2;
}

/* A few passes; was the last one idle? */
static bool put_right(const course *c) {
  memset(c->d->pass, 0, c->d->n * sizeof *c->d->pass);
  for (c->d->passes = 1; c->d->passes <= MOST_PASSES; c->d->passes++) {
    c->d->since = c->d->passes - 1;
    if (!for_each(c, msri_drift_collide)) return true;
  }
  return false;
}

static void append(course *c, const msri_pair *p) {
  c->full |= c->n == c->lists->near.capacity;
  if (!c->full) c->pair[c->n++] = *p;
}

static void put_in_order(course *c) { msri_near_order(c->pair, c->n, c->lists->near.pair); }

/* ---- Slow ways: one list, of all that may be pushed together */

static void append_close(course *c, msri_range range) {
  const msri_lists *w = c->lists;
  const double reach = (c->d->diameter + 2 * c->d->most) * msri_more;
  for (size_t k = range.begin; k < range.end; k++) {
    const msri_pair *p = &w->pool[k];
    if (w->body[w->bodies->of[p->i]].hot && distance2(c->d, p) <= reach * reach) append(c, p);
  }
}

/* Pairs that are close enough for this step, of bodies that may be pushed; false: they are too
 * many. */
static bool list_close(course *c) {
  const msri_lists *w = c->lists;
  c->n = 0, c->full = !msri_lists_cover_pushes(c->lists, c->d->q0, c->d->most);
  if (c->full) return false;
  for (size_t b = 0; b < w->bodies->n; b++)
    if (w->body[b].hot) append_close(c, w->body[b].pairs);
  append_close(c, w->kept->outer);
  put_in_order(c);
  return !c->full;
}

/* Zones grow by every pair that meets; if there is no end to it, all are one. */
static void join(const course *c) {
  msri_zones_part(c->d);
  for (int joins = 0; joins < MOST_JOINS; joins++) {
    c->d->since = joins > 0 ? c->d->passes++ : 0;
    if (!for_each(c, msri_zones_join)) return;
  }
  msri_zones_join_all(c->d);
}

static void resolve_slowly(const course *c) {
  msri_drift *d = c->d;
  if (!is_any(c, d->parts ? overlapped : meets)) return;
  if (!put_right(c)) {
    d->apart = 0;
    join(c);
  }
  for (int k = 0; d->rests && !d->parts && k < REST_PASSES; k++)
    if (!for_each(c, msri_drift_rest)) break;
}

/* ---- Fast ways: lists of the pairs that meet, until there are none */

static bool meet_on_ways(const void *self, const msri_ways *ways, size_t i, size_t j) {
  const msri_disc_pair p = msri_drift_pair(self, i, j);
  (void)ways;
  return msri_disc_pair_meets(&p);
}

/* Of those within reach. */
static void append_meeting(course *c, msri_range range, double reach) {
  const msri_lists *w = c->lists;
  for (size_t k = range.begin; k < range.end; k++)
    if (distance2(c->d, &w->pool[k]) <= reach * reach && !are_swift(w, &w->pool[k]) &&
        meets(c->d, w->pool[k].i, w->pool[k].j))
      append(c, &w->pool[k]);
}

static bool list_fast(course *c) {
  msri_lists *w = c->lists;
  msri_motion_measure(w->bodies, c->d->q0, c->d->q, w->box);
  msri_lists_set_ways(w);
  msri_lists_cover_ways(w, c->d->q0);
  c->n = 0, c->full = false;
  const size_t found = list_swift(c, meet_on_ways);
  for (size_t k = 0; k < found; k++) append(c, &w->near.pair[k]);
  for (size_t b = 0; b < w->bodies->n; b++) append_meeting(c, w->body[b].pairs, reach_in(c, b));
  append_meeting(c, w->kept->outer, (double)INFINITY);
  put_in_order(c);
  return c->n > 0;
}

static void join_fast(course *c) {
  msri_zones_part(c->d);
  c->d->since = 0;
  for (int lists = 0; lists < MOST_LISTS; lists++) {
    if (!list_fast(c)) return;
    while (for_each(c, msri_zones_join)) continue;
  }
  msri_zones_join_all(c->d);
}

static void resolve_fast(course *c) {
  c->d->most = (double)INFINITY;
  for (int lists = 0; lists < MOST_LISTS; lists++) {
    if (!list_fast(c)) return;
    put_right(c);
  }
  c->d->apart = 0;
  join_fast(c);
}

/* ---- A drift */

static double longest_way(size_t n, const double *from, const double *to) {
  double most = 0;
  for (size_t i = 0; i < n; i++) {
    const double dx = to[i] - from[i], dy = to[n + i] - from[n + i];
    most = msri_max(most, dx * dx + dy * dy);
  }
  return sqrt(most);
}

/* Collisions, then the parting of discs that overlap. */
static void resolve(course *c) {
  msri_drift *d = c->d;
  const double apart = msri_min(parting_speed * fabs(d->h), most_parting) * d->diameter;
  const double longest = longest_way(d->n, d->q0, d->q);
  d->most = 1.5 * longest + 2 * apart;
  const bool fast = !(longest <= slow * d->diameter) || !list_close(c);
  memset(d->held, 0, 2 * d->n);
  d->rests = !fast && d->restitution < 1 && d->kick;
  for (int parts = 0; parts < 2; parts++) {
    d->parts = parts;
    d->apart = apart;
    if (fast)
      resolve_fast(c);
    else
      resolve_slowly(c);
  }
}

uint64_t msri_collide(msri_drift *d, msri_lists *lists, const double *q) {
  course c = {.d = d, .lists = lists, .pair = lists->chosen};
  msri_lists_begin(lists, d->q0, q);
  msri_lists_cover_ways(lists, d->q0);
  if (find_hot(&c)) {
    resolve(&c);
    msri_motion_measure(lists->bodies, d->q0, d->q, lists->box);
    msri_lists_set_ways(lists);
  }
  msri_lists_end(lists, q);
  return d->collisions;
}
