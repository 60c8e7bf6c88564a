/* discs.c - collisions of masses as discs: no friction, so that momentum and angular momentum are
 * kept.
 *
 * Masses first go where supports let them. Then each pair whose straight ways meet is put right,
 * one after the other in the order of their numbers, a few times over: the way along the normal
 * becomes that of their centre of mass, and the velocity along it is reflected (disc_pair.c). Who
 * is pushed into a support is stopped by it. Who is still in the way of another then goes back to
 * its old place for this step, and so on; as the old places were free, that ends, and no disc is
 * ever inside or beyond another, at any speed.
 *
 * Two that press on each other, so that they would be back within a step, come to rest: they leave
 * with what the rest of the step takes away. */
#include "contacts/discs.h"

#include "contacts/disc_pair.h"
#include "contacts/near.h"

#include <stdlib.h>
#include <string.h>

struct msri_discs {
  size_t n;
  const double *m;
  size_t m_stride;
  double diameter, restitution;
  msri_ties ties;
};

enum { MOST_PASSES = 16, MOST_RETREATS = 64 };

/* Discs that overlap part at so many diameters a second, by no more than a share of one in a step.
 */
static const double parting_speed = 10, most_parting = 0.02;

/* A drift under way. */
typedef struct motion {
  const msri_discs *discs;
  const msri_contact *supports;
  double h;
  const double *q0;   /* [2n]: places before */
  double *q, *v;      /* [2n]: places after, so far */
  const double *kick; /* [2n]: `half` of it is half a kick by the acceleration; NULL: none */
  double half;
  bool before; /* v is that of the middle of the step, and the half kick is still to come; else it's
                * that of the end */
  double *owed;
  double apart, most; /* [px]: by which overlapping discs part; that a disc may be pushed */
  msri_near near;
  bool fast;
  uint64_t collisions;
} motion;

static double mass(const msri_discs *d, size_t i) { return d->m[i * d->m_stride]; }

/* ---- One pair */

static msri_disc_pair pair_of(const msri_discs *d, const double *q0, const double *q, double apart,
                              size_t i, size_t j) {
  const size_t n = d->n;
  const msri_vec from = {q0[j] - q0[i], q0[n + j] - q0[n + i]};
  const msri_vec way = {(q[j] - q0[j]) - (q[i] - q0[i]),
                        (q[n + j] - q0[n + j]) - (q[n + i] - q0[n + i])};
  return (msri_disc_pair){i, j, from, way, d->diameter, apart};
}

static double kick_along(const motion *mo, size_t i, msri_vec n) {
  if (!mo->kick) return 0;
  return mo->half * (mo->kick[i] * n.x + mo->kick[mo->discs->n + i] * n.y);
}

/* The speed at which two leave that came at `speed`, both > 0. */
static double rebound(const motion *mo, double speed, double kick_i, double kick_j) {
  const double e = mo->discs->restitution, bounced = e * speed;
  if (e == 1 || bounced > fabs(kick_i) + fabs(kick_j)) return bounced;
  return msri_min(speed, msri_max(0, kick_i - kick_j));
}

/* Adds n s to a vector of mass i. */
static void add(const motion *mo, double *of, size_t i, msri_vec n, double s) {
  of[i] += n.x * s;
  of[mo->discs->n + i] += n.y * s;
}

static void reflect(motion *mo, const msri_disc_pair *p, msri_vec n) {
  const size_t i = p->i, j = p->j, count = mo->discs->n;
  const double *vx = mo->v, *vy = mo->v + count;
  const double kick_i = kick_along(mo, i, n), kick_j = kick_along(mo, j, n);
  double speed = -((vx[j] - vx[i]) * n.x + (vy[j] - vy[i]) * n.y);
  if (!mo->before) speed += kick_j - kick_i;
  if (!(speed > 0)) return;
  const double change = speed + rebound(mo, speed, kick_i, kick_j);
  const double mi = mass(mo->discs, i), mj = mass(mo->discs, j);
  add(mo, mo->v, i, n, -change * (mj / (mi + mj)));
  add(mo, mo->v, j, n, change * (mi / (mi + mj)));
  mo->collisions++;
}

/* The way along the normal becomes that of the centre of mass, but for the gap. */
static void stop(const motion *mo, const msri_disc_pair *p, msri_vec n) {
  const double lacks = msri_disc_pair_gap(p) - (p->way.x * n.x + p->way.y * n.y);
  if (!(lacks > 0)) return;
  const double mi = mass(mo->discs, p->i), mj = mass(mo->discs, p->j);
  add(mo, mo->q, p->i, n, -lacks * (mj / (mi + mj)));
  add(mo, mo->q, p->j, n, lacks * (mi / (mi + mj)));
}

/* Supports stop a mass that was pushed. */
static void obstruct(motion *mo, size_t i) {
  const size_t n = mo->discs->n;
  const double half = mo->kick ? mo->half : 0, later = mo->before ? 0 : half;
  double x[2], w[2], u[2], a[2], none[2];
  if (!mo->supports->drift) return;
  for (size_t d = 0; d < 2; d++) {
    const size_t k = i + d * n;
    const double kick = mo->kick ? mo->kick[k] : 0;
    x[d] = mo->q0[k], u[d] = (mo->q[k] - x[d]) / mo->h;
    w[d] = mo->v[k] - later * kick;
    a[d] = 2 * half * kick / mo->h;
  }
  const uint64_t met = mo->supports->drift(mo->supports->self, 1, mo->h, u, a, x, w, none);
  if (met == 0) return;
  for (size_t d = 0; d < 2; d++) {
    const size_t k = i + d * n;
    mo->q[k] = x[d];
    mo->v[k] = w[d] + (mo->kick ? later * mo->kick[k] : 0);
  }
  mo->collisions += met;
}

/* In a slow step nobody is pushed further than the list of neighbours is good for. */
static void hold(const motion *mo, size_t i) {
  const size_t n = mo->discs->n;
  const double dx = mo->q[i] - mo->q0[i], dy = mo->q[n + i] - mo->q0[n + i];
  const double way2 = dx * dx + dy * dy;
  if (mo->fast || way2 <= mo->most * mo->most) return;
  const double share = mo->most / sqrt(way2);
  mo->q[i] = mo->q0[i] + share * dx;
  mo->q[n + i] = mo->q0[n + i] + share * dy;
}

static bool collide(motion *mo, size_t i, size_t j) {
  const msri_disc_pair p = pair_of(mo->discs, mo->q0, mo->q, mo->apart, i, j);
  if (!msri_disc_pair_meets(&p)) return false;
  const msri_vec n = msri_disc_pair_normal(&p, mo->discs->restitution);
  const size_t both[] = {i, j};
  stop(mo, &p, n);
  reflect(mo, &p, n);
  for (int k = 0; k < 2; k++) {
    hold(mo, both[k]);
    obstruct(mo, both[k]);
    if (mo->owed) mo->owed[both[k]] = mo->owed[mo->discs->n + both[k]] = 0;
  }
  return true;
}

static bool retreat(motion *mo, size_t i, size_t j) {
  const size_t both[] = {i, j}, n = mo->discs->n;
  const msri_disc_pair p = pair_of(mo->discs, mo->q0, mo->q, 0, i, j);
  if (!msri_disc_pair_meets(&p)) return false;
  for (int k = 0; k < 2; k++) {
    mo->q[both[k]] = mo->q0[both[k]];
    mo->q[n + both[k]] = mo->q0[n + both[k]];
  }
  return true;
}

/* ---- All pairs */

/* For fast steps, whose lists are of the pairs that meet. */
typedef struct context {
  const msri_discs *discs;
  double apart;
} context;

static bool meet(const void *self, const msri_ways *ways, size_t i, size_t j) {
  const context *c = self;
  const msri_disc_pair p = pair_of(c->discs, ways->q0, ways->q, c->apart, i, j);
  return msri_disc_pair_meets(&p);
}

static void list_fast(motion *mo, double apart) {
  const context c = {mo->discs, apart};
  if (mo->fast)
    msri_near_list_ways(&mo->near, &(msri_ways){mo->q0, mo->q}, &(msri_meets){meet, &c});
}

/* Puts right, or back, each pair that meets. Were there any? */
static bool pass(motion *mo, bool (*one)(motion *, size_t, size_t), double apart) {
  bool any = false;
  list_fast(mo, apart);
  for (size_t k = 0; k < mo->near.list->n; k++)
    any |= one(mo, mo->near.pair[k].i, mo->near.pair[k].j);
  return any;
}

static void resolve(motion *mo) {
  for (int p = 0; p < MOST_PASSES; p++)
    if (!pass(mo, collide, mo->apart)) return;
  for (int p = 0; p < MOST_RETREATS; p++)
    if (!pass(mo, retreat, 0)) return;
  memcpy(mo->q, mo->q0, 2 * mo->discs->n * sizeof *mo->q);
}

/* ---- Is there anything to do? */

/* How many went further than `most` from where they were? What isn't finite did. */
static size_t further(size_t n, const double *from, const double *to, double most) {
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    const double dx = to[i] - from[i], dy = to[n + i] - from[n + i];
    count += !(dx * dx + dy * dy <= most * most);
  }
  return count;
}

static double longest_way(size_t n, const double *from, const double *to) {
  double most = 0;
  for (size_t i = 0; i < n; i++) {
    const double dx = to[i] - from[i], dy = to[n + i] - from[n + i];
    most = msri_max(most, dx * dx + dy * dy);
  }
  return sqrt(most);
}

/* A list that is good for the free ways. */
static void list_for_ways(motion *mo) {
  const double reach = msri_near_skin * mo->discs->diameter;
  if (!mo->near.list->valid || further(mo->discs->n, mo->near.at, mo->q, reach) > 0)
    msri_near_list_at(&mo->near, mo->q0);
}

/* A list that is good for all that may be pushed, too. */
static void list_for_pushes(motion *mo) {
  const double diameter = mo->discs->diameter;
  mo->most = 1.5 * longest_way(mo->discs->n, mo->q0, mo->q) + 2 * mo->apart;
  const double stale = msri_near_skin * diameter - mo->most;
  if (further(mo->discs->n, mo->near.at, mo->q0, stale) > 0) msri_near_list_at(&mo->near, mo->q0);
}

static bool any_meets(const motion *mo) {
  for (size_t k = 0; k < mo->near.list->n; k++) {
    const msri_disc_pair p =
        pair_of(mo->discs, mo->q0, mo->q, mo->apart, mo->near.pair[k].i, mo->near.pair[k].j);
    if (msri_disc_pair_meets(&p)) return true;
  }
  return false;
}

/* Lists depend on the past, but what is in them is looked at again: what happens doesn't. */
static uint64_t act(motion *mo) {
  const msri_discs *d = mo->discs;
  mo->apart = msri_min(parting_speed * fabs(mo->h), most_parting) * d->diameter;
  mo->fast = further(d->n, mo->q0, mo->q, msri_near_slow * d->diameter) > 0;
  if (!mo->fast) {
    list_for_ways(mo);
    if (!any_meets(mo)) return 0;
    list_for_pushes(mo);
  }
  resolve(mo);
  return mo->collisions;
}

/* ---- Drift and bounce */

static size_t near_begins(const msri_discs *d) { return 2 * d->n * sizeof(double); }

static msri_near near_in(const msri_discs *d, void *room) {
  return msri_near_place(d->n, d->diameter, &d->ties,
                         (char *)room + (near_begins(d) + 15) / 16 * 16);
}

void msri_discs_forget(const msri_discs *d, void *room) { near_in(d, room).list->valid = false; }

uint64_t msri_discs_drift(const msri_discs *d, const msri_contact *supports, void *room, double h,
                          const double *u, const double *a, double *q, double *v, double *owed) {
  uint64_t met = 0;
  memcpy(room, q, 2 * d->n * sizeof *q);
  if (supports->drift)
    met = supports->drift(supports->self, d->n, h, u, a, q, v, owed);
  else
    for (size_t i = 0; i < 2 * d->n; i++) q[i] += h * u[i];
  motion mo = {.discs = d,
               .supports = supports,
               .h = h,
               .q0 = room,
               .q = q,
               .v = v,
               .kick = a,
               .half = h / 2,
               .before = true,
               .owed = supports->drift ? owed : NULL,
               .near = near_in(d, room)};
  return met + act(&mo);
}

uint64_t msri_discs_bounce(const msri_discs *d, const msri_contact *supports, void *room, double h,
                           const double *q0, const double *v0, double *q, double *v, double *owed) {
  uint64_t met = 0;
  double *const kick = room;
  for (size_t i = 0; i < 2 * d->n; i++) kick[i] = v[i] - v0[i];
  if (supports->bounce) met = supports->bounce(supports->self, d->n, h, q0, v0, q, v, owed);
  motion mo = {.discs = d,
               .supports = supports,
               .h = h,
               .q0 = q0,
               .q = q,
               .v = v,
               .kick = kick,
               .half = 0.5,
               .owed = supports->bounce ? owed : NULL,
               .near = near_in(d, room)};
  return met + act(&mo);
}

/* ---- Creation */

size_t msri_discs_bytes(const msri_discs *d) {
  return sizeof *d + (d->n + 2) * sizeof *d->ties.first +
         d->ties.first[d->n] * sizeof *d->ties.partner;
}

size_t msri_discs_room(const msri_discs *d) {
  return (near_begins(d) + 15) / 16 * 16 + msri_near_bytes(d->n);
}

static bool all_tied(size_t n, const msri_ties *ties) {
  return ties->first[n] == n / 2 * (n % 2 ? n : n - 1);
}

msr_status msri_discs_create(const msr_view *start, double diameter, double restitution,
                             msri_discs **discs, msr_error *err) {
  if (start->n >= UINT32_MAX)
    return msri_fail(err, MSR_EUSAGE, "%zu masses are too many for collisions between them",
                     start->n);
  msri_discs *made = msri_alloc(1, sizeof *made, "collisions", err);
  if (!made) return MSR_ENOMEM;
  *made = (msri_discs){start->n, start->m, start->m_stride, diameter, restitution, {0}};
  const msr_status status = msri_ties_create(start->n, start->springs, &made->ties, err);
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
