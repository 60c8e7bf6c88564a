/* lammps.c - LAMMPS (Thompson et al. 2022, Comput. Phys. Commun. 271, 108171): bond_style harmonic,
 * E = K (r - r0)^2 with K = k/2, and fix nve, which is velocity Verlet; no pairs, no sorting of
 * atoms (their order is a good one), neighbour lists made once; one MPI rank or two. */
#include "child.h"
#include "speed.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char start[] = "echo pid $$; exec stdbuf -oL lmp -log none";

typedef struct lammps_run {
  child c;
  size_t n;
  char path[256];
} lammps_run;

static bool start_ranks(child *c, int ranks) {
  const char *const alone[] = {"sh", "-c", start, NULL};
  const char *const two[] = {"mpirun", "-np", "2", "sh", "-c", start, NULL};
  setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
  setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  return child_open(c, ranks == 2 ? two : alone) && child_ask(c, "ready", "print ready\n");
}

static void write_data(const work *w, const char *path) {
  FILE *f = fopen(path, "w");
  if (!f) bench_fail("%s can't be written", path);
  fprintf(f, "block\n\n%zu atoms\n%zu bonds\n1 atom types\n1 bond types\n", w->n, w->n_springs);
  fprintf(f, "-2 %zu xlo xhi\n-2 %zu ylo yhi\n-0.5 0.5 zlo zhi\n", w->width + 2, w->height + 2);
  fprintf(f, "\nMasses\n\n1 %.17g\n\nAtoms\n\n", mass);
  for (size_t i = 0; i < w->n; i++) fprintf(f, "%zu 1 1 %.17g %.17g 0\n", i + 1, w->x[i], w->y[i]);
  fprintf(f, "\nBonds\n\n");
  for (size_t s = 0; s < w->n_springs; s++)
    fprintf(f, "%zu 1 %u %u\n", s + 1, w->i[s] + 1, w->j[s] + 1);
  if (fclose(f) != 0) bench_fail("%s can't be written", path);
}

static bool set_up(lammps_run *r) {
  return child_ask(
      &r->c, "Loop time",
      "units lj\ndimension 2\nboundary f f p\natom_style bond\n"
      "atom_modify map array sort 0 0\nspecial_bonds lj/coul 1 1 1\npair_style none\n"
      "bond_style harmonic\ncomm_modify cutoff 2\nneighbor 0.3 bin\n"
      "neigh_modify delay 1000000000 check no\nread_data %s\nbond_coeff 1 %.17g %.17g\n"
      "fix 1 all nve\ntimestep %.17g\nthermo 1000000000\nrun 0\n",
      r->path, stiffness / 2, rest, step);
}

static entry open_lammps(const contestant *c, const work *w, int threads) {
  (void)c;
  lammps_run *r = need(1, sizeof *r);
  r->n = w->n;
  snprintf(r->path, sizeof r->path, "%s/lammps.data", scratch);
  if (!start_ranks(&r->c, threads)) {
    child_close(&r->c);
    free(r);
    return (entry){.missing = threads == 1 ? "there is no LAMMPS (lmp)" : "there is no mpirun"};
  }
  const double before = child_resident(&r->c);
  write_data(w, r->path);
  if (!set_up(r)) bench_fail("LAMMPS refuses its input: %s", r->c.line);
  unlink(r->path);
  return (entry){r, w->n_springs, child_resident(&r->c) - before, true, NULL};
}

static double run_lammps(void *self, size_t steps) {
  lammps_run *r = self;
  if (!child_ask(&r->c, "Loop time", "run %zu pre no post no\n", steps))
    bench_fail("LAMMPS has ended: %s", r->c.line);
  return strtod(r->c.line + strlen("Loop time of"), NULL);
}

static void read_lammps(void *self, double *x, double *y) {
  lammps_run *r = self;
  char line[CHILD_LINE];
  size_t i = 0;
  if (!child_ask(&r->c, "written",
                 "write_dump all custom %s id x y modify sort id format float %%.17g\n"
                 "print written\n",
                 r->path))
    bench_fail("LAMMPS has ended: %s", r->c.line);
  FILE *f = fopen(r->path, "r");
  for (int head = 0; f && head < 9 && fgets(line, sizeof line, f); head++) continue;
  while (f && i < r->n && fgets(line, sizeof line, f)) {
    char *at = line;
    strtoul(at, &at, 10);
    x[i] = strtod(at, &at);
    y[i++] = strtod(at, NULL);
  }
  if (f) fclose(f);
  unlink(r->path);
  if (i < r->n) bench_fail("LAMMPS wrote %zu atoms of %zu", i, r->n);
}

static void close_lammps(void *self) {
  lammps_run *r = self;
  child_close(&r->c);
  free(r);
}

const char *lammps_version(void) {
  static char version[128];
  FILE *f = popen("lmp -h 2>/dev/null | sed -n 's/.*Simulator - //p'", "r");
  if (!f || !fgets(version, sizeof version, f)) snprintf(version, sizeof version, "none");
  if (f) pclose(f);
  version[strcspn(version, "\n")] = '\0';
  return version;
}

const contestant lammps = {
    .name = "LAMMPS, MPI ranks",
    .grain = 1,
    .threads = MOST_THREADS,
    .open = open_lammps,
    .run = run_lammps,
    .read = read_lammps,
    .close = close_lammps,
};
