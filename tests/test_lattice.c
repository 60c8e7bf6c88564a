/* test_lattice.c - the kernels of forces/lattice.h, each width of them, against a loop over
 * springs, one after the other: the same bits. Those that this machine hasn't got are left out. */
#include "forces/lattice.h"

#include "scenes.h"

enum { AROUND = 16, CELLS = 80, SIZE = CELLS + 2 * AROUND };

/* Cells, what is around them and, for each way, forces from above and to below. */
typedef struct row {
  double x[SIZE], y[SIZE], vx[SIZE], vy[SIZE], below_x[SIZE], below_y[SIZE];
  double k[MSRI_WAYS][SIZE];
  double above[MSRI_WAYS][2][SIZE], below[MSRI_WAYS][2][SIZE];
} row;

static void fill(double *array, double from, double to, uint64_t *dice) {
  for (size_t c = 0; c < SIZE; c++) array[c] = uniform(dice, from, to);
}

/* Springs between most cells; none beyond the last one, which no row begins with. */
static void fill_springs(row *r, size_t n, uint64_t *dice) {
  for (int way = 0; way < MSRI_WAYS; way++)
    for (size_t c = 0; c < SIZE; c++) {
      const bool last = way == MSRI_RIGHT && c == AROUND + n - 1;
      r->k[way][c] = last || random_below(dice, 4) == 0 ? 0 : uniform(dice, 1, 50);
    }
}

static void fill_row(row *r, size_t n, uint64_t *dice) {
  fill(r->x, 0, 3, dice), fill(r->y, 0, 3, dice);
  fill(r->vx, -2, 2, dice), fill(r->vy, -2, 2, dice);
  fill(r->below_x, 0, 3, dice), fill(r->below_y, 0, 3, dice);
  for (int way = 0; way < MSRI_WAYS; way++)
    for (int axis = 0; axis < 2; axis++) {
      fill(r->above[way][axis], -1, 1, dice);
      fill(r->below[way][axis], -1, 1, dice);
    }
  fill_springs(r, n, dice);
}

static msri_motion motion_of(uint64_t *dice) {
  msri_motion m = {.L = {1, sqrt(2)}, .w = uniform(dice, 1, 10), .drift = uniform(dice, 0, 0.1)};
  for (int n = 0; n < 2; n++) {
    m.weight[n] = uniform(dice, -5, 5);
    m.kick[n] = uniform(dice, -0.1, 0.1);
    m.keep[n] = uniform(dice, 0, 1);
    for (int axis = 0; axis < 2; axis++) m.push[n][axis] = uniform(dice, -4, 4);
  }
  return m;
}

static msri_cells cells_of(row *r, size_t n) {
  msri_cells s = {.n = n,
                  .x = r->x + AROUND,
                  .y = r->y + AROUND,
                  .vx = r->vx + AROUND,
                  .vy = r->vy + AROUND,
                  .below_x = r->below_x + AROUND,
                  .below_y = r->below_y + AROUND};
  for (int way = 0; way < MSRI_WAYS; way++) {
    s.k[way] = r->k[way] + AROUND;
    s.above[way] = (msri_pull){r->above[way][0] + AROUND, r->above[way][1] + AROUND};
    s.below[way] = (msri_pull){r->below[way][0] + AROUND, r->below[way][1] + AROUND};
  }
  return s;
}

/* ---- One spring after the other */

typedef struct force {
  double x, y;
} force;

static force force_of(double k, double L, double dx, double dy) {
  const double l = sqrt(dx * dx + dy * dy);
  if (k <= 0 || l <= 0) return (force){0, 0};
  const double f = k * (l - L) / l;
  return (force){f * dx, f * dy};
}

static force right_of(const msri_cells *s, const msri_motion *m, size_t c) {
  return force_of(s->k[MSRI_RIGHT][c], m->L[0], s->x[c + 1] - s->x[c], s->y[c + 1] - s->y[c]);
}

static force below_of(const msri_cells *s, const msri_motion *m, size_t c, int way) {
  static const ptrdiff_t shift[] = {[MSRI_BELOW_LEFT] = -1, [MSRI_BELOW_RIGHT] = 1};
  const ptrdiff_t to = (ptrdiff_t)c + shift[way];
  return force_of(s->k[way][c], m->L[way != MSRI_BELOW], s->below_x[to] - s->x[c],
                  s->below_y[to] - s->y[c]);
}

/* ax, ay [n], and the forces to below, by the places as they are. */
static void accelerate(const msri_cells *s, const msri_motion *m, int ways, int besides, double *ax,
                       double *ay) {
  for (size_t c = 0; c < s->n; c++) {
    double x = 0, y = 0;
    for (int way = MSRI_BELOW; way < ways; way++) x -= s->above[way].x[c], y -= s->above[way].y[c];
    const force left = c > 0 ? right_of(s, m, c - 1) : (force){0, 0}, right = right_of(s, m, c);
    x = x - left.x + right.x, y = y - left.y + right.y;
    for (int way = MSRI_BELOW; way < ways; way++) {
      const force f = below_of(s, m, c, way);
      x += f.x, y += f.y;
      s->below[way].x[c] = f.x, s->below[way].y[c] = f.y;
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

static double advance_cells(const msri_cells *s, const msri_motion *m, int ways, int besides) {
  double ax[CELLS], ay[CELLS], fastest = 0;
  accelerate(s, m, ways, besides, ax, ay);
  for (size_t c = 0; c < s->n; c++) {
    fastest = fmax(fastest, moved(m, 0, besides, ax[c], s->x + c, s->vx + c));
    fastest = fmax(fastest, moved(m, 1, besides, ay[c], s->y + c, s->vy + c));
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

static void assert_rows(const msri_lattice_kernel *kernel, const char *what, size_t n, int ways,
                        int besides, const row *is, const row *due) {
  if (memcmp(is, due, sizeof *is) != 0)
    fail_msg("%s, %s: other bits, %zu cells, %d ways, besides %d", kernel->name, what, n, ways,
             besides);
}

/* What a kernel does to a row, and what is due; all bytes around the cells stay as they are. */
static void check_advance(const msri_lattice_kernel *kernel, const row *from, size_t n,
                          const msri_motion *m, int ways, int besides) {
  row due = *from, is = *from;
  const msri_cells at = cells_of(&is, n), wanted = cells_of(&due, n);
  const double fastest = advance_cells(&wanted, m, ways, besides);
  const double told = kernel->of[ways == MSRI_WAYS].advance[besides](&at, m);
  assert_rows(kernel, "advance", n, ways, besides, &is, &due);
  if (memcmp(&told, &fastest, sizeof told) != 0)
    fail_msg("%s: fastest is %g, not %g, %zu cells", kernel->name, told, fastest, n);
}

/* The same without the drift; the accelerations are told. */
static void check_kick(const msri_lattice_kernel *kernel, const row *from, size_t n,
                       const msri_motion *m, int ways, int besides) {
  row due = *from, is = *from;
  msri_motion still = *m;
  still.drift = 0;
  double a[2][CELLS + 1] = {{0}}, wanted_a[2][CELLS + 1] = {{0}};
  const msri_cells at = cells_of(&is, n), wanted = cells_of(&due, n);
  accelerate(&wanted, m, ways, besides, wanted_a[0], wanted_a[1]);
  const double fastest = advance_cells(&wanted, &still, ways, besides);
  const double told = kernel->of[ways == MSRI_WAYS].kick[besides](&at, m, a[0], a[1]);
  assert_rows(kernel, "kick", n, ways, besides, &is, &due);
  assert_memory_equal(a, wanted_a, sizeof a);
  assert_memory_equal(&told, &fastest, sizeof told);
}

static void check_pull(const msri_lattice_kernel *kernel, const row *from, size_t n,
                       const msri_motion *m, int ways) {
  row due = *from, is = *from;
  double a[2][CELLS];
  const msri_cells at = cells_of(&is, n), wanted = cells_of(&due, n);
  accelerate(&wanted, m, ways, 0, a[0], a[1]);
  kernel->of[ways == MSRI_WAYS].pull(&at, m);
  assert_rows(kernel, "pull", n, ways, 0, &is, &due);
}

static void check_all(const row *from, size_t n, const msri_motion *m) {
  const msri_lattice_kernel *kernel;
  for (size_t k = 0; (kernel = kernel_here(k)); k++)
    for (int ways = MSRI_BELOW + 1; ways <= MSRI_WAYS; ways += MSRI_WAYS - MSRI_BELOW - 1) {
      for (int besides = 0; besides < MSRI_BESIDES; besides++)
        check_advance(kernel, from, n, m, ways, besides),
            check_kick(kernel, from, n, m, ways, besides);
      check_pull(kernel, from, n, m, ways);
    }
}

/* ---- Tests */

static void kernels_do_what_springs_do(void **state) {
  (void)state;
  uint64_t dice = 1;
  for (size_t n = 0; n <= CELLS; n += n < 40 ? 1 : 13)
    for (int turn = 0; turn < 4; turn++) {
      row r;
      fill_row(&r, n, &dice);
      const msri_motion m = motion_of(&dice);
      check_all(&r, n, &m);
    }
}

/* Springs without length pull nothing, in any direction. */
static void masses_may_be_at_one_place(void **state) {
  (void)state;
  uint64_t dice = 2;
  for (size_t n = 1; n <= 40; n++) {
    row r;
    fill_row(&r, n, &dice);
    const msri_motion m = motion_of(&dice);
    for (size_t c = 0; c < SIZE; c++)
      if (random_below(&dice, 2)) r.x[c] = r.y[c] = r.below_x[c] = r.below_y[c] = 1.5;
    check_all(&r, n, &m);
  }
}

static bool is_tied(const row *r, size_t c) {
  return r->k[MSRI_RIGHT][c] > 0 || r->k[MSRI_RIGHT][c - 1] > 0 || r->k[MSRI_BELOW][c] > 0 ||
         r->k[MSRI_BELOW_LEFT][c] > 0 || r->k[MSRI_BELOW_RIGHT][c] > 0;
}

/* Whatever stands where there is no mass is harmless: too far for a square, infinite, no number. */
static void what_has_no_spring_is_left_out(void **state) {
  (void)state;
  static const double wild[] = {1e200, -1e308, INFINITE, NO_NUMBER};
  uint64_t dice = 3;
  for (size_t n = 1; n <= 40; n++) {
    row sane, r;
    fill_row(&sane, n, &dice);
    for (size_t c = AROUND + 2; c < AROUND + n; c += 3) {
      sane.k[MSRI_RIGHT][c - 1] = sane.k[MSRI_RIGHT][c] = 0;
      for (int way = MSRI_BELOW; way < MSRI_WAYS; way++) sane.k[way][c] = 0;
    }
    sane.k[MSRI_RIGHT][AROUND - 1] = 0;
    r = sane;
    for (size_t c = AROUND; c <= AROUND + n; c++)
      if (c == AROUND + n || !is_tied(&r, c)) r.x[c] = r.y[c] = wild[random_below(&dice, 4)];
    msri_motion m = motion_of(&dice);
    const msri_lattice_kernel *kernel;
    for (size_t k = 0; (kernel = kernel_here(k)); k++)
      for (int eight = 0; eight < 2; eight++) {
        row is = r, due = sane;
        const msri_cells at = cells_of(&is, n), wanted = cells_of(&due, n);
        const double told = kernel->of[eight].advance[MSRI_WITH_WEIGHT](&at, &m);
        assert_true(told == advance_cells(&wanted, &m, eight ? MSRI_WAYS : MSRI_BELOW + 1,
                                          MSRI_WITH_WEIGHT));
        assert_memory_equal(is.vx, due.vx, sizeof is.vx);
        assert_memory_equal(is.vy, due.vy, sizeof is.vy);
        assert_memory_equal(is.below, due.below, sizeof is.below);
      }
  }
}

/* Forces to below may replace those from above, as a row after the other has it. */
static void forces_may_take_each_others_place(void **state) {
  (void)state;
  static const ptrdiff_t shift[MSRI_WAYS] = {[MSRI_BELOW_LEFT] = 1};
  uint64_t dice = 4;
  for (size_t n = 1; n <= 40; n++) {
    row r;
    fill_row(&r, n, &dice);
    const msri_motion m = motion_of(&dice);
    const msri_lattice_kernel *kernel;
    for (size_t k = 0; (kernel = kernel_here(k)); k++)
      for (int ways = MSRI_BELOW + 1; ways <= MSRI_WAYS; ways += MSRI_WAYS - MSRI_BELOW - 1) {
        row is = r, due = r;
        msri_cells at = cells_of(&is, n), wanted = cells_of(&due, n);
        for (int way = MSRI_BELOW; way < MSRI_BELOW_RIGHT; way++)
          at.above[way] = (msri_pull){at.below[way].x + shift[way], at.below[way].y + shift[way]};
        for (int way = MSRI_BELOW; way < MSRI_BELOW_RIGHT; way++)
          for (int axis = 0; axis < 2; axis++)
            for (size_t c = 0; c < n; c++)
              due.above[way][axis][AROUND + c] =
                  r.below[way][axis][AROUND + c + (size_t)shift[way]];
        advance_cells(&wanted, &m, ways, 0);
        kernel->of[ways == MSRI_WAYS].advance[0](&at, &m);
        assert_memory_equal(is.vx, due.vx, sizeof is.vx);
        assert_memory_equal(is.vy, due.vy, sizeof is.vy);
        assert_memory_equal(is.below, due.below, sizeof is.below);
      }
  }
}

/* The fastest may be anywhere, and go backwards. */
static void the_fastest_is_found(void **state) {
  (void)state;
  uint64_t dice = 5;
  for (size_t n = 1; n <= 40; n++)
    for (size_t at = 0; at < n; at++) {
      row r;
      fill_row(&r, n, &dice);
      const msri_motion m = motion_of(&dice);
      (at % 2 ? r.vx : r.vy)[AROUND + at] = at % 3 ? -1e6 : 1e6;
      const msri_lattice_kernel *kernel;
      for (size_t k = 0; (kernel = kernel_here(k)); k++) check_advance(kernel, &r, n, &m, 4, 0);
      for (size_t k = 0; (kernel = kernel_here(k)); k++) check_advance(kernel, &r, n, &m, 2, 3);
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
