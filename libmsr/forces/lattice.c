/* lattice.c - the kernels of lattice.h, compiled for several widths: the machine that they run on
 * decides between them. What is left of a row by wide vectors is done by narrower ones. */
#include "forces/lattice.h"

/* What is done to each cell; known when a kernel is compiled, so that none asks. */
typedef struct msri_task {
  int ways; /* of springs, from MSRI_RIGHT on */
  int besides;
  bool only_below;
  double *ax, *ay; /* [n]: accelerations go here, and cells do not drift; NULL: they do */
} msri_task;

/* Where a row is to be gone on with, and the force of the spring that ends there from the left. */
typedef struct msri_place {
  size_t cell;
  double left[2];
  double fastest; /* velocity along an axis so far; */
  bool odd;       /* one was no number */
} msri_place;

#define LANES    1
#define NAMED(x) x##_1
#include "forces/lattice_kernel.inc"

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
#endif

/* ---- By width */

#if MSRI_WIDE
MSRI_INLINE void go_narrow(const msri_cells *s, const msri_motion *motion, const msri_task *task,
                           msri_place *place) {
  go_2(s, motion, task, place);
  go_1(s, motion, task, place);
}

MSRI_INLINE MSRI_AVX2 void go_wide(const msri_cells *s, const msri_motion *motion,
                                   const msri_task *task, msri_place *place) {
  go_4(s, motion, task, place);
  go_narrow(s, motion, task, place);
}

MSRI_INLINE MSRI_AVX512 void go_wider(const msri_cells *s, const msri_motion *motion,
                                      const msri_task *task, msri_place *place) {
  go_8(s, motion, task, place);
  go_wide(s, motion, task, place);
}
#else
MSRI_INLINE void go_narrow(const msri_cells *s, const msri_motion *motion, const msri_task *task,
                           msri_place *place) {
  go_1(s, motion, task, place);
}
#endif

/* Springs to 4 neighbours, the first of those BELOW, or to 8, those BESIDE it, too. */
enum { BELOW = MSRI_BELOW + 1, BESIDE = MSRI_WAYS };

/* The kernels of one width, for some number of ways. */
#define ADVANCE(target, width, number, with)                                                       \
  target static double advance_##width##_##number##_##with(const msri_cells *s,                    \
                                                           const msri_motion *motion) {            \
    msri_place place = {0};                                                                        \
    width(s, motion, &(msri_task){.ways = number, .besides = with}, &place);                       \
    return place.odd ? (double)NAN : place.fastest;                                                \
  }
#define KICK(target, width, number, with)                                                          \
  target static double kick_##width##_##number##_##with(                                           \
      const msri_cells *s, const msri_motion *motion, double *ax, double *ay) {                    \
    msri_place place = {0};                                                                        \
    width(s, motion, &(msri_task){.ways = number, .besides = with, .ax = ax, .ay = ay}, &place);   \
    return place.odd ? (double)NAN : place.fastest;                                                \
  }
#define KERNELS(target, width, number)                                                             \
  ADVANCE(target, width, number, 0)                                                                \
  ADVANCE(target, width, number, 1)                                                                \
  ADVANCE(target, width, number, 2)                                                                \
  ADVANCE(target, width, number, 3)                                                                \
  ADVANCE(target, width, number, 6)                                                                \
  ADVANCE(target, width, number, 7)                                                                \
  KICK(target, width, number, 0)                                                                   \
  KICK(target, width, number, 1)                                                                   \
  KICK(target, width, number, 2)                                                                   \
  KICK(target, width, number, 3)                                                                   \
  KICK(target, width, number, 6)                                                                   \
  KICK(target, width, number, 7)                                                                   \
  target static void pull_##width##_##number(const msri_cells *s, const msri_motion *motion) {     \
    width(s, motion, &(msri_task){.ways = number, .only_below = true}, &(msri_place){0});          \
  }
/* By what acts beside the springs: nothing pushes but air. */
#define ALL(kernel)                                                                                \
  { kernel##_0, kernel##_1, kernel##_2, kernel##_3, kernel##_0, kernel##_1, kernel##_6, kernel##_7 }
#define ROW(width, number)                                                                         \
  { ALL(advance_##width##_##number), ALL(kick_##width##_##number), pull_##width##_##number, }

KERNELS(, go_narrow, BELOW)
KERNELS(, go_narrow, BESIDE)
#if MSRI_WIDE
KERNELS(MSRI_AVX2, go_wide, BELOW)
KERNELS(MSRI_AVX2, go_wide, BESIDE)
KERNELS(MSRI_AVX512, go_wider, BELOW)
KERNELS(MSRI_AVX512, go_wider, BESIDE)
#endif

const msri_lattice_kernel msri_lattice_kernels[] = {
#if MSRI_WIDE
    {"AVX-512", msri_has_avx512, {ROW(go_wider, BELOW), ROW(go_wider, BESIDE)}},
    {"AVX2", msri_has_avx2, {ROW(go_wide, BELOW), ROW(go_wide, BESIDE)}},
#endif
    {"any", NULL, {ROW(go_narrow, BELOW), ROW(go_narrow, BESIDE)}},
};

const msri_lattice_kernel *msri_lattice_widest(void) {
  const msri_lattice_kernel *kernel = msri_lattice_kernels;
  while (kernel->runs_here && !kernel->runs_here()) kernel++;
  return kernel;
}
