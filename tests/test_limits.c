/* test_limits.c - the largest stable steps that the analysis tells are those at which real runs
 * begin to explode: 2 % below they stay bounded, 2 % above they don't; and no bound is above them.
 * link: --wrap=malloc --wrap=calloc --wrap=realloc */
#include "alloc.h"
#include "scenes.h"

/* ---- Meshes without contacts */

typedef struct object {
  const char *name;
  msr_scene *(*make)(const struct object *self);
  size_t width, height; /* or numbers of masses and springs */
  int neighbours;       /* or of anchors */
  double lightest;      /* of masses, the others being 1 */
  msr_found found;      /* how, at the worst stretch */
} object;

static msr_scene *block(const object *o) {
  return lattice(o->width, o->height, o->neighbours, &weightless);
}

static msr_scene *with_holes(const object *o) {
  (void)o;
  return scene_of("oooooo\no.oo.o\noooooo\nooo..o\noo.ooo\n", &weightless, NULL);
}

static msr_scene *attached(const object *o) {
  return scene_of("#oooooo\n.oooooo\n#oooooo\n", &weightless,
                  &(msr_scene_options){.attach = true, .neighbours = o->neighbours});
}

/* Of springs at rest, k 500 .. 1500, a few masses much lighter than the rest; the first two masses
 * are tied, and `neighbours` anchors. */
static msr_scene *random_ties(const object *o) {
  uint64_t dice = 7 + o->width;
  msr_scene *scene = empty_scene(1);
  double *x = zeroed(2 * o->width, sizeof *x), *y = x + o->width;
  for (size_t i = 0; i < o->width; i++) {
    x[i] = uniform(&dice, 0, 10), y[i] = uniform(&dice, 0, 10);
    add_mass(scene, x[i], y[i], 0, 0,
             random_below(&dice, 5) ? uniform(&dice, 0.5, 1) : o->lightest);
  }
  for (size_t s = 0; s < o->height; s++) {
    const size_t i = random_below(&dice, o->width);
    const size_t j = (i + 1 + random_below(&dice, o->width - 1)) % o->width;
    const double k = uniform(&dice, 500, 1500);
    must(msr_scene_add_spring(scene, i, j, k, hypot(x[j] - x[i], y[j] - y[i]), &why));
  }
  for (int a = 0; a < o->neighbours; a++) {
    const size_t i = random_below(&dice, o->width);
    must(msr_scene_add_anchor(scene, &(msr_anchor){i, x[i] + 3, y[i] - 4, 1000, 5}, &why));
  }
  free(x);
  return scene;
}

/* Longer and shorter than at rest by up to 30 %: across a spring there is stiffness, too. */
static msr_scene *under_tension(const object *o) {
  msr_scene *scene = empty_scene(1);
  for (size_t i = 0; i < o->width; i++) {
    add_mass(scene, 1.3 * (double)i, 0, 0, 0, 0.1);
    if (i > 0) must(msr_scene_add_spring(scene, i - 1, i, 1500, 1, &why));
  }
  must(msr_scene_add_anchor(scene, &(msr_anchor){0, -1.3, 0, 1500, 1}, &why));
  const double right = 1.3 * (double)o->width;
  must(msr_scene_add_anchor(scene, &(msr_anchor){o->width - 1, right, 0, 1500, 1}, &why));
  return scene;
}

static const object objects[] = {
    {"block", block, 9, 7, 4, 0, MSR_FOUND_CLOSED_FORM},
    {"row", block, 12, 1, 4, 0, MSR_FOUND_CLOSED_FORM},
    {"pair", block, 1, 2, 4, 0, MSR_FOUND_CLOSED_FORM},
    {"block of 8 neighbours", block, 9, 7, 8, 0, MSR_FOUND_LANCZOS},
    {"block with holes", with_holes, 0, 0, 0, 0, MSR_FOUND_LANCZOS},
    {"attached block", attached, 0, 0, 8, 0, MSR_FOUND_LANCZOS},
    {"mesh at random", random_ties, 40, 120, 3, 0.5, MSR_FOUND_LANCZOS},
    {"loose mesh", random_ties, 30, 25, 0, 0.5, MSR_FOUND_LANCZOS},
    {"masses of 1 and 1e-6", random_ties, 50, 150, 2, 1e-6, MSR_FOUND_LANCZOS},
    {"chain under tension", under_tension, 10, 0, 0, 0, MSR_FOUND_LANCZOS},
};

/* ---- What happens at a step */

typedef struct experiment {
  const object *object;
  const msr_integrator *method;
  const msr_force *brake; /* NULL: none */
  double rate;            /* of the brake */
  double pull;            /* the start is so many times as large */
} experiment;

static world begin(const experiment *e, double dt) {
  msr_scene *scene = e->object->make(e->object);
  must(msr_scene_set_times(scene, dt, 1, 1, &why));
  if (e->brake) add_force(scene, e->brake, &(msr_drag){e->rate}); /* all of msr_damping, too */
  return open_world(scene, e->method, 1);
}

enum { STEPS = 1500 };

static double energy_of(const world *w) { return msr_state_energy(w->state).total; }

/* Swings so small that springs stay as they were, or so large that rest lengths don't count. Grown
 * 10^4 times in energy it isn't a swing of the method's own, which 2 % below is 100 times at most,
 * by symplectic Euler. The guard wouldn't wait for that: an edit makes it begin anew. */
static bool explodes(const experiment *e, double dt) {
  uint64_t dice = 3;
  world w = begin(e, dt);
  const msr_plan_figures f = msr_plan_describe(w.plan);
  const msr_arrays a = msr_state_edit(w.state);
  const double part = e->pull > 1 ? 0.1 * e->pull : 1e-6, speed = part * f.omega;
  const double rest = energy_of(&w);
  for (size_t i = 0; i < f.masses; i++) {
    a.x[i] = e->pull * a.x[i] + part * uniform(&dice, -1, 1);
    a.y[i] = e->pull * a.y[i] + part * uniform(&dice, -1, 1);
    a.vx[i] = speed * uniform(&dice, -1, 1), a.vy[i] = speed * uniform(&dice, -1, 1);
  }
  const double start = energy_of(&w) - rest;
  bool grown = false;
  for (int i = 1; i <= STEPS && !grown; i++) {
    grown = msr_state_step(w.state, 1, NULL) != MSR_OK;
    (void)msr_state_edit(w.state);
    if (i % 50 != 0) continue;
    const double energy = energy_of(&w) - rest;
    grown = grown || !(energy < 1e4 * start);
    if (energy < 1e-6 * start) break;
  }
  close_world(w);
  return grown;
}

static msr_stability analyse(const experiment *e) {
  msr_stability s;
  world w = begin(e, 1);
  must(msr_plan_stability(w.plan, &s, &why));
  close_world(w);
  return s;
}

static void check_limit(const experiment *e, const char *what, const msr_limit *limit) {
  if (explodes(e, 0.98 * limit->step) || !explodes(e, 1.02 * limit->step))
    fail_msg("%s, %s, %s: not at %g s: %d %d", e->object->name, e->method->name, what, limit->step,
             explodes(e, 0.98 * limit->step), explodes(e, 1.02 * limit->step));
}

static const msr_integrator *const methods[] = {&msr_integrator_verlet,
                                                &msr_integrator_symplectic_euler,
                                                &msr_integrator_rk4, &msr_integrator_pefrl};

static void at_rest_and_stretched(void **unused) {
  (void)unused;
  for (size_t o = 0; o < LENGTH(objects); o++)
    for (size_t m = 0; m < LENGTH(methods); m++) {
      experiment e = {.object = &objects[o], .method = methods[m], .pull = 1};
      const msr_stability s = analyse(&e);
      assert_int_equal(s.stretched.found, objects[o].found);
      assert_true(s.bound <= s.stretched.step * (1 + 4 * DBL_EPSILON));
      assert_true(s.stretched.step <= s.at_rest.step * 1.001);
      check_limit(&e, "at rest", &s.at_rest);
      e.pull = 1e7;
      check_limit(&e, "stretched", &s.stretched);
    }
}

/* ---- With damping */

/* Brakes in units of what makes the highest mode of the block overdamped. */
static experiment braked(const msr_integrator *method, const object *o, bool along, double rate) {
  experiment e = {.object = o, .method = method, .pull = 1};
  const double omega = analyse(&e).at_rest.omega;
  e.brake = along ? &msr_force_damping : &msr_force_drag;
  e.rate = rate * (along ? 1500 / omega : 0.1 * omega);
  return e;
}

/* Both sides of a limit that is known, and of Verlet's, which no damping changes; of others only
 * that they are bounded below. Steps of Euler's begin to grow too slowly where damping is weak. */
static void check_damped(const msr_integrator *method, const object *o, bool along, double rate) {
  const experiment e = braked(method, o, along, rate);
  const msr_limit limit = analyse(&e).damped;
  const bool no_limit = isinf(limit.step), none = limit.step == 0;
  const bool equal_masses = o != &objects[6], at_rest = o != &objects[9];
  const bool bands = method->splits && method->evaluations > 1;
  const bool known = equal_masses && (!along || (at_rest && !method->splits));
  if (no_limit) assert_int_equal(limit.found, MSR_FOUND_ANY);
  if (none) assert_int_equal(limit.found, MSR_FOUND_NONE);
  assert_true(none == (!known && method == &msr_integrator_euler));
  if (no_limit) assert_true(known && !explodes(&e, 0.01) && !explodes(&e, 1));
  if (no_limit || none || (method == &msr_integrator_euler && rate < 1)) return;
  assert_true((known && !bands) == (limit.found != MSR_FOUND_BOUND) || (known && bands));
  if (limit.found != MSR_FOUND_BOUND || method == &msr_integrator_verlet)
    check_limit(&e, along ? "damped along springs" : "in air", &limit);
  else
    assert_false(explodes(&e, 0.98 * limit.step));
}

static void with_damping(void **unused) {
  (void)unused;
  static const msr_integrator *const all[] = {
      &msr_integrator_verlet, &msr_integrator_symplectic_euler, &msr_integrator_rk4,
      &msr_integrator_pefrl,  &msr_integrator_kahan_li_6,       &msr_integrator_euler};
  static const size_t of[] = {0, 3, 6, 9};
  for (size_t m = 0; m < LENGTH(all); m++)
    for (size_t o = 0; o < LENGTH(of); o++)
      for (double rate = 0.03; rate < 100; rate *= 10) {
        check_damped(all[m], &objects[of[o]], false, rate);
        check_damped(all[m], &objects[of[o]], true, rate);
      }
}

/* ---- What is ordinary, too */

static msr_stability of_scene(msr_scene *scene, const msr_integrator *method) {
  msr_stability s;
  world w = open_world(scene, method, 1);
  must(msr_plan_stability(w.plan, &s, &why));
  close_world(w);
  return s;
}

static void assert_found(const msr_stability *s, msr_found found, double step) {
  const msr_limit *const limits[] = {&s->at_rest, &s->stretched, &s->damped};
  for (size_t i = 0; i < LENGTH(limits); i++) {
    assert_int_equal(limits[i]->found, found);
    assert_true(limits[i]->step == step);
    assert_int_equal(limits[i]->iterations, 0);
  }
}

/* No mass, one, no spring, springs that don't pull: any step, whatever else there is. */
static void any_step_where_nothing_swings(void **unused) {
  (void)unused;
  static const char *const arts[] = {"..\n", "o#\n", "o.o\n"};
  msr_stability s;
  for (size_t i = 0; i < LENGTH(arts); i++) {
    s = of_scene(scene_of(arts[i], &example, NULL), NULL);
    assert_found(&s, MSR_FOUND_ANY, INFINITE);
  }
  s = of_scene(random_mesh(&(mesh){.masses = 20, .springs = 30, .anchors = 2, .slack = true}, NULL),
               NULL);
  assert_found(&s, MSR_FOUND_ANY, INFINITE);
  msr_scene *scene = scene_of("oo\noo\n", &example, NULL);
  add_force(scene, &msr_force_damping, &(msr_damping){5});
  s = of_scene(scene, &msr_integrator_sdirk2);
  assert_found(&s, MSR_FOUND_ANY, INFINITE);
  s = of_scene(scene_of("oo\noo\n", &example, NULL), &msr_integrator_euler);
  assert_found(&s, MSR_FOUND_NONE, 0);
}

/* A lattice that lacks a corner can't swing faster than a whole one, and hardly slower: what
 * Lanczos finds is as true as it says, where a spectrum is dense up to its end. */
static void dense_spectra_are_as_true_as_said(void **unused) {
  (void)unused;
  for (size_t n = 40; n <= 160; n *= 2) {
    msr_picture *picture;
    must(msr_picture_create(n, n, &picture, &why));
    for (size_t p = 1; p < n * n; p++) memcpy(picture->rgb + 3 * p, rgb_of('o'), 3);
    const msr_stability s = of_scene(scene_from(picture, &weightless, NULL), NULL);
    const msr_stability whole = of_scene(lattice(n, n, 4, &weightless), NULL);
    assert_int_equal(s.stretched.found, MSR_FOUND_LANCZOS);
    assert_true(fabs(s.at_rest.step / whole.at_rest.step - 1) < 1e-3);
    assert_true(fabs(s.stretched.step / whole.stretched.step - 1) < 1e-3);
    assert_true(s.at_rest.iterations < 100 && s.stretched.iterations < 100);
  }
}

/* A picture that lacks a corner, with damping if `c` isn't 0. */
static msr_stability of_picture(size_t side, int neighbours, double c) {
  msr_picture *picture;
  must(msr_picture_create(side, side, &picture, &why));
  for (size_t p = 1; p < side * side; p++) memcpy(picture->rgb + 3 * p, rgb_of('o'), 3);
  msr_scene *scene =
      scene_from(picture, &weightless, &(msr_scene_options){.neighbours = neighbours});
  if (c > 0) add_force(scene, &msr_force_damping, &(msr_damping){c});
  world w = open_world(scene, NULL, 1);
  msr_stability s;
  alloc_largest = 0;
  must(msr_plan_stability(w.plan, &s, &why));
  close_world(w);
  return s;
}

/* Above 131072 masses nothing is made that has a double for each, and what is told is a bound: no
 * higher than what Lanczos finds of a picture of that kind, which is 0.1 % off, and near it. */
static void vast_pictures_have_bounds(void **unused) {
  (void)unused;
  for (int neighbours = 4; neighbours <= 8; neighbours += 4)
    for (double c = 0; c < 2; c++) {
      const msr_stability s = of_picture(363, neighbours, c);
      assert_true(alloc_largest < sizeof(double) * 363 * 363);
      const msr_stability small = of_picture(120, neighbours, c);
      const msr_limit *const limits[] = {&s.at_rest, &s.stretched, &s.damped};
      const msr_limit *const found[] = {&small.at_rest, &small.stretched, &small.damped};
      for (size_t i = 0; i < LENGTH(limits); i++) {
        assert_int_equal(limits[i]->found, MSR_FOUND_BOUND);
        assert_int_equal(limits[i]->iterations, 0);
        assert_true(limits[i]->step < found[i]->step * (1 + 1e-9));
        assert_true(limits[i]->step > found[i]->step * (1 - 2e-3));
      }
      assert_true(s.bound <= s.stretched.step);
    }
}

/* Pairs: Gershgorin's bound, omega^2 = 2 k / m, is exact. */
static void vast_meshes_have_bounds(void **unused) {
  (void)unused;
  enum { PAIRS = 1 << 16 };
  for (size_t more = 0; more < 2; more++) {
    msr_scene *scene = empty_scene(1);
    for (size_t i = 0; i < 2 * (PAIRS + more); i++) add_mass(scene, (double)i, 0, 0, 0, 0.1);
    for (size_t i = 0; i < PAIRS + more; i++)
      must(msr_scene_add_spring(scene, 2 * i, 2 * i + 1, 1500, 1, &why));
    const msr_stability s = of_scene(scene, &msr_integrator_verlet);
    assert_int_equal(s.at_rest.found, more ? MSR_FOUND_BOUND : MSR_FOUND_LANCZOS);
    assert_true(fabs(s.at_rest.step / (2 / sqrt(2 * 1500 / 0.1)) - 1) < 1e-3);
    assert_true(fabs(s.stretched.step / (2 / sqrt(2 * 1500 / 0.1)) - 1) < 1e-3);
  }
}

/* omega^2 = 2 k / m for stiffness and mass at the ends of the range of numbers. */
static void numbers_of_any_size(void **unused) {
  (void)unused;
  for (double k = 1e-300; k < 1e301; k *= 1e50)
    for (double m = 1e-300; m < 1e301; m *= 1e50) {
      if (k / m > 1e300 || k / m < 1e-300) continue;
      msr_scene *scene = empty_scene(1);
      for (int i = 0; i < 2; i++) add_mass(scene, i, 0, 0, 0, m);
      must(msr_scene_add_spring(scene, 0, 1, k, 1, &why));
      add_force(scene, &msr_force_damping, &(msr_damping){0.5 * sqrt(k) * sqrt(m)});
      const msr_stability s = of_scene(scene, &msr_integrator_rk4);
      const double step = 2 * sqrt(2) / sqrt(2) / sqrt(k) * sqrt(m);
      assert_true(fabs(s.at_rest.step / step - 1) < 1e-3);
      assert_true(fabs(s.stretched.step / step - 1) < 1e-3);
      assert_int_equal(s.damped.found, MSR_FOUND_LANCZOS);
    }
}

/* A force of one's own that pulls back with k and brakes with c v, and an integrator, Verlet, of
 * one's own: both count as built-ins do. */
static msr_status add_own(const void *self, void *scratch, const msr_view *s, double *fx,
                          double *fy) {
  (void)scratch;
  const double c = ((const msr_drag *)self)->c;
  for (size_t i = 0; i < s->n; i++) {
    fx[i] -= 50 * s->x[i] + c * s->vx[i];
    fy[i] -= 50 * s->y[i] + c * s->vy[i];
  }
  return MSR_OK;
}

static msr_status own_rates(const void *self, const msr_view *s, double *omega2, double *gamma) {
  *omega2 = 50 / msr_view_mass(s, 0);
  *gamma = ((const msr_drag *)self)->c / msr_view_mass(s, 0);
  return MSR_OK;
}

static const msr_force own = {.name = "own",
                              .summary = "-50 x - c v",
                              .dissipative = true,
                              .uses_velocity = true,
                              .params_size = sizeof(msr_drag),
                              .add = add_own,
                              .rates = own_rates};

static void forces_of_ones_own_count(void **unused) {
  (void)unused;
  for (double c = 1; c < 5; c *= 2) {
    msr_scene *scene = empty_scene(1);
    add_mass(scene, 0, 0, 0, 0, 0.5);
    add_force(scene, &own, &(msr_drag){c});
    const msr_stability s = of_scene(scene, &msr_integrator_rk4);
    assert_int_equal(s.at_rest.found, MSR_FOUND_BOUND);
    assert_true(fabs(s.at_rest.omega - 10) < 1e-12 && fabs(s.stretched.omega - 10) < 1e-12);
    for (int above = 0; above < 2; above++) {
      msr_scene *at = empty_scene((above ? 1.01 : 0.99) * s.damped.step);
      add_mass(at, 1, 0, 0, 0, 0.5);
      add_force(at, &own, &(msr_drag){c});
      world w = open_world(at, &msr_integrator_rk4, 1);
      for (int i = 0; i < 1500; i++)
        (void)msr_state_step(w.state, 1, NULL), msr_state_edit(w.state);
      const double x = fabs(msr_state_view(w.state).x[0]);
      assert_true(above ? !(x < 10) : x < 1);
      close_world(w);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(at_rest_and_stretched),
      cmocka_unit_test(with_damping),
      cmocka_unit_test(any_step_where_nothing_swings),
      cmocka_unit_test(dense_spectra_are_as_true_as_said),
      cmocka_unit_test(vast_pictures_have_bounds),
      cmocka_unit_test(vast_meshes_have_bounds),
      cmocka_unit_test(numbers_of_any_size),
      cmocka_unit_test(forces_of_ones_own_count),
  };
  return cmocka_run_group_tests_name("limits", tests, NULL, NULL);
}
