/* startup.c - a picture of 4000 x 4000 masses read from its file and planned: seconds, and the most
 * memory that the process held at any time, which a process of its own tells. */
#include "scene.h"

#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

enum { SIDE = 4000 };

static const char *path_of(const char *suffix) {
  static char path[2][256];
  static int next;
  next = !next;
  snprintf(path[next], sizeof *path, "%s/start-up.%s", scratch, suffix);
  return path[next];
}

static double peak_bytes(void) {
  struct rusage used;
  getrusage(RUSAGE_SELF, &used);
  return 1024.0 * (double)used.ru_maxrss;
}

int startup_once(void) {
  msr_scene *scene;
  msr_plan *plan;
  const double before = peak_bytes(), begin = seconds_now();
  must(msr_scene_load(path_of("ppm"), path_of("conf"), NULL, &scene, reason()));
  const double loaded = seconds_now();
  must(msr_plan_create(scene, NULL, &plan, reason()));
  msr_scene_free(scene);
  const double planned = seconds_now();
  printf("%.6f %.6f %.0f %zu\n", loaded - begin, planned - begin, peak_bytes() - before,
         msr_plan_describe(plan).masses);
  msr_plan_free(plan);
  return EXIT_SUCCESS;
}

static void write_files(void) {
  msr_picture *picture;
  must(msr_picture_create(SIDE, SIDE, &picture, reason()));
  for (size_t p = 0; p < (size_t)SIDE * SIDE; p++) memcpy(picture->rgb + 3 * p, "\377\0\0", 3);
  must(msr_picture_write(picture, path_of("ppm"), reason()));
  msr_picture_free(picture);
  FILE *f = fopen(path_of("conf"), "w");
  if (!f) bench_fail("%s can't be written", path_of("conf"));
  fprintf(f, "DT\n%g\nGRAVITE\n9.8\nMASSE\n%g\nTENSION_RESSORT\n%g\n", step, mass, stiffness);
  fprintf(f, "NB_ITERATIONS\n1000\nNB_IMAGES\n10\n");
  fclose(f);
}

static void measure(double *loaded, double *planned, double *bytes) {
  char command[600];
  size_t masses = 0;
  snprintf(command, sizeof command, "'%s' '%s' start-up-once", myself, scratch);
  FILE *f = popen(command, "r");
  if (!f || fscanf(f, "%lf %lf %lf %zu", loaded, planned, bytes, &masses) != 4)
    bench_fail("%s: no answer", command);
  pclose(f);
  *bytes /= (double)masses;
}

static void print(const char *what, double *sample) {
  const spread s = spread_of(sample, ROUNDS);
  printf("%-24s %8.3f (%.3f..%.3f)\n", what, s.median, s.low, s.high);
}

void startup_table(void) {
  double loaded[ROUNDS], planned[ROUNDS], bytes[ROUNDS];
  write_files();
  for (int i = 0; i < ROUNDS; i++) measure(&loaded[i], &planned[i], &bytes[i]);
  unlink(path_of("ppm"));
  unlink(path_of("conf"));
  printf("\n== Start-up, %d x %d masses\n", SIDE, SIDE);
  print("loaded [s]", loaded);
  print("loaded and planned [s]", planned);
  print("peak bytes per mass", bytes);
  bar_at_most(spread_of(planned, ROUNDS).median, 1, "start-up: s, loaded and planned");
  bar_at_most(spread_of(bytes, ROUNDS).median, 60, "start-up: bytes per mass");
}
