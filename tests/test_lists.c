/* test_lists.c - collisions are looked for only where masses can meet, and none is missed: against
 * all pairs and against lists made anew, at any speed; and what moves as a whole costs no lists. */
#include "contacts/disc_pair.h"
#include "contacts/discs.h"
#include "contacts/lists.h"
#include "scenes.h"

/* ---- Bodies, and loose masses, in a game of springs */

typedef struct game {
  size_t n, n_springs;
  double *q, *v, *q0, *v0, *a; /* [2n] */
  msr_run_of_springs *run;     /* [n_springs]: one spring each */
  msri_ties ties;
  msri_discs *discs[2]; /* as it is; and with all bodies tied to each other, far away */
  msri_contact supports;
  void *room[2];
} game;

/* Discs; an iteration. */
static const double diameter = 0.9, h = 0.01;

static const double one = 1, stiff = 300;

static void add_one(game *g, double x, double y, double vx, double vy, size_t most) {
  const size_t i = g->n++;
  g->q[i] = x, g->q[i + most] = y, g->v[i] = vx, g->v[i + most] = vy;
}

static void join(game *g, size_t i, size_t j) {
  g->run[g->n_springs++] = (msr_run_of_springs){i, 1, j - i, &stiff, &one, 0};
}

/* A lattice of so many columns and rows, turned, with a way and a spin of its own. */
static void add_block(game *g, uint64_t *dice, double x, double y, double speed, size_t most) {
  const size_t columns = 1 + random_below(dice, 6), rows = 1 + random_below(dice, 6);
  const double turn = uniform(dice, 0, 6.283), spin = uniform(dice, -speed, speed) / 4;
  const double vx = uniform(dice, -speed, speed), vy = uniform(dice, -speed, speed);
  const size_t first = g->n;
  for (size_t k = 0; k < columns * rows; k++) {
    const double cx = (double)(k % columns), cy = (double)(k / columns);
    const double px = cx * cos(turn) - cy * sin(turn), py = cx * sin(turn) + cy * cos(turn);
    add_one(g, x + px, y + py, vx - spin * py, vy + spin * px, most);
    if (k % columns > 0) join(g, first + k - 1, first + k);
    if (k >= columns) join(g, first + k - columns, first + k);
  }
}

/* In rows, with little between them, and the first to push the others. */
static void add_rows(game *g, double speed, size_t most) {
  for (int k = 0; k < 8; k++) {
    const size_t first = g->n;
    for (size_t i = 0; i < 20; i++) {
      add_one(g, 20 + (double)i, 20 + 0.95 * k, 0, k ? 0 : speed, most);
      if (i > 0) join(g, first + i - 1, first + i);
    }
  }
}

/* Far away, a mass that is tied to mass i. */
static void add_aerial(game *g, size_t i, size_t most) {
  add_one(g, -1e5, 10 * (double)g->n, 0, 0, most);
  join(g, i, g->n - 1);
}

enum { BODIES = 9, MOST = BODIES * 37 };

/* y [n] comes after x [n]. */
static void close_up(game *g) {
  memmove(g->q + g->n, g->q + MOST, g->n * sizeof *g->q);
  memmove(g->v + g->n, g->v + MOST, g->n * sizeof *g->v);
}

static void add_bodies(game *g, uint64_t *dice, double speed) {
  for (int cell = 0; cell < BODIES; cell++) {
    const double x = 20 + 12 * (cell % 3), y = 20 + 12 * (cell / 3);
    if (random_below(dice, 4) > 0)
      add_block(g, dice, x, y, speed, MOST);
    else
      add_one(g, x, y, uniform(dice, -speed, speed), uniform(dice, -speed, speed), MOST);
  }
}

static void make_discs(game *g, size_t n_springs, double restitution, bool tied) {
  const msr_springs springs = {.n = n_springs, .n_runs = n_springs, .run = g->run};
  const msr_view start = {.n = g->n, .x = g->q, .y = g->q + g->n, .m = &one, .springs = &springs};
  if (!tied) must(msri_ties_create(&start, diameter, &g->ties, &why));
  must(msri_discs_create(&start, diameter, restitution, &g->discs[tied], &why));
  g->room[tied] = zeroed(1, msri_discs_room(g->discs[tied]));
}

static void add_floor(game *g, double restitution) {
  msr_picture *picture = paint("......\n......\n##..##\n");
  const msri_supports_options options = {.restitution = restitution};
  must(msri_supports_create(picture, &options, &g->supports, &why));
  msr_picture_free(picture);
}

static game game_of(uint64_t *dice, double speed, double restitution, bool rows) {
  game g = {.run = zeroed(4 * MOST, sizeof *g.run)};
  double **const vectors[] = {&g.q, &g.v, &g.q0, &g.v0, &g.a};
  for (size_t k = 0; k < LENGTH(vectors); k++) *vectors[k] = zeroed(2 * MOST, sizeof **vectors[k]);
  if (rows)
    add_rows(&g, speed, MOST);
  else
    add_bodies(&g, dice, speed);
  const size_t near = g.n, springs = g.n_springs;
  for (size_t i = 0; i < near; i++) { // each body has one, by its first mass
    bool first = true;
    for (size_t s = 0; s < springs; s++) first &= g.run[s].first + g.run[s].offset != i;
    if (!first) continue;
    add_aerial(&g, i, MOST);
  }
  close_up(&g);
  make_discs(&g, g.n_springs, restitution, false);
  const size_t apart = g.n_springs;
  for (size_t i = near + 1; i < g.n; i++) join(&g, i - 1, i);
  make_discs(&g, g.n_springs, restitution, true);
  g.n_springs = apart;
  return g;
}

static void free_game(game *g) {
  free(g->q), free(g->v), free(g->q0), free(g->v0), free(g->a);
  free(g->run);
  msri_ties_clear(&g->ties);
  for (int tied = 0; tied < 2; tied++) free(g->room[tied]), msri_discs_free(g->discs[tied]);
  if (g->supports.release) g->supports.release(g->supports.self);
}

/* v += h a: springs that are no aerials, gravity; a is told, so that what is slow may rest. */
static void kick(game *g, double gravity) {
  const size_t n = g->n;
  memset(g->a, 0, 2 * n * sizeof *g->a);
  for (size_t s = 0; s < g->n_springs; s++) {
    const size_t i = g->run[s].first, j = i + g->run[s].offset;
    const double dx = g->q[j] - g->q[i], dy = g->q[n + j] - g->q[n + i], l = hypot(dx, dy);
    const double f = l > 0 && l < 1e3 ? stiff * (l - one) / l : 0;
    g->a[i] += f * dx, g->a[n + i] += f * dy, g->a[j] -= f * dx, g->a[n + j] -= f * dy;
  }
  for (size_t i = 0; i < n; i++)
    if (g->q[i] > -1e4) g->a[n + i] -= gravity;
  for (size_t i = 0; i < 2 * n; i++) g->v[i] += h * g->a[i];
}

static uint64_t drift(const game *g, bool tied, void *room, double *q, double *v) {
  const msri_obstacles all = {g->discs[tied], &g->supports, room};
  return msri_discs_drift(&all, h, g->v0, g->a, q, v, NULL);
}

/* ---- Against all pairs */

static bool meet(const game *g, size_t i, size_t j, bool overlaps_too) {
  const size_t n = g->n;
  const msri_vec from = {g->q0[j] - g->q0[i], g->q0[n + j] - g->q0[n + i]};
  const msri_vec way = {(g->q[j] - g->q0[j]) - (g->q[i] - g->q0[i]),
                        (g->q[n + j] - g->q0[n + j]) - (g->q[n + i] - g->q0[n + i])};
  const msri_disc_pair p = {.from = from, .path = way, .diameter = diameter};
  return msri_disc_pair_meets(&p) || (overlaps_too && hypot(from.x, from.y) < diameter + 1e-9);
}

static bool any_meet(const game *g, bool overlaps_too) {
  for (size_t i = 0; i < g->n; i++)
    for (size_t j = i + 1; j < g->n; j++)
      if (meet(g, i, j, overlaps_too) && !msri_ties_tied(&g->ties, i, j)) return true;
  return false;
}

/* Would free ways have met, without supports? */
static bool would_meet(game *g) {
  for (size_t i = 0; i < 2 * g->n; i++) g->q[i] = g->q0[i] + h * g->v0[i];
  return any_meet(g, true);
}

/* The same again, with other memory: the same bits. */
static void expect_same(game *g, bool tied, void *room, uint64_t count) {
  const size_t n = 2 * g->n;
  double *q = zeroed(n, sizeof *q), *v = zeroed(n, sizeof *v);
  memcpy(q, g->q, n * sizeof *q), memcpy(v, g->v, n * sizeof *v);
  memcpy(g->q, g->q0, n * sizeof *q), memcpy(g->v, g->v0, n * sizeof *v);
  assert_int_equal(drift(g, tied, room, g->q, g->v), count);
  assert_memory_equal(g->q, q, n * sizeof *q);
  assert_memory_equal(g->v, v, n * sizeof *v);
  free(q), free(v);
}

/* A drift: nobody meets in the end; where nobody would have met, nothing has changed; and neither
 * what is remembered of earlier ones nor what holds together changes a bit. */
static bool expect_sound(game *g, uint64_t *met) {
  const size_t n = 2 * g->n;
  memcpy(g->q0, g->q, n * sizeof *g->q), memcpy(g->v0, g->v, n * sizeof *g->v);
  const bool meets = would_meet(g);
  double *free_way = zeroed(n, sizeof *free_way);
  memcpy(free_way, g->q, n * sizeof *g->q), memcpy(g->q, g->q0, n * sizeof *g->q);
  const uint64_t count = drift(g, false, g->room[0], g->q, g->v);
  assert_false(any_meet(g, false));
  if (!meets && !g->supports.drift) {
    assert_int_equal(count, 0);
    assert_memory_equal(g->q, free_way, n * sizeof *g->q);
    assert_memory_equal(g->v, g->v0, n * sizeof *g->v);
  }
  free(free_way);
  void *fresh = zeroed(1, msri_discs_room(g->discs[0]));
  expect_same(g, false, fresh, count);
  expect_same(g, true, g->room[1], count);
  free(fresh);
  *met += count;
  return meets;
}

/* Bodies that fly, turn, shake, fold and meet, from slow to very fast. */
static void no_pair_is_missed(void **unused) {
  (void)unused;
  uint64_t dice = 23, met = 0, quiet = 0;
  const double speeds[] = {0.3, 3, 15, 25, 40, 120, 3000};
  for (int trial = 0; trial < 70; trial++) {
    const double restitution = trial % 2 ? 1 : 0.4;
    game g = game_of(&dice, speeds[trial % 7], restitution, trial % 5 == 4);
    if (trial % 4 == 3) add_floor(&g, restitution);
    for (int step = 0; step < 100; step++) {
      kick(&g, trial % 3 ? 0 : 50);
      quiet += !expect_sound(&g, &met);
    }
    free_game(&g);
  }
  assert_true(met > 1000 && quiet > 1000);
}

/* ---- What isn't looked at */

typedef struct place {
  size_t n;
  double *q;
  msri_ties ties;
  msri_bodies bodies;
  msri_lists lists;
  char *block;
} place;

/* Two blocks, side by side. */
static void put_two_blocks(place *p, size_t side, double apart) {
  const size_t n = 2 * side * side;
  *p = (place){.n = n, .q = zeroed(2 * n, sizeof(double))};
  msr_run_of_springs *run = zeroed(4 * n, sizeof *run);
  size_t runs = 0, size = 0, end = 0;
  for (size_t i = 0; i < n; i++) {
    const size_t block = i / (side * side), column = i % side, row = i / side % side;
    p->q[i] = (double)column + (double)block * apart, p->q[n + i] = (double)row;
    if (column > 0) run[runs++] = (msr_run_of_springs){i - 1, 1, 1, &one, &one, 0};
    if (row > 0) run[runs++] = (msr_run_of_springs){i - side, 1, side, &one, &one, 0};
  }
  const msr_springs springs = {.n = runs, .n_runs = runs, .run = run};
  const msr_view start = {.n = n, .x = p->q, .y = p->q + n, .springs = &springs};
  must(msri_ties_create(&start, 1, &p->ties, &why));
  must(msri_bodies_create(n, &p->ties, &p->bodies, &why));
  msri_lists_place(&p->bodies, 1, &p->ties, NULL, &size);
  p->block = zeroed(1, size);
  p->lists = msri_lists_place(&p->bodies, 1, &p->ties, p->block, &end);
  free(run);
}

static void free_place(place *p) {
  msri_ties_clear(&p->ties);
  msri_bodies_clear(&p->bodies);
  free(p->q);
  free(p->block);
}

static void drift_to(place *p, const double *q) {
  msri_displacement_measure(&p->bodies, p->q, q, p->lists.box);
  msri_lists_begin(&p->lists, p->q, p->q);
  msri_lists_cover_paths(&p->lists, p->q);
  msri_lists_end(&p->lists, p->q);
  memcpy(p->q, q, 2 * p->n * sizeof *q);
}

/* Two bodies turn and fly apart: the first lists are the last ones, and empty. */
static void what_moves_as_a_whole_is_listed_once(void **unused) {
  (void)unused;
  place p;
  put_two_blocks(&p, 20, 60);
  double *q = zeroed(2 * p.n, sizeof *q);
  const double c = cos(0.003), s = sin(0.003);
  for (int step = 0; step < 500; step++) {
    for (size_t i = 0; i < p.n; i++) {
      const double sign = i < p.n / 2 ? -1 : 1, x = p.q[i], y = p.q[p.n + i];
      q[i] = c * x - s * y + 0.2 * sign, q[p.n + i] = s * x + c * y;
    }
    drift_to(&p, q);
  }
  for (size_t b = 0; b < 2; b++) assert_true(p.lists.body[b].listed == 0);
  assert_int_equal(p.lists.kept->used, 0);
  free(q);
  free_place(&p);
}

/* Two large bodies beside each other: only pairs of the sides that face each other are listed. */
static void only_sides_that_face_are_listed(void **unused) {
  (void)unused;
  place p;
  put_two_blocks(&p, 50, 50.2);
  drift_to(&p, p.q);
  const size_t listed = p.lists.kept->used;
  assert_int_equal(listed, 50);
  for (size_t k = 0; k < listed; k++) {
    assert_int_equal(p.lists.pool[k].i % 50, 49);
    assert_int_equal(p.lists.pool[k].j % 50, 0);
  }
  free_place(&p);
}

/* ---- Bodies and motions */

static void bodies_are_what_is_tied(void **unused) {
  (void)unused;
  place p;
  put_two_blocks(&p, 5, 10);
  assert_int_equal(p.bodies.n, 2);
  for (size_t i = 0; i < p.n; i++) assert_int_equal(p.bodies.of[i], i / 25);
  uint32_t set[25];
  assert_int_equal(msri_bodies_masses(&p.bodies, 1, set), 25);
  for (uint32_t k = 0; k < 25; k++) assert_int_equal(set[k], 25 + k);
  free_place(&p);
  put_two_blocks(&p, 3, 10); // small ones are one
  assert_int_equal(p.bodies.n, 1);
  assert_int_equal(msri_bodies_masses(&p.bodies, 0, set), 18);
  free_place(&p);
}

/* Every way is within the spread of the body's; every distance within twice the change. */
static void motions_hold_for_every_mass(void **unused) {
  (void)unused;
  uint64_t dice = 7;
  for (int trial = 0; trial < 100; trial++) {
    place p;
    put_two_blocks(&p, 4 + random_below(&dice, 12), 30);
    const size_t n = p.n;
    double *q = zeroed(2 * n, sizeof *q);
    const double turn = uniform(&dice, -3, 3), c = cos(turn), s = sin(turn);
    const double noise = pow(10, uniform(&dice, -6, 1)), far = uniform(&dice, -1e3, 1e3);
    for (size_t i = 0; i < n; i++) {
      q[i] = c * p.q[i] - s * p.q[n + i] + far + uniform(&dice, -noise, noise);
      q[n + i] = s * p.q[i] + c * p.q[n + i] - far + uniform(&dice, -noise, noise);
    }
    msri_displacement_measure(&p.bodies, p.q, q, p.lists.box);
    for (size_t b = 0; b < 2; b++) {
      const msri_displacement m = msri_displacement_of(&p.lists.box[b]);
      const double change = msri_displacement_change(&p.bodies, b, p.q, q);
      assert_true(change <= 3 * noise + 1e-9); // the best turn leaves the noise, and rounding
      for (size_t i = b * n / 2; i < (b + 1) * n / 2; i++) {
        const double dx = q[i] - p.q[i] - m.path[0], dy = q[n + i] - p.q[n + i] - m.path[1];
        assert_true(hypot(dx, dy) <= m.spread);
        const size_t j = b * n / 2 + random_below(&dice, n / 2);
        const double before = hypot(p.q[i] - p.q[j], p.q[n + i] - p.q[n + j]);
        const double after = hypot(q[i] - q[j], q[n + i] - q[n + j]);
        assert_true(fabs(after - before) <= 2 * change + 1e-9);
      }
    }
    free(q);
    free_place(&p);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(no_pair_is_missed),
      cmocka_unit_test(what_moves_as_a_whole_is_listed_once),
      cmocka_unit_test(only_sides_that_face_are_listed),
      cmocka_unit_test(bodies_are_what_is_tied),
      cmocka_unit_test(motions_hold_for_every_mass),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
