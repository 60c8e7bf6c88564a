/* test_accuracy.c - the accuracy study: what it says about runs is true, and it ends as it should.
 * link: --wrap=malloc --wrap=calloc --wrap=realloc */
#include "alloc.h"
#include "exact.h"

/* ---- Studies */

#define METHODS(list) .integrators = (list), .n_integrators = LENGTH(list)

static const msr_integrator *const three[] = {&msr_integrator_verlet, &msr_integrator_srkn6,
                                              &msr_integrator_rk4};

static msr_accuracy *study_of(const msr_scene *scene, const msr_accuracy_options *options) {
  msr_accuracy *made = NULL;
  must(msr_accuracy_study(scene, options, &made, &why));
  return made;
}

/* Frees the scene. */
static msr_accuracy *study(msr_scene *scene, const msr_accuracy_options *options) {
  msr_accuracy *made = study_of(scene, options);
  msr_scene_free(scene);
  return made;
}

static msr_plan_options options_of(const msr_accuracy_point *p) {
  return (msr_plan_options){.integrator = p->integrator,
                            .substeps = p->substeps,
                            .atol = p->atol,
                            .impacts = MSR_IMPACTS_LOCATED};
}

static void assert_near(double a, double b, double within) {
  if (!(fabs(a - b) <= within)) fail_msg("%.17g isn't %.17g within %g", a, b, within);
}

/* Rounding of positions of size 10 px over some 1e5 steps. */
static const double rounding = 1e-12;

/* ---- What it says is true */

static void assert_errors_are_true(const exact *e) {
  size_t n;
  msr_accuracy *made = study(e->make(), &(msr_accuracy_options){.finest = 1e-8});
  const msr_accuracy_figures f = msr_accuracy_describe(made);
  const msr_accuracy_point *p = msr_accuracy_points(made, &n);
  assert_true(n > 20);
  assert_true(f.complete);
  assert_true(f.reference_error < 1e-9);
  for (size_t i = 0; i < n; i++) {
    if (!p[i].stable) continue;
    const msr_plan_options options = options_of(&p[i]);
    const double error = exact_error(e, &options, f.horizon);
    if (!(fabs(error - p[i].max) <= 2 * f.reference_error + rounding))
      fail_msg("%s: %s, %llu substeps, atol %g: error %g, not %g", e->name, p[i].integrator->name,
               (unsigned long long)p[i].substeps, p[i].atol, error, p[i].max);
  }
  msr_accuracy_free(made);
}

static void errors_are_true(void **unused) {
  (void)unused;
  for (size_t i = 0; i < LENGTH(exacts); i++) assert_errors_are_true(&exacts[i]);
}

/* The same work again gives the same counts, and the same energies as the reference's. */
static void work_is_true(void **unused) {
  (void)unused;
  size_t n;
  msr_accuracy *made = study(make_chain(), &(msr_accuracy_options){METHODS(three)});
  const msr_accuracy_point *p = msr_accuracy_points(made, &n);
  for (size_t i = 0; i < n; i++) {
    const msr_plan_options options = options_of(&p[i]);
    msr_scene *scene = make_chain();
    world w;
    must(msr_plan_create(scene, &options, &w.plan, &why));
    must(msr_state_create(w.plan, &w.state, &why));
    msr_scene_free(scene);
    const double start = msr_state_energy(w.state).total;
    double scale = 0, drift = 0;
    for (int frame = 0; p[i].stable && frame < 40; frame++) {
      advance(&w, 1);
      const msr_energy now = msr_state_energy(w.state);
      drift = fmax(drift, fabs(now.total - start));
      scale = fmax(scale, now.kinetic + now.spring);
    }
    const msr_work work = msr_state_work(w.state);
    if (p[i].stable && (work.steps != p[i].steps || work.evaluations != p[i].evaluations))
      fail_msg("%s: %llu steps, %llu evaluations", p[i].integrator->name,
               (unsigned long long)p[i].steps, (unsigned long long)p[i].evaluations);
    if (p[i].stable) assert_near(p[i].drift, drift / scale, 1e-11); /* that of the truth */
    close_world(w);
  }
  msr_accuracy_free(made);
}

/* Though some of its runs explode: a DT is 10 times the largest stable step of Verlet. */
static void success_leaves_no_error(void **unused) {
  (void)unused;
  msr_scene *scene = make_chain();
  must(msr_scene_set_times(scene, 1, 20, 20, &why));
  msr_error err = {MSR_OK, "as it was"};
  msr_accuracy *made;
  size_t n, unstable = 0;
  must(msr_accuracy_study(scene, &(msr_accuracy_options){METHODS(three)}, &made, &err));
  const msr_accuracy_point *p = msr_accuracy_points(made, &n);
  for (size_t i = 0; i < n; i++) unstable += !p[i].stable;
  assert_true(unstable > 0);
  assert_string_equal(err.message, "as it was");
  msr_accuracy_free(made);
  msr_scene_free(scene);
}

/* Far from rounding and from the largest steps, errors fall as declared. */
static void orders_are_as_declared(void **unused) {
  (void)unused;
  size_t n, seen = 0;
  msr_accuracy *made = study(make_chain(), NULL);
  const msr_accuracy_figures f = msr_accuracy_describe(made);
  const msr_accuracy_point *p = msr_accuracy_points(made, &n);
  for (size_t i = 0; i < n; i++) {
    if (!(fabs(p[i].order) >= 0) || p[i].max < 50 * f.reference_error || p[i].max > 1e-5) continue;
    if (fabs(p[i].order - p[i].integrator->order) > 0.25)
      fail_msg("%s, %llu substeps: order %g", p[i].integrator->name,
               (unsigned long long)p[i].substeps, p[i].order);
    seen++;
  }
  assert_true(seen > 10);
  msr_accuracy_free(made);
}

static void points_are_in_order(void **unused) {
  (void)unused;
  size_t n;
  msr_accuracy *made = study(make_pair(), NULL);
  const msr_accuracy_point *p = msr_accuracy_points(made, &n);
  size_t method = 0;
  for (size_t i = 0; i < n; i++) {
    while (msr_integrators[method] && msr_integrators[method] != p[i].integrator) method++;
    assert_non_null(msr_integrators[method]);
    assert_true(p[i].integrator->adaptive == (p[i].atol > 0));
    if (i == 0 || p[i - 1].integrator != p[i].integrator) continue;
    assert_true(p[i].atol > 0 ? p[i].atol < p[i - 1].atol : p[i].substeps > p[i - 1].substeps);
  }
  msr_accuracy_free(made);
}

/* The front and the answers, against their definitions. */
static void front_and_answers_are_true(void **unused) {
  (void)unused;
  size_t n;
  msr_accuracy *made = study(make_chain(), &(msr_accuracy_options){METHODS(three)});
  const double own = msr_accuracy_describe(made).reference_error;
  const msr_accuracy_point *p = msr_accuracy_points(made, &n);
  for (size_t i = 0; i < n; i++) {
    bool beaten = !p[i].stable;
    for (size_t j = 0; j < n; j++)
      beaten |=
          p[j].stable && p[j].seconds <= p[i].seconds && j != i && fmax(p[j].max, own) <= p[i].max;
    if (p[i].max > own) assert_true(p[i].front != beaten);
  }
  for (double error = 1; error > own; error /= 10) {
    const msr_accuracy_point *best = msr_accuracy_cheapest(made, error);
    for (size_t i = 0; i < n; i++)
      if (p[i].stable && p[i].max + own <= error)
        assert_true(best && best->max + own <= error && best->seconds <= p[i].seconds);
  }
  for (size_t i = 0; i < n; i++) {
    const double error = p[i].max + own / 2;
    const msr_accuracy_point *best = msr_accuracy_cheapest(made, error);
    if (best) assert_true(best->max + own <= error);
  }
  assert_null(msr_accuracy_cheapest(made, own / 2));
  msr_accuracy_free(made);
}

/* A step beyond the stable one is shown, and no method is left out. */
static void unstable_points_are_shown(void **unused) {
  (void)unused;
  static const msr_integrator *const verlet[] = {&msr_integrator_verlet};
  size_t n;
  msr_scene *scene = make_chain();
  must(msr_scene_set_times(scene, 0.4, 5, 5, &why));
  msr_accuracy *made = study(scene, &(msr_accuracy_options){METHODS(verlet), .finest = 1e-5});
  const msr_accuracy_point *p = msr_accuracy_points(made, &n);
  assert_true(n > 3);
  assert_false(p[0].stable);
  assert_true(p[0].max > 1e300 && p[0].rms > 1e300 && !(p[0].seconds >= 0));
  for (size_t i = 1; i < n; i++) {
    assert_true(p[i].stable || p[i].substeps < p[n - 1].substeps);
    if (p[i].stable) assert_true(p[i].seconds > 0);
  }
  msr_accuracy_free(made);
}

/* A picture that differs by a row of a block in one frame of two. */
static void pixels_that_differ_are_counted(void **unused) {
  (void)unused;
  static const msr_integrator *const euler[] = {&msr_integrator_symplectic_euler};
  size_t n;
  msr_scene *scene = scene_of("ooo....\n"
                              ".......\n"
                              ".......\n"
                              ".......\n",
                              &(msr_conf){0.1, 2, 1, 0, 18, 18}, NULL);
  msr_accuracy *made = study(scene, &(msr_accuracy_options){METHODS(euler), .finest = 1e-4});
  const msr_accuracy_point *p = msr_accuracy_points(made, &n);
  /* Symplectic Euler is at y - g t (t + h) / 2, h = 0.1, instead of y - g t^2 / 2: the row is one
   * pixel too low (6 of 28 pixels differ) when a whole y + 1/2 lies between the two. */
  size_t wrong = 0;
  for (int i = 1; i <= 18; i++) {
    const double t = 0.1 * i, truth = floor(4 - 0.5 - t * t), run = floor(4 - 0.5 - t * (t + 0.1));
    if (truth != run) wrong += run < 0 ? 3 : 6;
  }
  assert_true(wrong > 0);
  assert_near(p[0].pixels, (double)wrong / (18 * 28), 1e-12);
  assert_near(p[n - 1].pixels, 0, 0);
  msr_accuracy_free(made);
}

/* ---- The same again */

static void studies_repeat(void **unused) {
  (void)unused;
  size_t n[2];
  msr_accuracy *made[2];
  const msr_accuracy_point *p[2];
  for (int i = 0; i < 2; i++) {
    made[i] = study(make_chain(), &(msr_accuracy_options){.finest = 1e-6});
    p[i] = msr_accuracy_points(made[i], &n[i]);
  }
  assert_int_equal(n[0], n[1]);
  for (size_t i = 0; i < n[0]; i++) {
    msr_accuracy_point a = p[0][i], b = p[1][i];
    assert_ptr_equal(a.integrator, b.integrator);
    assert_int_equal(a.substeps, b.substeps);
    assert_int_equal(a.steps, b.steps);
    assert_int_equal(a.evaluations, b.evaluations);
    const double x[] = {a.atol, a.rms, a.max, a.drift}, y[] = {b.atol, b.rms, b.max, b.drift};
    assert_memory_equal(x, y, sizeof x);
  }
  const msr_accuracy_figures a = msr_accuracy_describe(made[0]), b = msr_accuracy_describe(made[1]);
  assert_int_equal(a.scene_hash, b.scene_hash);
  assert_int_equal(a.frames, b.frames);
  assert_memory_equal(&a.reference_error, &b.reference_error, sizeof a.reference_error);
  for (int i = 0; i < 2; i++) msr_accuracy_free(made[i]);
}

static uint64_t hash_of(msr_scene *scene) {
  static const msr_integrator *const one[] = {&msr_integrator_srkn6};
  msr_accuracy *made = study(scene, &(msr_accuracy_options){METHODS(one), .finest = 1e-3});
  const uint64_t hash = msr_accuracy_describe(made).scene_hash;
  msr_accuracy_free(made);
  return hash;
}

/* Every change of a scene changes its hash. */
static void scenes_have_hashes(void **unused) {
  (void)unused;
  enum { CHANGES = 9 };
  uint64_t hash[CHANGES + 1];
  for (int change = 0; change <= CHANGES; change++) {
    msr_conf conf = {0.01, 9.8, 0.1, 15, 8, 4};
    if (change == 1) conf.dt = 0.011;
    if (change == 2) conf.stiffness = 16;
    const char *art = change == 3 ? "oo..\n....\n" : "ooo.\n....\n";
    msr_scene *scene = scene_of(art, &conf, &(msr_scene_options){.closed_border = change == 4});
    add_mass(scene, 1.5, 1.5, 0, change == 5 ? 1 : 0, 1);
    must(msr_scene_add_spring(scene, 0, 1, change == 6 ? 2 : 3, 1, &why));
    must(msr_scene_add_anchor(scene, &(msr_anchor){1, change == 7 ? 1 : 2, 2, 3, 1}, &why));
    add_force(scene, &msr_force_drag, &(msr_drag){change == 8 ? 0.1 : 0.2});
    must(msr_scene_set_contact(scene, change == 9 ? 0.5 : 1, 0, &why));
    hash[change] = hash_of(scene);
    for (int before = 0; before < change; before++)
      assert_int_not_equal(hash[before], hash[change]);
  }
}

/* ---- Where it ends */

/* A chain of masses that hangs from one end and swings over: chaos. */
static msr_scene *whip(void) {
  msr_scene *scene = empty_scene(0.02);
  add_force(scene, &msr_force_gravity, &(msr_gravity){60});
  for (size_t i = 0; i < 4; i++) {
    add_mass(scene, (double)i + 1, 0, 0, 0, 0.1);
    if (i > 0) must(msr_scene_add_spring(scene, i - 1, i, 100, 1, &why));
  }
  must(msr_scene_add_anchor(scene, &(msr_anchor){0, 0, 0, 100, 1}, &why));
  must(msr_scene_set_times(scene, 0.02, 2000, 2000, &why));
  return scene;
}

static void chaos_has_a_horizon(void **unused) {
  (void)unused;
  static const msr_integrator *const one[] = {&msr_integrator_srkn6};
  msr_accuracy *made = study(whip(), &(msr_accuracy_options){METHODS(one), .finest = 1});
  const msr_accuracy_figures f = msr_accuracy_describe(made);
  assert_near(f.until, 40, 1e-9);
  assert_true(f.horizon > 2 && f.horizon < 30);
  assert_true(f.reference_error <= 1e-3);
  assert_near(f.horizon, 0.02 * (double)f.frames, 1e-9);
  msr_accuracy_free(made);
}

static void until_is_kept(void **unused) {
  (void)unused;
  msr_accuracy_options options = {METHODS(three), .until = 0.73};
  msr_accuracy *made = study(make_pair(), &options);
  const msr_accuracy_figures f = msr_accuracy_describe(made);
  assert_near(f.until, 0.73, 0);
  assert_near(f.horizon, 0.75, 1e-9);
  msr_accuracy_free(made);
  options.until = 99;
  made = study(make_pair(), &options);
  assert_near(msr_accuracy_describe(made).until, 3, 1e-9);
  msr_accuracy_free(made);
}

/* Few frames have instants between them; a single iteration has one. */
static void instants_are_enough(void **unused) {
  (void)unused;
  static const struct {
    uint64_t iterations, images, frames;
  } cases[] = {{1, 1, 1},    {5, 2, 4},    {60, 60, 60},
               {100, 1, 32}, {400, 3, 33}, {30000, 25000, 8334}};
  for (size_t i = 0; i < LENGTH(cases); i++) {
    msr_scene *scene = make_pair();
    must(msr_scene_set_times(scene, 0.0001, cases[i].iterations, cases[i].images, &why));
    msr_accuracy *made = study(scene, &(msr_accuracy_options){METHODS(three), .finest = 1e-2});
    assert_int_equal(msr_accuracy_describe(made).frames, cases[i].frames);
    msr_accuracy_free(made);
  }
}

/* A caller that stops once the text begins with `word`. */
typedef struct stopper {
  const char *word;
  int calls;
  bool shares; /* were between 0 and 1 */
} stopper;

static msr_status stop_at(void *data, const msr_accuracy_progress *progress) {
  stopper *s = data;
  s->calls++;
  s->shares &= progress->share >= 0 && progress->share <= 1;
  return strncmp(progress->text, s->word, strlen(s->word)) == 0 ? MSR_EINTR : MSR_OK;
}

static size_t points_of(const msr_accuracy *made, const msr_integrator *integrator) {
  size_t n, found = 0;
  const msr_accuracy_point *p = msr_accuracy_points(made, &n);
  for (size_t i = 0; i < n; i++) found += p[i].integrator == integrator;
  return found;
}

/* The cheapest runs come first: stopped before srkn6's second, which costs as much as Verlet with
 * 22 substeps, there is its first, and more than one of Verlet's. A run is told before it begins.
 */
static void poll_ends_it(void **unused) {
  (void)unused;
  stopper s = {"reference", 0, true};
  msr_scene *scene = make_chain();
  msr_accuracy *made = NULL;
  assert_int_equal(
      msr_accuracy_study(scene, &(msr_accuracy_options){.poll = stop_at, .data = &s}, &made, &why),
      MSR_EINTR);
  assert_null(made);
  assert_int_equal(s.calls, 1);
  s = (stopper){"srkn6, 2 ", 0, true};
  made = study(scene, &(msr_accuracy_options){.poll = stop_at, .data = &s});
  size_t n;
  assert_int_equal(points_of(made, &msr_integrator_srkn6), 1);
  assert_true(points_of(made, &msr_integrator_verlet) > 1);
  (void)msr_accuracy_points(made, &n);
  assert_true(s.shares && s.calls > (int)n);
  assert_false(msr_accuracy_describe(made).complete);
  msr_accuracy_free(made);
}

/* Nothing at all, or what there was time for. */
static void budget_ends_it(void **unused) {
  (void)unused;
  msr_scene *scene = lattice(12, 12, 4, &(msr_conf){0.01, 9.8, 0.1, 1500, 1000, 100});
  msr_accuracy *made = NULL;
  msr_error err;
  assert_int_equal(msr_accuracy_study(scene, &(msr_accuracy_options){.budget = 1e-6}, &made, &err),
                   MSR_EUNSTABLE);
  assert_non_null(strstr(err.message, "budget"));
  made = study_of(scene, &(msr_accuracy_options){.budget = 0.2});
  assert_false(msr_accuracy_describe(made).complete);
  msr_accuracy_free(made);
  msr_scene_free(scene);
}

/* ---- What isn't possible */

static void refused(const msr_scene *scene, const msr_accuracy_options *options, msr_status status,
                    const char *word) {
  msr_accuracy *made = NULL;
  msr_error err;
  assert_int_equal(msr_accuracy_study(scene, options, &made, &err), status);
  assert_int_equal(err.status, status);
  assert_null(made);
  if (!strstr(err.message, word)) fail_msg("'%s' isn't in '%s'", word, err.message);
  assert_int_equal(msr_accuracy_study(scene, options, &made, NULL), status);
}

static void wrong_arguments_are_refused(void **unused) {
  (void)unused;
  static const msr_integrator *const none[] = {NULL};
  msr_scene *scene = make_pair(), *empty = empty_scene(0.1);
  refused(empty, NULL, MSR_EINPUT, "no mass");
  refused(scene, &(msr_accuracy_options){.until = -1}, MSR_EUSAGE, "until");
  refused(scene, &(msr_accuracy_options){.budget = NO_NUMBER}, MSR_EUSAGE, "budget");
  refused(scene, &(msr_accuracy_options){.finest = INFINITE}, MSR_EUSAGE, "finest");
  refused(scene, &(msr_accuracy_options){METHODS(none)}, MSR_EUSAGE, "integrator 0");
  refused(scene, &(msr_accuracy_options){.n_integrators = 1}, MSR_EUSAGE, "integrator 0");
  must(msr_scene_set_times(scene, 0.1, 0, 1, &why));
  refused(scene, NULL, MSR_EINPUT, "NB_ITERATIONS");
  msr_scene_free(scene);
  msr_scene_free(empty);
  msr_accuracy_free(NULL);
}

/* A force that fails, with a word of its own, after a second. */
static msr_status add_and_fail(const void *self, void *scratch, const msr_view *s, double *fx,
                               double *fy) {
  (void)self, (void)scratch, (void)fx, (void)fy;
  return s->t > 1 ? MSR_EIO : MSR_OK;
}
static const msr_force broken = {.name = "broken", .summary = "fails", .add = add_and_fail};

static void forces_may_fail(void **unused) {
  (void)unused;
  msr_scene *scene = make_pair();
  add_force(scene, &broken, NULL);
  refused(scene, NULL, MSR_EIO, "broken");
  msr_scene_free(scene);
}

/* A user's own method is studied as any other; one that refuses the scene has no points. */
static msr_status refuse(const msr_integrator *self, const msr_system *system, void **object,
                         msr_error *err) {
  (void)self, (void)system, (void)object, (void)err;
  return MSR_EUSAGE;
}

static void own_methods_are_studied(void **unused) {
  (void)unused;
  msr_integrator mine = msr_integrator_verlet, picky = msr_integrator_verlet;
  const msr_integrator *const list[] = {&mine, &picky, &mine, &msr_integrator_euler};
  size_t n;
  picky.open = refuse;
  msr_accuracy *made = study(make_pair(), &(msr_accuracy_options){METHODS(list), .finest = 1e-3});
  const msr_accuracy_point *p = msr_accuracy_points(made, &n);
  assert_true(n > 5);
  assert_ptr_equal(p[0].integrator, &mine);
  assert_ptr_equal(p[n - 1].integrator, &msr_integrator_euler);
  for (size_t i = 0; i < n; i++) {
    assert_ptr_not_equal(p[i].integrator, &picky);
    if (i > 0 && p[i].integrator == p[i - 1].integrator)
      assert_true(p[i].substeps > p[i - 1].substeps);
  }
  msr_accuracy_free(made);
}

/* ---- Memory */

static int wrong;

static bool attempt(void) {
  static const msr_integrator *const one[] = {&msr_integrator_verlet};
  msr_accuracy *made = NULL;
  msr_error err = {MSR_OK, ""};
  msr_scene *scene = NULL;
  const size_t failing = alloc_failing;
  alloc_failing = 0;
  scene = scene_of("oo.\n...\n", &(msr_conf){0.05, 9.8, 1, 10, 3, 3}, NULL);
  alloc_calls = 0;
  alloc_failing = failing;
  const msr_status status =
      msr_accuracy_study(scene, &(msr_accuracy_options){METHODS(one), .finest = 1}, &made, &err);
  const size_t calls = alloc_calls;
  alloc_failing = 0;
  msr_accuracy_free(made);
  msr_scene_free(scene);
  alloc_calls = calls;
  wrong += status != MSR_OK && (status != MSR_ENOMEM || !strstr(err.message, "out of memory"));
  wrong += status != MSR_OK && made;
  return status == MSR_OK;
}

static void memory_may_fail(void **unused) {
  (void)unused;
  assert_true(alloc_fail_each(attempt) > 20);
  assert_int_equal(wrong, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(errors_are_true),
      cmocka_unit_test(work_is_true),
      cmocka_unit_test(success_leaves_no_error),
      cmocka_unit_test(orders_are_as_declared),
      cmocka_unit_test(points_are_in_order),
      cmocka_unit_test(front_and_answers_are_true),
      cmocka_unit_test(unstable_points_are_shown),
      cmocka_unit_test(pixels_that_differ_are_counted),
      cmocka_unit_test(studies_repeat),
      cmocka_unit_test(scenes_have_hashes),
      cmocka_unit_test(chaos_has_a_horizon),
      cmocka_unit_test(until_is_kept),
      cmocka_unit_test(instants_are_enough),
      cmocka_unit_test(poll_ends_it),
      cmocka_unit_test(budget_ends_it),
      cmocka_unit_test(wrong_arguments_are_refused),
      cmocka_unit_test(forces_may_fail),
      cmocka_unit_test(own_methods_are_studied),
      cmocka_unit_test(memory_may_fail),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
