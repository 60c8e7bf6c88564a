/* test_armed.c - tests against supports that are left out tell nothing: ranges of masses, the list
 * of what impacts owe, distances and clearances against their plain forms, and whole runs against
 * runs in which every mass is tested at every step, bit for bit.
 * link: --wrap=malloc --wrap=calloc --wrap=realloc */
#include "alloc.h"
#include "files.h"
#include "scenes.h"

#include "contacts/armed.h"
#include "contacts/supports.h"
#include "plan/state.h"

static const msr_impacts rules[] = {MSR_IMPACTS_KEPT, MSR_IMPACTS_LOCATED};

/* ---- Supports at random */

static msr_picture *random_picture(uint64_t *dice, size_t width, size_t height, size_t every) {
  msr_picture *p;
  must(msr_picture_create(width, height, &p, &why));
  for (size_t i = 0; i < width * height; i++)
    memcpy(p->rgb + 3 * i, rgb_of(random_below(dice, every) ? '.' : '#'), 3);
  return p;
}

static msri_contact supports_of(const msr_picture *p, const msri_supports_options *options) {
  msri_contact contact;
  must(msri_supports_create(p, options, &contact, &why));
  return contact;
}

/* ---- Ranges of masses */

enum { MOST = 200 };

/* Some masses; z = x, y, vx, vy, ax, ay [6][MOST]. */
typedef struct swarm {
  double z[6][MOST];
  msri_debt debt[MOST];
  msri_debts debts;
} swarm;

static double odd_number(uint64_t *dice) {
  static const double odd[] = {NO_NUMBER, INFINITE, -INFINITE,   DBL_MAX,      -DBL_MAX,   -0.0,
                               0x1p52,    0x1p53,   -0x1p51,     DBL_TRUE_MIN, 0x1p52 + 1, 3,
                               0x1p22,    -0x1p23,  5 - 0x1p-50, -0x1p-1074};
  return odd[random_below(dice, LENGTH(odd))];
}

static void fill(swarm *s, uint64_t *dice, const msr_picture *p, bool odd) {
  const double width = (double)p->width, height = (double)p->height;
  const double speed = pow(10, uniform(dice, -2, 3));
  for (size_t i = 0; i < MOST; i++) {
    s->z[0][i] = uniform(dice, -2, width + 2), s->z[1][i] = uniform(dice, -2, height + 2);
    for (size_t a = 2; a < 6; a++) s->z[a][i] = uniform(dice, -speed, speed);
    if (odd && random_below(dice, 4) == 0) s->z[random_below(dice, 4)][i] = odd_number(dice);
    if (random_below(dice, 8) == 0) s->z[random_below(dice, 2)][i] = (double)random_below(dice, 9);
  }
  s->debts = (msri_debts){s->debt, 0, MOST, MSR_OK};
}

static msri_flock flock_of(swarm *s, size_t from, size_t n, bool bent) {
  return (msri_flock){.n = n,
                      .first = 1000 + from,
                      .x = s->z[0] + from,
                      .y = s->z[1] + from,
                      .vx = s->z[2] + from,
                      .vy = s->z[3] + from,
                      .ux = s->z[2] + from,
                      .uy = s->z[3] + from,
                      .ax = bent ? s->z[4] + from : NULL,
                      .ay = bent ? s->z[5] + from : NULL};
}

/* The plain form of the rule `kept`: mass by mass, without distances. */
static uint64_t drift_plainly(const msri_contact *contact, double h, const msri_flock *f,
                              msri_debts *debts) {
  uint64_t collisions = 0;
  for (size_t k = 0; k < f->n; k++) {
    const double to[] = {f->x[k] + h * f->ux[k], f->y[k] + h * f->uy[k]};
    if (floor(to[0]) == floor(f->x[k]) && floor(to[1]) == floor(f->y[k])) {
      f->x[k] = to[0], f->y[k] = to[1];
      continue;
    }
    msri_leg leg = {.h = h,
                    .a = {f->ax ? f->ax[k] : 0, f->ax ? f->ay[k] : 0},
                    .x = {f->x[k], f->y[k]},
                    .v = {f->vx[k], f->vy[k]},
                    .follows = debts != NULL};
    collisions += msri_supports_keep(contact->self, to, &leg);
    f->x[k] = leg.x[0], f->y[k] = leg.x[1];
    f->vx[k] = leg.v[0], f->vy[k] = leg.v[1];
    if (leg.owed[0] != 0 || leg.owed[1] != 0)
      msri_debts_add(debts, f->first + k, leg.owed[0], leg.owed[1]);
  }
  return collisions;
}

/* The plain form of any rule: one mass after the other, all of them seen as near a support. */
static uint64_t drift_one_by_one(const msri_contact *contact, double h, const msri_flock *f,
                                 msri_debts *debts) {
  const msri_supports *s = contact->self;
  if (!contact->meet) return drift_plainly(contact, h, f, debts);
  uint64_t collisions = 0;
  const size_t cells = (s->width + 2) * (s->height + 2);
  unsigned char *distance = malloc(cells);
  assert_non_null(distance);
  memcpy(distance, s->distance, cells);
  memset(s->distance, 0, cells);
  for (size_t k = 0; k < f->n; k++) {
    msri_flock one = *f;
    one.n = 1, one.first += k;
    one.x += k, one.y += k, one.vx += k, one.vy += k, one.ux += k, one.uy += k;
    if (f->ax) one.ax += k, one.ay += k;
    collisions += contact->drift(contact->self, h, &one, debts);
  }
  memcpy(s->distance, distance, cells);
  free(distance);
  return collisions;
}

static void assert_same_swarms(const swarm *a, const swarm *b) {
  assert_memory_equal(a->z, b->z, sizeof a->z);
  assert_int_equal(a->debts.n, b->debts.n);
  for (size_t k = 0; k < a->debts.n; k++) {
    assert_int_equal(a->debt[k].mass, b->debt[k].mass);
    assert_memory_equal(&a->debt[k].x, &b->debt[k].x, sizeof(double));
    assert_memory_equal(&a->debt[k].y, &b->debt[k].y, sizeof(double));
  }
}

/* A range has the bits of its masses one by one, whatever its length, and leaves others alone. */
static void ranges_drift_as_masses_do(void **unused) {
  (void)unused;
  static swarm whole, plain;
  uint64_t dice = 1, met = 0;
  for (int n = 0; n < 600; n++) {
    const msri_supports_options options = {n % 2, n % 3 ? 1 : 0.5, n % 5 ? 0 : 0.3,
                                           rules[n / 2 % 2]};
    msr_picture *p = random_picture(&dice, 1 + random_below(&dice, 12), 1 + random_below(&dice, 12),
                                    2 + random_below(&dice, 40));
    const msri_contact contact = supports_of(p, &options);
    fill(&whole, &dice, p, n % 4 == 0);
    memcpy(&plain, &whole, sizeof whole);
    plain.debts.debt = plain.debt;
    const size_t from = random_below(&dice, MOST), count = random_below(&dice, MOST - from + 1);
    const bool bent = random_below(&dice, 2), owes = random_below(&dice, 4);
    const msri_flock f = flock_of(&whole, from, count, bent);
    const msri_flock g = flock_of(&plain, from, count, bent);
    const uint64_t a = contact.drift(contact.self, 0.01, &f, owes && bent ? &whole.debts : NULL);
    const uint64_t b = drift_one_by_one(&contact, 0.01, &g, owes && bent ? &plain.debts : NULL);
    assert_int_equal(a, b);
    assert_same_swarms(&whole, &plain);
    met += a;
    contact.release(contact.self);
    msr_picture_free(p);
  }
  assert_true(met > 1000);
}

/* Blocks of any length, by vectors of each width, and mass by mass. */
static void widths_do_the_same(void **unused) {
  (void)unused;
  uint64_t dice = 9;
  msr_picture *p = random_picture(&dice, 20, 20, 10);
  for (const msri_flock_kernel *kernel = msri_flock_kernels;; kernel++) {
    const bool runs = !kernel->runs_here || kernel->runs_here();
    for (size_t n = 0; runs && n <= MSRI_FLOCK_BLOCK; n++) {
      static swarm now, was, due;
      uint64_t left = 0;
      fill(&now, &dice, p, n % 2);
      memcpy(&was, &now, sizeof was);
      memcpy(&due, &now, sizeof due);
      for (size_t i = 0; i < n; i++) {
        for (int axis = 0; axis < 2; axis++) due.z[axis][i] += 0.01 * due.z[2 + axis][i];
        const bool stays =
            floor(due.z[0][i]) == floor(was.z[0][i]) && floor(due.z[1][i]) == floor(was.z[1][i]);
        left |= (uint64_t)!stays << i;
      }
      const msri_flock f = flock_of(&now, 0, n, false);
      kernel->glide(&f, 0.01);
      for (size_t i = 0; i < MOST; i++) // NaN is NaN, whatever its bits are
        for (int z = 0; z < 4; z++)
          assert_true(memcmp(&now.z[z][i], &due.z[z][i], sizeof(double)) == 0 ||
                      (isnan(now.z[z][i]) && isnan(due.z[z][i])));
      assert_true(kernel->leave(&f, &(msri_places){was.z[0], was.z[1]}) == left);
    }
    if (!kernel->runs_here) break;
  }
  msr_picture_free(p);
}

/* From just before the first edge it's 1 to the second, but for rounding. */
static void rounding_leads_into_no_support(void **unused) {
  (void)unused;
  msr_picture *p = paint("..#\n");
  for (size_t rule = 0; rule < LENGTH(rules); rule++) {
    const msri_contact contact = supports_of(p, &(msri_supports_options){false, 1, 0, rules[rule]});
    double q[] = {nextafter(1, 0), 0.5}, v[] = {1, 0};
    assert_true(q[0] + v[0] == 2 && 2 - q[0] == 1);
    const msri_flock f = msri_flock_of(1, v, NULL, q, v);
    assert_int_equal(contact.drift(contact.self, 1, &f, NULL), 1);
    assert_true(q[0] < 2);
    contact.release(contact.self);
  }
  msr_picture_free(p);
}

/* ---- What impacts owe */

static void debts_are_paid_once(void **unused) {
  (void)unused;
  msri_debts debts = {0};
  double a[2][20], v[2][20] = {{0}};
  for (size_t i = 0; i < 20; i++) a[0][i] = 1, a[1][i] = 2;
  for (size_t i = 0; i < 20; i += 2) msri_debts_add(&debts, 7 + i, (double)i, 1);
  msri_debts_cancel(&debts, 7 + 4);
  msri_debts_cancel(&debts, 7 + 5); // isn't owed anything
  for (int times = 0; times < 2; times++) {
    assert_int_equal(msri_debts_pay(&debts, 7, a[0], a[1], v[0], v[1]), MSR_OK);
    for (size_t i = 0; i < 20; i++) {
      const bool owed = i % 2 == 0 && i != 4;
      assert_true(v[0][i] == (owed ? (double)i : 0) && v[1][i] == (owed ? 2 : 0));
    }
  }
  msri_debts_clear(&debts);
  assert_null(debts.debt);
}

static void debts_that_are_lost_are_told(void **unused) {
  (void)unused;
  msri_debts debts = {0};
  const double a = 1;
  double v = 0;
  alloc_calls = 0, alloc_failing = 1;
  msri_debts_add(&debts, 0, 1, 1);
  alloc_failing = 0;
  assert_int_equal(msri_debts_pay(&debts, 0, &a, &a, &v, &v), MSR_ENOMEM);
  assert_int_equal(msri_debts_pay(&debts, 0, &a, &a, &v, &v), MSR_OK);
  assert_true(v == 0);
}

/* ---- Distances */

static bool is_solid(const msri_supports *s, long column, long row) {
  const bool inside = column >= 0 && row >= 0 && column < (long)s->width && row < (long)s->height;
  return inside ? msri_supports_solid(s, (size_t)row * s->width + (size_t)column)
                : s->options.closed;
}

/* From a cell of the ring or the picture to the nearest support, ring by ring of pixels. */
static long distance_from(const msri_supports *s, long column, long row) {
  const long far = (long)(s->width > s->height ? s->width : s->height) + 2;
  for (long d = 0; d <= far && d < UINT8_MAX; d++)
    for (long r = row - d; r <= row + d; r++)
      for (long c = column - d; c <= column + d; c += labs(r - row) == d || d == 0 ? 1 : 2 * d)
        if (is_solid(s, c, r)) return d;
  return UINT8_MAX;
}

static void check_distances(const msr_picture *p, bool closed) {
  const msri_contact contact = supports_of(p, &(msri_supports_options){closed, 1, 0, rules[0]});
  const msri_supports *s = contact.self;
  for (long r = -1; r <= (long)p->height; r++)
    for (long c = -1; c <= (long)p->width; c++) {
      const size_t cell = (size_t)(r + 1) * (p->width + 2) + (size_t)(c + 1);
      assert_int_equal(s->distance[cell], distance_from(s, c, r));
    }
  contact.release(contact.self);
}

static void distances_are_exact(void **unused) {
  (void)unused;
  static const size_t sizes[][3] = {{1, 1, 2},   {1, 1, 1000}, {1, 9, 8},     {9, 1, 8},
                                    {17, 11, 5}, {30, 20, 99}, {40, 40, 800}, {600, 2, 2000}};
  uint64_t dice = 2;
  for (size_t i = 0; i < LENGTH(sizes); i++)
    for (int n = 0; n < 8; n++) {
      msr_picture *p = random_picture(&dice, sizes[i][0], sizes[i][1], sizes[i][2]);
      check_distances(p, n % 2);
      msr_picture_free(p);
    }
}

/* ---- Clearances */

/* From a place to the nearest pixel that is a support, along one axis or the other. */
static double way_to_support(const msri_supports *s, double x, double y) {
  double least = INFINITE;
  for (long r = -1; r <= (long)s->height; r++)
    for (long c = -1; c <= (long)s->width; c++) {
      if (!is_solid(s, c, r)) continue;
      const double dx = fmax(fmax((double)c - x, x - (double)(c + 1)), 0);
      const double dy = fmax(fmax((double)r - y, y - (double)(r + 1)), 0);
      least = fmin(least, fmax(dx, dy));
    }
  return least;
}

/* Never more than the way to the nearest support, and of no use only beside one or at an open
 * border. */
static void clearances_are_no_more_than_the_way(void **unused) {
  (void)unused;
  uint64_t dice = 3;
  size_t useful = 0;
  for (int n = 0; n < 60; n++) {
    msr_picture *p = random_picture(&dice, 1 + random_below(&dice, 30), 1 + random_below(&dice, 30),
                                    20 + random_below(&dice, 300));
    const msri_contact contact = supports_of(p, &(msri_supports_options){n % 2, 1, 0, rules[0]});
    const double width = (double)p->width, height = (double)p->height, beyond = n % 2 ? 0 : 20;
    double x[50], y[50], least = INFINITE;
    for (size_t i = 0; i < LENGTH(x); i++) {
      x[i] = uniform(&dice, -beyond, width + beyond);
      y[i] = uniform(&dice, -beyond, height + beyond);
      const double way = way_to_support(contact.self, x[i], y[i]);
      const double alone = contact.clearance(contact.self, 1, x + i, y + i);
      assert_true(alone >= 0 && (alone <= way || alone == 0));
      const bool outside = x[i] < 0 || y[i] < 0 || x[i] >= width || y[i] >= height;
      if (!outside && way < 200) assert_true(alone > way - 1 - 1e-9); // rounding of x
      least = fmin(least, alone);
      useful += alone > 0;
    }
    assert_true(contact.clearance(contact.self, LENGTH(x), x, y) == least);
    contact.release(contact.self);
    msr_picture_free(p);
  }
  assert_true(useful > 1000);
}

/* What is no number, or so far away that coordinates are coarse, has no clearance. */
static void odd_places_have_no_clearance(void **unused) {
  (void)unused;
  static const double odd[] = {NO_NUMBER, INFINITE, -INFINITE, 0x1p23, -0x1p23, DBL_MAX, -DBL_MAX};
  msr_picture *p = paint("#.........\n..........\n");
  for (int closed = 0; closed < 2; closed++) {
    const msri_contact contact = supports_of(p, &(msri_supports_options){closed, 1, 0, rules[0]});
    const double x[] = {8.5, 8.5}, y[] = {-50, 30};
    assert_true(contact.clearance(contact.self, 2, x, y) == (closed ? 0 : 28));
    for (size_t i = 0; i < LENGTH(odd); i++) {
      assert_true(contact.clearance(contact.self, 1, odd + i, y) == 0);
      assert_true(contact.clearance(contact.self, 1, y, odd + i) == 0);
    }
    contact.release(contact.self);
  }
  msr_picture_free(p);
}

/* ---- Ranges that are armed in time */

static uint64_t tests; /* drifts of the supports below */
static msri_contact counted;

static uint64_t count_drift(const void *self, double h, const msri_flock *f, msri_debts *debts) {
  tests++;
  return counted.drift(self, h, f, debts);
}

/* A swarm that is shaken, and the same one with all tested at every step. */
static void check_shaken(uint64_t *dice, int n) {
  static swarm whole, plain;
  msri_armed armed[MOST / MSRI_FLOCK_BLOCK + 1] = {{0, 0}};
  const msri_supports_options options = {n % 2, 1, 0, rules[n / 2 % 2]};
  msr_picture *p = random_picture(dice, 60, 40, 2000);
  counted = supports_of(p, &options);
  msri_contact contact = counted;
  contact.drift = count_drift;
  fill(&whole, dice, p, n % 8 == 0);
  memcpy(&plain, &whole, sizeof whole);
  plain.debts.debt = plain.debt;
  const size_t count = random_below(dice, MOST + 1);
  const double gust = pow(10, uniform(dice, -2, 4));
  for (int step = 0; step < 200; step++) {
    const double h = uniform(dice, 0, 0.01);
    const msri_flock f = flock_of(&whole, 0, count, true);
    uint64_t met = 0;
    for (size_t from = 0; from < count; from += MSRI_FLOCK_BLOCK) {
      const msri_flock part = msri_flock_part(&f, from);
      met += msri_armed_drift(&armed[from / MSRI_FLOCK_BLOCK], &contact, h, &part, &whole.debts);
    }
    const msri_flock g = flock_of(&plain, 0, count, true);
    assert_int_equal(met, counted.drift(counted.self, h, &g, &plain.debts));
    assert_same_swarms(&whole, &plain);
    whole.debts.n = plain.debts.n = 0;
    const double x = uniform(dice, -gust, gust), y = uniform(dice, -gust, gust);
    for (size_t i = 0; i < count; i++) {
      whole.z[2][i] += h * x, whole.z[3][i] += h * y;
      plain.z[2][i] += h * x, plain.z[3][i] += h * y;
    }
  }
  counted.release(counted.self);
  msr_picture_free(p);
}

static void ranges_are_armed_in_time(void **unused) {
  (void)unused;
  uint64_t dice = 4;
  const uint64_t ranges = 200 * 200 * (MOST / MSRI_FLOCK_BLOCK) / 2;
  tests = 0;
  for (int n = 0; n < 200; n++) check_shaken(&dice, n);
  assert_in_range(tests, ranges / 20, 2 * ranges); // of some 2.6 a step: not none, and not all
}

/* Steps little above half the spacing of doubles move a mass twice as far as they should. */
static void steps_within_rounding_are_counted(void **unused) {
  (void)unused;
  msr_picture *p = paint(".#\n");
  const msri_contact contact = supports_of(p, &(msri_supports_options){false, 1, 0, rules[0]});
  const double start = 0x1p21, clearance = 0x1p-26;
  double x = start, y = 0.5, vx = 0x1.1p-32, vy = 0, before;
  msri_armed armed = {clearance, 0};
  const msri_flock f = {.n = 1, .x = &x, .y = &y, .vx = &vx, .vy = &vy, .ux = &vx, .uy = &vy};
  do {
    before = armed.left;
    assert_true(x - start <= clearance);
    msri_armed_drift(&armed, &contact, 1, &f, NULL);
  } while (armed.left < before);
  assert_true(x > start);
  contact.release(contact.self);
  msr_picture_free(p);
}

/* ---- Whole runs */

/* The hook is stepped row by row, what is denser all at once. */
static const char walls[] = "..........oooooooooo....................#\n"
                            "...oooooo.o..........oooo...............#\n"
                            "...oooooo.o....#.....oooo...............#\n"
                            "...oooooo.o..........oooo...............#\n"
                            "...oooooo.o.............................#\n"
                            "#.........o.............................#\n"
                            "#.........o.................#...........#\n"
                            "#.........o..............o..............#\n"
                            "#.............#.........................#\n"
                            "#.......................................#\n"
                            "........................................#\n"
                            "####..###################################\n";

/* Two states of one scene, the second of a plan that tests all masses at every step. */
typedef struct pair {
  world w[2];
} pair;

static pair open_pair(const msr_scene *scene, const msr_plan_options *options) {
  pair p;
  for (int tested = 0; tested < 2; tested++) {
    world *w = &p.w[tested];
    must(msr_plan_create(scene, options, &w->plan, &why));
    assert_true(msri_plan_arms(w->plan));
    if (tested) w->plan->contact.clearance = NULL;
    must(msr_state_create(w->plan, &w->state, &why));
  }
  return p;
}

static void close_pair(const pair *p) {
  close_world(p->w[0]);
  close_world(p->w[1]);
}

static void assert_same(const pair *p) {
  assert_true(msr_state_hash(p->w[0].state) == msr_state_hash(p->w[1].state));
  assert_int_equal(msr_state_contacts(p->w[0].state), msr_state_contacts(p->w[1].state));
}

static void go(const pair *p, uint64_t iterations) {
  for (int k = 0; k < 2; k++) advance(&p->w[k], iterations);
  assert_same(p);
}

/* A state that is swept row by row counts by blocks of these; in a patch nothing is kept. */
static bool any_is_disarmed(const world *w) {
  const msri_objects *o = &w->plan->objects;
  for (size_t b = 0; w->state->sweep && b < o->n_blocks; b++)
    if (w->state->rows.until[b] > 0) return true;
  for (size_t b = 0; !w->state->sweep && b < msri_flock_blocks(w->plan->figures.masses); b++)
    if (w->state->armed[b].left > 0) return true;
  return false;
}

/* Throws all masses, some of them next to a wall and towards it, where nothing was near before. */
static void throw_masses(const pair *p, uint64_t *dice) {
  const uint64_t start = *dice;
  for (int k = 0; k < 2; k++) {
    *dice = start;
    const msr_arrays s = msr_state_edit(p->w[k].state);
    for (size_t i = 0; i < msr_plan_describe(p->w[k].plan).masses; i++) {
      const double dx = uniform(dice, -0.01, 0.01);
      s.x[i] += 12 + dx;
      s.vx[i] += uniform(dice, -200, 600), s.vy[i] += uniform(dice, -50, 50);
    }
  }
}

static void copy(const pair *to, const pair *from) {
  for (int k = 0; k < 2; k++) msr_state_copy(to->w[k].state, from->w[k].state);
}

static char files[2][300];

static void save_or_load(const pair *p, bool load) {
  for (int k = 0; k < 2; k++) {
    const char *path = files[k];
    must(load ? msr_state_load(p->w[k].state, path, &why)
              : msr_state_save(p->w[k].state, path, &why));
  }
}

static void check_runs(const msr_integrator *integrator, uint64_t substeps, msr_impacts impacts,
                       uint64_t seed) {
  const msr_conf conf = {0.005, 9.8, 0.1, 300, 1, 1};
  const msr_wind wind = {.c = 0.05, .speed = 10, .gust = 30, .gust_time = 0.1, .seed = seed};
  msr_scene *scene = scene_of(walls, &conf, &(msr_scene_options){.closed_border = seed % 2});
  add_force(scene, &msr_force_wind, &wind);
  const msr_plan_options options = {
      .integrator = integrator, .substeps = substeps, .impacts = impacts};
  const pair p = open_pair(scene, &options);
  pair before = p;
  for (int k = 0; k < 2; k++) must(msr_state_create(p.w[k].plan, &before.w[k].state, &why));
  uint64_t dice = seed;
  bool disarmed = false;
  for (int k = 0; k < 2; k++) snprintf(files[k], sizeof files[k], "%s/state%d", directory, k);
  go(&p, 1);
  for (int n = 0; n < 8; n++) {
    go(&p, 20);
    disarmed |= any_is_disarmed(&p.w[0]);
    copy(&before, &p);
    save_or_load(&p, false);
    go(&p, 20);
    if (n % 4 == 0) throw_masses(&p, &dice);
    if (n % 4 == 1) copy(&p, &before);
    if (n % 4 == 2) save_or_load(&p, true);
    go(&p, 10);
  }
  assert_true(disarmed && msr_state_contacts(p.w[0].state) > 10);
  for (int k = 0; k < 2; k++) remove(files[k]), msr_state_free(before.w[k].state);
  close_pair(&p);
  msr_scene_free(scene);
}

static void nothing_is_missed(void **unused) {
  (void)unused;
  for (size_t rule = 0; rule < LENGTH(rules); rule++)
    for (uint64_t seed = 0; seed < 4; seed++) {
      check_runs(&msr_integrator_verlet, 3, rules[rule], seed);
      check_runs(&msr_integrator_symplectic_euler, 3, rules[rule], seed);
      check_runs(NULL, 0, rules[rule], seed);
    }
}

/* Nothing is left of what was counted from the old beginning. */
static void rows_begin_anew(void **unused) {
  (void)unused;
  const msr_conf conf = {0.005, 9.8, 0.1, 300, 1, 1};
  msr_scene *scene = scene_of(walls, &conf, NULL);
  const msr_plan_options options = {.integrator = &msr_integrator_verlet, .substeps = 3};
  const pair p = open_pair(scene, &options);
  const msri_objects *o = &p.w[0].plan->objects;
  const msri_armed_rows *armed = &p.w[0].state->rows;
  assert_non_null(p.w[0].state->sweep);
  go(&p, 1);
  for (size_t r = 0; r < o->n_rows; r++) armed->gone[r] = 0x1.8p22;
  for (size_t b = 0; b < o->n_blocks; b++) armed->until[b] = 0x1p23;
  go(&p, 1000);
  size_t anew = 0;
  for (size_t r = 0; r < o->n_rows; r++) anew += armed->gone[r] < 1e6;
  assert_true(anew >= 8 && msr_state_contacts(p.w[0].state) > 10);
  close_pair(&p);
  msr_scene_free(scene);
}

/* ---- Masses that are moved otherwise */

static const char lane[] = "o.......................................#\n";
static const double beside = 38.2, speed = 20; /* of the wall, which is at 40; of the mass */

static void jump_by_edit(msr_state *state, msr_state *other) {
  (void)other;
  msr_state_edit(state).x[0] = beside;
}

static void jump_by_copy(msr_state *state, msr_state *other) {
  msr_state_edit(other).x[0] = beside;
  msr_state_edit(other).vx[0] = speed;
  msr_state_copy(state, other);
}

static void jump_by_load(msr_state *state, msr_state *other) {
  char path[300];
  snprintf(path, sizeof path, "%s/state", directory);
  msr_state_edit(other).x[0] = beside;
  msr_state_edit(other).vx[0] = speed;
  must(msr_state_save(other, path, &why));
  must(msr_state_load(state, path, &why));
  remove(path);
}

static void jump_back(msr_state *state, msr_state *other) {
  const double kept[] = {beside, 0.5, speed, 0};
  (void)other;
  msri_state_put_back(state, kept);
}

/* A mass far from the wall is left alone for many steps; not so once it's beside it. */
static void jumps_are_noticed(void **unused) {
  (void)unused;
  static void (*const jump[])(msr_state *, msr_state *) = {jump_by_edit, jump_by_copy, jump_by_load,
                                                           jump_back};
  for (size_t j = 0; j < LENGTH(jump); j++) {
    world w = open_world(scene_of(lane, &weightless, NULL), &msr_integrator_verlet, 1);
    msr_state *other;
    must(msr_state_create(w.plan, &other, &why));
    msr_state_edit(w.state).vx[0] = speed;
    advance(&w, 2);
    assert_true(w.state->armed[0].left > 30);
    jump[j](w.state, other);
    advance(&w, 40); // 4 px
    assert_int_equal(msr_state_contacts(w.state), 1);
    assert_true(msr_state_view(w.state).x[0] < 40);
    msr_state_free(other);
    close_world(w);
  }
}

/* Steps that leap; and substeps between them. */
static void leaps_are_noticed(void **unused) {
  (void)unused;
  static const msr_conf stiff = {0.05, 9.8, 0.1, 1e3 * 0.1 / (0.005 * 0.005), 1, 1};
  msr_scene *scene = scene_of(pegs, &stiff, NULL);
  const pair p = open_pair(scene, NULL);
  for (int n = 0; n < 30; n++) {
    const uint64_t steps = msr_state_work(p.w[0].state).steps;
    if (n < 5) p.w[0].state->armed[0].left = 1000; // not true any more after a leap
    go(&p, 1);
    if (n < 5) assert_true(msr_state_work(p.w[0].state).steps == steps + 1);
    if (n < 5) assert_true(p.w[0].state->armed[0].left == 0);
  }
  const msr_work work = msr_state_work(p.w[0].state);
  assert_true(work.leaps > 0 && work.steps > 100 * work.leaps);
  assert_true(msr_state_contacts(p.w[0].state) > 0);
  close_pair(&p);
  msr_scene_free(scene);
}

/* An integrator that drifts another vector than the state's, and then takes that. */
static msr_status step_elsewhere(const msr_integrator *self, const msr_system *system,
                                 const msr_interval *interval, double *q, double *v,
                                 msr_workspace *work, msr_error *err) {
  (void)self, (void)err;
  double *other = work->vector;
  const double half = interval->h / 2;
  memcpy(other, q, system->n * sizeof *q);
  msr_status status = msr_system_drift(system, half, v, NULL, other, v);
  if (status != MSR_OK) return status;
  memcpy(q, other, system->n * sizeof *q);
  return msr_system_drift(system, half, v, NULL, q, v);
}

static void other_vectors_are_tested(void **unused) {
  (void)unused;
  static const msr_integrator elsewhere = {.name = "elsewhere",
                                           .summary = "drifts a copy, then the state",
                                           .order = 1,
                                           .bounces = true,
                                           .vectors = 1,
                                           .stability = 1,
                                           .step = step_elsewhere};
  msr_scene *scene = scene_of(lane, &weightless, NULL);
  for (int start = 0; start < 4; start++) { // in either half of a step it comes to the wall
    const pair p = open_pair(scene, &(msr_plan_options){.integrator = &elsewhere});
    for (int k = 0; k < 2; k++) {
      const msr_arrays s = msr_state_edit(p.w[k].state);
      s.x[0] = 0.52 + 0.025 * start, s.vx[0] = speed;
    }
    go(&p, 450);
    assert_int_equal(msr_state_contacts(p.w[0].state), 1);
    close_pair(&p);
  }
  msr_scene_free(scene);
}

/* The list of what is owed can't grow in the middle of a step. */
static void a_step_without_memory_says_so(void **unused) {
  (void)unused;
  world w = open_world(scene_of("o\n.\n#\n", &example, NULL), &msr_integrator_verlet, 3);
  msr_error err;
  msr_status status = MSR_OK;
  alloc_calls = 0, alloc_failing = 1;
  for (int n = 0; n < 200 && status == MSR_OK; n++) status = msr_state_step(w.state, 1, &err);
  alloc_failing = 0;
  assert_int_equal(status, MSR_ENOMEM);
  assert_non_null(strstr(err.message, "out of memory"));
  assert_true(msr_state_contacts(w.state) == 1);
  close_world(w);
}

int main(void) {
  const struct CMUnitTest all[] = {
      cmocka_unit_test(ranges_drift_as_masses_do),
      cmocka_unit_test(widths_do_the_same),
      cmocka_unit_test(rounding_leads_into_no_support),
      cmocka_unit_test(debts_are_paid_once),
      cmocka_unit_test(debts_that_are_lost_are_told),
      cmocka_unit_test(distances_are_exact),
      cmocka_unit_test(clearances_are_no_more_than_the_way),
      cmocka_unit_test(odd_places_have_no_clearance),
      cmocka_unit_test(ranges_are_armed_in_time),
      cmocka_unit_test(steps_within_rounding_are_counted),
      cmocka_unit_test(nothing_is_missed),
      cmocka_unit_test(rows_begin_anew),
      cmocka_unit_test(jumps_are_noticed),
      cmocka_unit_test(leaps_are_noticed),
      cmocka_unit_test(other_vectors_are_tested),
      cmocka_unit_test(a_step_without_memory_says_so),
  };
  return cmocka_run_group_tests_name("armed", all, make_directory, remove_directory);
}
