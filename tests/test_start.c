/* test_start.c - from a scene to a plan: which pixel is which mass, springs in their order, bounds
 * of the stable step, and what is kept of all that. Fast ways are compared with the simplest. */
#include "plan/objects.h"
#include "scenes.h"

#include "forces/mesh.h"

#include <pthread.h>

static const msr_conf usual = {0.005, 9.8, 0.1, 1500, 8, 2};

/* ---- Pictures at random, in stretches of up to `longest` pixels of one kind, some of one colour
 */

typedef struct drawing {
  size_t width, height, longest;
  int neighbours;
  bool attach;
} drawing;

static const drawing drawings[] = {
    {1, 1, 1, 4, false},     {1, 40, 3, 8, true},    {40, 1, 3, 8, true},  {7, 30, 1, 4, false},
    {30, 7, 2, 8, true},     {33, 29, 5, 4, true},   {29, 33, 9, 8, true}, {64, 64, 300, 8, false},
    {250, 20, 40, 8, false}, {20, 250, 200, 4, true}};

static msr_picture *draw(const drawing *d, uint64_t *dice) {
  static const unsigned char mass[][3] = {{255, 255, 0}, {0, 0, 255}, {255, 0, 255}, {0, 64, 0}};
  msr_picture *picture;
  must(msr_picture_create(d->width, d->height, &picture, &why));
  for (size_t p = 0, end = 0, kind = 0; p < d->width * d->height; p++) {
    if (p == end) end += 1 + random_below(dice, d->longest), kind = random_below(dice, 7);
    unsigned char *rgb = picture->rgb + 3 * p;
    if (kind == 6) memset(rgb, 0, 3);
    if (kind < 5) memcpy(rgb, mass[kind < 2 ? kind : random_below(dice, 4)], 3);
  }
  return picture;
}

/* Is the pixel a mass, or is it a support? */
static bool has(const msr_picture *p, size_t column, size_t row, bool mass) {
  const unsigned char *rgb = p->rgb + 3 * (row * p->width + column);
  const int sum = rgb[0] + rgb[1] + rgb[2];
  return mass ? sum > 0 && sum < 3 * 255 : sum == 0;
}

static msr_scene *scene_with(const drawing *d, const msr_picture *picture) {
  const msr_scene_options options = {.neighbours = d->neighbours, .attach = d->attach};
  msr_scene *scene;
  must(msr_scene_from_picture("test", picture, &usual, &options, &scene, &why));
  return scene;
}

/* ---- Masses */

static void check_pixels(const msr_scene *scene, const world *w, const msr_picture *picture) {
  const msr_view s = msr_state_view(w->state);
  size_t mass = 0, supports = 0, column, row, index;
  for (size_t r = 0; r < picture->height; r++)
    for (size_t c = 0; c < picture->width; c++) {
      supports += has(picture, c, r, false);
      if (!has(picture, c, r, true)) {
        assert_int_equal(msr_scene_mass_at(scene, c, r, &index, NULL), MSR_EUSAGE);
        continue;
      }
      must(msr_scene_mass_at(scene, c, r, &index, &why));
      assert_int_equal(index, mass);
      assert_true(msr_plan_pixel(w->plan, mass, &column, &row) && column == c && row == r);
      assert_true(s.x[mass] == (double)c + 0.5);
      assert_true(s.y[mass] == (double)(picture->height - r) - 0.5);
      assert_true(s.vx[mass] == 0 && s.vy[mass] == 0);
      mass++;
    }
  assert_int_equal(mass, s.n);
  assert_false(msr_plan_pixel(w->plan, mass, &column, &row));
  assert_int_equal(msr_plan_describe(w->plan).supports, supports);
}

static void masses_are_found_where_they_are(void **unused) {
  (void)unused;
  uint64_t dice = 3;
  for (size_t n = 0; n < 5 * LENGTH(drawings); n++) {
    const drawing *d = &drawings[n % LENGTH(drawings)];
    msr_picture *picture = draw(d, &dice);
    msr_scene *scene = scene_with(d, picture);
    world w;
    must(msr_plan_create(scene, NULL, &w.plan, &why));
    must(msr_state_create(w.plan, &w.state, &why));
    check_pixels(scene, &w, picture);
    close_world(w);
    msr_scene_free(scene);
    msr_picture_free(picture);
  }
}

/* ---- Springs: spring by spring, each joining the run before if it can */

typedef struct chain {
  size_t n;
  msr_run_of_springs *run;
  double k, L[2];
} chain;

static void append(chain *all, size_t i, size_t j, const double *L) {
  msr_run_of_springs *last = all->n > 0 ? &all->run[all->n - 1] : NULL;
  if (last && last->first + last->count == i && last->offset == j - i && last->L == L) {
    last->count++;
    return;
  }
  all->run[all->n++] = (msr_run_of_springs){i, 1, j - i, &all->k, L, 0};
}

/* From the masses of a row to those `right` and `down` of them, from left to right. */
static void tie_each(chain *all, const msr_picture *p, const size_t *number, size_t row, int right,
                     size_t down) {
  for (size_t c = 0; c < p->width; c++) {
    const size_t to = c + (size_t)right;
    if (!has(p, c, row, true) || to >= p->width || !has(p, to, row + down, true)) continue;
    append(all, number[row * p->width + c], number[(row + down) * p->width + to],
           &all->L[right != 0 && down > 0]);
  }
}

static void search(chain *all, const msr_picture *p, int neighbours) {
  *all = (chain){.k = usual.stiffness, .L = {1, sqrt(2)}};
  const size_t pixels = p->width * p->height;
  size_t *number = zeroed(pixels, sizeof *number);
  for (size_t n = 0, mass = 0; n < pixels; n++)
    number[n] = has(p, n % p->width, n / p->width, true) ? mass++ : 0;
  all->run = zeroed(4 * pixels, sizeof *all->run);
  for (size_t row = 0; row < p->height; row++) {
    for (int d = 0; row > 0 && d < (neighbours == 8 ? 3 : 1); d++)
      tie_each(all, p, number, row - 1, (const int[]){0, -1, 1}[d], 1);
    tie_each(all, p, number, row, 1, 0);
  }
  free(number);
}

static void springs_are_in_their_order(void **unused) {
  (void)unused;
  uint64_t dice = 4;
  for (size_t n = 0; n < 5 * LENGTH(drawings); n++) {
    const drawing *d = &drawings[n % LENGTH(drawings)];
    msr_picture *picture = draw(d, &dice);
    world w = open_world(scene_with(d, picture), NULL, 0);
    const msr_springs *made = msr_state_view(w.state).springs;
    chain due;
    search(&due, picture, d->neighbours);
    assert_int_equal(made->n_runs, due.n);
    for (size_t r = 0; r < due.n; r++) {
      const msr_run_of_springs *a = &made->run[r], *b = &due.run[r];
      assert_true(a->first == b->first && a->count == b->count && a->offset == b->offset);
      assert_true(a->k[0] == b->k[0] && a->L[0] == b->L[0] && a->stride == 0);
    }
    free(due.run);
    close_world(w);
    msr_picture_free(picture);
  }
}

/* By bands of 1024 masses, offsets, masses, then values. */
static int in_order(const void *a, const void *b) {
  const tie *p = a, *q = b;
  const double order[] = {(double)(p->i / 1024) - (double)(q->i / 1024),
                          (double)(p->j - p->i) - (double)(q->j - q->i),
                          (double)p->i - (double)q->i, p->k - q->k, p->L - q->L};
  for (size_t n = 0; n < LENGTH(order); n++)
    if (order[n] < 0 || order[n] > 0) return order[n] < 0 ? -1 : 1;
  return 0;
}

static void added_springs_are_sorted(void **unused) {
  (void)unused;
  enum { TWINS = 100 }; // springs between the same two masses, as stiff
  const mesh m = {.masses = 5000, .springs = 20000, .seed = 13};
  const size_t springs = m.springs + TWINS;
  tie *due = zeroed(springs, sizeof *due);
  msr_scene *scene = random_mesh(&m, due);
  for (size_t n = m.springs; n < springs; n++) {
    due[n] = (tie){8, 9, 7, (double)(n * 37 % TWINS)};
    must(msr_scene_add_spring(scene, due[n].i, due[n].j, due[n].k, due[n].L, &why));
  }
  world w = open_world(scene, NULL, 0);
  for (size_t n = 0; n < springs; n++)
    if (due[n].i > due[n].j) due[n] = (tie){due[n].j, due[n].i, due[n].k, due[n].L};
  qsort(due, springs, sizeof *due, in_order);
  const msr_springs *made = msr_state_view(w.state).springs;
  size_t n = 0;
  for (size_t r = 0; r < made->n_runs; r++) {
    const msr_run_of_springs *run = &made->run[r];
    for (size_t s = 0; s < run->count; s++, n++) {
      assert_true(run->first + s == due[n].i && run->first + s + run->offset == due[n].j);
      assert_true(run->k[s * run->stride] == due[n].k && run->L[s * run->stride] == due[n].L);
    }
  }
  assert_int_equal(n, springs);
  free(due);
  close_world(w);
}

/* ---- Bounds: all row sums at once, in the order of the springs */

static double bound_at_once(const msr_view *s, const double *weight) {
  double *row = zeroed(s->n, sizeof *row), most = 0;
  for (size_t r = 0; r < s->springs->n_runs; r++) {
    const msr_run_of_springs *run = &s->springs->run[r];
    for (size_t n = 0; n < run->count; n++) {
      const double twice = 2 * (weight ? *weight : run->k[n * run->stride]);
      row[run->first + n] += twice;
      row[run->first + n + run->offset] += twice;
    }
  }
  for (size_t a = 0; a < s->springs->n_anchors; a++)
    row[s->springs->anchor[a].i] += weight ? *weight : s->springs->anchor[a].k;
  for (size_t i = 0; i < s->n; i++) most = fmax(most, row[i] / msr_view_mass(s, i));
  free(row);
  return most;
}

/* The same bits, of stiffnesses and of any weight. */
static void check_bounds(msr_scene *scene) {
  const double weight = 0.3;
  double bound;
  world w = open_world(scene, NULL, 0);
  const msr_view s = msr_state_view(w.state);
  must(msri_mesh_bound(&s, NULL, &bound));
  assert_true(bound == bound_at_once(&s, NULL));
  must(msri_mesh_bound(&s, &weight, &bound));
  assert_true(bound == bound_at_once(&s, &weight));
  close_world(w);
}

/* Masses in rows of `width`, joined to the right and below, all equal or all different. */
static msr_scene *lattice_by_hand(size_t masses, size_t width, bool equal) {
  uint64_t dice = masses;
  msr_scene *scene = empty_scene(0.001);
  for (size_t i = 0; i < masses; i++)
    add_mass(scene, (double)(i % width), (double)(i / width), 0, 0,
             equal ? 1 : uniform(&dice, 1, 2));
  for (size_t i = 0; i + 1 < masses; i++) {
    const double k = equal ? 7 : uniform(&dice, 1, 9);
    if (i % width + 1 < width) must(msr_scene_add_spring(scene, i, i + 1, k, 1, &why));
    if (i + width < masses) must(msr_scene_add_spring(scene, i, i + width, k, 1, &why));
  }
  return scene;
}

static void bounds_need_not_all_rows_at_once(void **unused) {
  (void)unused;
  static const drawing large[] = {{400, 300, 90, 8, true},
                                  {300, 400, 5000, 4, false},
                                  {150000, 1, 100000, 4, false},
                                  {50000, 3, 30000, 8, true},
                                  {1, 100000, 7, 4, false}};
  uint64_t dice = 6;
  for (size_t n = 0; n < LENGTH(large); n++) {
    msr_picture *picture = draw(&large[n], &dice);
    check_bounds(scene_with(&large[n], picture));
    msr_picture_free(picture);
  }
  for (int equal = 0; equal < 2; equal++) {
    check_bounds(lattice_by_hand(80000, 200, equal));
    check_bounds(lattice_by_hand(80000, 40000, equal));
  }
  check_bounds(
      random_mesh(&(mesh){.masses = 70000, .springs = 40000, .anchors = 9, .seed = 8}, NULL));
  for (size_t masses = 1; masses < 60; masses++) check_bounds(lattice_by_hand(masses, 4, false));
}

/* ---- Memory */

static size_t plan_bytes(msr_scene *scene) {
  world w = open_world(scene, &msr_integrator_verlet, 1);
  const size_t bytes = msr_plan_describe(w.plan).plan_bytes;
  close_world(w);
  return bytes;
}

/* Colours, a bit and a byte for supports, a number for each row, names and reasons, and runs: two
 * for each row of a full picture, or four with diagonals; of others what there are. Rows of objects
 * and their pieces aren't more than rows and runs. */
static void check_bytes(const drawing *d, msr_picture *picture) {
  const size_t rest = 3 * d->width * d->height + d->height * sizeof(size_t);
  world w = open_world(scene_with(d, picture), NULL, 0);
  const size_t runs = msr_state_view(w.state).springs->n_runs;
  if (d->longest == 0) assert_int_equal(runs, (d->height - 1) * (size_t)d->neighbours / 2 + 1);
  assert_in_range(msr_plan_describe(w.plan).plan_bytes, rest,
                  rest + d->width * d->height * 9 / 8 + d->height * sizeof(size_t) + 8192 +
                      runs * (sizeof(msr_run_of_springs) + sizeof(msri_piece)));
  close_world(w);
  msr_picture_free(picture);
}

static void pictures_take_colours_and_runs(void **unused) {
  (void)unused;
  uint64_t dice = 9;
  for (int neighbours = 4; neighbours <= 8; neighbours += 4) {
    const drawing full = {500, 400, 0, neighbours, false}, torn = {300, 400, 30, neighbours, false};
    msr_picture *picture;
    must(msr_picture_create(full.width, full.height, &picture, &why));
    for (size_t p = 0; p < full.width * full.height; p++) picture->rgb[3 * p] = 0;
    check_bytes(&full, picture);
    check_bytes(&torn, draw(&torn, &dice));
  }
}

/* Stiffness and length of a lattice by hand: alike all over, in each row, or in no two springs. */
typedef struct variety {
  bool rows, springs;
} variety;

static double value_of(const variety *v, size_t i, size_t j) {
  return 1 + (v->rows ? (double)(i / 100) : 0) + (v->springs ? (double)(i + j) / 7 : 0);
}

static msr_scene *varied(const variety *v) {
  msr_scene *scene = empty_scene(0.001);
  for (size_t i = 0; i < 10000; i++) add_mass(scene, (double)(i % 100), (double)(i / 100), 0, 0, 1);
  for (size_t i = 0; i < 10000; i++) {
    const double k = value_of(v, i, i + 1);
    if (i % 100 < 99) must(msr_scene_add_spring(scene, i + 1, i, k, k / 2, &why));
  }
  return scene;
}

/* Each spring has its own values; 99 make a run, and share one if they are alike, as runs do. */
static void what_is_alike_is_kept_once(void **unused) {
  (void)unused;
  const struct {
    variety of;
    size_t values, stride;
  } rows[] = {{{false, false}, 1, 0}, {{true, false}, 100, 0}, {{false, true}, 9900, 1}};
  const size_t least = plan_bytes(varied(&rows[0].of));
  for (size_t n = 0; n < LENGTH(rows); n++) {
    const size_t more = (rows[n].values - 1) * 2 * sizeof(double);
    assert_int_equal(plan_bytes(varied(&rows[n].of)), least + more);
    world w = open_world(varied(&rows[n].of), NULL, 0);
    const msr_springs *springs = msr_state_view(w.state).springs;
    assert_int_equal(springs->n_runs, 100);
    for (size_t r = 0; r < 100; r++) {
      const msr_run_of_springs *run = &springs->run[r];
      assert_true(run->count == 99 && run->stride == rows[n].stride);
      for (size_t s = 0; s < run->count; s++) {
        const double due = value_of(&rows[n].of, run->first + s, run->first + s + run->offset);
        assert_true(run->k[s * run->stride] == due && run->L[s * run->stride] == due / 2);
      }
    }
    close_world(w);
  }
}

/* Velocities are kept if there is one. */
static void masses_that_move_take_more(void **unused) {
  (void)unused;
  size_t bytes[2];
  for (int moving = 0; moving < 2; moving++) {
    msr_scene *scene = empty_scene(0.001);
    for (size_t i = 0; i < 1000; i++) add_mass(scene, (double)i, 2, 0, i == 999 ? moving : 0, 1);
    world w = open_world(scene, NULL, 0);
    const msr_view s = msr_state_view(w.state);
    bytes[moving] = msr_plan_describe(w.plan).plan_bytes;
    for (size_t i = 0; i < 1000; i++) {
      assert_true(s.x[i] == (double)i && s.y[i] == 2 && s.vx[i] == 0);
      assert_true(s.vy[i] == (i == 999 ? moving : 0));
    }
    close_world(w);
  }
  assert_int_equal(bytes[1] - bytes[0], 1000 * 2 * sizeof(double));
}

/* ---- One picture for a scene and its plans */

static void *free_plan(void *plan) {
  msr_plan_free(plan);
  return NULL;
}

/* Whoever is the last frees the picture: a tool that looks at memory and threads sees the rest. */
static void plans_share_a_picture(void **unused) {
  (void)unused;
  enum { THREADS = 4 };
  pthread_t thread[THREADS];
  msr_plan *plan[THREADS];
  for (int round = 0; round < 20; round++) {
    msr_scene *scene = scene_of(pegs, &usual, NULL);
    for (size_t n = 0; n < THREADS; n++) must(msr_plan_create(scene, NULL, &plan[n], &why));
    for (size_t n = 0; n < THREADS; n++)
      assert_int_equal(pthread_create(&thread[n], NULL, free_plan, plan[n]), 0);
    msr_scene_free(scene);
    for (size_t n = 0; n < THREADS; n++) assert_int_equal(pthread_join(thread[n], NULL), 0);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(masses_are_found_where_they_are),
      cmocka_unit_test(springs_are_in_their_order),
      cmocka_unit_test(added_springs_are_sorted),
      cmocka_unit_test(bounds_need_not_all_rows_at_once),
      cmocka_unit_test(pictures_take_colours_and_runs),
      cmocka_unit_test(what_is_alike_is_kept_once),
      cmocka_unit_test(masses_that_move_take_more),
      cmocka_unit_test(plans_share_a_picture),
  };
  return cmocka_run_group_tests_name("start", tests, NULL, NULL);
}
