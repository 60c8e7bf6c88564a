/* test_sweep_supports.c - steps row by row past supports: the same bits and collisions as by whole
 * vectors, for any shape, rule of impact, threads and cuts.
 * link: --wrap=msri_processors */
#include "sweep/sweep.h"

#include "processors.h"
#include "scenes.h"

typedef struct trial {
  size_t width, height;  /* of the object */
  int neighbours, holes; /* in 100 pixels */
  double restitution, friction, speed, wind;
  msr_impacts impacts;
  const msr_integrator *integrator;
  uint64_t seed;
  bool walls; /* beside the object, a pixel away */
} trial;

enum { AROUND = 8, STEPS = 150 };

/* An object over pegs and a floor. */
static msr_scene *scene_by(const trial *t) {
  const size_t width = t->width + 2 * AROUND, height = t->height + 2 * AROUND;
  const msr_conf conf = {
      .dt = 0.001, .gravity = 9.8, .mass = 0.1, .stiffness = 1500, .iterations = 600, .images = 1};
  uint64_t dice = t->seed;
  msr_picture *picture;
  must(msr_picture_create(width, height, &picture, &why));
  for (size_t r = 0; r < height; r++)
    for (size_t c = 0; c < width; c++) {
      unsigned char *rgb = picture->rgb + 3 * (r * width + c);
      const bool object =
          r >= AROUND && r < AROUND + t->height && c >= AROUND && c < AROUND + t->width;
      const bool peg = r > AROUND + t->height + 1 && c % 7 == 3;
      const bool wall = t->walls && (c + 2 == AROUND || c == AROUND + t->width + 1);
      if (peg || wall || r + 2 == height) memcpy(rgb, rgb_of('#'), 3);
      if (object && random_below(&dice, 100) >= (uint64_t)t->holes) memcpy(rgb, rgb_of('o'), 3);
    }
  msr_scene *scene = scene_from(picture, &conf, &(msr_scene_options){.neighbours = t->neighbours});
  must(msr_scene_set_contact(scene, t->restitution, t->friction, &why));
  if (t->wind > 0)
    add_force(scene, &msr_force_wind, &(msr_wind){.c = 0.01, .speed = t->wind, .gust = 2});
  return scene;
}

/* threads 0: by whole vectors. */
static world open_by(const trial *t, unsigned threads) {
  msr_scene *scene = scene_by(t);
  if (threads == 0) add_force(scene, &nothing, NULL);
  world w = open_world_with(scene, &(msr_plan_options){.integrator = t->integrator,
                                                       .substeps = 1,
                                                       .impacts = t->impacts,
                                                       .threads = threads});
  const msr_arrays a = msr_state_edit(w.state);
  for (size_t i = 0; i < msr_plan_describe(w.plan).masses; i++) {
    a.vx[i] = t->speed / 5;
    a.vy[i] = -t->speed;
  }
  assert_true(msri_plan_sweeps(w.plan) == (threads > 0));
  return w;
}

static void compare(const trial *t, const world *is, const world *due) {
  if (msr_state_hash(is->state) == msr_state_hash(due->state) &&
      msr_state_contacts(is->state) == msr_state_contacts(due->state))
    return;
  fail_msg("%zu x %zu, %d neighbours, holes %d, %s, impacts %d, e %g, at %g px/s, seed %llu: other "
           "bits",
           t->width, t->height, t->neighbours, t->holes, t->integrator->name, (int)t->impacts,
           t->restitution, t->speed, (unsigned long long)t->seed);
}

static void try(const trial *t, uint64_t piece, unsigned threads) {
  world is = open_by(t, threads), due = open_by(t, 0);
  for (uint64_t done = 0; done < STEPS; done += piece) advance(&is, piece);
  advance(&due, (STEPS + piece - 1) / piece * piece);
  assert_true(msr_state_contacts(due.state) > 0);
  compare(t, &is, &due);
  close_world(is);
  close_world(due);
}

static trial trial_of(uint64_t seed) {
  uint64_t dice = seed + 1;
  return (trial){.width = 3 + random_below(&dice, 40),
                 .height = 1 + random_below(&dice, 25),
                 .neighbours = seed % 3 ? 4 : 8,
                 .holes = seed % 4 ? 0 : 20,
                 .restitution = seed % 2 ? 1 : 0.5,
                 .friction = seed % 5 ? 0 : 0.3,
                 .speed = seed % 7 ? 60 : 400,
                 .wind = seed % 6 ? 0 : 3,
                 .impacts = seed % 3 == 1 ? MSR_IMPACTS_LOCATED : MSR_IMPACTS_KEPT,
                 .integrator =
                     seed % 8 == 7 ? &msr_integrator_symplectic_euler : &msr_integrator_verlet,
                 .seed = seed};
}

static void small_objects_bounce_as_by_whole_vectors(void **unused) {
  (void)unused;
  for (uint64_t seed = 0; seed < 40; seed++) {
    const trial t = trial_of(seed);
    try(&t, 1 + seed % 40, (unsigned)(1 + seed % 3));
  }
}

/* Too large for a patch: whole, and with holes. */
static void large_objects_bounce_as_by_whole_vectors(void **unused) {
  (void)unused;
  for (int holes = 0; holes <= 10; holes += 10) {
    trial t = trial_of(4);
    t.width = 150, t.height = 90, t.holes = holes;
    try(&t, STEPS, 1);
    t.impacts = MSR_IMPACTS_LOCATED, t.neighbours = 4;
    try(&t, 47, 2);
  }
}

/* All rows hit a wall at the same time, so that whatever one part leaves to another is owed
 * something. */
static void what_is_owed_goes_from_part_to_part(void **unused) {
  (void)unused;
  for (unsigned threads = 2; threads <= 3; threads++) {
    trial t = trial_of(4);
    t.width = 60, t.height = 210, t.walls = true, t.speed = 100;
    try(&t, STEPS, threads);
    t.impacts = MSR_IMPACTS_LOCATED, t.neighbours = 4, t.holes = 10;
    try(&t, 47, threads);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(small_objects_bounce_as_by_whole_vectors),
      cmocka_unit_test(large_objects_bounce_as_by_whole_vectors),
      cmocka_unit_test(what_is_owed_goes_from_part_to_part),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
