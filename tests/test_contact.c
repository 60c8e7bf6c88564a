/* test_contact.c - supports, by both rules of impact: whatever its speed, a mass is never in
 * a support and never passes one; it comes back with the restitution and friction asked for; and it
 * neither heats nor sinks. Times and orders: test_impacts.c. */
#include "art.h"

#include "base/pixel.h"
#include "contacts/flock.h"
#include "plan/state.h"

#define PI 3.14159265358979323846

/* ---- Supports, and shots at them */

static uint64_t random_state;

static uint64_t draw_bits(void) {
  random_state = random_state * 6364136223846793005U + 1442695040888963407U;
  return random_state >> 33;
}

static size_t draw(size_t n) { return (size_t)draw_bits() % n; }

static double uniform(double from, double to) {
  return from + (to - from) * (double)draw_bits() / 0x1p31;
}

static const msr_impacts rules[] = {MSR_IMPACTS_KEPT, MSR_IMPACTS_LOCATED};

static msri_contact supports_of(const msr_picture *picture, bool closed, double restitution,
                                double friction, msr_impacts impacts) {
  const msri_supports_options options = {
      .closed = closed, .restitution = restitution, .friction = friction, .impacts = impacts};
  msri_contact contact;
  assert_int_equal(msri_supports_create(picture, &options, &contact, NULL), MSR_OK);
  return contact;
}

typedef struct mass {
  double q[2], v[2];
} mass;

/* Moves one mass by h times its velocity; returns the number of collisions. */
static uint64_t shoot(const msri_contact *contact, mass *m, double h) {
  const double u[2] = {m->v[0], m->v[1]};
  const msri_flock one = msri_flock_of(1, u, NULL, m->q, m->v);
  return contact->drift(contact->self, h, &one, NULL);
}

/* Along a path bent by a; or as a method does that reaches q, v + h a as if nothing was there; or
 * back to what it met first. */
static uint64_t shoot_bent(const msri_contact *contact, mass *m, double h, const double *a) {
  const double u[2] = {m->v[0], m->v[1]};
  const mass before = *m;
  msri_debt room;
  msri_debts list = {&room, 0, 1, MSR_OK}, *debts = draw(2) ? &list : NULL;
  const msri_flock one = msri_flock_of(1, u, a, m->q, m->v);
  if (draw(2)) return contact->drift(contact->self, h, &one, debts);
  for (int d = 0; d < 2; d++) {
    m->q[d] += h * u[d] + h * h * a[d] / 2;
    m->v[d] += h * a[d];
  }
  if (contact->strike && draw(2)) return contact->strike(contact->self, 1, before.q, m->q, m->v);
  return contact->bounce(contact->self, 1, h, before.q, before.v, m->q, m->v, debts);
}

/* ---- Regions: cells that a path through air joins, in a picture with a ring around it */

enum { MOST_SIDE = 40, MOST_CELLS = (MOST_SIDE + 2) * (MOST_SIDE + 2) };

typedef struct regions {
  size_t width, height;  /* with the ring */
  int label[MOST_CELLS]; /* 0: support */
} regions;

static void fill(regions *r, size_t cell, int label) {
  static size_t stack[4 * MOST_CELLS];
  size_t n = 0;
  stack[n++] = cell;
  while (n > 0) {
    const size_t c = stack[--n], column = c % r->width, row = c / r->width;
    if (r->label[c] != -1) continue;
    r->label[c] = label;
    if (column > 0) stack[n++] = c - 1;
    if (column + 1 < r->width) stack[n++] = c + 1;
    if (row > 0) stack[n++] = c - r->width;
    if (row + 1 < r->height) stack[n++] = c + r->width;
  }
}

/* Rows from the bottom; the ring is air if the border is open. */
static void find_regions(const msr_picture *p, bool closed, regions *r) {
  r->width = p->width + 2;
  r->height = p->height + 2;
  for (size_t c = 0; c < r->width * r->height; c++) {
    const size_t column = c % r->width, row = c / r->width;
    const bool inside = column > 0 && column <= p->width && row > 0 && row <= p->height;
    const bool solid =
        inside ? msri_pixel_at(p, column - 1, p->height - row) == MSRI_SUPPORT : closed;
    r->label[c] = solid ? 0 : -1;
  }
  int labels = 0;
  for (size_t c = 0; c < r->width * r->height; c++)
    if (r->label[c] == -1) fill(r, c, ++labels);
}

static size_t cell_of(double at, size_t side) {
  return at < 0 ? 0 : at < (double)(side - 2) ? (size_t)at + 1 : side - 1;
}

static int region_at(const regions *r, const double q[2]) {
  return r->label[cell_of(q[1], r->height) * r->width + cell_of(q[0], r->width)];
}

/* Shoots and looks where the mass comes to, move after move; every other one is bent. */
static void assert_kept_in_region(const msri_contact *contact, const regions *r, mass m, double h,
                                  int moves) {
  const int region = region_at(r, m.q);
  assert_true(region > 0);
  const mass start = m;
  for (int i = 0; i < moves; i++) {
    const double most = pow(10, uniform(-2, 4)) * hypot(m.v[0], m.v[1]);
    const double a[2] = {uniform(-most, most), uniform(-most, most)};
    if (i % 2)
      shoot_bent(contact, &m, h, a);
    else
      shoot(contact, &m, h);
    if (!isfinite(m.q[0]) || !isfinite(m.q[1])) return;
    if (region_at(r, m.q) == region) continue;
    print_error("from (%.17g, %.17g) at (%g, %g): in (%.17g, %.17g) after %d moves\n", start.q[0],
                start.q[1], start.v[0], start.v[1], m.q[0], m.q[1], i + 1);
    fail();
  }
}

/* ---- Tunnelling */

static const char *const walls[] = {
    "........#........\n"
    "........#........\n"
    "........#........\n"
    "........#........\n"
    "........#........\n",
    "#########\n"
    "#.......#\n"
    "#.......#\n"
    "#.......#\n"
    "#########\n",
    "#........\n"
    ".#.......\n"
    "..#......\n"
    "...#.....\n"
    "....#....\n"
    ".....#...\n"
    "......#..\n",
    ".........#\n"
    ".......##.\n"
    ".....##...\n"
    "...##.....\n"
    ".##.......\n"
    "#.........\n",
    "####.####\n"
    "#.......#\n"
    "#.#.#.#.#\n"
    "#..#.#..#\n"
    "####.####\n",
    "##########\n"
    ".........#\n"
    "########.#\n"
    "#........#\n"
    "#.########\n",
    "#.#.#.#.#\n"
    ".#.#.#.#.\n"
    "#.#.#.#.#\n",
    "#\n"
    ".\n"
    "#\n"
    ".\n",
    "..#.#\n",
};

static const double speeds[] = {1, 10, 1e2, 1e3, 1e4, 1e5, 1e6, 1e12, 1e100, DBL_MAX};

/* From the centre of every pixel of air, in 48 directions, at every speed. */
static void no_speed_passes_a_wall(void **unused) {
  (void)unused;
  enum { DIRECTIONS = 48, MOVES = 12 };
  static regions r;
  for (size_t w = 0; w < 4 * LENGTH(walls); w++) {
    msr_picture *picture = paint(walls[w / 4]);
    const bool closed = w % 2;
    const msri_contact contact = supports_of(picture, closed, 1, 0, rules[w / 2 % 2]);
    find_regions(picture, closed, &r);
    for (size_t p = 0; p < picture->width * picture->height; p++) {
      const size_t column = p % picture->width, row = p / picture->width;
      if (msri_pixel_at(picture, column, row) == MSRI_SUPPORT) continue;
      for (int d = 0; d < DIRECTIONS; d++) {
        const double angle = 2 * PI * d / DIRECTIONS, speed = speeds[draw(LENGTH(speeds))];
        const mass m = {{(double)column + 0.5, (double)(picture->height - row) - 0.5},
                        {speed * cos(angle), speed * sin(angle)}};
        assert_kept_in_region(&contact, &r, m, 0.005, MOVES);
      }
    }
    contact.release(contact.self);
    msr_picture_free(picture);
  }
}

static msr_picture *random_picture(void) {
  msr_picture *picture;
  const size_t width = 1 + draw(MOST_SIDE), height = 1 + draw(MOST_SIDE), share = 1 + draw(60);
  must(msr_picture_create(width, height, &picture, &why));
  for (size_t p = 0; p < width * height; p++)
    if (draw(100) < share) memset(picture->rgb + 3 * p, 0, 3);
  return picture;
}

/* Anywhere, on the edges of pixels too, and from outside if the border is open. */
static bool random_mass(const msr_picture *p, bool closed, const regions *r, mass *m) {
  const double margin = closed ? 0 : 3, speed = pow(10, uniform(0, 6)), angle = uniform(0, 2 * PI);
  *m = (mass){
      {uniform(-margin, (double)p->width + margin), uniform(-margin, (double)p->height + margin)},
      {speed * cos(angle), speed * sin(angle)}};
  if (draw(4) == 0) m->q[0] = floor(m->q[0]);
  if (draw(4) == 0) m->q[1] = floor(m->q[1]);
  if (draw(8) == 0) m->v[draw(2)] = 0;
  return region_at(r, m->q) > 0;
}

static void random_shots_stay_in_their_region(void **unused) {
  (void)unused;
  enum { PICTURES = 200, SHOTS = 100, MOVES = 12 };
  static regions r;
  size_t shots = 0;
  for (size_t i = 0; i < PICTURES; i++) {
    msr_picture *picture = random_picture();
    const bool closed = draw(2);
    const msri_contact contact = supports_of(picture, closed, draw(2) ? 1 : uniform(0, 1),
                                             draw(2) ? 0 : uniform(0, 1), rules[i % 2]);
    find_regions(picture, closed, &r);
    for (size_t s = 0; s < SHOTS; s++) {
      mass m;
      if (!random_mass(picture, closed, &r, &m)) continue;
      assert_kept_in_region(&contact, &r, m, 0.005, MOVES);
      shots++;
    }
    contact.release(contact.self);
    msr_picture_free(picture);
  }
  assert_true(shots > PICTURES * SHOTS / 4); // and half of them by each rule
}

/* ---- A walker that looks at one cell after the other */

static bool walker_blocked(const regions *r, double from, double to, double across, bool along_x) {
  const double step = to > from ? 1 : -1, edge = (double)(along_x ? r->width : r->height);
  for (double cell = floor(from); cell != floor(to);) {
    cell += step;
    if (cell < -2 || cell > edge) return false;
    const double q[2] = {along_x ? cell + 0.5 : across, along_x ? across : cell + 0.5};
    if (region_at(r, q) == 0) return true;
  }
  return false;
}

/* Kept: every move is the assignment's rule, x then y, with every cell on the way looked at. */
static void moves_as_a_walker_does(void **unused) {
  (void)unused;
  static regions r;
  for (size_t i = 0; i < 60; i++) {
    msr_picture *picture = random_picture();
    const msri_contact contact = supports_of(picture, false, 1, 0, MSR_IMPACTS_KEPT);
    find_regions(picture, false, &r);
    for (size_t s = 0; s < 100; s++) {
      mass m;
      if (!random_mass(picture, false, &r, &m)) continue;
      const double h = 10 / hypot(m.v[0], m.v[1]); // px of way, so that walking ends
      mass due = m;
      const double to_x = m.q[0] + h * m.v[0], to_y = m.q[1] + h * m.v[1];
      const bool hit_x = walker_blocked(&r, m.q[0], to_x, m.q[1], true);
      if (hit_x) due.v[0] = -m.v[0];
      if (!hit_x) due.q[0] = to_x;
      const bool hit_y = walker_blocked(&r, m.q[1], to_y, due.q[0], false);
      if (hit_y) due.v[1] = -m.v[1];
      if (!hit_y) due.q[1] = to_y;
      assert_int_equal(shoot(&contact, &m, h), hit_x + hit_y);
      assert_memory_equal(&m, &due, sizeof m);
    }
    contact.release(contact.self);
    msr_picture_free(picture);
  }
}

/* ---- Single cases */

static void boxed_in_stays(void **unused) {
  (void)unused;
  for (size_t rule = 0; rule < LENGTH(rules); rule++) {
    msr_picture *box = paint(".#.\n#.#\n.#.\n");
    const msri_contact contact = supports_of(box, false, 1, 0, rules[rule]);
    for (int i = 0; i < 10000; i++) {
      mass m = {{uniform(1, 2), uniform(1, 2)}, {uniform(-1e6, 1e6), uniform(-1e6, 1e6)}};
      for (int n = 0; n < 3; n++) shoot(&contact, &m, 0.005);
      assert_true(floor(m.q[0]) == 1 && floor(m.q[1]) == 1);
    }
    contact.release(contact.self);
    msr_picture_free(box);
  }
}

/* Along a wall, on the very edge of its pixels, nothing is met. */
static void grazing_meets_nothing(void **unused) {
  (void)unused;
  static const mass grazing[] = {
      {{0.5, 1}, {100, 0}},                   // on the floor's top edge
      {{0.5, 0x1.fffffffffffffp1}, {1e6, 0}}, // just under the ceiling
      {{9.5, 1}, {-1e6, 0}},
      {{1, 1}, {100, 0}},
  };
  for (size_t rule = 0; rule < LENGTH(rules); rule++) {
    msr_picture *corridor = paint("##########\n..........\n..........\n..........\n##########\n");
    const msri_contact contact = supports_of(corridor, false, 1, 0, rules[rule]);
    for (size_t i = 0; i < LENGTH(grazing); i++) {
      mass m = grazing[i];
      assert_int_equal(shoot(&contact, &m, 0.005), 0);
      assert_true(m.q[0] == grazing[i].q[0] + 0.005 * grazing[i].v[0]);
      assert_memory_equal(m.v, grazing[i].v, sizeof m.v);
    }
    mass down = {{0.5, 1}, {0, -0.001}}; // a pixel owns its lower and left edges, not the others
    assert_int_equal(shoot(&contact, &down, 0.005), 1);
    mass up = {{0.5, 3.9990234375}, {0, 0.25}}; // exactly to the ceiling's lower edge
    assert_int_equal(shoot(&contact, &up, 0.00390625), 1);
    assert_true(down.q[1] >= 1 && down.v[1] == 0.001 && up.q[1] < 4 && up.v[1] == -0.25);
    contact.release(contact.self);
    msr_picture_free(corridor);
  }
}

/* In a corridor one pixel wide with a bend, at any speed: in and out again, but never through. */
static void narrow_corridors_hold(void **unused) {
  (void)unused;
  static regions r;
  for (size_t rule = 0; rule < LENGTH(rules); rule++) {
    msr_picture *corridor = paint("#####\n"
                                  "#...#\n"
                                  "###.#\n"
                                  "#...#\n"
                                  "#.###\n");
    const msri_contact contact = supports_of(corridor, true, 1, 0, rules[rule]);
    find_regions(corridor, true, &r);
    for (int i = 0; i < 1000; i++) {
      const double speed = pow(10, uniform(0, 6)), angle = uniform(0, 2 * PI);
      const mass m = {{uniform(1, 4), 3.5}, {speed * cos(angle), speed * sin(angle)}};
      assert_kept_in_region(&contact, &r, m, 0.005, 20);
    }
    contact.release(contact.self);
    msr_picture_free(corridor);
  }
}

/* Coulomb: the speed along the wall loses at most friction times the normal impulse. */
static void reflects_with_restitution_and_friction(void **unused) {
  (void)unused;
  msr_picture *floor_ = paint(".....\n.....\n#####\n");
  for (int i = 0; i < 2000; i++) {
    const double e = i % 3 ? uniform(0, 1) : 1, mu = i % 4 ? uniform(0, 2) : 0;
    const bool kept = i % 2;
    const msri_contact contact =
        supports_of(floor_, false, e, mu, kept ? MSR_IMPACTS_KEPT : MSR_IMPACTS_LOCATED);
    const double vx = uniform(-100, 100), vy = -uniform(100, 1000);
    mass m = {{2.5, 1.25}, {vx, vy}};
    assert_int_equal(shoot(&contact, &m, 0.005), 1);
    const double impulse = m.v[1] - vy, most = mu * impulse, t = -0.25 / vy;
    assert_true(m.v[1] == -e * vy);
    // 4 eps: a quotient, products and sums of numbers up to 3
    assert_true(fabs(m.q[1] - (kept ? 1.25 : 1 + m.v[1] * (0.005 - t))) <= 4 * 3 * DBL_EPSILON);
    assert_true(m.v[0] * vx >= 0 && fabs(m.v[0]) <= fabs(vx)); // never backwards
    // sliding or sticking; 4 eps: one product and one difference
    if (fabs(vx) > most)
      assert_true(fabs(fabs(vx) - fabs(m.v[0]) - most) <= 4 * DBL_EPSILON * fabs(vx));
    else
      assert_true(m.v[0] == 0);
    contact.release(contact.self);
  }
  msr_picture_free(floor_);
}

/* A mass that already leaves isn't turned back; a mass at rest stays so. */
static void only_what_approaches_is_reflected(void **unused) {
  (void)unused;
  msr_picture *wall = paint(".#\n");
  for (size_t rule = 0; rule < LENGTH(rules); rule++) {
    const msri_contact contact = supports_of(wall, false, 1, 0, rules[rule]);
    const double u[2] = {200, 0}; // a mean velocity that isn't v
    double q[2] = {0.5, 0.5}, v[2] = {-3, 0};
    const msri_flock one = msri_flock_of(1, u, NULL, q, v);
    assert_int_equal(contact.drift(contact.self, 0.005, &one, NULL), 1);
    assert_true(v[0] == -3 && (rules[rule] == MSR_IMPACTS_KEPT ? q[0] == 0.5 : q[0] < 1));
    contact.release(contact.self);
  }
  msr_picture_free(wall);
}

static void closed_border_is_never_left(void **unused) {
  (void)unused;
  static const char *const arts[] = {".\n", "..........\n", ".\n.\n.\n.\n", "....\n....\n....\n"};
  for (size_t a = 0; a < 2 * LENGTH(arts); a++) {
    msr_picture *p = paint(arts[a / 2]);
    const msri_contact contact = supports_of(p, true, 1, 0, rules[a % 2]);
    for (int i = 0; i < 2000; i++) {
      const double speed = speeds[draw(LENGTH(speeds))], angle = uniform(0, 2 * PI);
      mass m = {{uniform(0, (double)p->width), uniform(0, (double)p->height)},
                {speed * cos(angle), speed * sin(angle)}};
      for (int n = 0; n < 10; n++) shoot(&contact, &m, 0.005);
      assert_true(m.q[0] >= 0 && m.q[0] < (double)p->width);
      assert_true(m.q[1] >= 0 && m.q[1] < (double)p->height);
    }
    contact.release(contact.self);
    msr_picture_free(p);
  }
}

static void open_border_lets_out_and_in(void **unused) {
  (void)unused;
  msr_picture *p = paint("...#\n...#\n");
  for (size_t rule = 0; rule < LENGTH(rules); rule++) {
    const bool kept = rules[rule] == MSR_IMPACTS_KEPT;
    const msri_contact contact = supports_of(p, false, 1, 0, rules[rule]);
    mass m = {{1.5, 1.5}, {-1000, 0}};
    shoot(&contact, &m, 0.005);
    assert_true(m.q[0] == -3.5);
    m.v[0] = 1000; // back, through the border, to the wall
    assert_int_equal(shoot(&contact, &m, 0.005), 0);
    assert_int_equal(shoot(&contact, &m, 0.005), 1);
    assert_true(m.v[0] == -1000);
    // located, 1.5 px to the wall and 3.5 px back; 16 eps: of quotient, products and sums up to 5
    assert_true(fabs(m.q[0] - (kept ? 1.5 : -0.5)) <= 16 * DBL_EPSILON);
    mass outside = {{6.5, 0.5}, {-1000, 0}}; // hits the wall's other side
    assert_int_equal(shoot(&contact, &outside, 0.005), 1);
    assert_true(outside.v[0] == 1000);
    assert_true(fabs(outside.q[0] - 6.5) <= 16 * DBL_EPSILON); // as far back as it came
    mass over = {{6.5, 2.5}, {-1000, 0}};                      // passes above the picture
    assert_int_equal(shoot(&contact, &over, 0.005), 0);
    contact.release(contact.self);
  }
  msr_picture_free(p);
}

/* Kept: in a box, with numbers on a binary grid so that nothing is rounded, v -> -v retraces the
 * path. */
static void retraces_its_path(void **unused) {
  (void)unused;
  msr_picture *box = paint("########\n#......#\n#......#\n#......#\n########\n");
  const msri_contact contact = supports_of(box, false, 1, 0, MSR_IMPACTS_KEPT);
  for (int i = 0; i < 1000; i++) {
    const mass start = {{1 + (double)draw(6 << 8) / 256, 1 + (double)draw(3 << 8) / 256},
                        {(double)draw(8192) - 4096, (double)draw(8192) - 4096}};
    mass m = start;
    uint64_t hits = 0;
    for (int n = 0; n < 100; n++) hits += shoot(&contact, &m, 0x1p-8);
    m.v[0] *= -1, m.v[1] *= -1;
    for (int n = 0; n < 100; n++) hits -= shoot(&contact, &m, 0x1p-8);
    m.v[0] *= -1, m.v[1] *= -1;
    assert_true(m.q[0] == start.q[0] && m.q[1] == start.q[1]);
    assert_true(m.v[0] == start.v[0] && m.v[1] == start.v[1]);
    assert_int_equal(hits, 0);
  }
  contact.release(contact.self);
  msr_picture_free(box);
}

/* No crash and no endless loop; the guard is there to tell of them. */
static void survives_what_is_no_number(void **unused) {
  (void)unused;
  static const double odd[] = {NO_NUMBER, INFINITE, -INFINITE, DBL_MAX,
                               -DBL_MAX,  -0.0,     1.5,       DBL_TRUE_MIN};
  msr_picture *p = paint("#.#\n...\n#.#\n");
  for (int border = 0; border < 4; border++) {
    const bool closed = border / 2;
    const msri_contact contact = supports_of(p, closed, 0.5, 0.5, rules[border % 2]);
    for (size_t i = 0; i < LENGTH(odd) * LENGTH(odd) * LENGTH(odd) * LENGTH(odd); i++) {
      size_t n = i;
      double number[4];
      for (int k = 0; k < 4; k++, n /= LENGTH(odd)) number[k] = odd[n % LENGTH(odd)];
      mass m = {{number[0], number[1]}, {number[2], number[3]}};
      for (int k = 0; k < 3; k++) shoot(&contact, &m, k ? 0.005 : 10);
      if (isfinite(number[0])) continue;
      assert_true(!isfinite(m.q[0])); // nothing that was no number becomes one
    }
    contact.release(contact.self);
  }
  msr_picture_free(p);
}

/* ---- In a simulation */

typedef struct setting {
  const char *art;
  msr_conf conf;
  msr_scene_options options;
  double restitution, friction, damping;
} setting;

static world build(const setting *s, const msr_integrator *integrator, msr_impacts impacts) {
  msr_scene *scene = scene_of(s->art, &s->conf, &s->options);
  must(msr_scene_set_contact(scene, s->restitution, s->friction, &why));
  if (s->damping > 0) add_force(scene, &msr_force_damping, &(msr_damping){s->damping});
  return open_world_with(scene, &(msr_plan_options){.integrator = integrator, .impacts = impacts});
}

#define DROP                                                                                       \
  "............\n"                                                                                 \
  "....oooo....\n"                                                                                 \
  "....oooo....\n"                                                                                 \
  "............\n"                                                                                 \
  "............\n"                                                                                 \
  "............\n"                                                                                 \
  "#..........#\n"                                                                                 \
  "############\n"

static const msr_conf usual = {0.005, 9.8, 0.1, 1500, 1, 1};

/* Elastic and undamped, a block neither gains nor loses: measured within 1 % over 200 s at the
 * library's own step; the bound is five times that. */
static void bounces_keep_their_energy(void **unused) {
  (void)unused;
  const setting s = {DROP, usual, {0}, 1, 0, 0};
  for (size_t rule = 0; rule < LENGTH(rules); rule++) {
    world w = build(&s, NULL, rules[rule]);
    const double start = msr_state_energy(w.state).total;
    const double scale = 8 * 0.1 * 9.8 * 4; // what falling 4 px gives 8 masses
    double worst = 0;
    for (int i = 0; i < 200; i++) {
      advance(&w, 200);
      worst = fmax(worst, fabs(msr_state_energy(w.state).total - start));
    }
    assert_true(msr_state_contacts(w.state) > 100);
    if (worst > 0.05 * scale) fail_msg("the energy went %g %% astray", 100 * worst / scale);
    close_world(w);
  }
}

/* A mass alone bounces for ever to the height that it fell from: kept, each bounce moves it by at
 * most the way of one step, g t h; located, the height is met to the g h^2 / 8 that a step misses
 * it by, and so is the floor but for one step's way. */
static void a_mass_alone_bounces_for_ever(void **unused) {
  (void)unused;
  const setting s = {".\no\n.\n.\n.\n.\n#\n", usual, {0}, 1, 0, 0};
  for (size_t rule = 0; rule < LENGTH(rules); rule++) {
    world w = build(&s, NULL, rules[rule]);
    double highest = 0, lowest = 7;
    for (int i = 0; i < 10000; i++) {
      advance(&w, 1);
      const double y = msr_state_view(w.state).y[0];
      highest = fmax(highest, y), lowest = fmin(lowest, y);
    }
    const double h = 0.005, fall = 4.5, way = sqrt(2 * 9.8 * fall) * h;
    const double miss = rules[rule] == MSR_IMPACTS_KEPT ? 2 * way : 9.8 * h * h / 8;
    assert_true(lowest >= 1 && lowest < 1 + way);
    assert_true(fabs(highest - 5.5) < miss);
    assert_in_range(msr_state_contacts(w.state), 20, 40); // 50 s of 1.92 s each
    close_world(w);
  }
}

/* Without restitution, and with damping along and across, a block lies down and stays. */
static void a_damped_block_comes_to_rest(void **unused) {
  (void)unused;
  const setting s = {DROP, usual, {.neighbours = 8}, 0, 0.5, 0.5};
  for (size_t rule = 0; rule < LENGTH(rules); rule++) {
    world w = build(&s, NULL, rules[rule]);
    advance(&w, 6000);
    double before[16];
    memcpy(before, msr_state_view(w.state).x, sizeof before);
    advance(&w, 2000);
    const double *now = msr_state_view(w.state).x;
    for (int i = 0; i < 16; i++) assert_true(fabs(now[i] - before[i]) < 1e-6);
    // at rest a step of gravity alone is under way: v = g h at most
    assert_true(msr_state_energy(w.state).kinetic < 8 * 0.1 * pow(9.8 * 0.005, 2));
    close_world(w);
  }
}

static void assert_stays_outside(const setting *s, const msr_integrator *integrator,
                                 msr_impacts impacts, const regions *r) {
  world w = build(s, integrator, impacts);
  for (int n = 0; n < 1000; n++) {
    const msr_status status = msr_state_step(w.state, 1, NULL);
    if (status == MSR_EUNSTABLE && integrator->stability == 0) break;
    assert_int_equal(status, MSR_OK);
    const msr_view view = msr_state_view(w.state);
    for (size_t k = 0; k < view.n; k++)
      assert_true(region_at(r, (const double[2]){view.x[k], view.y[k]}) > 0);
  }
  assert_true(msr_state_contacts(w.state) > 0);
  close_world(w);
}

/* What a method drifts by is its own affair: none may end in a support. */
static void every_integrator_stays_outside(void **unused) {
  (void)unused;
  static regions r;
  static const setting s = {"#..oooo...#\n"
                            "#..oooo...#\n"
                            "#.........#\n"
                            "#.#..#..#.#\n"
                            "#.........#\n"
                            "###########\n",
                            {0.005, 50, 0.1, 1500, 1, 1},
                            {0},
                            1,
                            0.2,
                            0};
  msr_picture *picture = paint(s.art);
  find_regions(picture, false, &r);
  for (size_t n = 0; n < LENGTH(rules); n++)
    for (const msr_integrator *const *i = msr_integrators; *i; i++)
      assert_stays_outside(&s, *i, rules[n], &r);
  msr_picture_free(picture);
}

/* Supports and border in a corner: the same wall twice is one wall. */
static void supports_beside_the_border(void **unused) {
  (void)unused;
  const setting s = {"#.o.#\n", {0.005, 0, 0.1, 0, 1, 1}, {.closed_border = true}, 1, 0, 0};
  for (size_t rule = 0; rule < LENGTH(rules); rule++) {
    world w = build(&s, NULL, rules[rule]);
    msr_state_edit(w.state).vx[0] = 1000;
    advance(&w, 1000);
    const msr_view view = msr_state_view(w.state);
    assert_true(view.x[0] >= 1 && view.x[0] < 4 && view.y[0] == 0.5);
    assert_true(fabs(view.vx[0]) == 1000);
    close_world(w);
  }
}

/* No black pixel and an open border: nothing of contacts is there to be called. */
static void absent_contacts_leave_no_code(void **unused) {
  (void)unused;
  static const struct row {
    const char *art;
    bool closed, any;
  } rows[] = {
      {"oo\n", false, false}, {"oo\n", true, true},  {"o#\n", false, true},
      {".#\n", false, false}, {"..\n", true, false},
  };
  for (size_t i = 0; i < LENGTH(rows); i++) {
    const setting s = {rows[i].art, usual, {.closed_border = rows[i].closed}, 1, 0, 0};
    world w = build(&s, NULL, rules[i % 2]);
    assert_int_equal(w.plan->contact.drift != NULL, rows[i].any);
    assert_int_equal(msri_state_system(w.state).drift != NULL, rows[i].any);
    close_world(w);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(no_speed_passes_a_wall),
      cmocka_unit_test(random_shots_stay_in_their_region),
      cmocka_unit_test(moves_as_a_walker_does),
      cmocka_unit_test(boxed_in_stays),
      cmocka_unit_test(grazing_meets_nothing),
      cmocka_unit_test(narrow_corridors_hold),
      cmocka_unit_test(reflects_with_restitution_and_friction),
      cmocka_unit_test(only_what_approaches_is_reflected),
      cmocka_unit_test(closed_border_is_never_left),
      cmocka_unit_test(open_border_lets_out_and_in),
      cmocka_unit_test(retraces_its_path),
      cmocka_unit_test(survives_what_is_no_number),
      cmocka_unit_test(bounces_keep_their_energy),
      cmocka_unit_test(a_mass_alone_bounces_for_ever),
      cmocka_unit_test(a_damped_block_comes_to_rest),
      cmocka_unit_test(every_integrator_stays_outside),
      cmocka_unit_test(supports_beside_the_border),
      cmocka_unit_test(absent_contacts_leave_no_code),
  };
  return cmocka_run_group_tests_name("contact", tests, NULL, NULL);
}
