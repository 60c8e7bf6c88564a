/* test_lattice.c - the kernels of forces/lattice.h, each width of them, against a loop over
 * springs, one after the other: the same bits. Those that this machine hasn't got are left out. */
#include "forces/lattice.h"

#include "scenes.h"

enum { AROUND = 16, CELLS = 80, SIZE = CELLS + 2 * AROUND, BLOCKS = CELLS / MSRI_LANES };

/* Cells, what is around them and, for each way, forces from above and to below. */
typedef struct row {
  double x[SIZE], y[SIZE], vx[SIZE], vy[SIZE], below_x[SIZE], below_y[SIZE];
  double above[MSRI_WAYS][2][SIZE], below[MSRI_WAYS][2][SIZE];
  bool mass[SIZE], tie[MSRI_WAYS][SIZE], tied[MSRI_WAYS][SIZE];
  msri_block block[BLOCKS];
  size_t n, blocks;
} row;

static void fill(double *array, double from, double to, uint64_t *dice) {
  for (size_t c = 0; c < SIZE; c++) array[c] = uniform(dice, from, to);
}

/* Masses in most cells, but for whole blocks here and there, and springs between most of them. */
static void fill_springs(row *r, uint64_t *dice) {
  const size_t empty = random_below(dice, 2 * BLOCKS);
  for (size_t c = AROUND; c < AROUND + r->n; c++)
    r->mass[c] = (c - AROUND) / MSRI_LANES != empty && random_below(dice, 8) > 0;
  for (size_t c = AROUND; c < AROUND + r->n; c++)
    for (int way = 0; way < MSRI_WAYS; way++) {
      const bool may = r->mass[c] && (way != MSRI_RIGHT || r->mass[c + 1]);
      r->tie[way][c] = may && random_below(dice, 4) > 0;
      r->tied[way][c] = r->mass[c] && random_below(dice, 4) > 0;
    }
}

static uint8_t bits_of(const bool *is) {
  unsigned bits = 0;
  for (int n = 0; n < 8; n++) bits |= (unsigned)is[n] << n;
  return (uint8_t)bits;
}

static bool is_listed(const row *r, size_t c) {
  return bits_of(r->mass + c / MSRI_LANES * MSRI_LANES) != 0;
}

/* Lists blocks, which begin where arrays do; in these, cells without a mass are 0. */
static void list(row *r) {
  r->blocks = 0;
  for (size_t c = AROUND; c < AROUND + r->n; c += MSRI_LANES) {
    msri_block b = {(uint32_t)(c - AROUND), bits_of(r->mass + c), {0}, {0}};
    for (int way = 0; way < MSRI_WAYS; way++) {
      b.tie[way] = bits_of(r->tie[way] + c);
      b.tied[way] = bits_of(r->tied[way] + c);
    }
    if (b.mass) r->block[r->blocks++] = b;
  }
  for (size_t c = AROUND; c < AROUND + r->n; c++)
    if (!r->mass[c] && is_listed(r, c)) r->x[c] = r->y[c] = r->vx[c] = r->vy[c] = 0;
}

static void fill_row(row *r, size_t n, uint64_t *dice) {
  *r = (row){.n = n};
  fill(r->x, 0, 3, dice), fill(r->y, 0, 3, dice);
  fill(r->vx, -2, 2, dice), fill(r->vy, -2, 2, dice);
  fill(r->below_x, 0, 3, dice), fill(r->below_y, 0, 3, dice);
  for (int way = 0; way < MSRI_WAYS; way++)
    for (int axis = 0; axis < 2; axis++) {
      fill(r->above[way][axis], -1, 1, dice);
      fill(r->below[way][axis], -1, 1, dice);
    }
  fill_springs(r, dice);
  list(r);
}

static msri_motion motion_of(uint64_t *dice) {
  msri_motion m = {.k = uniform(dice, 1, 50),
                   .L = {1, sqrt(2)},
                   .w = uniform(dice, 1, 10),
                   .drift = uniform(dice, 0, 0.1)};
  for (int n = 0; n < 2; n++) {
    m.weight[n] = uniform(dice, -5, 5);
    m.kick[n] = uniform(dice, -0.1, 0.1);
    m.keep[n] = uniform(dice, 0, 1);
    for (int axis = 0; axis < 2; axis++) m.push[n][axis] = uniform(dice, -4, 4);
  }
  return m;
}

static msri_cells cells_of(row *r) {
  msri_cells s = {.n = r->n,
                  .x = r->x + AROUND,
                  .y = r->y + AROUND,
                  .vx = r->vx + AROUND,
                  .vy = r->vy + AROUND,
                  .below_x = r->below_x + AROUND,
                  .below_y = r->below_y + AROUND,
                  .block = r->block,
                  .blocks = r->blocks};
  for (int way = 0; way < MSRI_WAYS; way++) {
    s.pull[way] = (msri_pull){r->below[way][0] + AROUND, r->below[way][1] + AROUND};
    s.back[way] = r->above[way][0] - r->below[way][0];
  }
  return s;
}

/* ---- One spring after the other */

typedef struct force {
  double x, y;
} force;

static force force_of(bool is, double k, double L, double dx, double dy) {
  const double l = sqrt(dx * dx + dy * dy);
  if (!is || l <= 0) return (force){0, 0};
  const double f = k * (l - L) / l;
  return (force){f * dx, f * dy};
}

static force right_of(const row *r, const msri_motion *m, size_t c) {
  return force_of(r->tie[MSRI_RIGHT][c], m->k, m->L[0], r->x[c + 1] - r->x[c],
                  r->y[c + 1] - r->y[c]);
}

static force below_of(const row *r, const msri_motion *m, size_t c, int way) {
  static const ptrdiff_t shift[] = {[MSRI_BELOW_LEFT] = -1, [MSRI_BELOW_RIGHT] = 1};
  const size_t to = c + (size_t)shift[way];
  return force_of(r->tie[way][c], m->k, m->L[way != MSRI_BELOW], r->below_x[to] - r->x[c],
                  r->below_y[to] - r->y[c]);
}

/* ax, ay [SIZE], and the forces to below, by the places as they are. */
static void accelerate(row *r, const msri_motion *m, int ways, int besides, double *ax,
                       double *ay) {
  for (size_t c = AROUND; c < AROUND + r->n; c++) {
    double x = 0, y = 0;
    if (!is_listed(r, c)) continue;
    for (int way = MSRI_BELOW; way < ways; way++)
      if (r->tied[way][c]) x -= r->above[way][0][c], y -= r->above[way][1][c];
    const force left = right_of(r, m, c - 1), right = right_of(r, m, c);
    x = x - left.x + right.x, y = y - left.y + right.y;
    for (int way = MSRI_BELOW; way < ways; way++) {
      const force f = below_of(r, m, c, way);
      x += f.x, y += f.y;
      r->below[way][0][c] = f.x, r->below[way][1][c] = f.y;
    }
    if (besides & MSRI_WITH_WEIGHT) x += m->weight[0], y += m->weight[1];
    ax[c] = x * m->w, ay[c] = y * m->w;
  }
}

static double moved(const msri_motion *m, int axis, int besides, double a, double *at, double *v) {
  *v += m->kick[0] * a;
  for (int n = 0; n < 2 && besides & MSRI_WITH_AIR; n++) {
    *v *= m->keep[n];
    if (besides & MSRI_WITH_PUSH) *v += m->push[n][axis];
  }
  *v += m->kick[1] * a;
  *at += m->drift * *v;
  return fabs(*v);
}

static double advance_cells(row *r, const msri_motion *m, int ways, int besides) {
  double ax[SIZE], ay[SIZE], fastest = 0;
  accelerate(r, m, ways, besides, ax, ay);
  for (size_t c = AROUND; c < AROUND + r->n; c++) {
    if (!r->mass[c]) continue;
    fastest = fmax(fastest, moved(m, 0, besides, ax[c], r->x + c, r->vx + c));
    fastest = fmax(fastest, moved(m, 1, besides, ay[c], r->y + c, r->vy + c));
  }
  return fastest;
}

/* ---- The kernels */

/* The n-th that runs here, or NULL. */
static const msri_lattice_kernel *kernel_here(size_t n) {
  const msri_lattice_kernel *k = msri_lattice_kernels;
  for (;; k++) {
    const bool runs = !k->runs_here || k->runs_here();
    if (runs && n-- == 0) return k;
    if (!k->runs_here) return NULL;
  }
}

static const msri_loops *loops_of(const msri_lattice_kernel *kernel, int ways) {
  return ways == MSRI_WAYS ? &kernel->eight : &kernel->four;
}

static void assert_rows(const msri_lattice_kernel *kernel, const char *what, int ways, int besides,
                        const row *is, const row *due) {
  if (memcmp(is, due, sizeof *is) != 0)
    fail_msg("%s, %s: other bits, %zu cells, %d ways, besides %d", kernel->name, what, is->n, ways,
             besides);
}

/* What a kernel does to a row, and what is due; all bytes around the cells stay as they are. */
static void check_advance(const msri_lattice_kernel *kernel, const row *from, const msri_motion *m,
                          int ways, int besides) {
  row due = *from, is = *from;
  const msri_cells at = cells_of(&is);
  advance_cells(&due, m, ways, besides);
  loops_of(kernel, ways)->advance[besides](&at, m);
  assert_rows(kernel, "advance", ways, besides, &is, &due);
}

/* ---- Who is told */

typedef struct lookout {
  bool near[CELLS / MSRI_LANES];
  uint8_t told[CELLS / MSRI_LANES];
  double trace[4][SIZE]; /* of cells from AROUND on */
  msri_lookout at;
} lookout;

static void look_out(lookout *l, double speed, uint64_t *dice) {
  for (size_t b = 0; b < CELLS / MSRI_LANES; b++) {
    l->near[b] = random_below(dice, 2);
    l->told[b] = random_below(dice, 4) ? 0 : (uint8_t)random_below(dice, 256);
  }
  memset(l->trace, 0, sizeof l->trace);
  l->at = (msri_lookout){.near = l->near,
                         .told = l->told,
                         .speed = speed,
                         .trace = {l->trace[0] + AROUND, l->trace[1] + AROUND, l->trace[2] + AROUND,
                                   l->trace[3] + AROUND}};
}

static bool is_told(const row *from, const row *to, size_t c, bool near, double speed) {
  const bool stays = floor(from->x[c]) == floor(to->x[c]) && floor(from->y[c]) == floor(to->y[c]);
  const double v2 = to->vx[c] * to->vx[c] + to->vy[c] * to->vy[c];
  return from->mass[c] && !(near ? stays : v2 <= speed * speed);
}

static unsigned due_of(const row *from, const row *to, size_t block, bool near, double speed) {
  unsigned bits = 0;
  for (size_t k = 0; k < MSRI_LANES; k++)
    bits |= (unsigned)is_told(from, to, AROUND + block * MSRI_LANES + k, near, speed) << k;
  return bits;
}

/* Those that are due, besides whoever was told before; the trace is that of the cells. */
static void assert_told(const lookout *l, const lookout *before, const row *from, const row *to,
                        double accelerations[2][SIZE]) {
  const double *const trace[] = {accelerations[0], accelerations[1], from->x, from->y};
  bool ran = false;
  for (size_t b = 0; b < from->n / MSRI_LANES; b++) {
    const size_t first = AROUND + b * MSRI_LANES;
    const unsigned due = is_listed(from, first) ? due_of(from, to, b, l->near[b], l->at.speed) : 0;
    assert_int_equal(l->told[b], before->told[b] | due);
    ran |= due != 0 && !l->near[b];
    for (size_t c = first; c < first + MSRI_LANES; c++)
      for (int what = 0; what < 4; what++)
        if (from->mass[c] && (l->near[b] || due >> (c - first) & 1))
          assert_memory_equal(&l->trace[what][c], &trace[what][c], sizeof(double));
  }
  assert_int_equal(l->at.ran, ran);
}

/* The same as advance; and who is to be told is. */
static void check_watch(const msri_lattice_kernel *kernel, const row *from, const msri_motion *m,
                        int ways, int besides) {
  uint64_t dice = from->n + (uint64_t)besides;
  row due = *from, is = *from, same = *from;
  double a[2][SIZE] = {{0}};
  lookout l, before;
  const msri_cells at = cells_of(&is);
  look_out(&l, uniform(&dice, 0, 4), &dice);
  before = l;
  accelerate(&same, m, ways, besides, a[0], a[1]);
  const double fastest = advance_cells(&due, m, ways, besides);
  loops_of(kernel, ways)->watch[besides](&at, m, &l.at);
  assert_rows(kernel, "watch", ways, besides, &is, &due);
  assert_told(&l, &before, from, &is, a);
  assert_true(kernel->fastest(&at) == fastest);
}

static void check_pull(const msri_lattice_kernel *kernel, const row *from, const msri_motion *m,
                       int ways) {
  row due = *from, is = *from;
  double a[2][SIZE];
  const msri_cells at = cells_of(&is);
  accelerate(&due, m, ways, 0, a[0], a[1]);
  loops_of(kernel, ways)->pull(&at, m);
  assert_rows(kernel, "pull", ways, 0, &is, &due);
}

static void check_all(const row *from, const msri_motion *m) {
  const msri_lattice_kernel *kernel;
  for (size_t k = 0; (kernel = kernel_here(k)); k++)
    for (int ways = MSRI_BELOW + 1; ways <= MSRI_WAYS; ways += MSRI_WAYS - MSRI_BELOW - 1) {
      for (int besides = 0; besides < MSRI_BESIDES; besides++)
        check_advance(kernel, from, m, ways, besides), check_watch(kernel, from, m, ways, besides);
      check_pull(kernel, from, m, ways);
    }
}

/* ---- Tests */

static void kernels_do_what_springs_do(void **state) {
  (void)state;
  uint64_t dice = 1;
  for (size_t n = 0; n <= CELLS; n += MSRI_LANES)
    for (int turn = 0; turn < 30; turn++) {
      row r;
      fill_row(&r, n, &dice);
      const msri_motion m = motion_of(&dice);
      check_all(&r, &m);
    }
}

/* Springs without length pull nothing, in any direction. */
static void masses_may_be_at_one_place(void **state) {
  (void)state;
  uint64_t dice = 2;
  for (int turn = 0; turn < 40; turn++) {
    row r;
    fill_row(&r, CELLS / 2, &dice);
    const msri_motion m = motion_of(&dice);
    for (size_t c = 0; c < SIZE; c++)
      if (r.mass[c] && random_below(&dice, 2)) r.x[c] = r.y[c] = r.below_x[c] = r.below_y[c] = 1.5;
    check_all(&r, &m);
  }
}

static void make_wild(double *at, uint64_t *dice) {
  static const double wild[] = {1e200, -1e308, INFINITE, NO_NUMBER};
  *at = wild[random_below(dice, 4)];
}

/* Whatever stands where there is no mass, or comes from where there is no spring, is harmless: too
 * far for a square, infinite, no number. */
static void what_has_no_spring_is_left_out(void **state) {
  (void)state;
  uint64_t dice = 3;
  for (int turn = 0; turn < 40; turn++) {
    row r;
    fill_row(&r, CELLS, &dice);
    const msri_motion m = motion_of(&dice);
    for (size_t c = 0; c < SIZE; c++) {
      const bool below =
          c > 0 && c + 1 < SIZE &&
          (r.tie[MSRI_BELOW][c] || r.tie[MSRI_BELOW_LEFT][c + 1] || r.tie[MSRI_BELOW_RIGHT][c - 1]);
      if (!below) make_wild(&r.below_x[c], &dice), make_wild(&r.below_y[c], &dice);
      if (!r.mass[c] && !is_listed(&r, c))
        make_wild(&r.x[c], &dice), make_wild(&r.y[c], &dice), make_wild(&r.vx[c], &dice);
      for (int way = MSRI_BELOW; way < MSRI_WAYS; way++)
        if (!r.tied[way][c])
          make_wild(&r.above[way][0][c], &dice), make_wild(&r.above[way][1][c], &dice);
    }
    check_all(&r, &m);
  }
}

/* Forces to below may replace those from above, as a row after the other has it. */
static void forces_may_take_each_others_place(void **state) {
  (void)state;
  static const ptrdiff_t shift[MSRI_WAYS] = {[MSRI_BELOW_LEFT] = 1};
  uint64_t dice = 4;
  for (int turn = 0; turn < 40; turn++) {
    row r;
    fill_row(&r, CELLS, &dice);
    const msri_motion m = motion_of(&dice);
    const msri_lattice_kernel *kernel;
    for (size_t k = 0; (kernel = kernel_here(k)); k++)
      for (int ways = MSRI_BELOW + 1; ways <= MSRI_WAYS; ways += MSRI_WAYS - MSRI_BELOW - 1) {
        row is = r, due = r;
        msri_cells at = cells_of(&is);
        for (int way = MSRI_BELOW; way < MSRI_BELOW_RIGHT; way++) {
          at.back[way] = shift[way];
          for (int axis = 0; axis < 2; axis++)
            for (size_t c = AROUND; c < AROUND + r.n; c++)
              due.above[way][axis][c] = r.below[way][axis][c + (size_t)shift[way]];
        }
        advance_cells(&due, &m, ways, 0);
        loops_of(kernel, ways)->advance[0](&at, &m);
        assert_memory_equal(is.vx, due.vx, sizeof is.vx);
        assert_memory_equal(is.vy, due.vy, sizeof is.vy);
        assert_memory_equal(is.below, due.below, sizeof is.below);
      }
  }
}

/* The fastest may be anywhere, and go backwards; what is no number is, and is told. */
static void the_fastest_is_found(void **state) {
  (void)state;
  uint64_t dice = 5;
  const msri_lattice_kernel *kernel;
  for (size_t at = 0; at < CELLS; at++) {
    row r;
    fill_row(&r, CELLS, &dice);
    const msri_motion m = motion_of(&dice);
    if (!r.mass[AROUND + at]) continue;
    double *const v = &(at % 2 ? r.vx : r.vy)[AROUND + at];
    *v = at % 3 ? -1e6 : 1e6;
    for (size_t k = 0; (kernel = kernel_here(k)); k++)
      check_watch(kernel, &r, &m, MSRI_WAYS, 0), check_watch(kernel, &r, &m, 2, 3);
    *v = NO_NUMBER;
    for (size_t k = 0; (kernel = kernel_here(k)); k++) {
      row is = r;
      lookout l;
      const msri_cells cells = cells_of(&is);
      assert_true(isnan(kernel->fastest(&cells)));
      look_out(&l, 1e9, &dice);
      kernel->four.watch[1](&cells, &m, &l.at);
      assert_true(l.told[at / MSRI_LANES] >> at % MSRI_LANES & 1);
    }
  }
}

/* The widest one is taken, and the last one runs anywhere. */
static void the_widest_is_taken(void **state) {
  (void)state;
  assert_ptr_equal(msri_lattice_widest(), kernel_here(0));
  const msri_lattice_kernel *last = kernel_here(0);
  for (size_t k = 0; kernel_here(k); k++) last = kernel_here(k);
  assert_null(last->runs_here);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(kernels_do_what_springs_do),
      cmocka_unit_test(masses_may_be_at_one_place),
      cmocka_unit_test(what_has_no_spring_is_left_out),
      cmocka_unit_test(forces_may_take_each_others_place),
      cmocka_unit_test(the_fastest_is_found),
      cmocka_unit_test(the_widest_is_taken),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
