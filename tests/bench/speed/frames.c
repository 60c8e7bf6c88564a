/* frames.c - frames a second: a step, a picture drawn, and its bytes on their way, to /dev/null and
 * through a pipe; beside the pipe's own speed for the same bytes. */
#include "scene.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

static const struct {
  const char *name;
  size_t side;
  uint64_t frames;
} films[] = {{"32 x 32", 32, 4000}, {"316 x 316", 316, 400}, {"1000 x 1000", 1000, 40}};
enum { FILMS = sizeof films / sizeof *films };

/* What fills a pipe or /dev/null. */
typedef struct film {
  size_t bytes; /* of a frame */
  uint64_t frames;
  msr_plan *plan;   /* NULL: no more than bytes */
  unsigned threads; /* of the plan and the run */
} film;

/* ---- Where bytes go */

/* Someone who reads them; returns the end to write to. */
static int open_pipe(pid_t *reader) {
  int ends[2];
  if (pipe(ends) != 0 || (*reader = fork()) < 0) bench_fail("there is no pipe");
  if (*reader > 0) {
    close(ends[0]);
    return ends[1];
  }
  close(ends[1]);
  const size_t size = 1 << 20;
  char *bytes = need(size, 1);
  while (read(ends[0], bytes, size) > 0) continue;
  _exit(EXIT_SUCCESS);
}

static void write_bytes(int to, const char *bytes, size_t size) {
  while (size > 0) {
    const ssize_t n = write(to, bytes, size);
    if (n <= 0) bench_fail("bytes can't be written");
    bytes += n, size -= (size_t)n;
  }
}

static void shoot(const film *f) {
  msr_state *state;
  msr_sink sink;
  must(msr_state_create(f->plan, &state, reason()));
  must(msr_frames_open(f->plan, "-", NULL, true, &sink, reason()));
  const msr_run_options options = {.sinks = &sink, .n_sinks = 1, .threads = f->threads};
  must(msr_run(state, &options, reason()));
  must(msr_sink_close(&sink, reason()));
  msr_state_free(state);
}

/* [frames/s] */
static double rate(const film *f, bool through_pipe) {
  pid_t reader = 0;
  fflush(stdout);
  const int real = dup(STDOUT_FILENO),
            to = through_pipe ? open_pipe(&reader) : open("/dev/null", O_WRONLY);
  char *bytes = need(f->bytes, 1);
  dup2(to, STDOUT_FILENO);
  close(to);
  const double begin = seconds_now();
  if (f->plan) shoot(f);
  for (uint64_t i = 0; !f->plan && i < f->frames; i++) write_bytes(STDOUT_FILENO, bytes, f->bytes);
  dup2(real, STDOUT_FILENO);
  if (reader > 0) waitpid(reader, NULL, 0);
  const double seconds = seconds_now() - begin;
  close(real);
  free(bytes);
  return (double)f->frames / seconds;
}

/* ---- The table */

enum { RAW, PIPE_1, PIPE_2, NULL_1, NULL_2, COLUMNS };

static void print_film(const char *name, size_t bytes, double (*x)[ROUNDS]) {
  printf("%-12s", name);
  double share[2][ROUNDS];
  for (int i = 0; i < ROUNDS; i++) {
    share[0][i] = x[PIPE_1][i] / x[RAW][i];
    share[1][i] = x[PIPE_2][i] / x[RAW][i];
  }
  for (int k = 0; k < COLUMNS; k++) {
    char text[40] = "-";
    const spread s = spread_of(x[k], ROUNDS);
    if (s.median > 0) snprintf(text, sizeof text, "%.0f (%.0f..%.0f)", s.median, s.low, s.high);
    printf("  %-22s", text);
  }
  for (int t = 0; t < 2; t++) {
    const double median = spread_of(share[t], ROUNDS).median;
    if (median > 0)
      printf(" %5.2f", median);
    else
      printf(" %5s", "-");
    if (bytes > 1000000 && median > 0)
      bar_at_least(median, 0.6, "frames of %s: pipe / raw, %d thread%s", name, t + 1,
                   t > 0 ? "s" : "");
  }
  printf("\n");
}

static void open_film(size_t i, int threads, film *f, msr_state **state) {
  work w = work_drawn("film", films[i].side, draw_block);
  const msr_plan_options options = verlet_with(threads);
  f->bytes = 3 * w.width * w.height;
  f->frames = films[i].frames;
  f->threads = (unsigned)threads;
  *state = state_of(&w, step, films[i].frames, &options, &f->plan);
  work_free(&w);
}

void frames_table(void) {
  printf(
      "\n== Frames a second, one step between two\n%-12s  %-22s  %-22s  %-22s  %-22s  %-22s %s\n",
      "", "pipe, bytes alone", "pipe, 1 thread", "pipe, 2 threads", "/dev/null, 1 thread",
      "/dev/null, 2 threads", "pipe / bytes alone");
  for (size_t i = 0; i < FILMS; i++) {
    double x[COLUMNS][ROUNDS] = {{0}};
    film f[2] = {{0}};
    msr_state *state[2] = {0};
    for (int t = 0; t < library.threads; t++) open_film(i, t + 1, &f[t], &state[t]);
    const film raw = {.bytes = f[0].bytes, .frames = f[0].frames};
    for (int round = 0; round < ROUNDS; round++) {
      x[RAW][round] = rate(&raw, true);
      for (int t = 0; t < library.threads; t++) {
        x[PIPE_1 + t][round] = rate(&f[t], true);
        x[NULL_1 + t][round] = rate(&f[t], false);
      }
    }
    print_film(films[i].name, raw.bytes, x);
    for (int t = 0; t < library.threads; t++) msr_state_free(state[t]), msr_plan_free(f[t].plan);
  }
}
