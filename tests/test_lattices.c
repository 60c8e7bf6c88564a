/* test_lattices.c - the springs of pictures and of programs: which masses they join, compared with
 * a search through all pairs, and the sum of their pulls on each. */
#include "scenes.h"

/* ---- The springs of pictures, and of programs */

/* A spring between masses i and j, or (j = ANCHOR) to (x, y). */
typedef struct link {
  size_t i, j;
  double x, y, k, L;
} link;

typedef struct links {
  size_t n;
  link *link;
} links;

static const size_t ANCHOR = SIZE_MAX;
static const double stiffness = 70;

static int by_ends(const void *a, const void *b) {
  const link *p = a, *q = b;
  const double order[] = {(double)p->i - (double)q->i,
                          (double)p->j - (double)q->j,
                          p->x - q->x,
                          p->y - q->y,
                          p->k - q->k,
                          p->L - q->L};
  for (size_t n = 0; n < LENGTH(order); n++)
    if (order[n] < 0 || order[n] > 0) return order[n] < 0 ? -1 : 1;
  return 0;
}

static links links_of(const msr_springs *springs) {
  links all = {0, zeroed(springs->n + springs->n_anchors, sizeof(link))};
  for (size_t r = 0; r < springs->n_runs; r++) {
    const msr_run_of_springs *run = &springs->run[r];
    for (size_t s = 0; s < run->count; s++)
      all.link[all.n++] = (link){run->first + s,          run->first + s + run->offset, 0, 0,
                                 run->k[s * run->stride], run->L[s * run->stride]};
  }
  assert_int_equal(all.n, springs->n);
  for (size_t a = 0; a < springs->n_anchors; a++) {
    const msr_anchor *anchor = &springs->anchor[a];
    all.link[all.n++] = (link){anchor->i, ANCHOR, anchor->x, anchor->y, anchor->k, anchor->L};
  }
  qsort(all.link, all.n, sizeof *all.link, by_ends);
  return all;
}

typedef struct drawing {
  size_t width, height;
  int neighbours;
  bool attach;
  bool full; /* no holes: long runs of springs */
} drawing;

static const drawing drawings[] = {
    {.width = 1, .height = 1, .neighbours = 4},
    {.width = 9, .height = 1, .neighbours = 8, .attach = true},
    {.width = 1, .height = 9, .neighbours = 8, .attach = true},
    {.width = 2, .height = 2, .neighbours = 8, .full = true},
    {.width = 14, .height = 9, .neighbours = 4},
    {.width = 14, .height = 9, .neighbours = 8},
    {.width = 14, .height = 9, .neighbours = 4, .attach = true},
    {.width = 9, .height = 14, .neighbours = 8, .attach = true},
    {.width = 600, .height = 2, .neighbours = 8, .full = true},
};

/* More masses than air or supports. */
static msr_picture *random_picture(const drawing *d, uint64_t *dice) {
  msr_picture *picture;
  must(msr_picture_create(d->width, d->height, &picture, &why));
  for (size_t p = 0; p < d->width * d->height; p++) {
    const size_t kind = d->full ? 0 : random_below(dice, 8);
    if (kind < 6) memcpy(picture->rgb + 3 * p, (const unsigned char[]){255, 0, 0}, 3);
    if (kind == 7) memset(picture->rgb + 3 * p, 0, 3);
  }
  return picture;
}

static bool neighbours(const drawing *d, double dx, double dy) {
  const double steps = fabs(dx) + fabs(dy), most = fmax(fabs(dx), fabs(dy));
  return steps > 0.5 && most < 1.5 && (d->neighbours == 8 || steps < 1.5);
}

/* All pairs of masses, and of masses and black pixels, that are neighbours. */
static links search(const drawing *d, const msr_picture *picture, const msr_view *s) {
  links all = {0, zeroed(8 * s->n, sizeof(link))};
  for (size_t i = 0; i < s->n; i++) {
    for (size_t j = i + 1; j < s->n; j++) {
      const double dx = s->x[j] - s->x[i], dy = s->y[j] - s->y[i];
      if (neighbours(d, dx, dy))
        all.link[all.n++] = (link){i, j, 0, 0, stiffness, sqrt(dx * dx + dy * dy)};
    }
    for (size_t p = 0; d->attach && p < d->width * d->height; p++) {
      const double x = (double)(p % d->width) + 0.5;
      const double y = (double)(d->height - p / d->width) - 0.5;
      const double dx = x - s->x[i], dy = y - s->y[i];
      if (picture->rgb[3 * p] == 0 && neighbours(d, dx, dy))
        all.link[all.n++] = (link){i, ANCHOR, x, y, stiffness, sqrt(dx * dx + dy * dy)};
    }
  }
  qsort(all.link, all.n, sizeof *all.link, by_ends);
  return all;
}

static void check_same(const links *a, const links *b) {
  assert_int_equal(a->n, b->n);
  for (size_t n = 0; n < a->n; n++)
    if (by_ends(&a->link[n], &b->link[n]) != 0)
      fail_msg("spring %zu: %zu -- %zu, not %zu -- %zu", n, a->link[n].i, a->link[n].j,
               b->link[n].i, b->link[n].j);
}

/* Adds a spring's pull on mass i by what is at (x, y), and its possible size. */
static void pull(const msr_view *s, size_t i, double x, double y, double k, double L, double *f,
                 double *size) {
  const double dx = x - s->x[i], dy = y - s->y[i], l = hypot(dx, dy);
  if (!(l > 0)) return;
  f[i] += k * (l - L) * dx / l;
  f[i + s->n] += k * (l - L) * dy / l;
  size[i] += k * (l + L);
}

/* Forces of the state against a sum spring by spring, on each mass within the rounding of a few
 * operations on each of its springs. */
static void check_sum(msr_state *state, const links *all) {
  const msr_view s = msr_state_view(state);
  double *f = zeroed(2 * s.n, sizeof *f), *sum = zeroed(2 * s.n, sizeof *sum);
  double *size = zeroed(s.n, sizeof *size);
  must(msr_state_forces(state, f, f + s.n, &why));
  for (size_t n = 0; n < all->n; n++) {
    const link *l = &all->link[n];
    const bool anchor = l->j == ANCHOR;
    pull(&s, l->i, anchor ? l->x : s.x[l->j], anchor ? l->y : s.y[l->j], l->k, l->L, sum, size);
    if (!anchor) pull(&s, l->j, s.x[l->i], s.y[l->i], l->k, l->L, sum, size);
  }
  for (size_t i = 0; i < 2 * s.n; i++)
    if (!(fabs(f[i] - sum[i]) <= 16 * DBL_EPSILON * size[i % s.n]))
      fail_msg("mass %zu: %.17g, not %.17g", i % s.n, f[i], sum[i]);
  free(f);
  free(sum);
  free(size);
}

static void shake(msr_state *state, uint64_t *dice) {
  const size_t n = msr_state_view(state).n;
  const msr_arrays s = msr_state_edit(state);
  for (size_t i = 0; i < n; i++) {
    s.x[i] += uniform(dice, -0.8, 0.8);
    s.y[i] += uniform(dice, -0.8, 0.8);
  }
}

/* The same mesh by a program: springs in any order, from either end. */
static world by_hand(const msr_view *s, const links *all, uint64_t *dice) {
  msr_scene *scene = empty_scene(0.01);
  for (size_t i = 0; i < s->n; i++) add_mass(scene, s->x[i], s->y[i], 0, 0, msr_view_mass(s, i));
  for (size_t n = 0; n < all->n; n++) {
    const link *l = &all->link[n * 7919 % all->n]; /* a prime larger than any n here */
    const bool turned = random_below(dice, 2);
    if (l->j == ANCHOR)
      must(msr_scene_add_anchor(scene, &(msr_anchor){l->i, l->x, l->y, l->k, l->L}, &why));
    else
      must(msr_scene_add_spring(scene, turned ? l->j : l->i, turned ? l->i : l->j, l->k, l->L,
                                &why));
  }
  return open_world(scene, NULL, 0);
}

static void check_drawing(const drawing *d, uint64_t *dice) {
  const msr_conf conf = {0.001, 0, 0.5, stiffness, 10, 1};
  const msr_scene_options options = {.neighbours = d->neighbours, .attach = d->attach};
  msr_picture *picture = random_picture(d, dice);
  msr_scene *scene;
  must(msr_scene_from_picture("test", picture, &conf, &options, &scene, &why));
  world w = open_world(scene, NULL, 0);
  const msr_view s = msr_state_view(w.state);
  links expected = search(d, picture, &s), drawn = links_of(s.springs);
  check_same(&drawn, &expected);
  world hand = by_hand(&s, &expected, dice);
  links added = links_of(msr_state_view(hand.state).springs);
  check_same(&added, &expected);
  uint64_t same = *dice;
  shake(w.state, dice);
  shake(hand.state, &same);
  check_sum(w.state, &expected);
  check_sum(hand.state, &expected);
  free(expected.link);
  free(drawn.link);
  free(added.link);
  msr_picture_free(picture);
  close_world(w);
  close_world(hand);
}

static void pictures_have_the_springs_of_a_search(void **state) {
  (void)state;
  uint64_t dice = 20;
  for (size_t n = 0; n < LENGTH(drawings); n++) check_drawing(&drawings[n], &dice);
}

/* As many masses as make several bands of sorting, springs of any length between them. */
static void a_large_mesh_loses_no_spring(void **state) {
  (void)state;
  const mesh m = {.masses = 2500, .springs = 9000, .seed = 11};
  tie *ties = zeroed(m.springs, sizeof *ties);
  links all = {m.springs, zeroed(m.springs, sizeof(link))};
  world w = open_world(random_mesh(&m, ties), NULL, 0);
  for (size_t n = 0; n < m.springs; n++)
    all.link[n] = (link){ties[n].i, ties[n].j, 0, 0, ties[n].k, ties[n].L};
  assert_int_equal(msr_plan_describe(w.plan).springs, m.springs);
  check_sum(w.state, &all);
  free(ties);
  free(all.link);
  close_world(w);
}

/* One run of springs, of many blocks, no two of which are alike. */
static void a_long_chain_has_its_own_springs(void **state) {
  (void)state;
  enum { N = 800 };
  uint64_t dice = 12;
  msr_scene *scene = empty_scene(0.01);
  links all = {N - 1, zeroed(N, sizeof(link))};
  for (size_t i = 0; i < N; i++) {
    add_mass(scene, uniform(&dice, 0, 9), uniform(&dice, 0, 9), 0, 0, 1);
    if (i == 0) continue;
    const link l = {i - 1, i, 0, 0, uniform(&dice, 1, 9), uniform(&dice, 1, 9)};
    must(msr_scene_add_spring(scene, l.i, l.j, l.k, l.L, &why));
    all.link[i - 1] = l;
  }
  world w = open_world(scene, NULL, 0);
  check_sum(w.state, &all);
  free(all.link);
  close_world(w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pictures_have_the_springs_of_a_search),
      cmocka_unit_test(a_large_mesh_loses_no_spring),
      cmocka_unit_test(a_long_chain_has_its_own_springs),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
