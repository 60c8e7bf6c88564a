/* lattice.c - the kernels of lattice.h, compiled for several widths: the machine that they run on
 * decides between them. */
#include "forces/lattice.h"

#include "base/machine.h"

/* A vector's cells: from `part` on of a block. */
typedef struct place {
  size_t cell;
  unsigned part;
  const msri_block *block;
} place;

/* What is done to each cell; known when a kernel is compiled, so that none asks. */
typedef struct msri_task {
  int ways; /* of springs, from MSRI_RIGHT on */
  int besides;
  bool watches;
} msri_task;

/* Springs to 4 neighbours, the first of those BELOW, or to 8, those BESIDE it, too. */
enum { BELOW = MSRI_BELOW + 1, BESIDE = MSRI_WAYS };

#if MSRI_WIDE
#define LANES    2
#define NAMED(x) x##_2
#include "forces/lattice_kernel.inc"

#define LANES    4
#define NAMED(x) x##_4
#include "forces/lattice_kernel.inc"

#define LANES    8
#define NAMED(x) x##_8
#include "forces/lattice_kernel.inc"
#else
#define LANES    1
#define NAMED(x) x##_1
#include "forces/lattice_kernel.inc"
#endif

/* ---- By width */

/* The kernels of one width, for some number of ways. */
#define ADVANCE(target, width, number, with)                                                       \
  target static void advance_##width##_##number##_##with(const msri_cells *s,                      \
                                                         const msri_motion *motion) {              \
    go_##width(s, motion, &(msri_task){.ways = number, .besides = with}, NULL);                    \
  }
#define WATCH(target, width, number, with)                                                         \
  target static void watch_##width##_##number##_##with(                                            \
      const msri_cells *s, const msri_motion *motion, msri_lookout *watch) {                       \
    const msri_task task = {.ways = number, .besides = with, .watches = true};                     \
    go_watched_##width(s, motion, &task, watch);                                                   \
  }
#define BOTH(target, width, number, with)                                                          \
  ADVANCE(target, width, number, with)                                                             \
  WATCH(target, width, number, with)
#define KERNELS(target, width, number)                                                             \
  BOTH(target, width, number, 0)                                                                   \
  BOTH(target, width, number, 1)                                                                   \
  BOTH(target, width, number, 2)                                                                   \
  BOTH(target, width, number, 3)                                                                   \
  BOTH(target, width, number, 6)                                                                   \
  BOTH(target, width, number, 7)                                                                   \
  target static void pull_##width##_##number(const msri_cells *s, const msri_motion *motion) {     \
    look_below_##width(s, motion, number);                                                         \
  }
/* By what acts beside the springs: nothing pushes but air. */
#define ALL(kernel)                                                                                \
  { kernel##_0, kernel##_1, kernel##_2, kernel##_3, kernel##_0, kernel##_1, kernel##_6, kernel##_7 }
#define ROW(width, number)                                                                         \
  { ALL(advance_##width##_##number), ALL(watch_##width##_##number), pull_##width##_##number, }

#define WIDTH(target, width)                                                                       \
  KERNELS(target, width, BELOW)                                                                    \
  KERNELS(target, width, BESIDE)                                                                   \
  target static double fastest_##width(const msri_cells *s) { return look_at_speeds_##width(s); }
#define ROWS(width) ROW(width, BELOW), ROW(width, BESIDE), fastest_##width

#if MSRI_WIDE
WIDTH(MSRI_AVX512, 8)
WIDTH(MSRI_AVX2, 4)
WIDTH(, 2)
#else
WIDTH(, 1)
#endif

const msri_lattice_kernel msri_lattice_kernels[] = {
#if MSRI_WIDE
    {"AVX-512", msri_has_avx512, ROWS(8)},
    {"AVX2", msri_has_avx2, ROWS(4)},
    {"SSE2", NULL, ROWS(2)},
#else
    {"any", NULL, ROWS(1)},
#endif
};

const msri_lattice_kernel *msri_lattice_widest(void) {
  const msri_lattice_kernel *kernel = msri_lattice_kernels;
  while (kernel->runs_here && !kernel->runs_here()) kernel++;
  return kernel;
}
