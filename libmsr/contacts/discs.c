/* discs.c - collisions of masses as discs: no friction, so that momentum and angular momentum are
 * kept.
 *
 * Masses first go where supports let them. Then each pair whose straight ways meet is put right,
 * one after the other in the order of their numbers, a few times over; who still meets another goes
 * the same way as that other (drift.c). As the old places were free, that ends, and no disc is ever
 * inside or beyond another, at any speed.
 *
 * Which pairs are looked at depends on the past; what becomes of them doesn't, and those that are
 * left out don't meet. */
#include "contacts/discs.h"

#include "contacts/drift.h"
#include "contacts/flock.h"

#include <stdlib.h>
#include <string.h>

struct msri_discs {
  size_t n;
  const double *m;
  size_t m_stride;
  double diameter, restitution;
  msri_ties ties;
};

enum { ALIGNMENT = 16, MOST_PASSES = 12, REST_PASSES = 6, MOST_LISTS = 6, MOST_JOINS = 64 };

/* Discs that overlap part at so many diameters a second, by no more than a share of one in a step.
 */
static const double parting_speed = 10, most_parting = 0.02;

/* Longer ways than this, in diameters, have lists of their own. */
static const double slow = 0.3;

/* A drift, and where its pairs are listed. */
typedef struct course {
  msri_drift d;
  msri_near near;
} course;

/* ---- Ways */

/* A way that many go, to see them at rest: the mean of a few. */
static msri_vec common_way(size_t n, const double *from, const double *to) {
  enum { FEW = 64 };
  const size_t every = n / FEW + 1, few = (n + every - 1) / every;
  msri_vec sum = {0, 0};
  for (size_t i = 0; i < n; i += every) sum.x += to[i] - from[i], sum.y += to[n + i] - from[n + i];
  return (msri_vec){sum.x / (double)few, sum.y / (double)few};
}

/* How many went further than `most` from where they were, seen from what goes `way`? What isn't
 * finite did. */
static size_t further(size_t n, const double *from, const double *to, msri_vec way, double most) {
  const double *x0 = from, *y0 = from + n, *x = to, *y = to + n, most2 = most * most;
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    const double dx = x[i] - x0[i] - way.x, dy = y[i] - y0[i] - way.y;
    count += !(dx * dx + dy * dy <= most2);
  }
  return count;
}

/* Has anyone moved against the others by more than `most` since the list was made? */
static bool is_stale(const course *c, const double *q, double most) {
  const double *at = c->near.at;
  return !c->near.list->valid || !(most > 0) ||
         further(c->d.n, at, q, common_way(c->d.n, at, q), most) > 0;
}

/* How far a list of slow ways is to reach: for some steps, and for nothing in a lattice at rest. */
static double skin_for(const course *c, double way) {
  return msri_max(1.25 * way, msri_min(0.45 * c->d.diameter,
                                       msri_max(msri_near_skin * c->d.diameter, 8 * way)));
}

static double longest_way(size_t n, const double *from, const double *to) {
  double most = 0;
  for (size_t i = 0; i < n; i++) {
    const double dx = to[i] - from[i], dy = to[n + i] - from[n + i];
    most = msri_max(most, dx * dx + dy * dy);
  }
  return sqrt(most);
}

/* ---- All pairs of a list */

typedef bool pair_act(msri_drift *d, size_t i, size_t j);

static bool for_each(course *c, const msri_pair *pair, size_t n, pair_act *act) {
  bool any = false;
  for (size_t k = 0; k < n; k++) any |= act(&c->d, pair[k].i, pair[k].j);
  return any;
}

static bool for_each_pair(course *c, pair_act *act) {
  return for_each(c, c->near.pair, c->near.list->n, act);
}

/* Those that are close enough for this step. */
static bool for_each_close(course *c, pair_act *act) {
  return for_each(c, c->near.close, c->near.list->n_close, act);
}

static bool is_any(course *c, pair_act *act) {
  for (size_t k = 0; k < c->near.list->n; k++)
    if (act(&c->d, c->near.pair[k].i, c->near.pair[k].j)) return true;
  return false;
}

static bool meets(msri_drift *d, size_t i, size_t j) {
  const msri_disc_pair p = msri_drift_pair(d, i, j);
  return msri_disc_pair_meets(&p);
}

/* Did they overlap by more than rounding? */
static bool overlapped(msri_drift *d, size_t i, size_t j) {
  const msri_vec r = msri_drift_pair(d, i, j).from;
  const double least2 = d->diameter * d->diameter * (1 - msri_disc_rounding / 2);
  return r.x * r.x + r.y * r.y < least2;
}

/* A few passes; was the last one idle? */
static bool put_right(course *c, const msri_pair *pair, size_t n) {
  memset(c->d.pass, 0, c->d.n * sizeof *c->d.pass);
  for (c->d.passes = 1; c->d.passes <= MOST_PASSES; c->d.passes++) {
    c->d.since = c->d.passes - 1;
    if (!for_each(c, pair, n, msri_drift_collide)) return true;
  }
  return false;
}

/* ---- Slow ways: one list, of all that may be pushed together */

/* A list that is good for the free ways. */
static void list_for_ways(course *c, double longest) {
  if (is_stale(c, c->d.q, c->near.list->skin))
    msri_near_list_at(&c->near, c->d.q0, skin_for(c, longest));
}

/* A list that is good for all that may be pushed, too; false: it's too long. */
static bool list_for_pushes(course *c) {
  if (!is_stale(c, c->d.q0, c->near.list->skin - c->d.most)) return true;
  msri_near_list_at(&c->near, c->d.q0, skin_for(c, c->d.most));
  if (c->near.list->full) msri_near_list_at(&c->near, c->d.q0, c->d.most);
  return !c->near.list->full;
}

/* Zones grow by every pair that meets; if there is no end to it, all are one. */
static void join(course *c) {
  msri_drift_part(&c->d);
  for (int joins = 0; joins < MOST_JOINS; joins++) {
    c->d.since = joins > 0 ? c->d.passes++ : 0;
    if (!for_each_close(c, msri_drift_join)) return;
  }
  msri_drift_join_all(&c->d);
}

/* False: there are too many pairs. */
static bool resolve_slowly(course *c) {
  if (!is_any(c, c->d.parts ? overlapped : meets)) return true;
  if (!list_for_pushes(c)) return false;
  msri_near_choose(&c->near, c->d.q0, c->d.most);
  if (!put_right(c, c->near.close, c->near.list->n_close)) {
    c->d.apart = 0;
    join(c);
  }
  for (int k = 0; c->d.rests && !c->d.parts && k < REST_PASSES; k++)
    if (!for_each_close(c, msri_drift_rest)) break;
  return true;
}

/* ---- Fast ways: lists of the pairs that meet, until there are none */

static bool meet_on_ways(const void *self, const msri_ways *ways, size_t i, size_t j) {
  const msri_drift *d = self;
  const msri_disc_pair p = msri_drift_pair(d, i, j);
  (void)ways;
  return msri_disc_pair_meets(&p);
}

static bool list_fast(course *c) {
  const msri_ways ways = {c->d.q0, c->d.q};
  msri_near_list_ways(&c->near, &ways, slow * c->d.diameter, &(msri_meets){meet_on_ways, &c->d});
  return c->near.list->n > 0;
}

static void join_fast(course *c) {
  msri_drift_part(&c->d);
  c->d.since = 0;
  for (int lists = 0; lists < MOST_LISTS; lists++) {
    if (!list_fast(c)) return;
    while (for_each_pair(c, msri_drift_join)) continue;
  }
  msri_drift_join_all(&c->d);
}

static void resolve_fast(course *c) {
  c->d.most = (double)INFINITY;
  for (int lists = 0; lists < MOST_LISTS; lists++) {
    if (!list_fast(c)) return;
    put_right(c, c->near.pair, c->near.list->n);
  }
  c->d.apart = 0;
  join_fast(c);
}

/* ---- A drift */

/* Collisions, then the parting of discs that overlap. */
static uint64_t collide(course *c) {
  msri_drift *d = &c->d;
  const double apart = msri_min(parting_speed * fabs(d->h), most_parting) * d->diameter;
  const double longest = longest_way(d->n, d->q0, d->q);
  bool fast = !(longest <= slow * d->diameter);
  d->most = 1.5 * longest + 2 * apart;
  if (!fast) list_for_ways(c, longest);
  fast |= c->near.list->full;
  memset(d->held, 0, 2 * d->n);
  d->rests = !fast && d->restitution < 1 && d->kick;
  for (int parts = 0; parts < 2; parts++) {
    d->parts = parts;
    d->apart = apart;
    if (fast || !resolve_slowly(c)) resolve_fast(c);
  }
  return d->collisions;
}

/* ---- Memory of a state: a vector, the zones, the list */

static size_t rounded(size_t bytes) { return (bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT; }

static size_t vector_bytes(const msri_discs *d) { return rounded(2 * d->n * sizeof(double)); }

static size_t zone_bytes(const msri_discs *d) { return rounded(3 * d->n * sizeof(uint32_t)); }

static size_t held_bytes(const msri_discs *d) { return rounded(2 * d->n); }

size_t msri_discs_room(const msri_discs *d) {
  return vector_bytes(d) + zone_bytes(d) + held_bytes(d) + msri_near_bytes(d->n);
}

static course begin(const msri_discs *discs, const msri_contact *supports, void *room, double h) {
  char *const zones = (char *)room + vector_bytes(discs);
  char *const held = zones + zone_bytes(discs), *const near = held + held_bytes(discs);
  return (course){.d = {.n = discs->n,
                        .m = discs->m,
                        .m_stride = discs->m_stride,
                        .diameter = discs->diameter,
                        .restitution = discs->restitution,
                        .supports = supports,
                        .h = h,
                        .zone = (void *)zones,
                        .next = (uint32_t *)(void *)zones + discs->n,
                        .pass = (uint32_t *)(void *)zones + 2 * discs->n,
                        .held = (signed char *)held},
                  .near = msri_near_place(discs->n, discs->diameter, &discs->ties, near)};
}

/* ---- Drift and bounce */

uint64_t msri_discs_drift(const msri_obstacles *all, double h, const double *u, const double *a,
                          double *q, double *v, msri_debts *debts) {
  uint64_t met = 0;
  const msri_contact *supports = all->supports;
  course c = begin(all->discs, supports, all->room, h);
  msri_drift *d = &c.d;
  memcpy(all->room, q, 2 * d->n * sizeof *q);
  const msri_flock flock = msri_flock_of(d->n, u, a, q, v);
  if (supports->drift)
    met = supports->drift(supports->self, h, &flock, debts);
  else
    for (size_t i = 0; i < 2 * d->n; i++) q[i] += h * u[i];
  d->q0 = all->room, d->q = q, d->v = v;
  d->kick = a, d->unit = h;
  d->debts = supports->drift ? debts : NULL;
  return met + collide(&c);
}

uint64_t msri_discs_bounce(const msri_obstacles *all, double h, const double *q0, const double *v0,
                           double *q, double *v, msri_debts *debts) {
  uint64_t met = 0;
  const msri_contact *supports = all->supports;
  course c = begin(all->discs, supports, all->room, h);
  msri_drift *d = &c.d;
  double *const kick = all->room;
  for (size_t i = 0; i < 2 * d->n; i++) kick[i] = v[i] - v0[i];
  if (supports->bounce) met = supports->bounce(supports->self, d->n, h, q0, v0, q, v, debts);
  d->q0 = q0, d->q = q, d->v = v;
  d->kick = kick, d->unit = 1, d->behind = 0.5;
  d->debts = supports->bounce ? debts : NULL;
  return met + collide(&c);
}

/* ---- Creation */

size_t msri_discs_bytes(const msri_discs *d) {
  return sizeof *d + (d->n + 2) * sizeof *d->ties.first +
         d->ties.first[d->n] * sizeof *d->ties.partner;
}

static bool all_tied(size_t n, const msri_ties *ties) {
  return ties->first[n] == (n % 2 ? (n - 1) / 2 * n : n / 2 * (n - 1));
}

msr_status msri_discs_create(const msr_view *start, double diameter, double restitution,
                             msri_discs **discs, msr_error *err) {
  if (start->n >= UINT32_MAX)
    return msri_fail(err, MSR_EUSAGE, "%zu masses are too many for collisions between them",
                     start->n);
  msri_discs *made = msri_alloc(1, sizeof *made, "collisions", err);
  if (!made) return MSR_ENOMEM;
  *made = (msri_discs){start->n, start->m, start->m_stride, diameter, restitution, {0}};
  const msr_status status = msri_ties_create(start, diameter, &made->ties, err);
  const bool none = status == MSR_OK && all_tied(start->n, &made->ties);
  if (status != MSR_OK || none) {
    msri_discs_free(made);
    made = NULL;
  }
  if (status == MSR_OK) *discs = made;
  return status;
}

void msri_discs_free(msri_discs *discs) {
  if (!discs) return;
  msri_ties_clear(&discs->ties);
  free(discs);
}
