/* test_effects.c - effects are paid for only when called for: what is off is never run and changes
 * no bit, what is on says why, and a force of one's own is treated as the library's are.
 * link: --wrap=gsl_rng_set */
#include "art.h"

#include <gsl/gsl_rng.h>

/* ---- Random numbers that were asked for */

static int seedings;

void __real_gsl_rng_set(const gsl_rng *rng, unsigned long seed);
void __wrap_gsl_rng_set(const gsl_rng *rng, unsigned long seed);

void __wrap_gsl_rng_set(const gsl_rng *rng, unsigned long seed) {
  seedings++;
  __real_gsl_rng_set(rng, seed);
}

/* ---- Scenes */

static const char block[] = "........\n..ooo...\n..ooo...\n........\n........\n........\n";
static const char block_on_floor[] = "........\n..ooo...\n..ooo...\n........\n........\n########\n";
/* The step is small enough for explicit Euler not to explode within the run. */
static const msr_conf still = {
    .dt = 0.0005, .mass = 0.1, .stiffness = 1500, .iterations = 1, .images = 1};

static const msr_scene_options closed_border = {.closed_border = true};

static msr_scene *with(msr_scene *scene, const msr_force *force, const void *params) {
  add_force(scene, force, params);
  return scene;
}

/* The block's masses without a picture: a scene that never had springs. */
static msr_scene *loose_masses(void) {
  msr_scene *scene = empty_scene(still.dt);
  for (int i = 0; i < 6; i++) add_mass(scene, 2.5 + i % 3, 4.5 - i / 3, 0, 0, 0.1);
  return scene;
}

/* ---- Runs */

enum { ITERATIONS = 40 };

/* Throws the block by hand and steps; the scene is freed. */
static world run_of(msr_scene *scene, const msr_integrator *integrator) {
  const world r = open_world(scene, integrator, 1);
  const msr_arrays a = msr_state_edit(r.state);
  for (size_t i = 0; i < msr_plan_describe(r.plan).masses; i++) {
    a.vx[i] = 1 + (double)i / 8;
    a.vy[i] = (double)i / 4 - 0.5;
  }
  advance(&r, ITERATIONS);
  return r;
}

/* The effect of that name: its number, or that of all effects. */
static size_t find(const world *r, const char *name, const msr_effect **effect) {
  size_t n, e = 0;
  const msr_effect *all = msr_plan_effects(r->plan, &n);
  while (e < n && strcmp(all[e].name, name) != 0) e++;
  *effect = e < n ? &all[e] : NULL;
  return e;
}

static void assert_effect(const world *r, const char *name, bool on) {
  const msr_effect *effect;
  const size_t e = find(r, name, &effect);
  assert_non_null(effect);
  assert_int_equal(effect->on, on);
  assert_true(strlen(effect->reason) > 0);
  assert_int_equal(msr_state_calls(r->state, e) > 0, on);
}

/* ---- What each effect needs to be on, to be off, and never to have been there */

static msr_scene *plain(void) { return scene_of(block, &still, NULL); }

static msr_scene *no_stiffness(void) {
  msr_conf slack = still;
  slack.stiffness = 0;
  return scene_of(block, &slack, NULL);
}

static msr_scene *in_gravity(void) {
  msr_conf heavy = still;
  heavy.gravity = 9.8;
  return scene_of(block, &heavy, NULL);
}

static msr_scene *on_floor(void) { return scene_of(block_on_floor, &still, NULL); }
static msr_scene *closed(void) { return scene_of(block, &still, &closed_border); }
static msr_scene *no_gravity(void) { return with(plain(), &msr_force_gravity, &(msr_gravity){0}); }
static msr_scene *drag(void) { return with(plain(), &msr_force_drag, &(msr_drag){0.1}); }
static msr_scene *no_drag(void) { return with(plain(), &msr_force_drag, &(msr_drag){0}); }
static msr_scene *damping(void) { return with(plain(), &msr_force_damping, &(msr_damping){0.1}); }
static msr_scene *no_damping(void) { return with(plain(), &msr_force_damping, &(msr_damping){0}); }
static msr_scene *push(void) { return with(plain(), &msr_force_push, &(msr_push){2, 1, 1}); }
static msr_scene *no_push(void) { return with(plain(), &msr_force_push, &(msr_push){2, 0, 0}); }

static msr_scene *wind(void) {
  return with(plain(), &msr_force_wind, &(msr_wind){.speed = 1, .gust = 1, .seed = 7});
}

static msr_scene *with_discs(msr_scene *scene, double diameter) {
  must(msr_scene_set_collisions(scene, diameter, &why));
  return scene;
}

static msr_scene *discs(void) { return with_discs(plain(), 0.5); }
static msr_scene *no_discs(void) { return with_discs(plain(), 0); }

static const struct row {
  const char *name;
  msr_scene *(*on)(void), *(*off)(void), *(*never)(void);
} rows[] = {
    {"springs", plain, no_stiffness, loose_masses},
    {"gravity", in_gravity, no_gravity, plain},
    {"damping", damping, no_damping, plain},
    {"drag", drag, no_drag, plain},
    {"wind", wind, plain, plain}, // no wind is no wind: what is still is drag
    {"push", push, no_push, plain},
    {"supports", on_floor, plain, plain},
    {"border", closed, plain, plain},
    {"collisions", discs, no_discs, plain},
};

/* A new row in the library's table must have one here. */
static void every_effect_is_tested(void **unused) {
  (void)unused;
  for (const msr_force *const *f = msr_forces; *f; f++) {
    size_t i = 0;
    while (i < LENGTH(rows) && strcmp(rows[i].name, (*f)->name) != 0) i++;
    if (i == LENGTH(rows)) fail_msg("%s has no row in this test", (*f)->name);
  }
  const world r = run_of(plain(), NULL);
  size_t n, steps = 0; // these are in test_costs.c
  const msr_effect *effects = msr_plan_effects(r.plan, &n);
  for (size_t e = 0; e < n; e++) steps += effects[e].role == MSR_ROLE_STEP;
  assert_int_equal(n, LENGTH(rows) + steps);
  assert_int_equal(steps, 4);
  close_world(r);
}

static void what_is_off_changes_no_bit(void **unused) {
  (void)unused;
  for (const msr_integrator *const *i = msr_integrators; *i; i++)
    for (size_t e = 0; e < LENGTH(rows); e++) {
      const world off = run_of(rows[e].off(), *i), never = run_of(rows[e].never(), *i);
      assert_effect(&off, rows[e].name, false);
      assert_effect(&never, rows[e].name, false);
      assert_true(msr_state_hash(off.state) == msr_state_hash(never.state));
      close_world(off);
      close_world(never);
    }
}

static void what_is_on_is_called(void **unused) {
  (void)unused;
  for (const msr_integrator *const *i = msr_integrators; *i; i++)
    for (size_t e = 0; e < LENGTH(rows); e++) {
      const world on = run_of(rows[e].on(), *i);
      assert_effect(&on, rows[e].name, true);
      close_world(on);
    }
}

/* A force does something; a support or a border that isn't met changes no bit. */
static void what_is_on_acts(void **unused) {
  (void)unused;
  for (size_t e = 0; e < LENGTH(rows); e++) {
    const world on = run_of(rows[e].on(), NULL), never = run_of(rows[e].never(), NULL);
    const msr_effect *effect;
    find(&on, rows[e].name, &effect);
    const bool same = msr_state_hash(on.state) == msr_state_hash(never.state);
    assert_int_equal(same, effect->force == NULL);
    assert_int_equal(msr_state_contacts(on.state), 0);
    close_world(on);
    close_world(never);
  }
}

/* Verlet takes one evaluation per step, and one at the start of each call: no effect is called more
 * often. */
static void calls_are_as_few_as_can_be(void **unused) {
  (void)unused;
  const world r = run_of(in_gravity(), &msr_integrator_verlet);
  const char *const names[] = {"springs", "gravity"};
  for (int i = 0; i < 2; i++) {
    const msr_effect *effect;
    const size_t e = find(&r, names[i], &effect);
    const uint64_t before = msr_state_calls(r.state, e);
    must(msr_state_step(r.state, ITERATIONS, &why));
    assert_int_equal(msr_state_calls(r.state, e) - before, ITERATIONS + 1);
  }
  assert_int_equal(msr_state_calls(r.state, 1000), 0);
  close_world(r);
}

static void no_random_number_without_gusts(void **unused) {
  (void)unused;
  static const msr_wind steady = {.speed = 3, .seed = 7}, gusty = {.gust = 1, .seed = 7};
  seedings = 0;
  close_world(run_of(plain(), NULL));
  assert_int_equal(seedings, 0);
  close_world(run_of(with(plain(), &msr_force_wind, &steady), NULL));
  assert_int_equal(seedings, 0);
  close_world(run_of(with(plain(), &msr_force_wind, &gusty), NULL));
  assert_true(seedings > 0);
}

/* Nothing moves: nothing is on. */
static void without_masses_all_is_off(void **unused) {
  (void)unused;
  msr_scene *scene = scene_of(".#.\n", &still, &closed_border);
  with(scene, &msr_force_gravity, &(msr_gravity){9.8});
  with(scene, &msr_force_drag, &(msr_drag){1});
  with(scene, &msr_force_damping, &(msr_damping){1});
  with(scene, &msr_force_wind, &(msr_wind){.speed = 1, .gust = 1});
  const world r = run_of(scene, NULL);
  size_t n;
  const msr_effect *effects = msr_plan_effects(r.plan, &n);
  for (size_t e = 0; e < n; e++) assert_effect(&r, effects[e].name, false);
  close_world(r);
}

/* ---- Order and reasons */

static void effects_are_in_the_order_in_which_they_act(void **unused) {
  (void)unused;
  static const char *const due[] = {"springs",    "push",   "drag",       "push",    "wind",
                                    "supports",   "border", "integrator", "guard",   "drag",
                                    "collisions", "leaps",  "care",       "gravity", "damping"};
  static const msr_role roles[] = {
      [5] = MSR_ROLE_CONTACT, MSR_ROLE_CONTACT, MSR_ROLE_STEP, MSR_ROLE_STEP,  MSR_ROLE_FORCE,
      MSR_ROLE_CONTACT,       MSR_ROLE_STEP,    MSR_ROLE_STEP, MSR_ROLE_FORCE, MSR_ROLE_FORCE};
  msr_scene *scene = scene_of(block_on_floor, &still, &closed_border);
  with(scene, &msr_force_push, &(msr_push){0, 1, 1});
  with(scene, &msr_force_drag, &(msr_drag){0.1});
  with(scene, &msr_force_drag, &(msr_drag){0});
  with(scene, &msr_force_push, &(msr_push){0, 2, 2});
  with(scene, &msr_force_wind, &(msr_wind){.speed = 1});
  const world r = run_of(scene, NULL);
  size_t n;
  const msr_effect *effects = msr_plan_effects(r.plan, &n);
  assert_int_equal(n, LENGTH(due));
  for (size_t e = 0; e < n; e++) {
    assert_string_equal(effects[e].name, due[e]);
    assert_int_equal(effects[e].on, e < 9);
    assert_int_equal(effects[e].role, roles[e]);
    assert_int_equal(effects[e].force != NULL, roles[e] == MSR_ROLE_FORCE);
  }
  close_world(r);
}

static void reasons_say_what_is_meant(void **unused) {
  (void)unused;
  static const struct {
    msr_scene *(*scene)(void);
    const char *name, *reason;
  } cases[] = {
      {plain, "springs", "7 springs between masses, 0 to fixed points"},
      {no_stiffness, "springs", "every stiffness (TENSION_RESSORT) is 0"},
      {loose_masses, "springs", "no two masses are neighbours"},
      {in_gravity, "gravity", "GRAVITE = 9.8 px/s^2"},
      {no_gravity, "gravity", "GRAVITE is 0"},
      {plain, "gravity", "GRAVITE is 0"},
      {drag, "drag", "asked for: c = 0.1 kg/s"},
      {no_drag, "drag", "its coefficient is 0"},
      {plain, "drag", "not asked for"},
      {damping, "damping", "asked for: z = 0.1 kg/s on every spring"},
      {no_damping, "damping", "its coefficient is 0"},
      {push, "push", "asked for: (1, 1) on mass 2"},
      {no_push, "push", "its force is 0"},
      {wind, "wind", "asked for: mean 1 px/s, gusts 1 px/s over 1 s, seed 7; drag c = 0.1 kg/s"},
      {on_floor, "supports", "8 black pixels, the first at (0,5); restitution 1, friction 0"},
      {plain, "supports", "there is no black pixel"},
      {closed, "border", "it is closed; restitution 1, friction 0"},
      {plain, "border", "it is open"},
      {plain, "collisions", "not asked for"},
  };
  for (size_t i = 0; i < LENGTH(cases); i++) {
    const world r = run_of(cases[i].scene(), NULL);
    const msr_effect *effect;
    find(&r, cases[i].name, &effect);
    assert_string_equal(effect->reason, cases[i].reason);
    close_world(r);
  }
}

/* ---- A force of one's own */

typedef struct mine {
  int *adds, *flows, *prepares, *releases;
  msr_status of_check, of_prepare, of_add, of_flow, of_rates;
  uint64_t *uses; /* of its scratch; NULL: not counted */
  double c;       /* F = -c v */
  bool idle;
} mine;

static msr_status my_check(const void *params, msr_error *err) {
  (void)err;
  return ((const mine *)params)->of_check;
}

static bool my_idle(const void *params, const msr_view *s, char *reason, size_t size) {
  const mine *p = params;
  assert_true(s->t == 0 && size > 8 && s->vx != NULL);
  if (p->idle) memcpy(reason, "of rest", sizeof "of rest");
  return p->idle;
}

static msr_status my_prepare(const void *params, const msr_view *s, void **self, msr_error *err) {
  (void)s, (void)err;
  const mine *p = params;
  ++*p->prepares;
  if (p->of_prepare) return p->of_prepare;
  mine *made = malloc(sizeof *made);
  assert_non_null(made);
  *made = *p;
  *self = made;
  return MSR_OK;
}

static void my_release(void *self) {
  assert_non_null(self); // it frees what prepare made, and nothing else
  ++*((mine *)self)->releases;
  free(self);
}

static msr_status my_add(const void *self, void *scratch, const msr_view *s, double *fx,
                         double *fy) {
  const mine *p = self;
  ++*p->adds;
  assert_true((uintptr_t)scratch % sizeof(double) == 0);
  ++*(uint64_t *)scratch;
  if (p->uses) assert_int_equal(*(uint64_t *)scratch, ++*p->uses);
  for (size_t i = 0; i < s->n; i++) fx[i] -= p->c * s->vx[i], fy[i] -= p->c * s->vy[i];
  return p->of_add;
}

static msr_status my_flow(const void *self, void *scratch, const msr_view *s, double h,
                          bool backward, double *vx, double *vy) {
  (void)scratch, (void)s, (void)h, (void)backward, (void)vx, (void)vy;
  ++*((const mine *)self)->flows;
  return ((const mine *)self)->of_flow;
}

static msr_status my_rates(const void *self, const msr_view *s, double *omega2, double *gamma) {
  assert_true(*omega2 == 0 && *gamma == 0);
  *gamma = ((const mine *)self)->c / msr_view_mass(s, 0);
  return ((const mine *)self)->of_rates;
}

#define MINE                                                                                       \
  .name = "mine", .summary = "F = -c v", .uses_velocity = true, .dissipative = true,               \
  .params_size = sizeof(mine), .scratch_size = sizeof(uint64_t) + 1, .check = my_check,            \
  .idle = my_idle, .prepare = my_prepare, .release = my_release, .add = my_add, .rates = my_rates

static const msr_force with_flow = {MINE, .flow = my_flow};
static const msr_force without_flow = {MINE};

static int adds, flows, prepares, releases;

static mine counting(double c) {
  adds = flows = prepares = releases = 0;
  return (mine){
      .adds = &adds, .flows = &flows, .prepares = &prepares, .releases = &releases, .c = c};
}

static void my_force_is_treated_as_built_in(void **unused) {
  (void)unused;
  const mine params = counting(0.1);
  const world r = run_of(with(plain(), &without_flow, &params), NULL);
  const msr_effect *effect;
  const size_t e = find(&r, "mine", &effect);
  assert_true(effect->on && effect->force == &without_flow);
  assert_string_equal(effect->reason, "asked for");
  assert_int_equal(prepares, 1);
  // drag by the midpoint rule is within (c h / 2 m)^3 / 6 of drag by its own flow, step by step
  const world built_in = run_of(drag(), NULL);
  const msr_view a = msr_state_view(r.state), b = msr_state_view(built_in.state);
  for (size_t i = 0; i < a.n; i++) assert_true(fabs(a.vx[i] - b.vx[i]) < 1e-6);
  assert_false(msr_state_hash(r.state) == msr_state_hash(built_in.state));
  close_world(built_in);
  const uint64_t before = msr_state_calls(r.state, e);
  adds = 0;
  must(msr_state_step(r.state, ITERATIONS, &why));
  assert_int_equal(msr_state_calls(r.state, e) - before, 2 * ITERATIONS); // half a step at each end
  assert_int_equal(adds, 2 * 2 * ITERATIONS); // two by the midpoint rule
  close_world(r);
  assert_int_equal(releases, 1);
}

static void my_flow_takes_the_place_of_add(void **unused) {
  (void)unused;
  const mine params = counting(0.1);
  for (int i = 0; i < 2; i++) {
    const world r = run_of(with(plain(), &with_flow, &params), i ? &msr_integrator_rk4 : NULL);
    adds = flows = 0;
    must(msr_state_step(r.state, ITERATIONS, &why));
    assert_int_equal(adds, i ? 4 * ITERATIONS : 0); // rk4 takes it through a
    assert_int_equal(flows, i ? 0 : 2 * ITERATIONS);
    close_world(r);
  }
}

/* Scratch is zero at first, and each force's and each state's own. */
static void my_forces_have_scratch_of_their_own(void **unused) {
  (void)unused;
  for (int again = 0; again < 2; again++) {
    uint64_t uses[2] = {0};
    mine first = counting(0.1), second = first;
    first.uses = &uses[0], second.uses = &uses[1];
    second.c = 0.2;
    close_world(run_of(with(with(plain(), &without_flow, &first), &without_flow, &second), NULL));
    assert_true(uses[0] > 0 && uses[1] > 0);
  }
}

static void my_idle_force_costs_nothing(void **unused) {
  (void)unused;
  mine params = counting(0.1);
  params.idle = true;
  const world r = run_of(with(plain(), &without_flow, &params), NULL),
              never = run_of(plain(), NULL);
  const msr_effect *effect;
  find(&r, "mine", &effect);
  assert_false(effect->on);
  assert_string_equal(effect->reason, "of rest");
  assert_true(msr_state_hash(r.state) == msr_state_hash(never.state));
  assert_true(msr_plan_describe(r.plan).state_bytes <=
              msr_plan_describe(never.plan).state_bytes + 64); // a count of calls
  close_world(r);
  close_world(never);
  assert_int_equal(adds + flows + prepares + releases, 0);
}

/* What a callback returns ends what called it, and comes back unchanged. */
static void my_status_comes_back(void **unused) {
  (void)unused;
  const msr_status odd = MSR_EINTR;
  msr_error err = {.message = ""};
  msr_plan *plan = NULL;
  msr_state *state;
  mine params = counting(0.1);

  params.of_check = odd;
  msr_scene *scene = plain();
  assert_int_equal(msr_scene_add_force(scene, &without_flow, &params, &err), odd);
  assert_string_equal(err.message, "force mine: interrupted"); // it said nothing
  params.of_check = MSR_OK;
  msr_scene_free(scene);

  params.of_prepare = odd;
  err.message[0] = 0;
  scene = with(plain(), &without_flow, &params);
  assert_int_equal(msr_plan_create(scene, NULL, &plan, &err), odd);
  assert_string_equal(err.message, "force mine: interrupted");
  assert_null(plan);
  assert_int_equal(prepares, 1);
  msr_scene_free(scene);
  params.of_prepare = MSR_OK;

  params.of_rates = odd;
  scene = with(plain(), &without_flow, &params);
  assert_int_equal(msr_plan_create(scene, NULL, &plan, &err), odd);
  assert_int_equal(err.status, odd);
  assert_null(plan);
  assert_int_equal(releases, 1);
  msr_scene_free(scene);
  params.of_rates = MSR_OK;

  params.of_add = params.of_flow = odd;
  for (int flow = 0; flow < 2; flow++)
    for (const msr_integrator *const *i = msr_integrators; *i; i++) {
      scene = with(plain(), flow ? &with_flow : &without_flow, &params);
      assert_int_equal(msr_plan_create(scene, &(msr_plan_options){.integrator = *i}, &plan, &err),
                       MSR_OK);
      assert_int_equal(msr_state_create(plan, &state, &err), MSR_OK);
      double fx[6], fy[6];
      assert_int_equal(msr_state_forces(state, fx, fy, &err), odd);
      assert_string_equal(err.message, "force mine: interrupted");
      assert_int_equal(msr_state_step(state, 1, &err), odd);
      assert_string_equal(err.message, "iteration 0: mine: interrupted");
      assert_int_equal(msr_run(state, NULL, &err), odd);
      msr_state_free(state);
      msr_plan_free(plan);
      msr_scene_free(scene);
    }
}

/* A force that drives is followed by the guard, whose failures are the force's. */
static void my_driving_force_is_followed(void **unused) {
  (void)unused;
  static const msr_force driving = {.name = "driving",
                                    .summary = "drives",
                                    .uses_velocity = true,
                                    .params_size = sizeof(mine),
                                    .scratch_size = sizeof(uint64_t),
                                    .add = my_add};
  mine params = counting(-1);
  const world r = run_of(with(plain(), &driving, &params), NULL);
  const int before = adds;
  must(msr_state_step(r.state, 10, &why));
  assert_true(adds >= before + 10 * 5); // two midpoint steps of two calls each, and the guard's
  close_world(r);
  params.of_add = MSR_EIO;
  const world failing = open_world(with(plain(), &driving, &params), NULL, 0);
  msr_error err;
  assert_int_equal(msr_state_step(failing.state, 1, &err), MSR_EIO);
  assert_string_equal(err.message, "force driving: input or output failed");
  close_world(failing);
}

static msr_status odd_rates(const void *self, const msr_view *s, double *omega2, double *gamma) {
  (void)s;
  *omega2 = *gamma = *(const double *)self;
  return MSR_OK;
}

static msr_status add_no_force(const void *self, void *scratch, const msr_view *s, double *fx,
                               double *fy) {
  (void)self, (void)scratch, (void)s, (void)fx, (void)fy;
  return MSR_OK;
}

/* A bound that is no number would give no stable step. */
static void rates_are_numbers(void **unused) {
  (void)unused;
  static const msr_force odd = {.name = "odd",
                                .summary = "has no rates",
                                .params_size = sizeof(double),
                                .add = add_no_force,
                                .rates = odd_rates};
  const double rates[] = {-1, (double)NAN};
  for (size_t i = 0; i < LENGTH(rates); i++) {
    msr_scene *scene = with(plain(), &odd, &rates[i]);
    msr_plan *plan = NULL;
    msr_error err;
    assert_int_equal(msr_plan_create(scene, NULL, &plan, &err), MSR_EUSAGE);
    assert_non_null(strstr(err.message, "force odd: rates must be numbers of 0 or more"));
    assert_null(plan);
    msr_scene_free(scene);
  }
}

static msr_status add_sway(const void *self, void *scratch, const msr_view *s, double *fx,
                           double *fy) {
  (void)self, (void)scratch, (void)fy;
  for (size_t i = 0; i < s->n; i++) fx[i] += cos(30 * s->t);
  return MSR_OK;
}

/* Verlet begins with one evaluation. What the guard and a program ask for isn't counted. */
static void only_calls_to_step_are_counted(void **unused) {
  (void)unused;
  static const msr_force swaying = {
      .name = "swaying", .summary = "F = cos(30 t)", .uses_time = true, .add = add_sway};
  const world w = open_world(with(in_gravity(), &swaying, NULL), NULL, 1);
  double fx[6], fy[6];
  for (uint64_t steps = 0; steps <= 70; steps += 35) { // the guard looks at 32 and 64
    must(msr_state_check(w.state, &why));
    must(msr_state_forces(w.state, fx, fy, &why));
    for (size_t e = 0; e < 3; e++)
      assert_int_equal(msr_state_calls(w.state, e), steps > 0 ? steps + 1 : 0);
    advance(&w, 35);
  }
  close_world(w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_effect_is_tested),
      cmocka_unit_test(what_is_off_changes_no_bit),
      cmocka_unit_test(what_is_on_is_called),
      cmocka_unit_test(what_is_on_acts),
      cmocka_unit_test(calls_are_as_few_as_can_be),
      cmocka_unit_test(no_random_number_without_gusts),
      cmocka_unit_test(without_masses_all_is_off),
      cmocka_unit_test(effects_are_in_the_order_in_which_they_act),
      cmocka_unit_test(reasons_say_what_is_meant),
      cmocka_unit_test(my_force_is_treated_as_built_in),
      cmocka_unit_test(my_flow_takes_the_place_of_add),
      cmocka_unit_test(my_forces_have_scratch_of_their_own),
      cmocka_unit_test(my_idle_force_costs_nothing),
      cmocka_unit_test(my_status_comes_back),
      cmocka_unit_test(my_driving_force_is_followed),
      cmocka_unit_test(rates_are_numbers),
      cmocka_unit_test(only_calls_to_step_are_counted),
  };
  return cmocka_run_group_tests_name("effects", tests, NULL, NULL);
}
