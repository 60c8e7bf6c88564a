/* test_beside.c - frames completed in a thread beside the simulation: the same frames in the same
 * order, one ahead at most, and what goes wrong is told. link: --wrap=pthread_create */
#include "art.h"
#include "files.h"

#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <time.h>

/* ---- A system that has no thread left */

static bool none_left;
int __real_pthread_create(pthread_t *thread, const pthread_attr_t *attributes,
                          void *(*start)(void *), void *argument);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes,
                          void *(*start)(void *), void *argument);

int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes,
                          void *(*start)(void *), void *argument) {
  return none_left ? EAGAIN : __real_pthread_create(thread, attributes, start, argument);
}

/* ---- A run: a block falls on a floor, 37 iterations, 10 frames */

enum { ITERATIONS = 37, FRAMES = 10 };

static msr_plan *plan;

static msr_state *new_state(void) {
  msr_state *state;
  must(msr_state_create(plan, &state, &why));
  return state;
}

static uint64_t due[FRAMES]; /* hashes of the frames */

static void expect(void) {
  msr_state *state = new_state();
  for (uint64_t i = 0; i < FRAMES; i++) {
    const uint64_t iteration = msr_plan_frame_iteration(plan, i);
    must(msr_state_step(state, iteration - msr_state_iteration(state), &why));
    due[i] = msr_state_hash(state);
  }
  msr_state_free(state);
}

static int set_up(void **unused) {
  static const char art[] = ".ooo.\n.ogo.\n.....\n#####\n";
  const msr_conf conf = {0.02, 30, 0.1, 500, ITERATIONS, FRAMES};
  msr_scene *scene = scene_of(art, &conf, NULL);
  must(msr_plan_create(scene, NULL, &plan, &why));
  msr_scene_free(scene);
  expect();
  return make_directory(unused);
}

static int tear_down(void **unused) {
  msr_plan_free(plan);
  return remove_directory(unused);
}

/* ---- A sink that keeps what it takes, and looks at it when it completes it
 *
 * What it finds wrong is told later: assertions are for the test's own thread. */

typedef struct witness {
  uint64_t failing; /* frame that it fails to complete, counted from 1; 0: none */
  uint64_t refused; /* frame that it fails to take, likewise */
  struct witness *after;
  uint64_t taken, completed; /* so far */
  uint64_t hash;             /* of the frame that was taken */
  uint64_t sound;            /* frames that were completed as they were due, in order */
  bool elsewhere;            /* in another thread */
  pthread_t home;
  sigset_t blocked; /* where it completes */
} witness;

static msr_status take(void *self, const msr_state *state, uint64_t frame, msr_error *err) {
  witness *w = self;
  (void)err;
  assert_int_equal(w->completed, w->taken); // one ahead at most
  if (frame + 1 == w->refused) return MSR_ENOMEM;
  w->hash = msr_state_hash(state);
  w->home = pthread_self();
  w->taken++;
  return MSR_OK;
}

static msr_status complete(void *self, uint64_t frame, msr_error *err) {
  witness *w = self;
  (void)err;
  w->elsewhere = !pthread_equal(w->home, pthread_self());
  pthread_sigmask(SIG_BLOCK, NULL, &w->blocked);
  w->completed++;
  w->sound += frame < FRAMES && w->hash == due[frame] && w->completed == w->taken &&
              (!w->after || w->after->completed == w->completed);
  return frame + 1 == w->failing ? MSR_EIO : MSR_OK;
}

static msr_sink sink_of(witness *w) {
  return (msr_sink){.self = w, .write = take, .complete = complete};
}

static void frames_are_completed_in_order(void **unused) {
  (void)unused;
  for (unsigned threads = 0; threads < 4; threads++) {
    witness a = {0}, b = {.after = &a};
    const msr_sink sinks[] = {sink_of(&a), sink_of(&b)};
    msr_state *state = new_state();
    const msr_run_options options = {.sinks = sinks, .n_sinks = 2, .threads = threads};
    must(msr_run(state, &options, &why));
    assert_int_equal(msr_state_iteration(state), ITERATIONS);
    assert_true(a.taken == FRAMES && a.completed == FRAMES && a.sound == FRAMES);
    assert_true(b.taken == FRAMES && b.completed == FRAMES && b.sound == FRAMES);
    assert_int_equal(a.elsewhere, threads > 1);
    must(msr_run(state, &options, &why)); // at its end it has nothing more to show
    assert_int_equal(a.taken, FRAMES);
    msr_state_free(state);
  }
}

static void without_a_thread_they_are_completed_all_the_same(void **unused) {
  (void)unused;
  witness w = {0};
  const msr_sink sink = sink_of(&w);
  msr_state *state = new_state();
  none_left = true;
  const msr_status status =
      msr_run(state, &(msr_run_options){.sinks = &sink, .n_sinks = 1, .threads = 2}, &why);
  none_left = false;
  must(status);
  assert_true(w.sound == FRAMES && !w.elsewhere);
  msr_state_free(state);
}

/* Those of the program are for its own threads; what a thread brings on itself stays its own. */
static void signals_are_left_to_the_program(void **unused) {
  (void)unused;
  witness w = {0};
  const msr_sink sink = sink_of(&w);
  sigset_t none, before, after;
  msr_state *state = new_state();
  sigemptyset(&none);
  pthread_sigmask(SIG_SETMASK, &none, &before);
  must(msr_run(state, &(msr_run_options){.sinks = &sink, .n_sinks = 1, .threads = 2}, &why));
  pthread_sigmask(SIG_SETMASK, &before, &after);
  assert_true(sigismember(&w.blocked, SIGINT) && sigismember(&w.blocked, SIGALRM));
  assert_false(sigismember(&w.blocked, SIGPIPE) || sigismember(&w.blocked, SIGSEGV));
  assert_false(sigismember(&after, SIGINT) || sigismember(&after, SIGPIPE));
  msr_state_free(state);
}

/* ---- Beside the simulation */

/* A slow sink: it waits until the simulation has gone on, for 10 s at most. */
typedef struct gate {
  pthread_mutex_t lock;
  pthread_cond_t stepped;
  bool open;
  uint64_t waits, late;
} gate;

static msr_status shut(void *self, const msr_state *state, uint64_t frame, msr_error *err) {
  gate *g = self;
  (void)state, (void)frame, (void)err;
  pthread_mutex_lock(&g->lock);
  g->open = false;
  pthread_mutex_unlock(&g->lock);
  return MSR_OK;
}

static msr_status wait_for_a_step(void *self, uint64_t frame, msr_error *err) {
  gate *g = self;
  (void)frame, (void)err;
  struct timespec limit;
  clock_gettime(CLOCK_REALTIME, &limit);
  limit.tv_sec += 10;
  pthread_mutex_lock(&g->lock);
  int failed = 0;
  while (!g->open && !failed) failed = pthread_cond_timedwait(&g->stepped, &g->lock, &limit);
  g->waits++;
  g->late += failed != 0;
  pthread_mutex_unlock(&g->lock);
  return failed ? MSR_EIO : MSR_OK;
}

static msr_status open_gate(void *data, const msr_state *state) {
  gate *g = data;
  (void)state;
  pthread_mutex_lock(&g->lock);
  g->open = true;
  pthread_cond_signal(&g->stepped);
  pthread_mutex_unlock(&g->lock);
  return MSR_OK;
}

static void the_simulation_goes_on_meanwhile(void **unused) {
  (void)unused;
  gate g = {.lock = PTHREAD_MUTEX_INITIALIZER, .stepped = PTHREAD_COND_INITIALIZER};
  const msr_sink sink = {.self = &g, .write = shut, .complete = wait_for_a_step};
  const msr_run_options options = {
      .sinks = &sink, .n_sinks = 1, .poll = open_gate, .data = &g, .threads = 2};
  msr_state *state = new_state();
  must(msr_run(state, &options, &why));
  assert_true(g.waits == FRAMES && g.late == 0);
  msr_state_free(state);
}

/* ---- What goes wrong */

/* It's told at the next frame or at the end, and no sink after it completes that frame. */
static void a_frame_that_fails_stops_the_run(void **unused) {
  (void)unused;
  for (unsigned threads = 1; threads < 3; threads++)
    for (uint64_t frame = 0; frame < FRAMES; frame++) {
      witness a = {.failing = frame + 1}, b = {0};
      const msr_sink sinks[] = {sink_of(&a), sink_of(&b)};
      const msr_run_options options = {.sinks = sinks, .n_sinks = 2, .threads = threads};
      msr_error err = {.message = ""};
      char message[64];
      msr_state *state = new_state();
      assert_int_equal(msr_run(state, &options, &err), MSR_EIO);
      snprintf(message, sizeof message, "frame %d: input or output failed", (int)frame);
      assert_string_equal(err.message, message);
      assert_int_equal(err.status, MSR_EIO);
      assert_true(a.taken == frame + 1 && a.completed == frame + 1 && b.completed == frame);
      const uint64_t next = frame + threads - 1;
      const uint64_t told = next < FRAMES ? msr_plan_frame_iteration(plan, next) : ITERATIONS;
      assert_int_equal(msr_state_iteration(state), told);
      // the run may go on: where the state has passed the frame it is lost, else it comes again
      witness c = {.taken = next, .completed = next};
      const msr_sink rest = sink_of(&c);
      must(msr_run(state, &(msr_run_options){.sinks = &rest, .n_sinks = 1}, &why));
      assert_true(c.completed == FRAMES && c.sound == FRAMES - next);
      msr_state_free(state);
    }
}

/* The scene alone: as the state is still there, it comes again. */
static void a_frame_that_failed_comes_again(void **unused) {
  (void)unused;
  const msr_conf conf = {0.02, 30, 0.1, 500, 0, 1};
  const world w = open_world_with(scene_of("o.\n", &conf, NULL), NULL);
  for (unsigned threads = 1; threads < 3; threads++) {
    witness a = {.failing = 1};
    const msr_sink sink = sink_of(&a);
    const msr_run_options options = {.sinks = &sink, .n_sinks = 1, .threads = threads};
    msr_state *state;
    must(msr_state_create(w.plan, &state, &why));
    assert_int_equal(msr_run(state, &options, NULL), MSR_EIO);
    a.failing = 0;
    must(msr_run(state, &options, &why));
    assert_int_equal(a.completed, 2);
    must(msr_run(state, &options, &why));
    assert_int_equal(a.completed, 2);
    msr_state_free(state);
  }
  close_world(w);
}

/* Frames that were taken before are whole by then; that one nobody completes. */
static void a_frame_that_is_refused_is_not_completed(void **unused) {
  (void)unused;
  for (unsigned threads = 1; threads < 3; threads++) {
    witness a = {0}, b = {.refused = 4};
    const msr_sink sinks[] = {sink_of(&a), sink_of(&b)};
    const msr_run_options options = {.sinks = sinks, .n_sinks = 2, .threads = threads};
    msr_error err = {.message = ""};
    msr_state *state = new_state();
    assert_int_equal(msr_run(state, &options, &err), MSR_ENOMEM);
    assert_string_equal(err.message, "frame 3: out of memory");
    assert_true(a.taken == 4 && a.sound == 3 && b.sound == 3);
    msr_state_free(state);
  }
}

static msr_status count_down(void *data, const msr_state *state) {
  (void)state;
  uint64_t *left = data;
  return (*left)-- == 0 ? MSR_EINTR : MSR_OK;
}

/* Wherever a run is stopped, what was taken is complete when it comes back, and nothing comes
 * twice.
 */
static void a_run_that_is_stopped_leaves_whole_frames(void **unused) {
  (void)unused;
  for (uint64_t stop = 0; stop < ITERATIONS * msr_plan_describe(plan).substeps; stop++) {
    witness w = {0};
    const msr_sink sink = sink_of(&w);
    uint64_t left = stop;
    msr_run_options options = {.sinks = &sink,
                               .n_sinks = 1,
                               .poll = count_down,
                               .poll_steps = 1,
                               .data = &left,
                               .threads = 2};
    msr_state *state = new_state();
    assert_int_equal(msr_run(state, &options, NULL), MSR_EINTR);
    assert_true(w.taken >= 1 && w.sound == w.taken);
    options.poll = NULL;
    must(msr_run(state, &options, &why));
    assert_int_equal(w.sound, FRAMES);
    msr_state_free(state);
  }
}

/* ---- Files */

enum { MOST_BYTES = 4096 };

static size_t read_frame(const char *dir, int frame, char bytes[MOST_BYTES]) {
  char name[64];
  snprintf(name, sizeof name, "%s/frame-%06d.ppm", dir, frame);
  const char *path = path_of(name);
  FILE *file = fopen(path, "rb");
  assert_non_null(file);
  const size_t size = fread(bytes, 1, MOST_BYTES, file);
  assert_int_equal(fclose(file), 0);
  assert_int_equal(remove(path), 0);
  return size;
}

static void files_are_the_same(void **unused) {
  (void)unused;
  static const char *const names[] = {"one", "two"};
  static char one[MOST_BYTES], two[MOST_BYTES];
  for (unsigned i = 0; i < 2; i++) {
    msr_sink sink;
    msr_state *state = new_state();
    must(msr_frames_open(plan, path_of(names[i]), NULL, false, &sink, &why));
    must(msr_run(state, &(msr_run_options){.sinks = &sink, .n_sinks = 1, .threads = 1 + i}, &why));
    must(msr_sink_close(&sink, &why));
    msr_state_free(state);
  }
  for (int frame = 0; frame < FRAMES; frame++) {
    const size_t size = read_frame("one", frame, one);
    assert_int_equal(read_frame("two", frame, two), size);
    assert_memory_equal(one, two, size);
  }
  for (size_t i = 0; i < LENGTH(names); i++) assert_int_equal(rmdir(path_of(names[i])), 0);
}

/* The directory goes while the run is on: it says where, and stops. */
static void a_file_that_cannot_be_written_is_told(void **unused) {
  (void)unused;
  msr_sink sink;
  msr_error err = {.message = ""};
  must(msr_frames_open(plan, path_of("a"), NULL, false, &sink, &why));
  assert_int_equal(rmdir(path_of("a")), 0);
  msr_state *state = new_state();
  const msr_run_options options = {.sinks = &sink, .n_sinks = 1, .threads = 2};
  assert_int_equal(msr_run(state, &options, &err), MSR_EIO);
  assert_non_null(strstr(err.message, "frame-000000.ppm: cannot write it: No such file"));
  msr_state_free(state);
  must(msr_sink_close(&sink, &why));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(frames_are_completed_in_order),
      cmocka_unit_test(without_a_thread_they_are_completed_all_the_same),
      cmocka_unit_test(signals_are_left_to_the_program),
      cmocka_unit_test(the_simulation_goes_on_meanwhile),
      cmocka_unit_test(a_frame_that_fails_stops_the_run),
      cmocka_unit_test(a_frame_that_failed_comes_again),
      cmocka_unit_test(a_frame_that_is_refused_is_not_completed),
      cmocka_unit_test(a_run_that_is_stopped_leaves_whole_frames),
      cmocka_unit_test(files_are_the_same),
      cmocka_unit_test(a_file_that_cannot_be_written_is_told),
  };
  return cmocka_run_group_tests_name("beside", tests, set_up, tear_down);
}
