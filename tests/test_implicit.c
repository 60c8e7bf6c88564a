/* test_implicit.c - what implicit integrators are for: steps far longer than the fastest period.
 * link: --wrap=malloc --wrap=calloc --wrap=realloc */
#include "alloc.h"
#include "systems.h"

static void on_implicit(void (*check)(const msr_integrator *integrator)) {
  for (const msr_integrator *const *i = msr_integrators; *i; i++)
    if ((*i)->implicit) check(*i);
}

/* ---- A stiff mode */

/* In one step of h omega = 10^6 an L-stable method leaves 1 / (h omega) of it, or (1 - 2g)/g^2
 * = 4.83 times that of two stages with g = 1 - 1/sqrt 2, a conservative or symplectic one all; h
 * omega times rounding is 2e-10. */
static void check_stiff_mode(const msr_integrator *integrator) {
  counted c = {.omega = 1e6};
  const msr_system system = {.n = 1, .self = &c, .acceleration = oscillate};
  double q = 0.6, v = 0.8 * c.omega;
  must(msr_integrate(integrator, &system, 0, 1, 1, &q, &v, &why));
  const double left = hypot(q, v / c.omega);
  const bool lives = integrator->symplectic || integrator->conservative;
  if (lives ? !(fabs(left - 1) < 1e-9) : !(left < 5e-6))
    fail_msg("%s leaves %g", integrator->name, left);
}

static void a_stiff_mode_dies_or_lives(void **state) {
  (void)state;
  on_implicit(check_stiff_mode);
}

/* ---- Blocks that spin */

/* A block of k h^2 / m = stiffness that spins and vibrates. */
typedef struct spin {
  int neighbours;
  double h, stiffness, vibration;
} spin;

static const double mass = 0.1;

static world spinning(const spin *s, const msr_integrator *integrator) {
  enum { N = 6 };
  const double k = s->stiffness * mass / (s->h * s->h);
  world w =
      open_world(lattice(N, N, s->neighbours, &(msr_conf){s->h, 0, mass, k, 1, 1}), integrator, 1);
  const msr_arrays a = msr_state_edit(w.state);
  for (size_t i = 0; i < (size_t)N * N; i++) {
    const double x = a.x[i] - N / 2, y = a.y[i] - N / 2;
    a.x[i] += s->vibration * sin(2 * x + y), a.y[i] += s->vibration * cos(x - 2 * y);
    a.vx[i] = 0.3 - 2 * y, a.vy[i] = 2 * x - 0.1;
  }
  return w;
}

typedef struct motion {
  double energy, px, py, angular;
} motion;

static motion motion_of(const msr_state *state) {
  const msr_energy e = msr_state_energy(state);
  const msr_view s = msr_state_view(state);
  motion m = {.energy = e.total, .px = e.px, .py = e.py};
  for (size_t i = 0; i < s.n; i++) m.angular += mass * (s.x[i] * s.vy[i] - s.y[i] * s.vx[i]);
  return m;
}

static const spin spins[] = {
    {4, 0.03, 10, 0.1},   {4, 0.03, 1e4, 1e-3}, {4, 0.03, 1e8, 1e-7},
    {8, 0.03, 1e4, 1e-3}, {8, 0.03, 1e6, 1e-4}, {8, 0.3, 10, 0.1},
};

/* Over 2000 steps, to 10 eps a step, at random; angular momentum 40 px from the origin, so far do
 * they fly, to 10 times that. Of the energy there is also what rounding of the places does to
 * stretched springs, k vibration times eps 40 px. */
static void energy_and_momenta_are_kept_at_any_step(void **state) {
  (void)state;
  const double steps = 2000, most = 10 * sqrt(steps) * DBL_EPSILON;
  for (size_t n = 0; n < LENGTH(spins); n++) {
    const spin *s = &spins[n];
    world w = spinning(s, &msr_integrator_energy_momentum);
    const motion before = motion_of(w.state);
    advance(&w, (uint64_t)steps);
    const motion after = motion_of(w.state);
    const double k = s->stiffness * mass / (s->h * s->h);
    const double stretched = 40 * k * s->vibration / before.energy;
    const double error[] = {(after.energy / before.energy - 1) / (1 + stretched),
                            (after.angular / before.angular - 1) / 10,
                            (after.px - before.px) / before.px, (after.py - before.py) / before.px};
    if (!(largest(4, error) < most))
      fail_msg("K %g: energy off by %g, angular momentum %g, momentum %g, %g", s->stiffness,
               error[0] * (1 + stretched), 10 * error[1], error[2], error[3]);
    close_world(w);
  }
}

/* Momentum is kept by every method, angular momentum by the midpoint rule too. */
static void check_momenta(const msr_integrator *integrator) {
  const double steps = 50, most = 100 * sqrt(steps) * DBL_EPSILON;
  for (size_t n = 0; n < LENGTH(spins); n++) {
    spin gentle = spins[n];
    gentle.h /= 10, gentle.stiffness /= 100; /* the midpoint rule doesn't bear more */
    world w = spinning(&gentle, integrator);
    const motion before = motion_of(w.state);
    advance(&w, (uint64_t)steps);
    const motion after = motion_of(w.state);
    const double turned = integrator->symplectic ? after.angular / before.angular - 1 : 0;
    const double error[] = {(after.px - before.px) / before.px, (after.py - before.py) / before.px,
                            turned};
    if (!(largest(3, error) < most))
      fail_msg("%s, K %g: momentum off by %g, %g, %g", integrator->name, gentle.stiffness, error[0],
               error[1], error[2]);
    close_world(w);
  }
}

static void momenta_are_kept_by_all(void **state) {
  (void)state;
  on_implicit(check_momenta);
}

/* There and back: each step's rounding is carried on, by up to 1000 here. */
static void long_steps_reverse(void **state) {
  (void)state;
  const uint64_t steps = 50;
  for (size_t n = 0; n < LENGTH(spins); n++) {
    double start[4 * 36], z[4 * 36];
    world w = spinning(&spins[n], &msr_integrator_energy_momentum);
    read_world(&w, start);
    for (int way = 0; way < 2; way++) {
      advance(&w, steps);
      read_world(&w, z);
      for (size_t i = 2 * 36; i < 4 * 36; i++) z[i] = -z[i];
      write_world(&w, z);
    }
    if (spins[n].stiffness >= 1e4 && !(distance(2 * 36, z, start) < 1e-9))
      fail_msg("K %g: %g", spins[n].stiffness, distance(2 * 36, z, start));
    close_world(w);
  }
}

/* Rigidly spinning at 2 rad/s, h = 0.03: the angle is off by (h w)^2 / 12, as of a chord, so that
 * places are by 2e-4 times that of a turn by 6 rad, 4 px from the centre. */
static void a_stiff_block_turns_as_it_should(void **state) {
  (void)state;
  const spin rigid = {4, 0.03, 1e8, 0};
  world w = spinning(&rigid, &msr_integrator_energy_momentum);
  const msr_view start = msr_state_view(w.state);
  const double x0 = start.x[0] - 3, y0 = start.y[0] - 3, t = 3;
  advance(&w, 100);
  const msr_view s = msr_state_view(w.state);
  const double x = 3 + 0.3 * t + cos(2 * t) * x0 - sin(2 * t) * y0;
  const double y = 3 - 0.1 * t + sin(2 * t) * x0 + cos(2 * t) * y0;
  const double off = hypot(s.x[0] - x, s.y[0] - y), most = 0.06 * 0.06 / 12 * 2 * t * 4;
  assert_true(off < 1.1 * most && off > 0.5 * most);
  close_world(w);
}

/* Newton's method takes no more iterations where springs are stiffer: 8 evaluations a step at most,
 * from a lattice that is stretched and flung about. */
static void iterations_do_not_grow_with_stiffness(void **state) {
  (void)state;
  for (double stiffness = 1; stiffness < 1e9; stiffness *= 100) {
    const spin s = {8, 0.01, stiffness, 0.1};
    world w = spinning(&s, &msr_integrator_backward_euler);
    advance(&w, 20);
    const double each = (double)msr_state_work(w.state).evaluations / 20;
    if (!(each < 8)) fail_msg("K %g: %g evaluations a step", stiffness, each);
    close_world(w);
  }
}

/* ---- Discrete gradients */

/* Potentials of a user's, without between(): a well of the fourth degree around each mass, and one
 * in time. */
static msr_status add_well(const void *self, void *scratch, const msr_view *s, double *fx,
                           double *fy) {
  (void)self, (void)scratch;
  for (size_t i = 0; i < s->n; i++) {
    const double x = s->x[i] - 3, y = s->y[i] - 2;
    fx[i] -= 0.2 * x * x * x, fy[i] -= 0.3 * y;
  }
  return MSR_OK;
}

static double energy_of_well(const void *self, const msr_view *s) {
  (void)self;
  double sum = 0;
  for (size_t i = 0; i < s->n; i++) {
    const double x = s->x[i] - 3, y = s->y[i] - 2;
    sum += 0.05 * x * x * x * x + 0.15 * y * y;
  }
  return sum;
}

static const msr_force well = {.name = "well",
                               .summary = "x^4",
                               .conservative = true,
                               .add = add_well,
                               .energy = energy_of_well};

/* The work of the mean force from s to `to`, and what the potential loses, to rounding of the sums.
 */
static void check_work(const msr_force *force, const msr_view *s, const msr_view *to) {
  actor a = prepare(force, trial_params(force), s);
  double f[64] = {0}, back[64] = {0}, d[64];
  must(force->between(a.self, a.scratch, s, to, f, f + s->n));
  must(force->between(a.self, a.scratch, to, s, back, back + s->n));
  for (size_t i = 0; i < 2 * s->n; i++) d[i] = to->x[i] - s->x[i];
  const double lost = force->energy(a.self, s) - force->energy(a.self, to);
  const double size = largest(2 * s->n, f) * largest(2 * s->n, d) + fabs(force->energy(a.self, s)) +
                      fabs(force->energy(a.self, to));
  if (!(fabs(dot(2 * s->n, f, d) - lost) <= 200 * DBL_EPSILON * size))
    fail_msg("%s: work %g, lost %g", force->name, dot(2 * s->n, f, d), lost);
  assert_memory_equal(f, back, sizeof f);
  dismiss(&a);
}

static void work_is_what_the_potential_loses(void **state) {
  (void)state;
  const mesh meshes[] = {{.masses = 9, .springs = 20, .anchors = 5, .seed = 1},
                         {.masses = 9, .springs = 20, .anchors = 5, .coincident = true, .seed = 2}};
  uint64_t dice = 3;
  for (size_t m = 0; m < LENGTH(meshes); m++)
    for (const msr_force *const *f = msr_forces; *f; f++) {
      if (!(*f)->conservative) continue;
      assert_non_null((*f)->between);
      world w = open_world(random_mesh(&meshes[m], NULL), NULL, 0);
      const msr_view s = msr_state_view(w.state);
      double q[64];
      for (double size = 1e-9; size < 1e3; size *= 100) {
        msr_view to = s;
        for (size_t i = 0; i < 2 * s.n; i++) q[i] = s.x[i] + uniform(&dice, -size, size);
        to.x = q, to.y = q + s.n;
        check_work(*f, &s, &to);
        check_work(*f, &s, &s);
      }
      close_world(w);
    }
}

/* Springs, anchors, weight, a push and a user's potential, over long steps: what is lost by
 * rounding is eps of the energies of all springs a step, at random. */
static void every_potential_is_kept(void **state) {
  (void)state;
  const mesh m = {.masses = 9, .springs = 20, .anchors = 5, .seed = 8};
  for (double h = 0.01; h < 0.2; h *= 3) {
    msr_scene *scene = random_mesh(&m, NULL);
    must(msr_scene_set_times(scene, h, 1, 1, &why));
    add_force(scene, &msr_force_gravity, &(msr_gravity){9.8});
    add_force(scene, &msr_force_push, &(msr_push){2, 3, -4});
    add_force(scene, &well, NULL);
    world w = open_world(scene, &msr_integrator_energy_momentum, 1);
    const double e0 = msr_state_energy(w.state).total;
    advance(&w, 300);
    const double off = msr_state_energy(w.state).total / e0 - 1;
    if (!(fabs(off) < 300 * 100 * DBL_EPSILON)) fail_msg("h %g: off by %g", h, off);
    close_world(w);
  }
}

/* ---- The same without the library's solver */

static msr_system stripped(const msr_system *system) {
  msr_system without = *system;
  without.linearise = NULL;
  without.solve = NULL;
  return without;
}

static msr_status open_without(const msr_integrator *self, const msr_system *system, void **object,
                               msr_error *err) {
  const msr_integrator *of = self->coefficients;
  const msr_system without = stripped(system);
  return of->open(of, &without, object, err);
}

static msr_status step_without(const msr_integrator *self, const msr_system *system,
                               const msr_interval *interval, double *q, double *v,
                               msr_workspace *work, msr_error *err) {
  const msr_integrator *of = self->coefficients;
  const msr_system without = stripped(system);
  return of->step(of, &without, interval, q, v, work, err);
}

/* Both solve to rounding: what is left is carried on for 20 steps. */
static void check_without(const msr_integrator *integrator) {
  msr_integrator without = *integrator;
  without.open = open_without;
  without.step = step_without;
  without.coefficients = integrator;
  for (size_t m = 0; m < LENGTH(media); m++) {
    double z[2][4 * MASSES];
    for (int own = 0; own < 2; own++) {
      world w = deformed(&media[m], own ? &without : integrator, 0.05, 1);
      advance(&w, 20);
      read_world(&w, z[own]);
      close_world(w);
    }
    if (!(distance(4 * MASSES, z[0], z[1]) < 1e-10))
      fail_msg("%s, %s: %g apart", integrator->name, media[m].name,
               distance(4 * MASSES, z[0], z[1]));
  }
}

static void differences_do_without_a_solver(void **state) {
  (void)state;
  on_implicit(check_without);
}

/* ---- What can't be solved */

/* Backward Euler spirals in until no place solves its equation: told, and not stepped. */
static void no_solution_is_told(void **state) {
  (void)state;
  const msr_system system = {.n = 2, .acceleration = fall_to_sun};
  double z[] = {0.7, 0, 0, 1.36}, before[4];
  msr_error err = {MSR_OK, ""};
  msr_status status = MSR_OK;
  for (int n = 0; n < 32 && status == MSR_OK; n++) {
    memcpy(before, z, sizeof z);
    status = msr_integrate(&msr_integrator_backward_euler, &system, 0, 0.125, 1, z, z + 2, &err);
  }
  assert_int_equal(status, MSR_EUNSTABLE);
  assert_int_equal(err.status, MSR_EUNSTABLE);
  assert_non_null(strstr(err.message, "weren't solved in"));
  assert_non_null(strstr(err.message, "take smaller steps (more substeps)"));
  assert_memory_equal(z, before, sizeof z);
}

static msr_status burst(void *self, double t, const double *q, const double *v, double *a) {
  (void)self, (void)t, (void)q, (void)v;
  a[0] = INFINITE;
  return MSR_OK;
}

static msr_status refuse(void *self, double t, const double *q, const double *v, double *a) {
  (void)self, (void)t, (void)q, (void)v, (void)a;
  return MSR_EINTR;
}

static void check_refusals(const msr_integrator *integrator) {
  msr_system system = {.n = 1, .acceleration = burst};
  double q = 1, v = 2;
  msr_error err;
  assert_int_equal(msr_integrate(integrator, &system, 0, 0.1, 3, &q, &v, &err), MSR_EUNSTABLE);
  assert_non_null(strstr(err.message, "beyond what numbers can hold"));
  system.acceleration = refuse;
  assert_int_equal(msr_integrate(integrator, &system, 0, 0.1, 3, &q, &v, &err), MSR_EINTR);
  assert_true(q == 1 && v == 2);
}

static void what_a_system_refuses_is_told(void **state) {
  (void)state;
  on_implicit(check_refusals);
}

/* Scrambled, at rest or flung about, and beyond all bounds: a method gets through or says that it
 * doesn't, and leaves numbers either way. */
static void check_wild(const msr_integrator *integrator) {
  uint64_t dice = 5;
  int through = 0;
  for (double stiffness = 0.01; stiffness < 1e13; stiffness *= 1e4)
    for (double size = 0.1; size < 11; size *= 10) {
      const spin s = {4 + 4 * (int)random_below(&dice, 2), 0.01, stiffness, 0};
      world w = spinning(&s, integrator);
      const msr_arrays a = msr_state_edit(w.state);
      for (size_t i = 0; i < 36; i++) {
        a.x[i] += uniform(&dice, -size, size), a.y[i] += uniform(&dice, -size, size);
        if (i % 5 == 0) a.x[i] = 1, a.y[i] = 2; /* at one place */
      }
      double z[4 * 36];
      const msr_status status = msr_state_step(w.state, 3, &why);
      read_world(&w, z);
      assert_true(status == MSR_OK || status == MSR_EUNSTABLE);
      assert_true(distance(4 * 36, z, z) == 0 && isfinite(largest(4 * 36, z)));
      through += status == MSR_OK;
      close_world(w);
    }
  assert_true(through >= 3);
}

static void wild_scenes_leave_numbers(void **state) {
  (void)state;
  on_implicit(check_wild);
}

/* ---- Scenes */

/* A chain of 8 hangs from a fixed point: with long steps of an L-stable method it comes to rest
 * where every spring bears the weight below it, l = L + m g n / k, to the rounding of k. */
static void check_hanging(const msr_integrator *integrator) {
  enum { LINKS = 8 };
  const double k = 1e6, g = 9.8;
  msr_scene *scene = empty_scene(0.5);
  for (size_t i = 0; i < LINKS; i++) add_mass(scene, 0.3 * (double)i, -(double)i - 1, 0, 0, mass);
  for (size_t i = 1; i < LINKS; i++) must(msr_scene_add_spring(scene, i - 1, i, k, 1, &why));
  must(msr_scene_add_anchor(scene, &(msr_anchor){0, 0, 0, k, 1}, &why));
  add_force(scene, &msr_force_gravity, &(msr_gravity){g});
  add_force(scene, &msr_force_drag, &(msr_drag){0.5});
  world w = open_world(scene, integrator, 1);
  advance(&w, 400);
  const msr_view s = msr_state_view(w.state);
  double y = 0;
  for (size_t i = 0; i < LINKS; i++) {
    y -= 1 + mass * g * (double)(LINKS - i) / k;
    if (!(hypot(s.x[i], s.y[i] - y) < 1e-9))
      fail_msg("%s: mass %zu is off by %g, %g", integrator->name, i, s.x[i], s.y[i] - y);
  }
  close_world(w);
}

static void a_chain_comes_to_hang(void **state) {
  (void)state;
  check_hanging(&msr_integrator_backward_euler);
  check_hanging(&msr_integrator_sdirk2);
}

/* n = 22500 masses, k h^2 / m = 10^4: two steps, their energy to rounding of sums of n, and what it
 * takes of memory, 400 bytes a mass at most. */
static void a_large_stiff_scene_runs(void **state) {
  (void)state;
  const double h = 0.01, k = 1e4 * mass / (h * h);
  world w = open_world(lattice(150, 150, 4, &(msr_conf){h, 9.8, mass, k, 1, 1}),
                       &msr_integrator_energy_momentum, 1);
  const msr_arrays a = msr_state_edit(w.state);
  const size_t n = 150 * 150;
  for (size_t i = 0; i < n; i++) {
    const double x = a.x[i] - 75, y = a.y[i] - 75;
    a.vx[i] = -0.5 * y, a.vy[i] = 0.5 * x;
    a.x[i] += 1e-3 * sin(0.1 * y), a.y[i] += 1e-3 * cos(0.2 * x);
  }
  const double e0 = msr_state_energy(w.state).total;
  advance(&w, 2);
  const msr_plan_figures f = msr_plan_describe(w.plan);
  assert_true(fabs(msr_state_energy(w.state).total / e0 - 1) < 10 * sqrt((double)n) * DBL_EPSILON);
  assert_true(f.state_bytes + f.plan_bytes < 400 * n && f.state_bytes > 300 * n);
  close_world(w);
}

/* ---- Memory */

static int wrong; /* failures that weren't told as such */

/* Done? If not, it must be for want of memory, and say so. */
static bool done(msr_status status, const msr_error *err) {
  if (status == MSR_OK) return true;
  wrong += status != MSR_ENOMEM || !strstr(err->message, "out of memory");
  return false;
}

static bool integrate_plainly(void) {
  counted c = {.omega = 1};
  const msr_system system = {.n = 1, .self = &c, .acceleration = oscillate};
  double q = 1, v = 0;
  msr_error err;
  return done(msr_integrate(&msr_integrator_sdirk2, &system, 0, 0.1, 2, &q, &v, &err), &err);
}

static bool step_a_scene(void) {
  static const msr_conf conf = {0.01, 9.8, 0.1, 1e5, 4, 1};
  const msr_plan_options options = {.integrator = &msr_integrator_energy_momentum, .substeps = 1};
  msr_error err;
  const size_t failing = alloc_failing;
  alloc_failing = 0;
  const size_t before = alloc_calls;
  msr_scene *scene = lattice(3, 3, 8, &conf);
  add_force(scene, &well, NULL);
  alloc_failing = failing;
  alloc_calls = before;
  msr_plan *plan = NULL;
  msr_state *made = NULL;
  bool success = done(msr_plan_create(scene, &options, &plan, &err), &err);
  success = success && done(msr_state_create(plan, &made, &err), &err);
  const size_t calls = alloc_calls;
  success = success && done(msr_state_step(made, 4, &err), &err);
  wrong += alloc_calls != calls; /* no step allocates */
  msr_state_free(made);
  msr_plan_free(plan);
  msr_scene_free(scene);
  return success;
}

static void want_of_memory_is_told(void **state) {
  (void)state;
  wrong = 0;
  assert_true(alloc_fail_each(integrate_plainly) >= 2);
  assert_true(alloc_fail_each(step_a_scene) >= 6);
  assert_int_equal(wrong, 0);
}

/* a = -q, and beyond 1 none: no guess out there may pass for a solution. */
static msr_status fenced(void *self, double t, const double *q, const double *v, double *a) {
  (void)self, (void)t, (void)v;
  a[0] = q[0] <= 1 ? -q[0] : (double)NAN;
  return MSR_OK;
}

static void what_is_no_number_is_no_solution(void **unused) {
  (void)unused;
  const msr_system system = {.n = 1, .acceleration = fenced};
  double q = 0, v = 1; /* the solution is q = v = 1/2, the guess q = 1 */
  const msr_status status =
      msr_integrate(&msr_integrator_backward_euler, &system, 0, 1, 1, &q, &v, NULL);
  assert_true(status == MSR_EUNSTABLE || (fabs(q - 0.5) < 1e-9 && fabs(v - 0.5) < 1e-9));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_stiff_mode_dies_or_lives),
      cmocka_unit_test(energy_and_momenta_are_kept_at_any_step),
      cmocka_unit_test(momenta_are_kept_by_all),
      cmocka_unit_test(long_steps_reverse),
      cmocka_unit_test(a_stiff_block_turns_as_it_should),
      cmocka_unit_test(iterations_do_not_grow_with_stiffness),
      cmocka_unit_test(work_is_what_the_potential_loses),
      cmocka_unit_test(every_potential_is_kept),
      cmocka_unit_test(differences_do_without_a_solver),
      cmocka_unit_test(no_solution_is_told),
      cmocka_unit_test(what_a_system_refuses_is_told),
      cmocka_unit_test(wild_scenes_leave_numbers),
      cmocka_unit_test(a_chain_comes_to_hang),
      cmocka_unit_test(a_large_stiff_scene_runs),
      cmocka_unit_test(what_is_no_number_is_no_solution),
      cmocka_unit_test(want_of_memory_is_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
