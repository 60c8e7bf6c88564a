/* growth.c - time per spring and step from 10^3 to 10^7 masses: were it constant, a step would be
 * linear in the masses; beside it the limit, whose steps are those of the caches. */
#include "speed.h"

#include <stdlib.h>
#include <unistd.h>

static const size_t sides[] = {32, 55, 100, 173, 316, 548, 1000, 1732, 3162};
static const double sample = 0.02; /* [s] */
enum { SIDES = sizeof sides / sizeof *sides, COLUMNS = 5 };

static const struct {
  const char *title;
  const contestant *who;
  int threads;
} columns[COLUMNS] = {{"libmsr, 1 thread", &library, 1},
                      {"libmsr, 2 threads", &library, 2},
                      {"limit, 1 step a pass", &limit_1, 1},
                      {"limit, 16 a pass", &limit_16, 1},
                      {"the same, 2 threads", &limit_16, 2}};

typedef struct cell {
  entry e;
  size_t masses, steps;
  double nanoseconds[ROUNDS]; /* per spring and step */
} cell;

static cell open_cell(size_t column, const work *w) {
  const contestant *c = columns[column].who;
  cell x = {.masses = w->n};
  if (columns[column].threads > c->threads)
    x.e.missing = "one thread only";
  else
    x.e = c->open(c, w, columns[column].threads);
  if (x.e.missing) return x;
  const double grains = sample * 16 / c->run(x.e.self, 16) / (double)c->grain;
  x.steps = c->grain * (size_t)fmax(1, round(grains));
  return x;
}

static void time_cell(size_t column, cell *x, int round) {
  if (x->e.missing) return;
  const double seconds = columns[column].who->run(x->e.self, x->steps);
  x->nanoseconds[round] = 1e9 * seconds / (double)x->steps / (double)x->e.springs;
}

static void print_cell(cell *x) {
  if (x->e.missing) {
    printf("  %-20s", "-");
    return;
  }
  const spread s = spread_of(x->nanoseconds, ROUNDS);
  char text[32];
  snprintf(text, sizeof text, "%.3f (%.3f..%.3f)", s.median, s.low, s.high);
  printf("  %-20s", text);
}

static void print_caches(void) {
#ifdef _SC_LEVEL1_DCACHE_SIZE
  printf("Caches: %ld KB (a core's first), %ld KB, %ld KB.\n",
         sysconf(_SC_LEVEL1_DCACHE_SIZE) / 1024, sysconf(_SC_LEVEL2_CACHE_SIZE) / 1024,
         sysconf(_SC_LEVEL3_CACHE_SIZE) / 1024);
#endif
}

static void print_all(cell (*x)[COLUMNS]) {
  printf("\n== Growth: ns per spring and step, blocks\n");
  print_caches();
  printf("%9s %9s", "masses", "KB");
  for (size_t k = 0; k < COLUMNS; k++) printf("  %-20s", columns[k].title);
  printf("\n");
  for (size_t i = 0; i < SIDES; i++) {
    printf("%9zu %9.0f", x[i][0].masses, x[i][0].e.bytes / 1024);
    for (size_t k = 0; k < COLUMNS; k++) print_cell(&x[i][k]);
    printf("\n");
  }
}

void growth_table(void) {
  cell(*x)[COLUMNS] = need(SIDES, sizeof *x);
  for (size_t i = 0; i < SIDES; i++) {
    work w = work_drawn("block", sides[i], draw_block);
    for (size_t k = 0; k < COLUMNS; k++) x[i][k] = open_cell(k, &w);
    work_free(&w);
  }
  for (int round = 0; round < ROUNDS; round++)
    for (size_t i = 0; i < SIDES; i++)
      for (size_t k = 0; k < COLUMNS; k++) time_cell(k, &x[i][k], round);
  print_all(x);
  for (size_t i = 0; i < SIDES; i++)
    for (size_t k = 0; k < COLUMNS; k++)
      if (!x[i][k].e.missing) columns[k].who->close(x[i][k].e.self);
  free(x);
}
