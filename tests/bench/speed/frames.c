/* frames.c - frames through a pipe and to files: how many a second, a step between two; and what
 * drawing and writing take, beside bare bytes that go to the same reader, or into files of the same
 * names: one frame after the other, which keeps the reader awake, and in the same run. */
#include "scene.h"
#include "target.h"

#include <stdlib.h>
#include <string.h>

static const struct {
  const char *name;
  size_t side;
  draw *how;
  uint64_t frames;
} films[] = {{"block 32 x 32", 32, draw_block, 300},
             {"block 316 x 316", 316, draw_block, 100},
             {"block 1000 x 1000", 1000, draw_block, 30},
             {"holes in 1000 x 1000", 1000, draw_holes, 30}};
enum { FILMS = sizeof films / sizeof *films };

static const char *const place_names[] = {"pipe", "files"};

/* ---- Bytes alone */

/* [s] a frame. */
static double bytes_alone(place where, size_t size, uint64_t frames) {
  target t = target_open(where);
  char *bytes = need(size, 1);
  memset(bytes, 255, size);
  const double begin = seconds_now();
  for (uint64_t i = 0; i < frames; i++) target_write(&t, i, bytes, size);
  target_drain(&t);
  const double seconds = seconds_now() - begin;
  target_remove(&t, frames);
  free(bytes);
  return seconds / (double)frames;
}

/* ---- Runs */

/* The sink that writes so many bytes without any drawing. */
typedef struct bare {
  const target *target;
  char *bytes;
  size_t size;
} bare;

static msr_status take_nothing(void *self, const msr_state *state, uint64_t frame, msr_error *err) {
  (void)self, (void)state, (void)frame, (void)err;
  return MSR_OK;
}

static msr_status write_bare(void *self, uint64_t frame, msr_error *err) {
  (void)err;
  const bare *b = self;
  target_write(b->target, frame, b->bytes, b->size);
  return MSR_OK;
}

/* A sink that looks at the clock about another one. */
typedef struct timed {
  msr_sink sink;
  double seconds;
} timed;

static msr_status timed_write(void *self, const msr_state *state, uint64_t frame, msr_error *err) {
  timed *t = self;
  const double begin = seconds_now();
  const msr_status status = t->sink.write(t->sink.self, state, frame, err);
  t->seconds += seconds_now() - begin;
  return status;
}

static msr_status timed_complete(void *self, uint64_t frame, msr_error *err) {
  timed *t = self;
  const double begin = seconds_now();
  const msr_status status = t->sink.complete(t->sink.self, frame, err);
  t->seconds += seconds_now() - begin;
  return status;
}

/* A scene with its state at the start, for some threads. */
typedef struct stage {
  unsigned threads;
  uint64_t frames;
  msr_plan *plan;
  msr_state *start;
} stage;

typedef struct shot {
  double wall, sink; /* [s] a frame: of the run; in the sink, in either thread */
} shot;

/* No sink: frames go nowhere. */
static shot run_with(const stage *s, target *t, timed *frames) {
  const msr_sink sink = {.self = frames, .write = timed_write, .complete = timed_complete};
  const msr_run_options options = {
      .sinks = &sink, .n_sinks = frames->sink.write != NULL, .threads = s->threads};
  msr_state *state;
  must(msr_state_create(s->plan, &state, reason()));
  msr_state_copy(state, s->start);
  const double begin = seconds_now();
  must(msr_run(state, &options, reason()));
  must(msr_sink_close(&frames->sink, reason()));
  target_drain(t);
  const double n = (double)s->frames;
  const shot taken = {(seconds_now() - begin) / n, frames->seconds / n};
  target_remove(t, s->frames);
  msr_state_free(state);
  return taken;
}

static shot run_alone(const stage *s) {
  target t = {.place = NOWHERE};
  return run_with(s, &t, &(timed){.seconds = 0});
}

static shot run_bare(const stage *s, place where, size_t size) {
  target t = target_open(where);
  bare b = {&t, need(size, 1), size};
  memset(b.bytes, 255, size);
  timed frames = {.sink = {.self = &b, .write = take_nothing, .complete = write_bare}};
  const shot taken = run_with(s, &t, &frames);
  free(b.bytes);
  return taken;
}

static shot run_frames(const stage *s, place where) {
  target t = target_open(where);
  timed frames = {.seconds = 0};
  const char *to = where == PIPE ? "-" : t.directory;
  must(msr_frames_open(s->plan, to, NULL, true, &frames.sink, reason()));
  return run_with(s, &t, &frames);
}

/* ---- The table */

/* [s] a frame; of drawing and writing what they take, by two threads, which do it beside, how much
 * longer the run is. */
typedef struct figures {
  double wall[ROUNDS], alone[ROUNDS], bare[ROUNDS], frames[ROUNDS];
} figures;

static double share(const double *alone, const double *frames) {
  double x[ROUNDS];
  for (int i = 0; i < ROUNDS; i++) x[i] = frames[i] > alone[i] ? alone[i] / frames[i] : 1;
  return spread_of(x, ROUNDS).median;
}

static void print_spread(const double *seconds, bool a_second) {
  double x[ROUNDS];
  char text[40];
  const int digits = a_second ? 0 : 3;
  for (int i = 0; i < ROUNDS; i++) x[i] = a_second ? 1 / seconds[i] : 1e3 * seconds[i];
  const spread s = spread_of(x, ROUNDS);
  snprintf(text, sizeof text, "%.*f (%.*f..%.*f)", digits, s.median, digits, s.low, digits, s.high);
  printf("  %-22s", text);
}

static void print_row(const char *name, place where, unsigned threads, size_t bytes,
                      const figures *f) {
  const double part = share(f->alone, f->frames);
  printf("%-22s%-7s%u", name, place_names[where], threads);
  print_spread(f->wall, true);
  print_spread(f->alone, false);
  print_spread(f->bare, false);
  print_spread(f->frames, false);
  printf(" %5.2f %5.2f\n", part, share(f->bare, f->frames));
  if (bytes > 1000000)
    bar_at_least(part, 0.6, "%s, %s, %u thread%s: bytes alone / frames", name, place_names[where],
                 threads, threads > 1 ? "s" : "");
}

static void measure(const stage *s, place where, size_t bytes, int round, figures *f) {
  const bool beside = s->threads > 1;
  const double none = beside ? run_alone(s).wall : 0;
  f->alone[round] = bytes_alone(where, bytes, s->frames);
  const shot plain = run_bare(s, where, bytes), drawn = run_frames(s, where);
  f->wall[round] = drawn.wall;
  f->bare[round] = beside ? plain.wall - none : plain.sink;
  f->frames[round] = beside ? drawn.wall - none : drawn.sink;
}

static void film_rows(size_t film, unsigned threads) {
  work w = work_drawn(films[film].name, films[film].side, films[film].how);
  const size_t bytes = 3 * w.width * w.height;
  const msr_plan_options options = verlet_with((int)threads);
  stage s = {.threads = threads, .frames = films[film].frames};
  figures f[2];
  s.start = state_of(&w, step, s.frames, &options, &s.plan);
  for (int round = 0; round < ROUNDS; round++)
    for (place where = PIPE; where <= FILES; where++) measure(&s, where, bytes, round, &f[where]);
  for (place where = PIPE; where <= FILES; where++)
    print_row(films[film].name, where, threads, bytes, &f[where]);
  msr_state_free(s.start);
  msr_plan_free(s.plan);
  work_free(&w);
}

void frames_table(void) {
  static const char *const columns[] = {"frames a second", "ms: bytes alone", "bytes in a run",
                                        "frames in a run"};
  printf("\n== Frames, one step between two\n%-30s", "                            threads");
  for (size_t i = 0; i < sizeof columns / sizeof *columns; i++) printf("  %-22s", columns[i]);
  printf(" bytes / frames\n");
  for (size_t i = 0; i < FILMS; i++)
    for (int threads = 1; threads <= library.threads; threads++) film_rows(i, (unsigned)threads);
}
