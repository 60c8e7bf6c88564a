/* test_forces.c - every force of the library by itself: what it declares (a potential, dissipation,
 * independence of v or t, a flow, bounds of its rates) and what holds for forces along springs. */
#include "scenes.h"

#include <gsl/gsl_eigen.h>

enum { MOST = 64 }; /* masses of a mesh here */

/* Meshes at random: some masses equal, some not; some tied at one place. */
static const mesh meshes[] = {
    {.masses = 12, .springs = 40, .seed = 1},
    {.masses = 12, .springs = 40, .anchors = 5, .seed = 2},
    {.masses = 12, .springs = 40, .anchors = 5, .equal = true, .seed = 3},
    {.masses = 3, .springs = 1, .seed = 4},
    {.masses = 12, .springs = 40, .anchors = 5, .coincident = true, .seed = 5},
    {.masses = 30, .springs = 0, .coincident = true, .equal = true, .seed = 6},
};

static double mass_of(const msr_view *s, size_t i) { return msr_view_mass(s, i % s->n); }

/* Calls check for every force of the library on every mesh. */
static void on_all_meshes(void (*check)(const actor *force, const mesh *m, const msr_view *s)) {
  for (size_t n = 0; n < LENGTH(meshes); n++) {
    world w = open_world(random_mesh(&meshes[n], NULL), NULL, 0);
    const msr_view s = msr_state_view(w.state);
    for (const msr_force *const *f = msr_forces; *f; f++) {
      actor a = prepare(*f, trial_params(*f), &s);
      check(&a, &meshes[n], &s);
      dismiss(&a);
    }
    close_world(w);
  }
}

/* ---- What a force declares */

/* Central differences of the energy, d = 1e-4 px: off by d^2 U'''/6, 1e-7 of the force or less for
 * springs no shorter than 0.1 px, and by eps U / d, less still. */
static void check_gradient(const actor *a, const mesh *m, const msr_view *s) {
  assert_int_equal(a->force->conservative, a->force->energy != NULL);
  if (!a->force->conservative || m->coincident) return;
  const double d = 1e-4;
  double f[2 * MOST], q[2 * MOST];
  act(a, s, f);
  memcpy(q, s->x, 2 * s->n * sizeof *q);
  msr_view moved = *s;
  moved.x = q, moved.y = q + s->n;
  for (size_t i = 0; i < 2 * s->n; i++) {
    const double at = q[i];
    q[i] = at + d;
    const double right = a->force->energy(a->self, &moved);
    q[i] = at - d;
    const double left = a->force->energy(a->self, &moved);
    q[i] = at;
    const double error = fabs(f[i] + (right - left) / (2 * d));
    if (!(error <= 1e-6 * (1 + largest(2 * s->n, f))))
      fail_msg("%s: F = %g, off by %g", a->force->name, f[i], error);
  }
}

static void force_is_minus_the_gradient_of_energy(void **state) {
  (void)state;
  on_all_meshes(check_gradient);
}

static void check_dissipation(const actor *a, const mesh *m, const msr_view *s) {
  (void)m;
  if (!a->force->dissipative) return;
  double f[2 * MOST];
  act(a, s, f);
  const double power = dot(2 * s->n, f, s->vx), n = (double)s->n;
  if (!(power <= 4 * n * DBL_EPSILON * largest(2 * s->n, f) * largest(2 * s->n, s->vx)))
    fail_msg("%s gives %g", a->force->name, power);
}

static void dissipative_forces_only_take(void **state) {
  (void)state;
  on_all_meshes(check_dissipation);
}

/* Does the force differ at another velocity, or another time? On bits. */
static void check_arguments(const actor *a, const mesh *m, const msr_view *s) {
  if (m->coincident) return;
  double here[2 * MOST], there[2 * MOST], v[2 * MOST];
  const size_t bytes = 2 * s->n * sizeof *v;
  for (size_t i = 0; i < 2 * s->n; i++) v[i] = 1 - s->vx[i];
  msr_view faster = *s, later = *s;
  faster.vx = v, faster.vy = v + s->n;
  later.t = 0.7;
  act(a, s, here);
  act(a, &faster, there);
  assert_int_equal(memcmp(here, there, bytes) != 0, a->force->uses_velocity);
  act(a, &later, there);
  assert_int_equal(memcmp(here, there, bytes) != 0, a->force->uses_time);
  if (a->force->uses_velocity) return;
  faster.vx = faster.vy = NULL;
  act(a, &faster, there);
  assert_memory_equal(here, there, bytes);
}

static void forces_depend_on_what_they_declare(void **state) {
  (void)state;
  on_all_meshes(check_arguments);
}

/* Largest eigenvalue of -M^-1/2 dF/dz M^-1/2, z being the positions (with v = 0: what damping does
 * when it turns isn't stiffness) or the velocities. F is linear in v, and in x a step of 1e-6 px
 * leaves an error of 1e-6 of the largest stiffness or less. */
static double stiffest(const actor *a, const msr_view *s, bool of_velocity) {
  const size_t n = 2 * s->n;
  double z[2 * MOST], right[2 * MOST], left[2 * MOST];
  const double rest[2 * MOST] = {0};
  msr_view moved = *s;
  moved.vx = moved.vy = rest;
  memcpy(z, of_velocity ? s->vx : s->x, n * sizeof *z);
  *(of_velocity ? &moved.vx : &moved.x) = z;
  *(of_velocity ? &moved.vy : &moved.y) = z + s->n;
  gsl_matrix *matrix = gsl_matrix_calloc(n, n);
  gsl_vector *values = gsl_vector_alloc(n);
  gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(n);
  for (size_t j = 0; j < n; j++) {
    const double at = z[j], d = 1e-6;
    z[j] = at + d, act(a, &moved, right);
    z[j] = at - d, act(a, &moved, left);
    z[j] = at;
    for (size_t i = 0; i < n; i++)
      gsl_matrix_set(matrix, i, j,
                     (left[i] - right[i]) / (2 * d) / sqrt(mass_of(s, i) * mass_of(s, j)));
  }
  gsl_eigen_symm(matrix, values, work);
  const double most = gsl_vector_max(values);
  gsl_eigen_symm_free(work);
  gsl_vector_free(values);
  gsl_matrix_free(matrix);
  return most;
}

/* A force without rates() says that both are 0. */
static void check_rates(const actor *a, const mesh *m, const msr_view *s) {
  if (m->coincident) return;
  double omega2 = 0, gamma = 0;
  if (a->force->rates) must(a->force->rates(a->self, s, &omega2, &gamma));
  const double of_x = stiffest(a, s, false), of_v = stiffest(a, s, true);
  if (!(of_x <= omega2 * (1 + 1e-5) + 1e-5 && of_v <= gamma * (1 + 1e-5) + 1e-5))
    fail_msg("%s: %g above %g, or %g above %g", a->force->name, of_x, omega2, of_v, gamma);
}

static void rates_are_upper_bounds(void **state) {
  (void)state;
  on_all_meshes(check_rates);
}

/* What planning asks of a force, in words and numbers, and what it does then. */
typedef struct answers {
  bool idle;
  char text[2][MSR_MESSAGE_SIZE];
  double rates[2], f[2 * MOST];
} answers;

static answers ask(const msr_force *force, const msr_view *start, const msr_view *s) {
  answers all = {0};
  const void *params = trial_params(force);
  actor a = prepare(force, params, start);
  if (force->idle) all.idle = force->idle(params, start, all.text[0], sizeof all.text[0]);
  if (force->describe) force->describe(params, start, all.text[1], sizeof all.text[1]);
  if (force->rates) must(force->rates(a.self, start, &all.rates[0], &all.rates[1]));
  act(&a, s, all.f);
  dismiss(&a);
  return all;
}

/* What says that it ignores the start says the same without one. */
static void check_ignorance(const actor *a, const mesh *m, const msr_view *s) {
  (void)m;
  msr_view nowhere = *s;
  nowhere.x = nowhere.y = nowhere.vx = nowhere.vy = NULL;
  if (!a->force->ignores_start) return;
  const answers here = ask(a->force, s, s), there = ask(a->force, &nowhere, s);
  assert_memory_equal(&here, &there, sizeof here);
}

static void what_ignores_the_start_needs_none(void **state) {
  (void)state;
  on_all_meshes(check_ignorance);
}

/* ---- Flows */

/* v by h under the force alone, by steps of the midpoint rule. */
static void follow_add(const actor *a, const msr_view *s, double h, size_t steps, double *v) {
  double f[2 * MOST], middle[2 * MOST];
  const size_t n = 2 * s->n;
  const double step = h / (double)steps;
  msr_view at = *s;
  for (size_t k = 0; k < steps; k++) {
    at.vx = v, at.vy = v + s->n;
    act(a, &at, f);
    for (size_t i = 0; i < n; i++) middle[i] = v[i] + step / 2 * f[i] / mass_of(s, i);
    at.vx = middle, at.vy = middle + s->n;
    act(a, &at, f);
    for (size_t i = 0; i < n; i++) v[i] += step * f[i] / mass_of(s, i);
  }
}

/* The error of 4000 steps, (gamma h / 4000)^2, is estimated from 2000 and taken away (Richardson).
 */
static void fine_flow(const actor *a, const msr_view *s, double h, double *v) {
  double coarse[2 * MOST];
  memcpy(coarse, v, 2 * s->n * sizeof *v);
  follow_add(a, s, h, 2000, coarse);
  follow_add(a, s, h, 4000, v);
  for (size_t i = 0; i < 2 * s->n; i++) v[i] += (v[i] - coarse[i]) / 3;
}

/* Error after h by `steps` pairs of a forward and a backward half step, as integrators take them.
 */
static double flow_error(const actor *a, const msr_view *s, double h, size_t steps,
                         const double *exact) {
  double v[2 * MOST];
  memcpy(v, s->vx, 2 * s->n * sizeof *v);
  for (size_t k = 0; k < 2 * steps; k++)
    must(a->force->flow(a->self, a->scratch, s, h / (double)(2 * steps), k % 2, v, v + s->n));
  return distance(2 * s->n, v, exact);
}

static void check_flow(const actor *a, const mesh *m, const msr_view *s) {
  if (!a->force->flow) return;
  const double h = 0.1, exact = 1e-10; /* what is left of the fine flow's error */
  double v[2 * MOST];
  memcpy(v, s->vx, 2 * s->n * sizeof *v);
  fine_flow(a, s, h, v);
  const double coarse = flow_error(a, s, h, 8, v), fine = flow_error(a, s, h, 16, v);
  const bool along_springs = a->force == &msr_force_damping && m->springs > 1;
  const double order = log2(coarse / fine);
  if (along_springs ? fabs(order - 2) > 0.1 : coarse > exact)
    fail_msg("%s, %zu springs: errors %g, %g", a->force->name, m->springs, coarse, fine);
}

static void flows_follow_their_forces(void **state) {
  (void)state;
  on_all_meshes(check_flow);
}

/* The backward flow of -h undoes the forward one of h. Rounding grows by exp(gamma h) at most,
 * here exp(8), in as many operations as there are springs. */
static void check_undoing(const actor *a, const mesh *m, const msr_view *s) {
  if (!a->force->flow) return;
  double v[2 * MOST];
  for (int backward = 0; backward < 2; backward++) {
    memcpy(v, s->vx, 2 * s->n * sizeof *v);
    must(a->force->flow(a->self, a->scratch, s, 0.02, backward, v, v + s->n));
    assert_true(distance(2 * s->n, v, s->vx) > 1e-3 || m->springs == 0);
    must(a->force->flow(a->self, a->scratch, s, -0.02, !backward, v, v + s->n));
    assert_true(distance(2 * s->n, v, s->vx) < 60 * exp(8) * DBL_EPSILON);
  }
}

static void backward_flows_undo_forward_ones(void **state) {
  (void)state;
  on_all_meshes(check_undoing);
}

/* ---- Forces along springs */

/* Sum of the sizes that forces along the springs may have. */
static double sum_of_sizes(const msr_view *s, double z) {
  double sum = 0;
  for (size_t r = 0; r < s->springs->n_runs; r++) {
    const msr_run_of_springs *run = &s->springs->run[r];
    for (size_t n = 0; n < run->count; n++) {
      const size_t i = run->first + n, j = i + run->offset;
      const double l = hypot(s->x[j] - s->x[i], s->y[j] - s->y[i]);
      sum += run->k[n * run->stride] * (l + run->L[n * run->stride]);
      sum += z * hypot(s->vx[j] - s->vx[i], s->vy[j] - s->vy[i]);
    }
  }
  return sum;
}

/* Each spring pulls both ends by the same bits: what is left is the rounding of sums of
 * `terms` numbers. */
static void check_cancelling(const actor *a, const mesh *m, const msr_view *s) {
  const bool internal = a->force == &msr_force_springs || a->force == &msr_force_damping;
  if (!internal || m->anchors > 0 || m->coincident) return;
  double f[2 * MOST], fx = 0, fy = 0, torque = 0;
  act(a, s, f);
  for (size_t i = 0; i < s->n; i++) {
    fx += f[i];
    fy += f[i + s->n];
    torque += s->x[i] * f[i + s->n] - s->y[i] * f[i];
  }
  const double terms = (double)(s->n + m->springs);
  const double rounding = terms * DBL_EPSILON * sum_of_sizes(s, 2);
  assert_true(largest(2 * s->n, f) > 0);
  assert_true(fabs(fx) < rounding && fabs(fy) < rounding);
  assert_true(fabs(torque) < 20 * rounding); /* no mass is further than 20 px from (0, 0) */
}

static void internal_forces_and_torques_cancel(void **state) {
  (void)state;
  on_all_meshes(check_cancelling);
}

static void springs_without_length_do_not_pull(void **state) {
  (void)state;
  world w =
      open_world(random_mesh(&(mesh){.masses = 2, .coincident = true, .seed = 9}, NULL), NULL, 0);
  const msr_view s = msr_state_view(w.state);
  const double none[4] = {0};
  double f[4];
  actor damping = prepare(&msr_force_damping, trial_params(&msr_force_damping), &s);
  must(msr_state_forces(w.state, f, f + 2, &why));
  assert_int_equal(msr_plan_describe(w.plan).springs + msr_plan_describe(w.plan).anchors, 3);
  assert_true(distance(4, f, none) <= 0);
  act(&damping, &s, f);
  assert_true(distance(4, f, none) <= 0);
  dismiss(&damping);
  close_world(w);
}

/* ---- Effects that are off */

static const mesh three = {.masses = 3, .springs = 3, .seed = 8};
static const mesh loose = {.masses = 3, .seed = 8};
static const mesh slack = {.masses = 3, .springs = 3, .slack = true, .seed = 8};

static const struct idler {
  const msr_force *force;
  const void *params;
  const mesh *on;
} idlers[] = {
    {&msr_force_springs, NULL, &loose},
    {&msr_force_springs, NULL, &slack},
    {&msr_force_gravity, &(msr_gravity){0}, &three},
    {&msr_force_drag, &(msr_drag){0}, &three},
    {&msr_force_damping, &(msr_damping){0}, &three},
    {&msr_force_damping, &(msr_damping){1}, &loose},
    {&msr_force_push, &(msr_push){0, 0, 0}, &three},
};

static void check_off(const world *w, const msr_force *force) {
  size_t n, found = 0;
  const msr_effect *effect = msr_plan_effects(w->plan, &n);
  for (size_t e = 0; e < n; e++) {
    if (effect[e].force != force) continue;
    found++;
    assert_false(effect[e].on);
    assert_true(strlen(effect[e].reason) > 0);
    assert_int_equal(msr_state_calls(w->state, e), 0);
  }
  assert_int_equal(found, 1);
}

/* Nor do they change a bit of what the rest does. */
static void idle_effects_leave_no_trace(void **state) {
  (void)state;
  for (size_t i = 0; i < LENGTH(idlers); i++) {
    msr_scene *scene = random_mesh(idlers[i].on, NULL);
    if (idlers[i].force != &msr_force_springs) add_force(scene, idlers[i].force, idlers[i].params);
    world with = open_world(scene, NULL, 0);
    world without = open_world(random_mesh(idlers[i].on, NULL), NULL, 0);
    advance(&with, 5);
    advance(&without, 5);
    check_off(&with, idlers[i].force);
    assert_true(msr_state_hash(with.state) == msr_state_hash(without.state));
    close_world(with);
    close_world(without);
  }
}

/* Nothing acts on no mass; a push on a mass that isn't there is refused. */
static void nothing_is_on_without_a_mass(void **state) {
  (void)state;
  for (const msr_force *const *f = msr_forces; *f; f++) {
    msr_plan *plan;
    size_t n;
    msr_scene *scene = empty_scene(0.01);
    if (*f != &msr_force_springs) add_force(scene, *f, trial_params(*f));
    const msr_status status = msr_plan_create(scene, NULL, &plan, &why);
    assert_int_equal(status, *f == &msr_force_push ? MSR_EUSAGE : MSR_OK);
    msr_scene_free(scene);
    if (status != MSR_OK) continue;
    const msr_effect *effect = msr_plan_effects(plan, &n);
    for (size_t e = 0; e < n; e++) assert_false(effect[e].on);
    msr_plan_free(plan);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(force_is_minus_the_gradient_of_energy),
      cmocka_unit_test(dissipative_forces_only_take),
      cmocka_unit_test(forces_depend_on_what_they_declare),
      cmocka_unit_test(rates_are_upper_bounds),
      cmocka_unit_test(what_ignores_the_start_needs_none),
      cmocka_unit_test(flows_follow_their_forces),
      cmocka_unit_test(backward_flows_undo_forward_ones),
      cmocka_unit_test(internal_forces_and_torques_cancel),
      cmocka_unit_test(springs_without_length_do_not_pull),
      cmocka_unit_test(idle_effects_leave_no_trace),
      cmocka_unit_test(nothing_is_on_without_a_mass),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
