/* test_solvers.c - the matrix of implicit methods: its pattern, what it says, and its solution,
 * against dense matrices of GSL. */
#include "plan/state.h"

#include "scenes.h"
#include "solvers/tangent.h"

#include <gsl/gsl_linalg.h>

static const mesh meshes[] = {
    {.masses = 2, .springs = 1, .equal = true, .seed = 1},
    {.masses = 12, .springs = 30, .equal = true, .seed = 2},
    {.masses = 12, .springs = 30, .anchors = 4, .seed = 3},
    {.masses = 9, .springs = 20, .anchors = 3, .slack = true, .seed = 4},
    {.masses = 9, .springs = 20, .anchors = 3, .coincident = true, .seed = 5},
    {.masses = 4, .springs = 60, .anchors = 20, .seed = 6}, /* many between the same two */
    {.masses = 6, .springs = 0, .anchors = 2, .seed = 7},
};

/* ---- The pattern */

static bool tied(const msr_springs *springs, size_t i, size_t j) {
  for (size_t r = 0; r < springs->n_runs; r++) {
    const msr_run_of_springs *run = &springs->run[r];
    if (i >= run->first && i < run->first + run->count && j == i + run->offset) return true;
  }
  return false;
}

/* Each mass is in the order once, pairs lie where the strips say, lower ones first, and no two
 * masses of a block are tied unless pairs are single. */
static void check_graph(const msri_graph *g, const msr_springs *springs) {
  uint32_t first[64], second[64];
  bool found[64] = {false};
  size_t pair = 0, pairs = 0, spring = 0;
  for (size_t i = 0; i < g->n; i++) {
    assert_true(g->order[i] < g->n && !found[g->order[i]]);
    found[g->order[i]] = true;
  }
  for (size_t b = 0, s = 0; b < g->blocks; b++) {
    const size_t begin = b > 0 ? g->block[b - 1].mass : 0, end = g->block[b].mass;
    assert_true(begin < end && end - begin <= MSRI_GRAPH_BLOCK);
    for (; s < g->block[b].strip; s++)
      for (size_t c = 0; c < g->strip[s].count; c++, pair++) {
        first[pair] = (uint32_t)(g->strip[s].first + c);
        second[pair] = (uint32_t)(g->strip[s].second + c);
        assert_true(first[pair] >= begin && first[pair] < end);
        assert_true(second[pair] >= (g->single ? first[pair] + 1 : end));
        assert_true(second[pair] - first[pair] <= g->reach);
        assert_true(tied(springs, g->order[first[pair]], g->order[second[pair]]));
      }
    assert_int_equal(g->block[b].pair, pair);
  }
  for (size_t i = 0; i < g->n; i++)
    for (size_t j = i + 1; j < g->n; j++) pairs += tied(springs, i, j);
  assert_int_equal(g->pairs, pairs);
  assert_int_equal(pair, pairs);
  assert_int_equal(g->n > 0 ? g->block[g->blocks - 1].mass : 0, g->n);
  for (size_t r = 0; r < springs->n_runs; r++)
    for (size_t s = 0; s < springs->run[r].count; s++, spring++) {
      const size_t i = springs->run[r].first + s, p = g->pair[spring];
      assert_true(p < pairs);
      assert_int_equal(g->order[first[p]], i);
      assert_int_equal(g->order[second[p]], i + springs->run[r].offset);
    }
}

static void pairs_are_sorted_and_merged(void **state) {
  (void)state;
  for (size_t m = 0; m < LENGTH(meshes); m++) {
    world w = open_world(random_mesh(&meshes[m], NULL), NULL, 0);
    const msr_view s = msr_state_view(w.state);
    msri_graph *graph;
    must(msri_graph_create(s.n, s.springs, &graph, &why));
    check_graph(graph, s.springs);
    free(graph);
    close_world(w);
  }
}

static void too_many_are_refused(void **state) {
  (void)state;
  const msr_springs none = {0}, many = {.n = (size_t)UINT32_MAX};
  msri_graph *graph = NULL;
  msr_error err;
  assert_int_equal(msri_graph_create((size_t)UINT32_MAX, &none, &graph, &err), MSR_EUSAGE);
  assert_non_null(strstr(err.message, "too many for an implicit integrator"));
  assert_int_equal(msri_graph_create(2, &many, &graph, &err), MSR_EUSAGE);
  assert_null(graph);
}

/* ---- What the matrix says */

/* Where it is asked for: q0 may be NULL. */
typedef struct place {
  const double *q0, *from, *q;
  double c;
} place;

/* Adds w (e_i - e_j)(e_i - e_j)^T for one spring, j = n: a fixed point. Of `b`, the 2 x 2 matrix.
 */
static void add_block(gsl_matrix *A, size_t n, size_t i, size_t j, double b[2][2]) {
  const size_t mass[2] = {i, j};
  for (size_t p = 0; p < 2; p++)
    for (size_t r = 0; r < 2; r++)
      for (size_t x = 0; x < 2; x++)
        for (size_t y = 0; y < 2; y++) {
          if (mass[p] == n || mass[r] == n) continue;
          double *entry = gsl_matrix_ptr(A, mass[p] + x * n, mass[r] + y * n);
          *entry += p == r ? b[x][y] : -b[x][y];
        }
}

/* The vector of a spring to `to` at q, if that is none of the masses: to (x, y). */
static void vector_of(const double *q, size_t n, size_t i, size_t j, const msr_anchor *a,
                      double d[2]) {
  d[0] = (a ? a->x : q[j]) - q[i];
  d[1] = (a ? a->y : q[j + n]) - q[i + n];
}

/* c (k n n^T + (f/l) (1 - n n^T)), f foretold to first order from `from`, no f/l below `least`. */
static void add_spring(gsl_matrix *A, const place *at, double least, size_t n, size_t i, size_t j,
                       double k, double L, const msr_anchor *a) {
  double d[2], d0[2], df[2], b[2][2];
  vector_of(at->q, n, i, j, a, d);
  vector_of(at->q0 ? at->q0 : at->q, n, i, j, a, d0);
  vector_of(at->from, n, i, j, a, df);
  const double mean[2] = {(d[0] + d0[0]) / 2, (d[1] + d0[1]) / 2};
  const double l = (hypot(d[0], d[1]) + hypot(d0[0], d0[1])) / 2, lf = hypot(df[0], df[1]);
  const double foretold = lf > 0 ? (df[0] * d[0] + df[1] * d[1]) / lf : 0;
  const double now = at->q0 ? (hypot(d0[0], d0[1]) + foretold) / 2 : foretold;
  const double across = l > 0 ? fmax(at->c * k * (now - L) / l, least) : at->c * k;
  for (int x = 0; x < 2; x++)
    for (int y = 0; y < 2; y++) {
      const double nn = l > 0 ? mean[x] * mean[y] / (l * l) : 0;
      b[x][y] = (at->c * k - across) * nn + (x == y ? across : 0);
    }
  add_block(A, n, i, j, b);
}

static gsl_matrix *dense(const msr_view *s, const place *at, double least) {
  const size_t n = s->n;
  gsl_matrix *A = gsl_matrix_calloc(2 * n, 2 * n);
  for (size_t i = 0; i < n; i++)
    for (size_t x = 0; x < 2; x++) gsl_matrix_set(A, i + x * n, i + x * n, msr_view_mass(s, i));
  for (size_t r = 0; r < s->springs->n_runs; r++) {
    const msr_run_of_springs *run = &s->springs->run[r];
    for (size_t m = 0; m < run->count; m++)
      add_spring(A, at, least, n, run->first + m, run->first + m + run->offset,
                 run->k[m * run->stride], run->L[m * run->stride], NULL);
  }
  for (size_t m = 0; m < s->springs->n_anchors; m++) {
    const msr_anchor *a = &s->springs->anchor[m];
    add_spring(A, at, least, n, a->i, n, a->k, a->L, a);
  }
  return A;
}

/* x of A x = M r. */
static void solve_densely(gsl_matrix *A, const msr_view *s, const double *r, double *x) {
  const size_t n = 2 * s->n;
  gsl_vector *b = gsl_vector_alloc(n);
  for (size_t i = 0; i < n; i++) gsl_vector_set(b, i, msr_view_mass(s, i % s->n) * r[i]);
  assert_int_equal(gsl_linalg_cholesky_decomp1(A), 0); /* it is positive */
  assert_int_equal(gsl_linalg_cholesky_svx(A, b), 0);
  memcpy(x, b->data, n * sizeof *x);
  gsl_vector_free(b);
}

static void scatter(size_t n, uint64_t *dice, double size, const double *from, double *to) {
  for (size_t i = 0; i < n; i++) to[i] = (from ? from[i] : 0) + uniform(dice, -size, size);
}

/* Both solve to eps times the ratio of the largest eigenvalue to the smallest, near c k / m; 1000
 * for the number of springs, and the tolerance. */
static void check_solution(world *w, const place *at, uint64_t *dice) {
  const msr_view s = msr_state_view(w->state);
  const msr_system system = msri_state_system(w->state);
  const double tolerance = 1e-9, most = tolerance + 1000 * DBL_EPSILON * (1 + at->c * 100 / 0.1);
  double r[64], x[64], expected[64];
  scatter(2 * s.n, dice, 1, NULL, r);
  must(system.linearise(system.self, 0, at->q0, at->from, at->q, at->c, NULL));
  must(system.solve(system.self, r, tolerance, x));
  gsl_matrix *A = dense(&s, at, w->state->stiffness.least);
  solve_densely(A, &s, r, expected);
  if (!(distance(2 * s.n, x, expected) <= most * sqrt(dot(2 * s.n, expected, expected))))
    fail_msg("c %g: off by %g of %g", at->c, distance(2 * s.n, x, expected),
             largest(2 * s.n, expected));
  gsl_matrix_free(A);
}

static void solutions_are_those_of_dense_matrices(void **state) {
  (void)state;
  uint64_t dice = 11;
  for (size_t m = 0; m < LENGTH(meshes); m++) {
    world w = open_world(random_mesh(&meshes[m], NULL), &msr_integrator_backward_euler, 0);
    const msr_view s = msr_state_view(w.state);
    double near[64], far[64];
    for (double c = 1e-6; c < 1e9; c *= 100) {
      scatter(2 * s.n, &dice, 0.05, s.x, near);
      scatter(2 * s.n, &dice, 2, s.x, far);
      check_solution(&w, &(place){NULL, s.x, s.x, c}, &dice);
      check_solution(&w, &(place){NULL, near, s.x, c}, &dice);
      check_solution(&w, &(place){s.x, near, far, c}, &dice);
      check_solution(&w, &(place){far, far, s.x, c}, &dice);
    }
    close_world(w);
  }
}

/* y = (a(q + e x) - a(q - e x)) / 2e, by a and, from q, by between: off by e^2 and eps / e. */
static void differ(const msr_system *system, const double *q, const double *x, bool mean,
                   double *y) {
  const double e = 1e-5;
  double at[64], a[2][64];
  for (int side = 0; side < 2; side++) {
    for (size_t i = 0; i < system->n; i++) at[i] = q[i] + (side ? e : -e) * x[i];
    if (mean)
      must(system->between(system->self, 0, q, at, a[side]));
    else
      must(system->acceleration(system->self, 0, at, NULL, a[side]));
  }
  for (size_t i = 0; i < system->n; i++) y[i] = (a[1][i] - a[0][i]) / (2 * e);
}

/* While it cuts nothing off, the matrix is the derivative of a, and twice that of the mean: solving
 * with what they make of x gives x. Of x, differ() is off by e^2 = 1e-10 times c k / m, 1e-3 at
 * most, for each of 10 springs at a mass, and a spring below a pixel times its length^-2: measured,
 * 6e-13 at most. */
static void the_matrix_is_the_derivative(void **state) {
  (void)state;
  uint64_t dice = 12;
  for (size_t m = 0; m < LENGTH(meshes); m++) {
    if (meshes[m].coincident) continue; /* there is no derivative */
    world w = open_world(random_mesh(&meshes[m], NULL), &msr_integrator_energy_momentum, 0);
    const msr_view s = msr_state_view(w.state);
    const msr_system system = msri_state_system(w.state);
    const double c = 1e-6;
    double x[64], y[64], solution[64];
    for (int mean = 0; mean < 2; mean++) {
      scatter(2 * s.n, &dice, 1, NULL, x);
      differ(&system, s.x, x, mean, y);
      for (size_t i = 0; i < 2 * s.n; i++) y[i] = x[i] - (mean ? 2 : 1) * c * y[i];
      must(system.linearise(system.self, 0, mean ? s.x : NULL, s.x, s.x, c, NULL));
      must(system.solve(system.self, y, 1e-13, solution));
      assert_true(distance(2 * s.n, x, solution) < 3e-12);
    }
    close_world(w);
  }
}

/* ---- Many masses: several windows, blocks and strips of the graph */

/* Solves for r at random, and puts x into the equations: their left side by the product of
 * tangent.c, which knows nothing of the graph. Off by the tolerance, 1e-11 of x, times the largest
 * eigenvalue over m, 1 + 12 c k / m. */
static void check_residual(const world *w, double c, double k, uint64_t *dice) {
  msri_stiffness *a = &w->state->stiffness;
  const msr_view s = msr_state_view(w->state);
  double *r = zeroed(2 * s.n, sizeof *r), *x = zeroed(2 * s.n, sizeof *x);
  double *y = zeroed(2 * s.n, sizeof *y), largest_x = 0, off = 0;
  scatter(2 * s.n, dice, 1, NULL, r);
  msri_stiffness_linearise(a, NULL, s.x, s.x, c, NULL);
  must(msri_stiffness_solve(a, r, 1e-11, x));
  msri_tangent_product(&s, x, y);
  for (size_t i = 0; i < 2 * s.n; i++) {
    const double m = msr_view_mass(&s, i % s.n);
    off += pow(x[i] + c * y[i] / m - r[i], 2);
    largest_x += x[i] * x[i];
  }
  const double most = 1e-11 * (1 + 12 * c * k / 0.1);
  if (!(sqrt(off) < most * sqrt(largest_x)))
    fail_msg("%zu masses, c %g: off by %g of %g", s.n, c, sqrt(off), sqrt(largest_x));
  free(r);
  free(x);
  free(y);
}

/* Pulled by a fifth, so that no spring pushes and nothing is cut off. */
static void large_lattices_are_solved(void **state) {
  (void)state;
  uint64_t dice = 14;
  for (int neighbours = 4; neighbours <= 8; neighbours += 4) {
    world w = open_world(lattice(70, 90, neighbours, &(msr_conf){0.01, 0, 0.1, 1500, 1, 1}),
                         &msr_integrator_backward_euler, 0);
    const msr_arrays s = msr_state_edit(w.state);
    for (size_t i = 0; i < 70 * 90; i++) {
      s.x[i] = 1.2 * s.x[i] + uniform(&dice, -0.05, 0.05);
      s.y[i] = 1.2 * s.y[i] + uniform(&dice, -0.05, 0.05);
    }
    assert_true(w.plan->graph->blocks > 100 && w.plan->graph->strips > w.plan->graph->blocks);
    assert_false(w.plan->graph->single);
    for (double c = 1e-5; c < 1; c *= 100) check_residual(&w, c, 1500, &dice);
    close_world(w);
  }
}

/* Numbered at random, masses that differ, and so far apart that every spring pulls. */
static void large_meshes_are_solved(void **state) {
  (void)state;
  uint64_t dice = 15;
  const mesh m = {.masses = 3000, .springs = 9000, .anchors = 50, .seed = 16};
  world w = open_world(random_mesh(&m, NULL), &msr_integrator_backward_euler, 0);
  const msr_arrays s = msr_state_edit(w.state);
  for (size_t i = 0; i < 3000; i++) s.x[i] *= 1e4, s.y[i] *= 1e4;
  assert_true(w.plan->graph->single);
  for (double c = 1e-5; c < 1; c *= 100) check_residual(&w, c, 100, &dice);
  close_world(w);
}

/* ---- The factors */

static world turned_lattice(double angle) {
  world w = open_world(lattice(12, 9, 4, &(msr_conf){0.01, 0, 0.1, 1500, 1, 1}),
                       &msr_integrator_backward_euler, 0);
  const msr_arrays s = msr_state_edit(w.state);
  for (size_t i = 0; i < 12 * 9; i++) {
    const double x = s.x[i], y = s.y[i];
    s.x[i] = cos(angle) * x - sin(angle) * y;
    s.y[i] = sin(angle) * x + cos(angle) * y;
  }
  return w;
}

/* Rows and columns decouple: the factors alone solve, to eps times c k / m = 1e8 and 100 for sums
 * along rows. */
static void factors_of_a_turned_lattice_are_exact(void **state) {
  (void)state;
  enum { N = 12 * 9 };
  uint64_t dice = 13;
  for (double angle = 0; angle < 3; angle += 0.4) {
    world w = turned_lattice(angle);
    msri_stiffness *a = &w.state->stiffness;
    const msr_view s = msr_state_view(w.state);
    double r[2 * N], x[2 * N], z[2 * N], y[2 * N], image[2 * N], rz;
    scatter(2 * N, &dice, 1, NULL, r);
    msri_stiffness_linearise(a, NULL, s.x, s.x, 1e8 * 0.1 / 1500, NULL);
    must(msri_stiffness_solve(a, r, 1e-9, x));
    const uint32_t *order = a->graph->order;
    for (size_t i = 0; i < 2 * N; i++) y[i] = 0.1 * r[order[i % N] + (i < N ? 0 : N)];
    msri_stiffness_forward(a, 0, a->graph->blocks, y);
    msri_stiffness_backward(a, y, image, &rz);
    for (size_t i = 0; i < 2 * N; i++) z[order[i % N] + (i < N ? 0 : N)] = y[i];
    if (!(distance(2 * N, x, z) < 100 * 1e8 * DBL_EPSILON * largest(2 * N, x)))
      fail_msg("angle %g: %g of %g", angle, distance(2 * N, x, z), largest(2 * N, x));
    close_world(w);
  }
}

/* A translation strains no spring, however stiff: only rounding of the factors stands in the way,
 * eps times c k / m, up to 1e12. Beyond 1e16 a matrix has no room left for the masses: that is
 * told. */
static void stiff_beyond_rounding_is_told(void **state) {
  (void)state;
  enum { N = 12 * 9 };
  world w = turned_lattice(0.3);
  const msr_view s = msr_state_view(w.state);
  double r[2 * N], x[2 * N];
  for (size_t i = 0; i < 2 * N; i++) r[i] = i < N ? 1 : -2;
  for (double c = 1; c < 1e25; c *= 100) {
    const double ratio = c * 1500 / 0.1;
    msri_stiffness_linearise(&w.state->stiffness, NULL, s.x, s.x, c, NULL);
    const msr_status status = msri_stiffness_solve(&w.state->stiffness, r, 1e-6, x);
    if (ratio < 1e13) assert_true(distance(2 * N, x, r) < 1e-6 + ratio * DBL_EPSILON);
    assert_int_equal(status, ratio < 1e13 ? MSR_OK : MSR_EUNSTABLE);
  }
  close_world(w);
}

static void nonsense_is_told(void **state) {
  (void)state;
  world w = turned_lattice(0);
  const msr_view s = msr_state_view(w.state);
  double r[2 * 12 * 9] = {1}, x[2 * 12 * 9];
  const double odd[] = {NO_NUMBER, INFINITE, 1e300};
  for (size_t i = 0; i < LENGTH(odd); i++) {
    msri_stiffness_linearise(&w.state->stiffness, NULL, s.x, s.x, odd[i], NULL);
    assert_int_equal(msri_stiffness_solve(&w.state->stiffness, r, 1e-6, x), MSR_EUNSTABLE);
  }
  r[0] = NO_NUMBER;
  msri_stiffness_linearise(&w.state->stiffness, NULL, s.x, s.x, 1, NULL);
  assert_int_equal(msri_stiffness_solve(&w.state->stiffness, r, 1e-6, x), MSR_EUNSTABLE);
  /* The corner takes its row of 12 along, stretching it by some m / (c k) = 1e-4 times 12^2 / 3;
   * r goes down to what is no normal number. */
  for (r[0] = 1; r[0] > 0; r[0] *= 1e-31) {
    must(msri_stiffness_solve(&w.state->stiffness, r, 1e-6, x));
    assert_true(r[0] < DBL_MIN ? largest(2 * s.n, x) == 0 : fabs(12 * x[0] / r[0] - 1) < 5e-3);
  }
  must(msri_stiffness_solve(&w.state->stiffness, r, 1e-6, x));
  assert_true(largest(2 * s.n, x) == 0);
  close_world(w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pairs_are_sorted_and_merged),
      cmocka_unit_test(too_many_are_refused),
      cmocka_unit_test(solutions_are_those_of_dense_matrices),
      cmocka_unit_test(the_matrix_is_the_derivative),
      cmocka_unit_test(large_lattices_are_solved),
      cmocka_unit_test(large_meshes_are_solved),
      cmocka_unit_test(factors_of_a_turned_lattice_are_exact),
      cmocka_unit_test(stiff_beyond_rounding_is_told),
      cmocka_unit_test(nonsense_is_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
