/* test_plan.c - plans: their figures, the stable step against closed forms and against what really
 * explodes, substeps, notes, memory, and the arithmetic of frames.
 * link: --wrap=malloc --wrap=calloc --wrap=realloc --wrap=free */
#include "art.h"

#include <malloc.h>

/* ---- Memory in use */

static size_t in_use; /* [bytes] */

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *block, size_t size);
void __real_free(void *block);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *block, size_t size);
void __wrap_free(void *block);

static void *counted(void *block) {
  in_use += malloc_usable_size(block);
  return block;
}

void *__wrap_malloc(size_t size) { return counted(__real_malloc(size)); }

void *__wrap_calloc(size_t count, size_t size) { return counted(__real_calloc(count, size)); }

void *__wrap_realloc(void *block, size_t size) {
  in_use -= malloc_usable_size(block);
  return counted(__real_realloc(block, size));
}

void __wrap_free(void *block) {
  in_use -= malloc_usable_size(block);
  __real_free(block);
}

/* ---- Scenes */

static const msr_conf usual = {0.005, 0, 0.1, 1500, 1, 1};

/* A rectangle of masses in the middle of a picture, a row of supports `below` it if not 0. */
static msr_scene *lattice(size_t width, size_t height, size_t below, const msr_conf *conf,
                          msr_scene_options options) {
  msr_picture *picture;
  must(msr_picture_create(width + 4, height + 4, &picture, &why));
  for (size_t r = 2; r < height + 2; r++)
    for (size_t c = 2; c < width + 2; c++) {
      unsigned char *rgb = picture->rgb + 3 * (r * picture->width + c);
      rgb[1] = rgb[2] = 0;
    }
  if (below > 0)
    memset(picture->rgb + 3 * ((height + 1 + below) * picture->width), 0, 3 * (width + 4));
  return scene_from(picture, conf, &options);
}

static msr_plan *plan_with(msr_scene *scene, const msr_integrator *integrator, uint64_t substeps) {
  const msr_plan_options options = {.integrator = integrator, .substeps = substeps};
  msr_plan *plan;
  msr_error err = {.message = ""};
  if (msr_plan_create(scene, &options, &plan, &err) != MSR_OK) fail_msg("%s", err.message);
  msr_scene_free(scene);
  return plan;
}

/* The figures of a plan that is made for them alone; the scene is freed. */
static msr_plan_figures figures_of(msr_scene *scene, const msr_integrator *integrator,
                                   uint64_t substeps) {
  msr_plan *plan = plan_with(scene, integrator, substeps);
  const msr_plan_figures f = msr_plan_describe(plan);
  msr_plan_free(plan);
  return f;
}

static bool near(double a, double b) { return fabs(a - b) <= 1e-12 * fabs(b); }

/* ---- Figures */

static void a_lattice_has_so_many_springs(void **unused) {
  (void)unused;
  static const size_t sides[][2] = {{1, 1}, {1, 7}, {7, 1}, {2, 2}, {3, 5}, {24, 24}, {300, 2}};
  for (size_t i = 0; i < LENGTH(sides); i++) {
    const size_t w = sides[i][0], h = sides[i][1];
    const size_t sides_4 = w * (h - 1) + h * (w - 1), diagonals = 2 * (w - 1) * (h - 1);
    for (int neighbours = 4; neighbours <= 8; neighbours += 4) {
      const msr_scene_options options = {.neighbours = neighbours};
      const msr_plan_figures f = figures_of(lattice(w, h, 0, &usual, options), NULL, 0);
      assert_int_equal(f.masses, w * h);
      assert_int_equal(f.springs, sides_4 + (neighbours == 8 ? diagonals : 0));
      assert_true(f.anchors == 0 && f.supports == 0);
      assert_true(f.width == w + 4 && f.height == h + 4);
      assert_true(f.dt == 0.005 && f.iterations == 1 && f.images == 1);
      assert_ptr_equal(f.integrator, &msr_integrator_verlet);
    }
  }
}

/* Are pixels p and q of a picture, both masses, next to each other? */
static bool beside(const msr_picture *picture, size_t p, size_t q, int neighbours) {
  const size_t w = picture->width;
  const double dx = fabs((double)(p % w) - (double)(q % w));
  const double dy = fabs((double)(p / w) - (double)(q / w));
  return neighbours == 8 ? dx <= 1 && dy <= 1 : dx + dy <= 1;
}

/* Of a picture with holes: every pair of neighbours once, and no other. */
static void springs_join_neighbours(void **unused) {
  (void)unused;
  enum { SIDE = 9 };
  for (unsigned seed = 0; seed < 40; seed++) {
    const int neighbours = seed % 2 ? 8 : 4;
    size_t pixel[SIDE * SIDE], n = 0, pairs = 0;
    static int joined[SIDE * SIDE][SIDE * SIDE];
    memset(joined, 0, sizeof joined);
    msr_picture *picture;
    msr_scene *scene;
    msr_state *state;
    must(msr_picture_create(SIDE, SIDE, &picture, &why));
    for (size_t p = 0; p < SIDE * SIDE; p++) {
      if ((p * 7919 + seed * 104729) % 11 < 4) continue;
      picture->rgb[3 * p + 1] = 0;
      pixel[n++] = p;
    }
    const msr_scene_options options = {.neighbours = neighbours};
    must(msr_scene_from_picture("p", picture, &usual, &options, &scene, &why));
    msr_plan *plan = plan_with(scene, NULL, 0);
    must(msr_state_create(plan, &state, &why));
    const msr_springs *springs = msr_state_view(state).springs;
    for (size_t r = 0; r < springs->n_runs; r++) {
      const msr_run_of_springs *run = &springs->run[r];
      for (size_t i = run->first; i < run->first + run->count; i++) joined[i][i + run->offset]++;
    }
    for (size_t i = 0; i < n; i++)
      for (size_t j = i + 1; j < n; j++) {
        const bool near_by = beside(picture, pixel[i], pixel[j], neighbours);
        assert_int_equal(joined[i][j] + joined[j][i], near_by);
        pairs += near_by;
      }
    assert_int_equal(springs->n, pairs);
    assert_true(msr_state_energy(state).spring == 0);
    msr_state_free(state);
    msr_plan_free(plan);
    msr_picture_free(picture);
  }
}

/* Each mass of the lowest row is tied to the supports beside it: 1, or 3 with diagonals. */
static void attached_masses_have_anchors(void **unused) {
  (void)unused;
  for (size_t w = 1; w < 6; w++)
    for (int neighbours = 4; neighbours <= 8; neighbours += 4)
      for (size_t below = 1; below <= 2; below++)
        for (int attach = 0; attach < 2; attach++) {
          const msr_scene_options options = {neighbours, attach, false};
          const msr_plan_figures f = figures_of(lattice(w, 3, below, &usual, options), NULL, 0);
          const size_t each = neighbours == 8 ? 3 : 1;
          assert_int_equal(f.anchors, attach && below == 1 ? each * w : 0);
          assert_int_equal(f.supports, w + 4);
        }
}

/* An attached lattice starts at rest: its anchors are as long as in the picture. */
static void anchors_start_at_rest(void **unused) {
  (void)unused;
  msr_plan *plan =
      plan_with(lattice(4, 2, 1, &usual, (msr_scene_options){8, true, false}), NULL, 0);
  msr_state *state;
  must(msr_state_create(plan, &state, &why));
  const msr_energy e = msr_state_energy(state);
  assert_true(e.spring == 0 && near(e.longest, 1));
  msr_state_free(state);
  msr_plan_free(plan);
}

/* ---- Stable step */

/* Any state of a lattice is safe while K = k h^2 / m < 2 / degree (Verlet, h omega < 2). */
static void stable_step_of_lattices(void **unused) {
  (void)unused;
  static const struct {
    size_t width, height;
    int neighbours;
    double degree;
  } rows[] = {{2, 1, 4, 1}, {5, 1, 4, 2},   {2, 2, 4, 2}, {3, 3, 4, 4}, {24, 24, 4, 4},
              {2, 2, 8, 3}, {24, 24, 8, 8}, {3, 2, 8, 5}, {3, 2, 4, 3}};
  for (size_t i = 0; i < LENGTH(rows); i++)
    for (const msr_integrator *const *method = msr_integrators; *method; method++) {
      const msr_scene_options options = {.neighbours = rows[i].neighbours};
      const msr_plan_figures f =
          figures_of(lattice(rows[i].width, rows[i].height, 0, &usual, options), *method, 1);
      assert_true(near(f.omega * f.omega, 2 * rows[i].degree * 1500 / 0.1));
      const double limit = (*method)->stability / f.omega; /* may be 0, or infinite */
      assert_true(near(f.stable_step, limit) || f.stable_step == limit);
      assert_true(near(f.safe_step, 0.9 * limit) || f.safe_step == limit);
      assert_true(f.gamma == 0);
      const double K = 1500 / 0.1 * f.stable_step * f.stable_step;
      if ((*method)->stability == 2) assert_true(near(K, 2 / rows[i].degree));
    }
}

/* Gershgorin by hand: max over masses of (2 sum of k of springs + sum of k of anchors) / m. */
static double bound_by_hand(const msr_view *s, double z) {
  double row[64] = {0}, most = 0;
  for (size_t r = 0; r < s->springs->n_runs; r++) {
    const msr_run_of_springs *run = &s->springs->run[r];
    for (size_t n = 0; n < run->count; n++) {
      const double k = z > 0 ? z : run->k[n * run->stride];
      row[run->first + n] += 2 * k;
      row[run->first + n + run->offset] += 2 * k;
    }
  }
  for (size_t a = 0; a < s->springs->n_anchors; a++)
    row[s->springs->anchor[a].i] += z > 0 ? z : s->springs->anchor[a].k;
  for (size_t i = 0; i < s->n; i++) most = fmax(most, row[i] / msr_view_mass(s, i));
  return most;
}

/* Masses, stiffnesses and anchors all different, with damping and drag. */
static msr_scene *mixture(double z, double c) {
  msr_scene *scene;
  must(msr_scene_create(&scene, &why));
  for (size_t i = 0; i < 40; i++) {
    const msr_mass mass = {
        .x = (double)(i % 8), .y = (double)(i / 8), .m = 0.1 + (double)(i * i % 17)};
    must(msr_scene_add_mass(scene, &mass, NULL, &why));
  }
  for (size_t i = 0; i < 40; i++) {
    must(msr_scene_add_spring(scene, i, (i * 7 + 3) % 40, (double)(i % 5) * 100, 1, &why));
    const msr_anchor anchor = {i, 0, 0, (double)(i % 3) * 10, 1};
    if (i % 4 == 0) must(msr_scene_add_anchor(scene, &anchor, &why));
  }
  must(msr_scene_add_force(scene, &msr_force_damping, &(msr_damping){z}, &why));
  must(msr_scene_add_force(scene, &msr_force_drag, &(msr_drag){c}, &why));
  return scene;
}

/* Damping costs nothing where its flow is exact and the method's limit of it infinite, else a
 * share. */
static void stable_step_of_mixtures(void **unused) {
  (void)unused;
  const double z = 3, c = 0.2;
  for (const msr_integrator *const *method = msr_integrators; *method; method++) {
    msr_plan *plan = plan_with(mixture(z, c), *method, 1);
    msr_state *state;
    must(msr_state_create(plan, &state, &why));
    const msr_view s = msr_state_view(state);
    const msr_plan_figures f = msr_plan_describe(plan);
    const double omega = sqrt(bound_by_hand(&s, 0));
    const bool free = isinf((*method)->damping_stability);
    const double gamma = free ? 0 : bound_by_hand(&s, z) + c / 0.1;
    assert_true(near(f.omega, omega));
    assert_true(gamma > 0 ? near(f.gamma, gamma) : f.gamma == 0);
    const double slowed = free ? 0 : gamma / (*method)->damping_stability;
    const double share = f.stable_step * (omega / (*method)->stability + slowed);
    if (isinf((*method)->stability) && free)
      assert_true(isinf(f.stable_step));
    else if ((*method)->stability > 0)
      assert_true(near(share, 1));
    if ((*method)->stability == 0) assert_true(f.stable_step == 0);
    msr_state_free(state);
    msr_plan_free(plan);
  }
}

static msr_status rate_of_100(const void *self, const msr_view *s, double *omega2, double *gamma) {
  (void)self, (void)s, (void)omega2;
  *gamma = 100;
  return MSR_OK;
}

/* A damping without a flow is stepped by the midpoint rule, h gamma < 2, by methods that split. */
static void stable_step_without_a_flow(void **unused) {
  (void)unused;
  static const msr_force slow = {.name = "slow",
                                 .summary = "s",
                                 .uses_velocity = true,
                                 .add = add_nothing,
                                 .rates = rate_of_100};
  for (size_t i = 0; msr_integrators[i]; i++) {
    const double declared = msr_integrators[i]->damping_stability;
    const double limit = msr_integrators[i]->splits ? fmin(2, declared) : declared;
    msr_conf slack = usual;
    slack.stiffness = 0;
    msr_scene *scene = lattice(1, 1, 0, &slack, (msr_scene_options){0});
    must(msr_scene_add_force(scene, &slow, NULL, &why));
    const msr_plan_figures f = figures_of(scene, msr_integrators[i], 1);
    assert_true(near(f.stable_step, limit / 100) || f.stable_step == limit);
  }
}

static void nothing_stiff_is_stable_for_ever(void **unused) {
  (void)unused;
  for (const msr_integrator *const *method = msr_integrators; *method; method++) {
    const msr_plan_figures f =
        figures_of(lattice(1, 1, 0, &usual, (msr_scene_options){0}), *method, 0);
    assert_true(isinf(f.stable_step) && isinf(f.safe_step));
    assert_true(f.substeps == 1 && f.h == 0.005 && f.omega == 0);
  }
}

/* ---- What really explodes */

/* Does a free lattice with k = K, m = 1, h = 1, shaken a little, gain energy a hundredfold? */
static bool explodes(double K, int neighbours) {
  const msr_conf conf = {1, 0, 1, K, 1, 1};
  msr_plan *plan =
      plan_with(lattice(24, 24, 0, &conf, (msr_scene_options){.neighbours = neighbours}), NULL, 1);
  msr_state *state;
  must(msr_state_create(plan, &state, &why));
  const msr_arrays a = msr_state_edit(state);
  for (size_t i = 0; i < 24 * 24; i++) {
    a.vx[i] = 1e-6 * ((double)(i * 7919 % 101) - 50);
    a.vy[i] = 1e-6 * ((double)(i * 104729 % 97) - 48);
  }
  const double before = msr_state_energy(state).total;
  const msr_status status = msr_state_step(state, 600, NULL);
  const double after = msr_state_energy(state).total;
  msr_state_free(state);
  msr_plan_free(plan);
  return status != MSR_OK || !(after < 100 * before);
}

/* Found by bisection elsewhere: 1.005 and 0.504; a lattice at rest has K < 1 and K < 1/2 by theory,
 * a finite one a little more. The stable step, good at any stretch, is half of it. */
static void the_stable_step_is_below_what_explodes(void **unused) {
  (void)unused;
  static const struct {
    int neighbours;
    double limit, found;
  } rows[] = {{4, 1, 1.005}, {8, 0.5, 0.504}};
  for (size_t i = 0; i < LENGTH(rows); i++) {
    double stable = 0.5 * rows[i].limit, unstable = 1.5 * rows[i].limit;
    const msr_conf conf = {1, 0, 1, stable, 1, 1};
    const msr_scene_options options = {.neighbours = rows[i].neighbours};
    assert_true(near(figures_of(lattice(24, 24, 0, &conf, options), NULL, 1).stable_step, 1));
    assert_false(explodes(stable, rows[i].neighbours));
    assert_true(explodes(unstable, rows[i].neighbours));
    while (unstable - stable > 0.001 * rows[i].limit) {
      const double K = (stable + unstable) / 2;
      if (explodes(K, rows[i].neighbours))
        unstable = K;
      else
        stable = K;
    }
    assert_true(unstable > rows[i].limit);
    assert_true(fabs(unstable - rows[i].found) < 0.005 * rows[i].found);
  }
}

/* ---- Substeps and notes */

static msr_scene *block(double dt, size_t below) {
  msr_conf conf = usual;
  conf.dt = dt;
  return lattice(5, 5, below, &conf, (msr_scene_options){0});
}

/* sqrt(0.5 m / k): the assignment's lattice of 4 neighbours. */
#define STABLE 0.0057735026918962576

static void substeps_are_as_few_as_is_safe(void **unused) {
  (void)unused;
  static const double steps[] = {1e-6, 0.001, 0.005, 0.0052, 0.0058, 0.01, 0.1, 1, 100};
  for (size_t i = 0; i < LENGTH(steps); i++)
    for (size_t below = 0; below <= 2; below += 2) {
      const double dt = steps[i], safe = (below ? 0.42 : 0.9) * STABLE;
      const msr_plan_figures f = figures_of(block(dt, below), NULL, 0);
      assert_true(near(f.stable_step, STABLE) && near(f.safe_step, safe));
      assert_true(f.h == dt / (double)f.substeps);
      assert_true(f.h <= safe * (1 + 1e-11));
      if (f.substeps > 1) assert_true(dt / (double)(f.substeps - 1) > safe);
      assert_int_equal(figures_of(block(dt, below), NULL, 1).substeps, 1);
      assert_int_equal(figures_of(block(dt, below), NULL, 7).substeps, 7);
    }
  // a DT that is the safe step itself, but for rounding, takes one
  assert_int_equal(figures_of(block(0.9 * STABLE * (1 + 1e-14), 0), NULL, 0).substeps, 1);
}

/* Where a fall of the picture's height (9 px) can crush springs, m g H > 0.15 k L^2, the step of a
 * method that was asked for is smaller in proportion, down to an eighth; where nothing is met, it
 * isn't. By default states see for themselves. */
static void safe_steps_are_smaller_where_springs_are_crushed(void **unused) {
  (void)unused;
  static const struct {
    double crush; /* m g H / k L^2 */
    size_t below;
    double share;
  } rows[] = {{0.1, 2, 0.5},       {0.149, 2, 0.5}, {0.3, 2, 0.25}, {-0.3, 2, 0.25},
              {1.2, 2, 0.5 / 8.0}, {99, 2, 0.0625}, {0.3, 0, 0.9}};
  for (size_t i = 0; i < LENGTH(rows); i++) {
    msr_conf conf = usual;
    conf.gravity = rows[i].crush * conf.stiffness / (9 * conf.mass);
    const msr_plan_figures f = figures_of(
        lattice(5, 5, rows[i].below, &conf, (msr_scene_options){0}), &msr_integrator_verlet, 0);
    assert_true(near(f.safe_step, rows[i].share * STABLE));
    const msr_plan_figures any =
        figures_of(lattice(5, 5, rows[i].below, &conf, (msr_scene_options){0}), NULL, 0);
    assert_true(near(any.safe_step, (rows[i].below ? 0.42 : 0.9) * STABLE));
  }
}

/* A pair by a program, above a support or not: 2 m v^2 / 2 is 0.15 k L^2 / 2 at 33.5 px/s, and
 * k (L - l)^2 / 2 is at 0.613 px; 2 px is where a spring has just enough to get to no length. */
static void safe_steps_are_smaller_where_the_start_crushes_springs(void **unused) {
  (void)unused;
  static const struct {
    double speed, length; /* of both masses, of the spring of L = 1 */
    bool below;
    double share;
  } rows[] = {{0, 1, true, 0.5},         {33, 1, true, 0.5},     {34, 1, true, 0.5 / 64},
              {1e6, 1, true, 0.5 / 64},  {1e6, 1, false, 0.9},   {0, 0.62, false, 0.9},
              {0, 0.6, false, 0.5 / 64}, {0, 0, true, 0.5 / 64}, {0, 2, false, 0.9},
              {0, 3, false, 0.5 / 64}};
  for (size_t i = 0; i < LENGTH(rows); i++) {
    msr_scene *scene = scene_of(rows[i].below ? ".....\n.....\n#####\n" : ".....\n", &usual, NULL);
    add_mass(scene, 1, 1.5, rows[i].speed, 0, 0.1);
    add_mass(scene, 1 + rows[i].length, 1.5, rows[i].speed, 0, 0.1);
    must(msr_scene_add_spring(scene, 0, 1, 1500, 1, &why));
    const msr_plan_figures f = figures_of(scene, &msr_integrator_verlet, 0);
    if (!near(f.safe_step, rows[i].share * f.stable_step))
      fail_msg("row %zu: %g of the stable step", i, f.safe_step / f.stable_step);
  }
}

static void notes_say_what_was_not_asked_for(void **unused) {
  (void)unused;
  static const struct {
    double dt;
    size_t below;
    const msr_integrator *method;
    uint64_t substeps;
    const char *note;
  } rows[] = {
      {0.005, 0, NULL, 0, NULL},
      {0.005, 0, NULL, 1, NULL},
      {0.0051, 0, NULL, 1, NULL},
      {0.0055, 0, NULL, 1,
       "steps of 0.0055 s are above 0.005196 s, the largest that is safe here: the run may heat up "
       "and then explode; 2 substeps would be safe"},
      {0.01, 0, NULL, 3, NULL},
      {0.005, 2, NULL, 1,
       "steps of 0.005 s are above 0.002887 s, the largest that is safe here: the run may heat up "
       "and then explode; 2 substeps would be safe"},
      {0.0028, 2, NULL, 1, NULL},
      {0.005, 2, NULL, 0,
       "3 substeps of 0.001667 s per iteration: steps up to 0.002425 s are safe here (the largest "
       "that "
       "is stable at any stretch is 0.005774 s)"},
      {0.01, 0, NULL, 0,
       "2 substeps of 0.005 s per iteration: steps up to 0.005196 s are safe here (the largest "
       "that is "
       "stable at any stretch is 0.005774 s)"},
      {0.01, 0, NULL, 1,
       "steps of 0.01 s are above 0.005774 s, the largest that is stable at any stretch: the run "
       "may explode; 2 substeps would be safe"},
      {0.1, 0, NULL, 2,
       "steps of 0.05 s are above 0.005774 s, the largest that is stable at any stretch: the run "
       "may explode; 20 substeps would be safe"},
      {0.005, 0, &msr_integrator_euler, 0,
       "euler declares no stable step for springs: expect it to explode; use verlet"},
  };
  for (size_t i = 0; i < LENGTH(rows); i++) {
    msr_plan *plan = plan_with(block(rows[i].dt, rows[i].below), rows[i].method, rows[i].substeps);
    const char *note = msr_plan_warning(plan, 0);
    if (rows[i].note) {
      assert_non_null(note);
      assert_string_equal(note, rows[i].note);
      assert_null(msr_plan_warning(plan, 1));
    } else {
      assert_null(note);
    }
    msr_plan_free(plan);
  }
}

/* Stable with springs, it knows of no step that is stable with damping through a. */
static void a_method_without_a_limit_of_damping_is_planned(void **unused) {
  (void)unused;
  msr_integrator frail = msr_integrator_rk4;
  frail.name = "frail";
  frail.damping_stability = 0;
  msr_scene *scene = block(0.005, 0);
  add_force(scene, &msr_force_drag, &(msr_drag){0.1});
  msr_plan *plan = plan_with(scene, &frail, 0);
  assert_string_equal(
      msr_plan_warning(plan, 0),
      "frail declares no stable step for damping: expect it to explode; use verlet");
  const msr_plan_figures f = msr_plan_describe(plan);
  assert_true(f.stable_step == 0 && f.substeps == 1);
  msr_plan_free(plan);
}

static void what_cannot_be_planned_is_refused(void **unused) {
  (void)unused;
  static const msr_integrator blank = {.name = "n", .summary = "s"};
  const msr_conf hard = {0.005, 0, 0.1, 1e300, 1, 1};
  msr_plan *plan = NULL;
  msr_error err;

  msr_scene *scene = lattice(3, 3, 0, &hard, (msr_scene_options){0});
  assert_int_equal(msr_plan_create(scene, NULL, &plan, &err), MSR_EINPUT);
  assert_string_equal(err.message, "DT 0.005 s is 2.23607e+148 times the largest stable step, "
                                   "2.23607e-151 s; lower DT or TENSION_RESSORT, or raise MASSE");
  const msr_plan_options forced = {.substeps = 5};
  assert_int_equal(msr_plan_create(scene, &forced, &plan, &err), MSR_OK); // who asks for it gets it
  msr_plan_free(plan);
  msr_scene_free(scene);

  scene = block(0.005, 0);
  plan = NULL;
  const msr_plan_options lame = {.integrator = &blank};
  assert_int_equal(msr_plan_create(scene, &lame, &plan, &err), MSR_EUSAGE);
  assert_string_equal(err.message, "an integrator needs at least name, summary and step");
  must(msr_scene_add_force(scene, &msr_force_push, &(msr_push){25, 1, 0}, &why));
  assert_int_equal(msr_plan_create(scene, NULL, &plan, &err), MSR_EUSAGE);
  assert_string_equal(err.message, "a push is on mass 25, and there are 25 masses");
  assert_null(plan);
  msr_scene_free(scene);
  msr_plan_free(NULL);
}

/* ---- A method that isn't what it says */

static msr_status slow(const void *self, void *scratch, const msr_view *s, double *fx, double *fy) {
  (void)self, (void)scratch;
  for (size_t i = 0; i < s->n; i++) fx[i] -= 0.3 * s->vx[i], fy[i] -= 0.3 * s->vy[i];
  return MSR_OK;
}

/* Whether it says that it splits or not, a method may ask for damping, and has room for what a
 * force without a flow takes. */
static void an_undeclared_splitting_has_room(void **unused) {
  (void)unused;
  static const msr_force slowing = {
      .name = "slowing", .summary = "-0.3 v", .uses_velocity = true, .add = slow};
  msr_integrator sly = msr_integrator_verlet;
  sly.splits = false;
  const msr_integrator *const methods[] = {&msr_integrator_verlet, &sly};
  uint64_t hash[2], calls[2];
  for (int i = 0; i < 2; i++) {
    msr_scene *scene = block(0.001, 0);
    add_force(scene, &slowing, NULL);
    const world w = open_world(scene, methods[i], 1);
    msr_state_edit(w.state).vx[0] = 1;
    advance(&w, 100);
    hash[i] = msr_state_hash(w.state);
    calls[i] = msr_state_calls(w.state, 0);
    close_world(w);
  }
  assert_true(hash[0] == hash[1]);
  assert_true(calls[0] == 101 && calls[1] == 101);
}

/* ---- Memory */

/* What they say that they take is what they take, once the scene is gone, of which a plan keeps the
 * picture: a plan within 2 % and 8 kB of names, reasons and room to grow, a state but for the last
 * page of its block. `before` the scene so much was in use. */
static void assert_memory_is_told(msr_scene *scene, size_t before) {
  msr_plan *plan;
  msr_state *state;
  must(msr_plan_create(scene, NULL, &plan, &why));
  msr_scene_free(scene);
  const size_t by_plan = in_use - before;
  must(msr_state_create(plan, &state, &why));
  const size_t by_state = in_use - before - by_plan;
  const msr_plan_figures f = msr_plan_describe(plan);
  if (fabs((double)by_plan - (double)f.plan_bytes) > 0.02 * (double)by_plan + 8192)
    fail_msg("a plan of %zu bytes says that it takes %zu", by_plan, f.plan_bytes);
  /* Two blocks, each in whole pages. */
  assert_true(by_state >= f.state_bytes && by_state <= f.state_bytes + 2 * 4096);
  msr_state_free(state);
  msr_plan_free(plan);
  assert_int_equal(in_use, before);
}

static void memory_figures_are_true(void **unused) {
  (void)unused;
  const size_t before = in_use;
  assert_memory_is_told(block(0.005, 0), before);
  assert_memory_is_told(lattice(200, 200, 2, &usual, (msr_scene_options){8, true, true}), before);
  msr_scene *scene = lattice(100, 100, 1, &usual, (msr_scene_options){8, true, false});
  for (size_t i = 0; i < 20000; i++) {
    const msr_mass mass = {.x = (double)i, .y = -5, .m = 1};
    must(msr_scene_add_mass(scene, &mass, NULL, &why));
    const size_t j = (i * 7919 + 1) % 10000;
    if (i % 10000 == j) continue;
    must(msr_scene_add_spring(scene, i % 10000, j, 1, 1, &why));
  }
  assert_memory_is_told(scene, before);
}

/* ---- Frames and pixels */

__extension__ typedef unsigned __int128 wide;

static void frames_are_spread_evenly(void **unused) {
  (void)unused;
  static const uint64_t runs[][2] = {{20000, 800},
                                     {0, 1},
                                     {1, 1},
                                     {7, 7},
                                     {10, 3},
                                     {1000, 999},
                                     {1ULL << 53, 1000000000},
                                     {(1ULL << 53) - 1, 999999999},
                                     {1000000000, 1000000000}};
  for (size_t r = 0; r < LENGTH(runs); r++) {
    const uint64_t iterations = runs[r][0], images = runs[r][1];
    msr_scene *scene = block(0.001, 0);
    must(msr_scene_set_times(scene, 0.001, iterations, images, &why));
    msr_plan *plan = plan_with(scene, NULL, 0);
    assert_int_equal(msr_plan_frame_iteration(plan, 0), 0);
    for (uint64_t n = 0; n < 1000; n++) {
      const uint64_t frame = images < 1000 ? n % images : images - 1 - n * (images / 1000);
      const uint64_t due = (uint64_t)((wide)frame * iterations / images);
      assert_true(msr_plan_frame_iteration(plan, frame) == due);
      assert_true(due <= iterations);
    }
    msr_plan_free(plan);
  }
}

static void pixels_and_masses_are_one_to_one(void **unused) {
  (void)unused;
  msr_scene *scene = lattice(5, 3, 1, &usual, (msr_scene_options){0});
  must(msr_scene_add_mass(scene, &(msr_mass){.x = 0, .y = 0, .m = 1}, NULL, &why));
  msr_plan *plan;
  must(msr_plan_create(scene, NULL, &plan, &why));
  size_t column = 99, row = 99, index;
  for (size_t i = 0; i < 15; i++) {
    assert_true(msr_plan_pixel(plan, i, &column, &row));
    assert_true(column == 2 + i % 5 && row == 2 + i / 5);
    must(msr_scene_mass_at(scene, column, row, &index, &why));
    assert_int_equal(index, i);
  }
  column = row = 99;
  assert_false(msr_plan_pixel(plan, 15, &column, &row)); // added by hand
  assert_false(msr_plan_pixel(plan, SIZE_MAX, &column, &row));
  assert_true(column == 99 && row == 99);
  msr_scene_free(scene);
  msr_plan_free(plan);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_lattice_has_so_many_springs),
      cmocka_unit_test(springs_join_neighbours),
      cmocka_unit_test(attached_masses_have_anchors),
      cmocka_unit_test(anchors_start_at_rest),
      cmocka_unit_test(stable_step_of_lattices),
      cmocka_unit_test(stable_step_of_mixtures),
      cmocka_unit_test(stable_step_without_a_flow),
      cmocka_unit_test(nothing_stiff_is_stable_for_ever),
      cmocka_unit_test(the_stable_step_is_below_what_explodes),
      cmocka_unit_test(substeps_are_as_few_as_is_safe),
      cmocka_unit_test(safe_steps_are_smaller_where_springs_are_crushed),
      cmocka_unit_test(safe_steps_are_smaller_where_the_start_crushes_springs),
      cmocka_unit_test(notes_say_what_was_not_asked_for),
      cmocka_unit_test(a_method_without_a_limit_of_damping_is_planned),
      cmocka_unit_test(an_undeclared_splitting_has_room),
      cmocka_unit_test(what_cannot_be_planned_is_refused),
      cmocka_unit_test(memory_figures_are_true),
      cmocka_unit_test(frames_are_spread_evenly),
      cmocka_unit_test(pixels_and_masses_are_one_to_one),
  };
  return cmocka_run_group_tests_name("plan", tests, NULL, NULL);
}
