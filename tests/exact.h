/* exact.h - scenes whose motion is known in closed form, for the tests of accuracy. */
#ifndef TESTS_EXACT_H
#define TESTS_EXACT_H

#include "scenes.h"

enum { EXACT_MOST = 8 }; /* masses */

typedef struct exact {
  const char *name;
  size_t masses;
  msr_scene *(*make)(void);
  void (*at)(double t, double *x, double *y); /* [masses] */
} exact;

static const double pi = 3.14159265358979323846;

/* ---- Two masses on a spring: the length is 1 + 0.3 cos(w t), w^2 = 2 k / m */

static inline msr_scene *make_pair(void) {
  msr_scene *scene = empty_scene(0.05);
  add_mass(scene, -0.65, 0, 0, 0, 0.5);
  add_mass(scene, 0.65, 0, 0, 0, 0.5);
  must(msr_scene_add_spring(scene, 0, 1, 9, 1, &why));
  must(msr_scene_set_times(scene, 0.05, 60, 60, &why));
  return scene;
}

static inline void pair_at(double t, double *x, double *y) {
  x[1] = 0.5 + 0.15 * cos(6 * t);
  x[0] = -x[1];
  y[0] = y[1] = 0;
}

/* ---- Two masses that spin about each other: m w^2 r = k (2 r - 1) */

static inline msr_scene *make_spin(void) {
  msr_scene *scene = empty_scene(0.05);
  const double w = sqrt(10 * 0.4 / 0.7); /* k 10, m 1, r 0.7 */
  add_mass(scene, -0.7, 0, 0, -0.7 * w, 1);
  add_mass(scene, 0.7, 0, 0, 0.7 * w, 1);
  must(msr_scene_add_spring(scene, 0, 1, 10, 1, &why));
  must(msr_scene_set_times(scene, 0.05, 60, 60, &why));
  return scene;
}

static inline void spin_at(double t, double *x, double *y) {
  const double w = sqrt(10 * 0.4 / 0.7);
  x[1] = 0.7 * cos(w * t), y[1] = 0.7 * sin(w * t);
  x[0] = -x[1], y[0] = -y[1];
}

/* ---- Two longitudinal modes of a straight chain of eight, w_j = 2 sqrt(k/m) sin(j pi / 16) */

static inline void chain_at(double t, double *x, double *y) {
  for (size_t i = 0; i < 8; i++) {
    const double place = ((double)i + 0.5) * pi / 8, s = 2 * sqrt(20 / 0.2);
    x[i] = (double)i + 0.2 * cos(s * sin(pi / 16) * t) * cos(place) +
           0.05 * cos(s * sin(3 * pi / 16) * t) * cos(3 * place);
    y[i] = 0;
  }
}

static inline msr_scene *make_chain(void) {
  msr_scene *scene = empty_scene(0.05);
  double x[8], y[8];
  chain_at(0, x, y);
  for (size_t i = 0; i < 8; i++) add_mass(scene, x[i], y[i], 0, 0, 0.2);
  for (size_t i = 1; i < 8; i++) must(msr_scene_add_spring(scene, i - 1, i, 20, 1, &why));
  must(msr_scene_set_times(scene, 0.05, 40, 40, &why));
  return scene;
}

/* ---- Free fall with drag: v' = -g - c v / m */

static inline msr_scene *make_fall(void) {
  msr_scene *scene = empty_scene(0.05);
  add_mass(scene, 3, 7, 2, 1, 0.5);
  add_force(scene, &msr_force_gravity, &(msr_gravity){9.8});
  add_force(scene, &msr_force_drag, &(msr_drag){0.6});
  must(msr_scene_set_times(scene, 0.05, 60, 60, &why));
  return scene;
}

static inline void fall_at(double t, double *x, double *y) {
  const double rate = 0.6 / 0.5, fallen = 9.8 / rate, gone = -expm1(-rate * t) / rate;
  x[0] = 3 + 2 * gone;
  y[0] = 7 + (1 + fallen) * gone - fallen * t;
}

/* ---- A mass that bounces on a floor at y = 1, with 0.8 of its speed each time */

static inline msr_scene *make_bounce(void) {
  msr_scene *scene = scene_of("......\n"
                              "......\n"
                              "......\n"
                              "######\n",
                              &(msr_conf){0.05, 9.8, 1, 0, 60, 60}, NULL);
  add_mass(scene, 1, 3.2, 1.5, 0, 0.5);
  must(msr_scene_set_contact(scene, 0.8, 0, &why));
  return scene;
}

static inline void bounce_at(double t, double *x, double *y) {
  double start = 0, height = 3.2, speed = 0;
  for (;;) {
    const double left = t - start,
                 lands = (speed + sqrt(speed * speed + 19.6 * (height - 1))) / 9.8;
    if (left <= lands) {
      x[0] = 1 + 1.5 * t;
      y[0] = height + left * (speed - 4.9 * left);
      return;
    }
    speed = 0.8 * (9.8 * lands - speed);
    start += lands;
    height = 1;
  }
}

static const exact exacts[] = {{"pair", 2, make_pair, pair_at},
                               {"spin", 2, make_spin, spin_at},
                               {"chain", 8, make_chain, chain_at},
                               {"fall", 1, make_fall, fall_at},
                               {"bounce", 1, make_bounce, bounce_at}};

/* ---- Errors of a run */

/* The largest distance of a mass from where it should be. */
static inline double error_now(const exact *e, const msr_state *state) {
  double x[EXACT_MOST], y[EXACT_MOST], most = 0;
  const msr_view s = msr_state_view(state);
  e->at(s.t, x, y);
  for (size_t i = 0; i < e->masses; i++) most = fmax(most, hypot(s.x[i] - x[i], s.y[i] - y[i]));
  return most;
}

/* The largest after any iteration up to `until`. */
static inline double exact_error(const exact *e, const msr_plan_options *options, double until) {
  msr_scene *scene = e->make();
  msr_plan *plan;
  msr_state *state;
  double most = 0;
  must(msr_plan_create(scene, options, &plan, &why));
  must(msr_state_create(plan, &state, &why));
  const msr_plan_figures f = msr_plan_describe(plan);
  for (uint64_t i = 0; i < f.iterations && (double)i * f.dt < until * (1 - 1e-9); i++) {
    must(msr_state_step(state, 1, &why));
    most = fmax(most, error_now(e, state));
  }
  msr_state_free(state);
  msr_plan_free(plan);
  msr_scene_free(scene);
  return most;
}

#endif
