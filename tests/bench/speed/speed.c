/* speed.c DIRECTORY [TABLE ...] - prints how fast libmsr is, beside others and beside the machine's
 * own limit; the tables named, or all. DIRECTORY is for files that are passed to other programs. */
#include "speed.h"

#include "../machine.h"

#include "msr.h"

#include <stdlib.h>
#include <string.h>

const char *scratch, *myself;

static void print_machine(void) {
  bench_print_machine();
  printf(".\nThe limit's vectors: %s. LAMMPS %s, %s.\n", limit_vectors(), lammps_version(),
         numba_version());
  printf("Double precision, k %g, m %g, dt %g, waves of 0.01 px, Verlet; medians of %d rounds and "
         "(quartiles).\n",
         stiffness, mass, step, ROUNDS);
}

/* ---- Tables of contests */

static void contest_and_free(work w) {
  contest(&w);
  work_free(&w);
}

static void blocks(void) {
  contest_and_free(work_drawn("block 32 x 32", 32, draw_block));
  contest_and_free(work_drawn("block 316 x 316", 316, draw_block));
  contest_and_free(work_drawn("block 1000 x 1000", 1000, draw_block));
}

static void pictures(void) {
  printf("\nThe limit beside a picture in which springs are missing is that of the block around "
         "it.\n");
  contest_and_free(work_drawn("holes in 316 x 316", 316, draw_holes));
  contest_and_free(work_drawn("holes in 1000 x 1000", 1000, draw_holes));
  contest_and_free(work_drawn("branches in 1000 x 1000", 1000, draw_branches));
  contest_and_free(work_drawn("objects in 1000 x 1000", 1000, draw_objects));
}

static void meshes(void) {
  contest_and_free(work_lattice("mesh, lattice 32 x 32", 32));
  contest_and_free(work_lattice("mesh, lattice 316 x 316", 316));
  contest_and_free(work_lattice("mesh, lattice 1000 x 1000", 1000));
  contest_and_free(work_disc("mesh, disc of triangles, 560 px", 560));
}

static const struct {
  const char *name;
  void (*print)(void);
} tables[] = {{"blocks", blocks},          {"pictures", pictures},   {"meshes", meshes},
              {"growth", growth_table},    {"frames", frames_table}, {"implicit", implicit_table},
              {"start-up", startup_table}, {"triad", triad_table}};

static bool is_asked(char **names, const char *name) {
  if (!*names) return true;
  while (*names && strcmp(*names, name) != 0) names++;
  return *names;
}

int main(int argc, char **argv) {
  if (argc < 2) bench_fail("give a directory for files");
  myself = argv[0];
  scratch = argv[1];
  if (argc == 3 && strcmp(argv[2], "start-up-once") == 0) return startup_once();

  const double begin = seconds_now();
  print_machine();
  for (size_t i = 0; i < sizeof tables / sizeof *tables; i++)
    if (is_asked(argv + 2, tables[i].name)) {
      tables[i].print();
      fflush(stdout);
    }
  bars_print();
  printf("\nMeasured in %.0f s.\n", seconds_now() - begin);
  return EXIT_SUCCESS;
}
