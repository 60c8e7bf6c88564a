/* collide.c - the pairs that are put right, and how often.
 *
 * Each pair whose straight paths meet is put right, one after the other in the order of their
 * numbers, a few times over; who still meets another goes the same way as that other (zones.c). As
 * the old places were free, that ends, and no disc is ever inside or beyond another, at any speed.
 *
 * Which pairs are looked at depends on the past; what becomes of them doesn't, and those that are
 * left out don't meet. */
#include "contacts/collide.h"

#include "contacts/encounters.h"
#include "contacts/zones.h"

#include <string.h>

enum { MOST_PASSES = 12, REST_PASSES = 6, MOST_LISTS = 6, MOST_JOINS = 64 };

/* Discs that overlap part at so many diameters a second, by no more than a share of one in a step.
 */
static const double parting_speed = 10, most_parting = 0.02;

/* ---- All pairs of a list */

typedef bool pair_act(msri_drift *d, size_t i, size_t j);

static bool for_each(const msri_encounters *c, pair_act *act) {
  bool any = false;
  for (size_t k = 0; k < c->n; k++) any |= act(c->d, c->pair[k].i, c->pair[k].j);
  return any;
}

static bool is_any(const msri_encounters *c, pair_act *act) {
  for (size_t k = 0; k < c->n; k++)
    if (act(c->d, c->pair[k].i, c->pair[k].j)) return true;
  return false;
}

/* Did they overlap by more than rounding? */
static bool overlapped(msri_drift *d, size_t i, size_t j) {
  const double least2 = d->diameter * d->diameter * (1 - msri_disc_rounding / 2);
  return msri_distance2(d, i, j) < least2;
}

/* A few passes; was the last one idle? */
static bool put_right(const msri_encounters *c) {
  memset(c->d->pass, 0, c->d->n * sizeof *c->d->pass);
  for (c->d->passes = 1; c->d->passes <= MOST_PASSES; c->d->passes++) {
    c->d->since = c->d->passes - 1;
    if (!for_each(c, msri_drift_collide)) return true;
  }
  return false;
}

/* ---- Slow paths: one list, of all that may be pushed together */

/* Zones grow by every pair that meets; if there is no end to it, all are one. */
static void join(const msri_encounters *c) {
  msri_zones_part(c->d);
  for (int joins = 0; joins < MOST_JOINS; joins++) {
    c->d->since = joins > 0 ? c->d->passes++ : 0;
    if (!for_each(c, msri_zones_join)) return;
  }
  msri_zones_join_all(c->d);
}

static void resolve_slowly(const msri_encounters *c) {
  msri_drift *d = c->d;
  if (!is_any(c, d->parts ? overlapped : msri_drift_meets)) return;
  if (!put_right(c)) {
    d->apart = 0;
    join(c);
  }
  for (int k = 0; d->rests && !d->parts && k < REST_PASSES; k++)
    if (!for_each(c, msri_drift_rest)) break;
}

/* ---- Fast paths: lists of the pairs that meet, until there are none */

static void join_fast(msri_encounters *c) {
  msri_zones_part(c->d);
  c->d->since = 0;
  for (int lists = 0; lists < MOST_LISTS; lists++) {
    if (!msri_encounters_list_meeting(c)) return;
    while (for_each(c, msri_zones_join)) continue;
  }
  msri_zones_join_all(c->d);
}

static void resolve_fast(msri_encounters *c) {
  c->d->most = (double)INFINITY;
  for (int lists = 0; lists < MOST_LISTS; lists++) {
    if (!msri_encounters_list_meeting(c)) return;
    put_right(c);
  }
  c->d->apart = 0;
  join_fast(c);
}

/* ---- A drift */

static double longest_path(size_t n, const double *from, const double *to) {
  double most = 0;
  for (size_t i = 0; i < n; i++) {
    const double dx = to[i] - from[i], dy = to[n + i] - from[n + i];
    most = msri_max(most, dx * dx + dy * dy);
  }
  return sqrt(most);
}

/* Collisions, then the parting of discs that overlap. */
static void resolve(msri_encounters *c) {
  msri_drift *d = c->d;
  const double apart = msri_min(parting_speed * fabs(d->h), most_parting) * d->diameter;
  const double longest = longest_path(d->n, d->q0, d->q);
  d->most = 1.5 * longest + 2 * apart;
  const bool fast = !(longest <= msri_slow * d->diameter) || !msri_encounters_list_close(c);
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
  msri_encounters c = {.d = d, .lists = lists, .pair = lists->chosen};
  msri_lists_begin(lists, d->q0, q);
  msri_lists_cover_paths(lists, d->q0);
  if (msri_encounters_are_hot(&c)) {
    resolve(&c);
    msri_displacement_measure(lists->bodies, d->q0, d->q, lists->box);
    msri_lists_set_paths(lists);
  }
  msri_lists_end(lists, q);
  return d->collisions;
}
