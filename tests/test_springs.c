/* test_springs.c - the kernels of the spring force: whatever the width of its vectors, a machine
 * gives the same bits. Those that this machine hasn't got are left out. */
#include "forces/springs.h"

#include "scenes.h"

static void add_with(const msri_springs_kernel *kernel, const msr_view *s, double *f) {
  memset(f, 0, 2 * s->n * sizeof *f);
  const msri_bundle all = msri_bundle_of_all(s->springs);
  kernel->add(&all, s->x, s->y, f, f + s->n);
}

static const msri_springs_kernel *last_kernel(void) {
  const msri_springs_kernel *kernel = msri_springs_kernels;
  while (kernel->runs_here) kernel++;
  return kernel;
}

static void compare_kernels(msr_scene *scene, uint64_t seed) {
  world w = open_world(scene, NULL, 0);
  const msr_view s = msr_state_view(w.state);
  const msr_arrays at = msr_state_edit(w.state);
  double *expected = zeroed(2 * s.n, sizeof *expected), *f = zeroed(2 * s.n, sizeof *f);
  for (size_t i = 0; i < s.n; i++) {
    at.x[i] += uniform(&seed, -0.3, 0.3);
    at.y[i] += uniform(&seed, -0.3, 0.3);
  }
  const msri_springs_kernel *last = last_kernel();
  add_with(last, &s, expected);
  for (const msri_springs_kernel *k = msri_springs_kernels; k != last; k++) {
    if (!k->runs_here()) continue;
    add_with(k, &s, f);
    if (memcmp(f, expected, 2 * s.n * sizeof *f) != 0)
      fail_msg("%s: other bits, %zu masses, %zu springs", k->name, s.n, s.springs->n);
  }
  free(expected);
  free(f);
  close_world(w);
}

/* Runs of every length up to two of the widest vectors and over, and of more than a block. */
static void kernels_agree_on_lattices(void **state) {
  (void)state;
  const msr_conf conf = {.dt = 0.01, .mass = 0.1, .stiffness = 1500, .images = 1};
  for (size_t width = 1; width < 40; width++) compare_kernels(lattice(width, 3, 8, &conf), width);
  for (size_t width = 255; width < 600; width += 43)
    compare_kernels(lattice(width, 2, 4, &conf), width);
}

static void kernels_agree_on_meshes(void **state) {
  (void)state;
  for (uint64_t seed = 1; seed < 20; seed++) {
    const mesh m = {.masses = 40, .springs = 300, .coincident = seed % 2, .seed = seed};
    compare_kernels(random_mesh(&m, NULL), seed);
  }
}

/* Where nothing moves apart, there is no direction: 0, not NaN, by every kernel. */
static void kernels_stand_springs_without_length(void **state) {
  (void)state;
  const msr_conf conf = {.dt = 0.01, .mass = 0.1, .stiffness = 1500, .images = 1};
  world w = open_world(lattice(20, 2, 4, &conf), NULL, 0);
  const msr_view s = msr_state_view(w.state);
  const msr_arrays at = msr_state_edit(w.state);
  memset(at.x, 0, s.n * sizeof *at.x);
  memset(at.y, 0, s.n * sizeof *at.y);
  double f[80], none[80] = {0};
  for (const msri_springs_kernel *k = msri_springs_kernels;; k++) {
    if (!k->runs_here || k->runs_here()) {
      add_with(k, &s, f);
      assert_true(distance(80, f, none) <= 0);
    }
    if (!k->runs_here) break;
  }
  close_world(w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(kernels_agree_on_lattices),
      cmocka_unit_test(kernels_agree_on_meshes),
      cmocka_unit_test(kernels_stand_springs_without_length),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
