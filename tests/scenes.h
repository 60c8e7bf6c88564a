/* scenes.h - what the tests of physics share: random numbers, meshes at random, and every force of
 * the library by itself with parameters to try it with. */
#ifndef TESTS_SCENES_H
#define TESTS_SCENES_H

#include "art.h"

/* ---- Memory, random numbers */

static inline void *zeroed(size_t count, size_t size) {
  void *block = calloc(count + 1, size);
  assert_non_null(block);
  return block;
}

/* SplitMix64 (Steele, Lea & Flood 2014). */
static inline uint64_t random_bits(uint64_t *dice) {
  uint64_t z = *dice += 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31);
}

static inline size_t random_below(uint64_t *dice, size_t n) {
  return (size_t)(random_bits(dice) % n);
}

static inline double uniform(uint64_t *dice, double from, double to) {
  return from + (to - from) * 0x1p-53 * (double)(random_bits(dice) >> 11);
}

/* ---- Small vectors */

static inline double largest(size_t n, const double *a) {
  double most = 0;
  for (size_t i = 0; i < n; i++) most = fmax(most, fabs(a[i]));
  return most;
}

/* Largest |a[i] - b[i]|; infinite if one isn't a number. */
static inline double distance(size_t n, const double *a, const double *b) {
  double most = 0;
  for (size_t i = 0; i < n; i++) {
    const double d = fabs(a[i] - b[i]);
    if (!(d <= most)) most = isnan(d) ? INFINITE : d;
  }
  return most;
}

static inline double dot(size_t n, const double *a, const double *b) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

/* ---- All that moves */

/* z = x, y, vx, vy [4n]. */
static inline void read_world(const world *w, double *z) {
  const msr_view s = msr_state_view(w->state);
  const double *from[] = {s.x, s.y, s.vx, s.vy};
  for (size_t a = 0; a < 4; a++) memcpy(z + a * s.n, from[a], s.n * sizeof *z);
}

static inline void write_world(const world *w, const double *z) {
  const size_t n = msr_plan_describe(w->plan).masses;
  const msr_arrays s = msr_state_edit(w->state);
  double *to[] = {s.x, s.y, s.vx, s.vy};
  for (size_t a = 0; a < 4; a++) memcpy(to[a], z + a * n, n * sizeof *z);
}

/* ---- Interrupts */

/* Which call of poll ends the run; 0: none. */
typedef struct interruption {
  uint64_t calls, at;
} interruption;

static inline msr_status interrupt(void *data, const msr_state *state) {
  interruption *s = data;
  (void)state;
  return ++s->calls == s->at ? MSR_EINTR : MSR_OK;
}

/* ---- Scenes */

/* A full rectangle of masses in free space. */
static inline msr_scene *lattice(size_t width, size_t height, int neighbours,
                                 const msr_conf *conf) {
  msr_picture *picture;
  must(msr_picture_create(width, height, &picture, &why));
  for (size_t p = 0; p < width * height; p++) memcpy(picture->rgb + 3 * p, rgb_of('o'), 3);
  return scene_from(picture, conf, &(msr_scene_options){.neighbours = neighbours});
}

/* A spring, as a test remembers it. */
typedef struct tie {
  size_t i, j;
  double k, L;
} tie;

/* A mesh at random in a square of 10 px: springs may be double or have no length. */
typedef struct mesh {
  size_t masses, springs, anchors;
  bool equal;      /* all masses are 0.7 kg; else 0.1 .. 2 kg */
  bool slack;      /* k = 0: there are springs, but they don't pull */
  bool coincident; /* masses 0 and 1 are at one place, tied; so is mass 0, to a fixed point */
  uint64_t seed;
} mesh;

static inline tie random_tie(const mesh *m, uint64_t *dice) {
  const size_t i = random_below(dice, m->masses);
  const size_t j = (i + 1 + random_below(dice, m->masses - 1)) % m->masses;
  const double k = m->slack ? 0 : uniform(dice, 10, 100);
  return (tie){i, j, k, random_below(dice, 8) ? uniform(dice, 1, 5) : 0};
}

static inline void tie_coincident(msr_scene *scene, double x, double y) {
  must(msr_scene_add_spring(scene, 0, 1, 50, 1, &why));
  must(msr_scene_add_spring(scene, 1, 0, 50, 0, &why));
  must(msr_scene_add_anchor(scene, &(msr_anchor){0, x, y, 50, 1}, &why));
}

/* The springs go to ties [m->springs], which may be NULL. */
static inline msr_scene *random_mesh(const mesh *m, tie *ties) {
  uint64_t dice = m->seed;
  double x = 0, y = 0;
  msr_scene *scene = empty_scene(0.01);
  for (size_t i = 0; i < m->masses; i++) {
    if (i != 1 || !m->coincident) x = uniform(&dice, 0, 10), y = uniform(&dice, 0, 10);
    const double vx = uniform(&dice, -3, 3), vy = uniform(&dice, -3, 3);
    add_mass(scene, x, y, vx, vy, m->equal ? 0.7 : uniform(&dice, 0.1, 2));
    if (i == 1 && m->coincident) tie_coincident(scene, x, y);
  }
  for (size_t s = 0; s < m->springs; s++) {
    const tie t = random_tie(m, &dice);
    must(msr_scene_add_spring(scene, t.i, t.j, t.k, t.L, &why));
    if (ties) ties[s] = t;
  }
  for (size_t a = 0; a < m->anchors; a++) {
    const tie t = random_tie(m, &dice);
    const double ax = uniform(&dice, 0, 10), ay = uniform(&dice, 0, 10);
    must(msr_scene_add_anchor(scene, &(msr_anchor){t.i, ax, ay, t.k, t.L}, &why));
  }
  return scene;
}

/* ---- The forces of the library, each by itself */

/* Parameters that make a force do something; NULL: it takes none. */
static inline const void *trial_params(const msr_force *force) {
  static const msr_gravity gravity = {9.8};
  static const msr_drag drag = {0.3};
  static const msr_damping damping = {2};
  static const msr_wind wind = {.c = 0.4, .speed = 3, .gust = 2, .gust_time = 0.5, .seed = 7};
  static const msr_push push = {.mass = 2, .fx = 3, .fy = -4};
  const struct {
    const msr_force *force;
    const void *params;
  } trials[] = {{&msr_force_gravity, &gravity},
                {&msr_force_drag, &drag},
                {&msr_force_damping, &damping},
                {&msr_force_wind, &wind},
                {&msr_force_push, &push}};
  for (size_t i = 0; i < LENGTH(trials); i++)
    if (trials[i].force == force) return trials[i].params;
  if (force->params_size > 0) fail_msg("scenes.h needs parameters to try %s with", force->name);
  return NULL;
}

/* A force prepared for a system. */
typedef struct actor {
  const msr_force *force;
  void *made, *scratch;
  const void *self;
} actor;

static inline actor prepare(const msr_force *force, const void *params, const msr_view *start) {
  actor a = {.force = force, .self = params, .scratch = zeroed(1, force->scratch_size)};
  if (force->prepare) {
    must(force->prepare(params, start, &a.made, &why));
    a.self = a.made;
  }
  return a;
}

static inline void dismiss(actor *a) {
  if (a->force->release) a->force->release(a->made);
  free(a->scratch);
}

/* f = fx[n], fy[n]: this force alone. */
static inline void act(const actor *a, const msr_view *s, double *f) {
  memset(f, 0, 2 * s->n * sizeof *f);
  must(a->force->add(a->self, a->scratch, s, f, f + s->n));
}

#endif
