/* test_run.c - whole runs: which frames come when and where they go, what the files hold, how a run
 * is stopped and goes on, and what happens when a sink fails. */
#include "art.h"
#include "files.h"

#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

/* ---- A simulation: a block that falls on a floor, 37 iterations, 10 frames */

enum { WIDTH = 8, HEIGHT = 6, MASSES = 6, ITERATIONS = 37, FRAMES = 10 };

static const char art[] = ".ooo....\n"
                          ".ooo....\n"
                          "........\n"
                          "........\n"
                          "........\n"
                          "########\n";

static msr_plan *plan_of(uint64_t iterations, uint64_t images) {
  const msr_conf conf = {0.02, 30, 0.1, 500, iterations, images};
  msr_plan *plan;
  msr_scene *scene = scene_of(art, &conf, NULL);
  const msr_wind wind = {.speed = 2, .gust = 2, .gust_time = 0.2, .seed = 5};
  must(msr_scene_add_force(scene, &msr_force_wind, &wind, &why));
  must(msr_plan_create(scene, NULL, &plan, &why));
  assert_true(msr_plan_describe(plan).substeps > 2);
  msr_scene_free(scene);
  return plan;
}

static msr_plan *plan; /* ITERATIONS and FRAMES */

static msr_state *new_state(const msr_plan *of) {
  msr_state *state;
  must(msr_state_create(of, &state, &why));
  return state;
}

/* Runs a plan from its start into sinks that are closed after. */
static msr_status run_into(const msr_plan *of, msr_sink *sinks, size_t n, msr_error *err) {
  msr_state *state = new_state(of);
  msr_status status = msr_run(state, &(msr_run_options){.sinks = sinks, .n_sinks = n}, err);
  msr_state_free(state);
  for (size_t s = 0; s < n; s++) {
    const msr_status closed = msr_sink_close(&sinks[s], status ? NULL : err);
    if (!status) status = closed;
  }
  return status;
}

/* What every frame is, by stepping up to it. */
typedef struct expected {
  uint64_t hash[FRAMES], contacts[FRAMES];
  double numbers[FRAMES][MASSES][4];
  msr_energy energy[FRAMES];
  double t[FRAMES];
} expected;

static expected due;

static void expect(void) {
  msr_state *state = new_state(plan);
  for (uint64_t i = 0; i < FRAMES; i++) {
    const uint64_t iteration = i * ITERATIONS / FRAMES;
    must(msr_state_step(state, iteration - msr_state_iteration(state), &why));
    const msr_view s = msr_state_view(state);
    due.hash[i] = msr_state_hash(state);
    due.contacts[i] = msr_state_contacts(state);
    due.energy[i] = msr_state_energy(state);
    due.t[i] = s.t;
    for (size_t m = 0; m < MASSES; m++) {
      const double numbers[] = {s.x[m], s.y[m], s.vx[m], s.vy[m]};
      memcpy(due.numbers[i][m], numbers, sizeof numbers);
    }
  }
  assert_true(due.contacts[FRAMES - 1] > 0);
  msr_state_free(state);
}

/* ---- Files */

static int set_up(void **unused) {
  plan = plan_of(ITERATIONS, FRAMES);
  expect();
  return make_directory(unused);
}

static int tear_down(void **unused) {
  msr_plan_free(plan);
  return remove_directory(unused);
}

static const char *frame_path(const char *dir, size_t frame) {
  char name[64];
  snprintf(name, sizeof name, "%s/frame-%06zu.ppm", dir, frame);
  return path_of(name);
}

static bool exists(const char *path) { return access(path, F_OK) == 0; }

enum { MOST_BYTES = 1 << 16 };

static size_t read_file(const char *path, char bytes[MOST_BYTES]) {
  FILE *file = fopen(path, "rb");
  assert_non_null(file);
  const size_t size = fread(bytes, 1, MOST_BYTES - 1, file);
  assert_int_equal(fclose(file), 0);
  bytes[size] = '\0';
  return size;
}

static void remove_frames(const char *dir, size_t frames) {
  for (size_t i = 0; i < frames; i++) assert_int_equal(remove(frame_path(dir, i)), 0);
  assert_int_equal(rmdir(path_of(dir)), 0); // nothing else is there
}

/* ---- Frames */

/* Each is the P6 that a renderer draws of the state that is due, the first the scene itself. */
static void frames_are_pictures_of_their_states(void **unused) {
  (void)unused;
  static char bytes[MOST_BYTES];
  static const char header[] = "P6\n8 6\n255\n";
  const size_t start = sizeof header - 1, size = 3 * WIDTH * HEIGHT;
  msr_sink sink;
  msr_renderer *renderer;
  must(msr_frames_open(plan, path_of("a"), NULL, false, &sink, &why));
  assert_int_equal(run_into(plan, &sink, 1, NULL), MSR_OK);
  must(msr_renderer_create(plan, NULL, &renderer, &why));
  msr_state *state = new_state(plan);
  msr_picture *scene = paint(art);
  for (size_t i = 0; i < FRAMES; i++) {
    assert_int_equal(read_file(frame_path("a", i), bytes), start + size);
    assert_memory_equal(bytes, header, start);
    const uint64_t to_go = i * ITERATIONS / FRAMES - msr_state_iteration(state);
    must(msr_state_step(state, to_go, &why));
    assert_memory_equal(bytes + start, msr_renderer_draw(renderer, state)->rgb, size);
    if (i == 0) assert_memory_equal(bytes + start, scene->rgb, size);
  }
  msr_picture_free(scene);
  msr_state_free(state);
  msr_renderer_free(renderer);
  remove_frames("a", FRAMES);
}

static void directories_above_are_made(void **unused) {
  (void)unused;
  static const char *const names[] = {"a/b/c", "a/b/c/", "a//b///c"};
  for (size_t i = 0; i < LENGTH(names); i++) {
    msr_sink sink;
    must(msr_frames_open(plan, path_of(names[i]), NULL, false, &sink, &why));
    assert_int_equal(run_into(plan, &sink, 1, NULL), MSR_OK);
    remove_frames("a/b/c", FRAMES);
    assert_int_equal(rmdir(path_of("a/b")), 0);
    assert_int_equal(rmdir(path_of("a")), 0);
  }
}

/* Frames that are there are never mixed with new ones, and nothing else is touched. */
static void frames_of_another_run_are_kept_or_replaced(void **unused) {
  (void)unused;
  static const char *const others[] = {"a/frame-00000.ppm",  "a/frame-0000000.pp",
                                       "a/frame-00000x.ppm", "a/frame.ppm",
                                       "a/Frame-000000.ppm", "a/frame-000000.ppm.bak"};
  msr_sink sink = {0};
  msr_error err;
  assert_int_equal(mkdir(path_of("a"), 0777), 0);
  for (size_t i = 0; i < LENGTH(others); i++) write_file(path_of(others[i]), "mine");
  assert_int_equal(msr_frames_open(plan, path_of("a"), NULL, false, &sink, &err), MSR_OK);
  must(msr_sink_close(&sink, &why));
  assert_null(sink.close);
  must(msr_sink_close(&sink, &why)); // again: nothing

  write_file(frame_path("a", 3), "mine");
  write_file(frame_path("a", 99), "mine");
  write_file(path_of("a/frame-1234567.ppm"), "mine");
  assert_int_equal(msr_frames_open(plan, path_of("a"), NULL, false, &sink, &err), MSR_EUSAGE);
  char message[600];
  snprintf(message, sizeof message,
           "%s: frames are there already; name another directory, or replace "
           "them (--force)",
           path_of("a"));
  assert_string_equal(err.message, message);
  assert_true(exists(frame_path("a", 3)) && exists(frame_path("a", 99)));
  assert_null(sink.write);

  assert_int_equal(msr_frames_open(plan, path_of("a"), NULL, true, &sink, &err), MSR_OK);
  assert_false(exists(frame_path("a", 3)) || exists(frame_path("a", 99)) ||
               exists(path_of("a/frame-1234567.ppm")));
  assert_int_equal(run_into(plan, &sink, 1, NULL), MSR_OK);
  for (size_t i = 0; i < LENGTH(others); i++) assert_int_equal(remove(path_of(others[i])), 0);
  remove_frames("a", FRAMES);
}

static void places_for_frames_that_are_none(void **unused) {
  (void)unused;
  msr_sink sink = {0};
  msr_error err;
  write_file(path_of("file"), "mine");
  assert_int_equal(msr_frames_open(plan, "", NULL, false, &sink, &err), MSR_EUSAGE);
  assert_string_equal(err.message, "the frames' directory needs a name");
  assert_int_equal(msr_frames_open(plan, path_of("file"), NULL, false, &sink, &err), MSR_EIO);
  assert_non_null(strstr(err.message, "file: cannot open it: Not a directory"));
  assert_int_equal(msr_frames_open(plan, path_of("file/a"), NULL, false, &sink, &err), MSR_EIO);
  assert_non_null(strstr(err.message, "file/a: cannot make it: Not a directory"));
  remove(path_of("file"));
  assert_int_equal(mkdir(path_of("a"), 0777), 0);
  assert_int_equal(mkdir(frame_path("a", 0), 0777), 0); // named as a frame, and not to be removed
  assert_int_equal(msr_frames_open(plan, path_of("a"), NULL, true, &sink, &err), MSR_EIO);
  assert_non_null(strstr(err.message, "a: cannot empty it"));
  assert_int_equal(rmdir(frame_path("a", 0)), 0);
  assert_int_equal(rmdir(path_of("a")), 0);
  assert_null(sink.write);
}

/* The directory goes while the run is on: it stops, and says where. */
static void a_frame_that_cannot_be_written_stops_the_run(void **unused) {
  (void)unused;
  msr_sink sink;
  msr_error err = {.message = ""};
  must(msr_frames_open(plan, path_of("a"), NULL, false, &sink, &why));
  assert_int_equal(rmdir(path_of("a")), 0);
  msr_state *state = new_state(plan);
  assert_int_equal(msr_run(state, &(msr_run_options){.sinks = &sink, .n_sinks = 1}, &err), MSR_EIO);
  assert_non_null(strstr(err.message, "frame-000000.ppm: cannot write it: No such file"));
  assert_int_equal(msr_state_iteration(state), 0);
  msr_state_free(state);
  must(msr_sink_close(&sink, &why));
}

/* ---- Standard output */

/* Puts a file in its place while `sink` is opened by `open`, run and closed; returns the status. */
static msr_status run_to_stdout(const char *path, msr_status (*open_sink)(msr_sink *, msr_error *),
                                msr_error *err) {
  fflush(stdout);
  const int kept = dup(STDOUT_FILENO), file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  assert_true(kept >= 0 && file >= 0);
  dup2(file, STDOUT_FILENO);
  msr_sink sink = {0};
  msr_status status = open_sink(&sink, err);
  if (status == MSR_OK) status = run_into(plan, &sink, 1, err);
  dup2(kept, STDOUT_FILENO);
  close(kept);
  close(file);
  return status;
}

static msr_status frames_to_stdout(msr_sink *sink, msr_error *err) {
  return msr_frames_open(plan, "-", NULL, false, sink, err);
}

static msr_status stats_to_stdout(msr_sink *sink, msr_error *err) {
  return msr_stats_open(plan, "-", sink, err);
}

static void frames_stream_to_standard_output(void **unused) {
  (void)unused;
  static char bytes[MOST_BYTES], frame[MOST_BYTES];
  msr_sink sink;
  assert_int_equal(run_to_stdout(path_of("stream"), frames_to_stdout, NULL), MSR_OK);
  must(msr_frames_open(plan, path_of("a"), NULL, false, &sink, &why));
  assert_int_equal(run_into(plan, &sink, 1, NULL), MSR_OK);
  const size_t size = read_file(path_of("stream"), bytes);
  size_t at = 0;
  for (size_t i = 0; i < FRAMES; i++) {
    const size_t n = read_file(frame_path("a", i), frame);
    assert_true(at + n <= size);
    assert_memory_equal(bytes + at, frame, n);
    at += n;
  }
  assert_int_equal(at, size);
  remove(path_of("stream"));
  remove_frames("a", FRAMES);
}

static void statistics_stream_to_standard_output(void **unused) {
  (void)unused;
  static char bytes[MOST_BYTES], file[MOST_BYTES];
  msr_sink sink;
  assert_int_equal(run_to_stdout(path_of("stream"), stats_to_stdout, NULL), MSR_OK);
  must(msr_stats_open(plan, path_of("s.csv"), &sink, &why));
  assert_int_equal(run_into(plan, &sink, 1, NULL), MSR_OK);
  const size_t size = read_file(path_of("stream"), bytes);
  remove(path_of("stream"));
  const bool stray = remove("-") == 0;
  assert_int_equal(read_file(path_of("s.csv"), file), size);
  assert_memory_equal(file, bytes, size);
  assert_false(stray); // "-" is no file's name
  remove(path_of("s.csv"));
}

/* ---- Statistics */

static void statistics_are_exact(void **unused) {
  (void)unused;
  static char text[MOST_BYTES];
  static const char header[] = "frame,time,kinetic,spring,gravity,total,px,py,contacts,longest\n";
  msr_sink sink;
  must(msr_stats_open(plan, path_of("s.csv"), &sink, &why));
  assert_int_equal(run_into(plan, &sink, 1, NULL), MSR_OK);
  read_file(path_of("s.csv"), text);
  assert_int_equal(strncmp(text, header, sizeof header - 1), 0);
  char *at = text + sizeof header - 1;
  uint64_t contacts = 0;
  for (size_t i = 0; i < FRAMES; i++) {
    const msr_energy *e = &due.energy[i];
    const double columns[] = {(double)i, due.t[i],   e->kinetic,
                              e->spring, e->gravity, e->total,
                              e->px,     e->py,      (double)(due.contacts[i] - contacts),
                              e->longest};
    contacts = due.contacts[i];
    for (size_t c = 0; c < LENGTH(columns); c++) {
      assert_true(strtod(at, &at) == columns[c]); // reads back to the bit
      assert_int_equal(*at++, c + 1 < LENGTH(columns) ? ',' : '\n');
    }
  }
  assert_int_equal(*at, '\0');
  remove(path_of("s.csv"));
}

static msr_status count_down(void *data, const msr_state *state) {
  (void)state;
  uint64_t *left = data;
  return (*left)-- == 0 ? MSR_EINTR : MSR_OK;
}

/* Without a single row no file is kept; with some, those. */
static void a_file_without_frames_is_not_kept(void **unused) {
  (void)unused;
  msr_sink sinks[2];
  must(msr_stats_open(plan, path_of("s.csv"), &sinks[0], &why));
  must(msr_trajectory_open(plan, path_of("t.npy"), &sinks[1], &why));
  for (int s = 0; s < 2; s++) must(msr_sink_close(&sinks[s], &why));
  assert_false(exists(path_of("s.csv")) || exists(path_of("t.npy")));
  write_file(path_of("s.csv"), "mine"); // nor is one that was there lost
  must(msr_stats_open(plan, path_of("s.csv"), &sinks[0], &why));
  must(msr_sink_close(&sinks[0], &why));
  char text[MOST_BYTES];
  assert_int_equal(read_file(path_of("s.csv"), text), 4);
  remove(path_of("s.csv"));
}

/* ---- Trajectories */

typedef struct array {
  uint64_t frames, masses, width;
  size_t data; /* where the numbers begin */
} array;

/* Reads the header as NumPy does: magic, version 1.0, length, dictionary. */
static array read_header(const char *bytes) {
  static const unsigned char magic[] = {0x93, 'N', 'U', 'M', 'P', 'Y', 1, 0};
  assert_memory_equal(bytes, magic, sizeof magic);
  const unsigned char *length = (const unsigned char *)bytes + 8;
  const size_t header = (size_t)length[0] + 256U * length[1];
  array a = {.data = 10 + header};
  assert_true(a.data % 64 == 0 && bytes[a.data - 1] == '\n');
  const uint16_t one = 1;
  const char order = *(const unsigned char *)&one ? '<' : '>';
  assert_int_equal(strncmp(bytes + 10, "{'descr': '", 11), 0);
  assert_int_equal(bytes[21], order);
  assert_int_equal(strncmp(bytes + 22, "f8', 'fortran_order': False, 'shape': (", 39), 0);
  char *at;
  a.frames = strtoull(bytes + 61, &at, 10);
  a.masses = strtoull(at + 1, &at, 10);
  a.width = strtoull(at + 1, &at, 10);
  assert_int_equal(strncmp(at, "), }", 4), 0);
  for (at += 4; at < bytes + a.data - 1; at++) assert_int_equal(*at, ' ');
  return a;
}

static void assert_trajectory(const char *path, size_t frames) {
  static char bytes[MOST_BYTES];
  const size_t size = read_file(path, bytes);
  const array a = read_header(bytes);
  assert_true(a.frames == frames && a.masses == MASSES && a.width == 4);
  assert_int_equal(size - a.data, frames * sizeof due.numbers[0]);
  assert_memory_equal(bytes + a.data, due.numbers, frames * sizeof due.numbers[0]);
}

static void trajectories_hold_every_bit(void **unused) {
  (void)unused;
  msr_sink sink;
  must(msr_trajectory_open(plan, path_of("t.npy"), &sink, &why));
  assert_int_equal(run_into(plan, &sink, 1, NULL), MSR_OK);
  assert_trajectory(path_of("t.npy"), FRAMES);
  remove(path_of("t.npy"));
}

/* More masses than the sink writes at a time. */
static void large_trajectories_are_whole(void **unused) {
  (void)unused;
  enum { MANY = 2500 };
  static char bytes[1 << 18];
  msr_scene *scene;
  msr_plan *large;
  msr_sink sink;
  must(msr_scene_create(&scene, &why));
  for (int i = 0; i < MANY; i++) {
    const msr_mass mass = {.x = i, .y = -i, .vx = 2 * i, .vy = 3 * i, .m = 1};
    must(msr_scene_add_mass(scene, &mass, NULL, &why));
  }
  must(msr_plan_create(scene, NULL, &large, &why));
  must(msr_trajectory_open(large, path_of("t.npy"), &sink, &why));
  assert_int_equal(run_into(large, &sink, 1, NULL), MSR_OK);
  FILE *file = fopen(path_of("t.npy"), "rb");
  assert_non_null(file);
  const size_t size = fread(bytes, 1, sizeof bytes, file);
  assert_int_equal(fclose(file), 0);
  const array a = read_header(bytes);
  assert_true(a.frames == 1 && a.masses == MANY);
  assert_int_equal(size, a.data + MANY * 4 * sizeof(double));
  for (int i = 0; i < MANY; i++) {
    double row[4];
    memcpy(row, bytes + a.data + (size_t)i * sizeof row, sizeof row);
    assert_true(row[0] == i && row[1] == -i && row[2] == 2 * i && row[3] == 3 * i);
  }
  remove(path_of("t.npy"));
  msr_plan_free(large);
  msr_scene_free(scene);
}

/* A run that ends early leaves files that are whole: fewer frames, and the header says so. */
static void a_run_stopped_early_leaves_whole_files(void **unused) {
  (void)unused;
  static char text[MOST_BYTES];
  uint64_t left = 15 * msr_plan_describe(plan).substeps;
  msr_state *state = new_state(plan);
  msr_sink sinks[3];
  must(msr_trajectory_open(plan, path_of("t.npy"), &sinks[0], &why));
  must(msr_stats_open(plan, path_of("s.csv"), &sinks[1], &why));
  must(msr_frames_open(plan, path_of("a"), NULL, false, &sinks[2], &why));
  const msr_run_options options = {
      .sinks = sinks, .n_sinks = 3, .poll = count_down, .poll_steps = 1, .data = &left};
  assert_int_equal(msr_run(state, &options, NULL), MSR_EINTR);
  msr_state_free(state);
  for (int s = 0; s < 3; s++) must(msr_sink_close(&sinks[s], &why));
  const size_t frames = 5; // at iterations 0, 3, 7, 11, 14
  assert_trajectory(path_of("t.npy"), frames);
  read_file(path_of("s.csv"), text);
  size_t lines = 0;
  for (const char *c = text; *c; c++) lines += *c == '\n';
  assert_int_equal(lines, 1 + frames);
  remove(path_of("t.npy"));
  remove(path_of("s.csv"));
  remove_frames("a", frames);
}

/* A pipe can't be mended: what was written stays. */
static void a_pipe_is_left_as_it_is(void **unused) {
  (void)unused;
  char bytes[MOST_BYTES];
  int ends[2];
  char path[32];
  uint64_t left = 0;
  assert_int_equal(pipe(ends), 0);
  snprintf(path, sizeof path, "/dev/fd/%d", ends[1]);
  msr_sink sink;
  must(msr_trajectory_open(plan, path, &sink, &why));
  msr_state *state = new_state(plan);
  const msr_run_options options = {
      .sinks = &sink, .n_sinks = 1, .poll = count_down, .poll_steps = 1, .data = &left};
  assert_int_equal(msr_run(state, &options, NULL), MSR_EINTR);
  must(msr_sink_close(&sink, &why));
  msr_state_free(state);
  close(ends[1]);
  const ssize_t size = read(ends[0], bytes, sizeof bytes);
  const array a = read_header(bytes);
  assert_true(a.frames == FRAMES && (size_t)size == a.data + sizeof due.numbers[0]);
  close(ends[0]);
}

/* ---- No space left */

/* One byte or many: the failure comes back, from the run or from the close at the latest. */
static void a_full_disk_is_told(void **unused) {
  (void)unused;
  msr_sink sink;
  msr_error err = {.message = ""};
  msr_state *state = new_state(plan);
  assert_int_equal(msr_stats_open(plan, "/dev/full", &sink, &err), MSR_OK);
  assert_int_equal(msr_run(state, &(msr_run_options){.sinks = &sink, .n_sinks = 1}, &err), MSR_EIO);
  assert_int_equal(msr_state_iteration(state), 0); // a row is handed on at once
  assert_int_equal(msr_sink_close(&sink, NULL), MSR_EIO);
  msr_state_free(state);
  assert_string_equal(err.message,
                      "/dev/full: cannot write it: No space left on device; free some space");
  err.message[0] = '\0';
  assert_int_equal(msr_trajectory_open(plan, "/dev/full", &sink, &err), MSR_OK);
  assert_int_equal(run_into(plan, &sink, 1, &err), MSR_EIO);
  assert_string_equal(err.message,
                      "/dev/full: cannot write it: No space left on device; free some space");
  assert_int_equal(run_to_stdout("/dev/full", frames_to_stdout, &err), MSR_EIO);
  assert_non_null(strstr(err.message, "No space left on device"));
}

/* Writes the state as a frame while files may have `most` bytes. */
static msr_status write_within(const msr_sink *sink, const msr_state *state, rlim_t most,
                               msr_error *err) {
  struct rlimit limit, low;
  getrlimit(RLIMIT_FSIZE, &limit);
  low = limit;
  low.rlim_cur = most;
  must(sink->write(sink->self, state, 0, &why));
  signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &low);
  const msr_status status = sink->complete(sink->self, 0, err);
  setrlimit(RLIMIT_FSIZE, &limit);
  signal(SIGXFSZ, SIG_DFL);
  return status;
}

/* Of a frame so large that it's written in pieces: a part leaves nothing, nor a trace in the next.
 */
static void a_part_of_a_frame_is_forgotten(void **unused) {
  (void)unused;
  enum { SCALE = 40, SIZE = 3 * SCALE * SCALE * WIDTH * HEIGHT };
  static char bytes[SIZE + 64];
  static const char header[] = "P6\n320 240\n255\n";
  const size_t start = sizeof header - 1;
  const msr_style style = {.scale = SCALE};
  msr_sink sink;
  msr_renderer *renderer;
  msr_error err = {.message = ""};
  msr_state *state = new_state(plan);
  must(msr_frames_open(plan, path_of("a"), &style, false, &sink, &why));
  must(msr_renderer_create(plan, &style, &renderer, &why));
  assert_int_equal(write_within(&sink, state, SIZE / 8, &err), MSR_EIO);
  assert_non_null(strstr(err.message, "File too large; raise the limit"));
  const msr_arrays a = msr_state_edit(state);
  for (size_t m = 0; m < MASSES; m++) a.x[m] += 3;
  must(write_within(&sink, state, sizeof bytes, &why));
  FILE *file = fopen(frame_path("a", 0), "rb");
  assert_non_null(file);
  assert_int_equal(fread(bytes, 1, sizeof bytes, file), start + SIZE);
  assert_int_equal(fclose(file), 0);
  assert_memory_equal(bytes, header, start);
  assert_memory_equal(bytes + start, msr_renderer_draw(renderer, state)->rgb, SIZE);
  must(msr_sink_close(&sink, &why));
  msr_renderer_free(renderer);
  msr_state_free(state);
  remove_frames("a", 1);
}

static void sinks_with_nowhere_to_go(void **unused) {
  (void)unused;
  msr_sink sink = {0};
  msr_error err;
  assert_int_equal(msr_stats_open(plan, "/nowhere/s.csv", &sink, &err), MSR_EIO);
  assert_int_equal(msr_trajectory_open(plan, directory, &sink, &err), MSR_EIO);
  assert_null(sink.write);
  msr_scene *scene;
  msr_plan *blank;
  must(msr_scene_create(&scene, &why));
  must(msr_plan_create(scene, NULL, &blank, &why));
  assert_int_equal(msr_frames_open(blank, path_of("a"), NULL, false, &sink, &err), MSR_EUSAGE);
  assert_string_equal(err.message, "a scene without a picture has no frames");
  assert_false(exists(path_of("a")));
  msr_plan_free(blank);
  msr_scene_free(scene);
}

/* ---- Sinks and polls of one's own */

typedef struct witness {
  uint64_t frames, failing; /* seen; the one that fails */
  uint64_t hash[2 * FRAMES], frame[2 * FRAMES];
} witness;

static msr_status see(void *self, const msr_state *state, uint64_t frame, msr_error *err) {
  (void)err;
  witness *w = self;
  assert_true(w->frames < 2 * FRAMES);
  w->hash[w->frames] = msr_state_hash(state);
  w->frame[w->frames++] = frame;
  return w->frames == w->failing ? MSR_EIO : MSR_OK;
}

/* Every frame once, in order, as it's due; the sinks one after the other. */
static void my_sinks_see_every_frame(void **unused) {
  (void)unused;
  witness a = {0}, b = {0};
  const msr_sink sinks[] = {{.self = &a, .write = see}, {.self = &b, .write = see}};
  msr_state *state = new_state(plan);
  must(msr_run(state, &(msr_run_options){.sinks = sinks, .n_sinks = 2}, &why));
  assert_int_equal(msr_state_iteration(state), ITERATIONS);
  assert_true(msr_state_view(state).t == ITERATIONS * 0.02);
  assert_int_equal(a.frames, FRAMES);
  for (size_t i = 0; i < FRAMES; i++) assert_true(a.frame[i] == i && a.hash[i] == due.hash[i]);
  assert_memory_equal(&a, &b, sizeof a);
  // what is at its end has nothing more to show
  must(msr_run(state, &(msr_run_options){.sinks = sinks, .n_sinks = 2}, &why));
  assert_int_equal(a.frames, FRAMES);
  msr_state_free(state);
  msr_sink mine = sinks[0];
  must(msr_sink_close(&mine, &why)); // no close of its own
}

static void a_failing_sink_stops_the_run(void **unused) {
  (void)unused;
  witness a = {.failing = 4}, b = {0};
  const msr_sink sinks[] = {{.self = &a, .write = see}, {.self = &b, .write = see}};
  msr_error err = {.message = ""};
  msr_state *state = new_state(plan);
  assert_int_equal(msr_run(state, &(msr_run_options){.sinks = sinks, .n_sinks = 2}, &err), MSR_EIO);
  assert_string_equal(err.message, "frame 3: input or output failed");
  assert_true(a.frames == 4 && b.frames == 3);
  assert_int_equal(msr_state_iteration(state), 3 * ITERATIONS / FRAMES);
  msr_state_free(state);
}

/* Stopped before any substep, even within an iteration, a run goes on to the same bits, and every
 * frame comes once, as it was due. */
static void a_run_goes_on_where_it_was_stopped(void **unused) {
  (void)unused;
  const uint64_t substeps = ITERATIONS * msr_plan_describe(plan).substeps;
  msr_state *whole = new_state(plan);
  must(msr_run(whole, NULL, &why));
  for (uint64_t stop = 0; stop < substeps; stop++) {
    witness w = {0};
    const msr_sink sink = {.self = &w, .write = see};
    msr_state *state = new_state(plan);
    uint64_t left = stop;
    const msr_run_options options = {
        .sinks = &sink, .n_sinks = 1, .poll = count_down, .poll_steps = 1, .data = &left};
    assert_int_equal(msr_run(state, &options, NULL), MSR_EINTR);
    assert_int_equal(msr_state_iteration(state), stop / msr_plan_describe(plan).substeps);
    must(msr_run(state, &(msr_run_options){.sinks = &sink, .n_sinks = 1}, &why));
    assert_true(msr_state_hash(state) == msr_state_hash(whole));
    assert_int_equal(msr_state_contacts(state), msr_state_contacts(whole));
    assert_int_equal(w.frames, FRAMES);
    for (size_t i = 0; i < FRAMES; i++) assert_true(w.frame[i] == i && w.hash[i] == due.hash[i]);
    msr_state_free(state);
  }
  msr_state_free(whole);
}

static msr_status return_it(void *data, const msr_state *state) {
  (void)state;
  return *(const msr_status *)data;
}

static void what_poll_returns_comes_back(void **unused) {
  (void)unused;
  static const msr_status statuses[] = {MSR_EIO,       MSR_ENOMEM, MSR_EUSAGE,    MSR_EINPUT,
                                        MSR_EUNSTABLE, MSR_EINTR,  (msr_status)77};
  for (size_t i = 0; i < LENGTH(statuses); i++) {
    msr_state *state = new_state(plan);
    msr_status status = statuses[i];
    msr_error err;
    assert_int_equal(msr_run(state, &(msr_run_options){.poll = return_it, .data = &status}, &err),
                     status);
    assert_int_equal(err.status, status);
    assert_true(strlen(err.message) > 0);
    msr_state_free(state);
  }
}

/* A state that is no longer sound isn't shown to a sink. */
static void unsound_frames_are_not_shown(void **unused) {
  (void)unused;
  witness w = {0};
  const msr_sink sink = {.self = &w, .write = see};
  msr_state *state = new_state(plan);
  msr_state_edit(state).x[2] = NO_NUMBER;
  assert_int_equal(msr_run(state, &(msr_run_options){.sinks = &sink, .n_sinks = 1}, NULL),
                   MSR_EUNSTABLE);
  assert_int_equal(w.frames, 0);
  msr_state_free(state);
}

/* No iteration: one frame, the scene. */
static void a_run_of_no_iteration_shows_the_scene(void **unused) {
  (void)unused;
  witness w = {0};
  const msr_sink sink = {.self = &w, .write = see};
  msr_plan *still = plan_of(0, 1);
  msr_state *state = new_state(still);
  must(msr_run(state, &(msr_run_options){.sinks = &sink, .n_sinks = 1}, &why));
  assert_int_equal(w.frames, 1);
  assert_true(w.hash[0] == due.hash[0]);
  msr_state_free(state);
  msr_plan_free(still);
}

/* ---- Threads */

static void *run_to_the_end(void *hash) {
  msr_state *state;
  *(uint64_t *)hash = 0;
  if (msr_state_create(plan, &state, NULL) != MSR_OK) return NULL;
  if (msr_run(state, NULL, NULL) == MSR_OK) *(uint64_t *)hash = msr_state_hash(state);
  msr_state_free(state);
  return NULL;
}

static void threads_share_a_plan(void **unused) {
  (void)unused;
  enum { THREADS = 4 };
  pthread_t threads[THREADS];
  uint64_t hashes[THREADS], alone;
  run_to_the_end(&alone);
  assert_true(alone != 0);
  for (int i = 0; i < THREADS; i++)
    assert_int_equal(pthread_create(&threads[i], NULL, run_to_the_end, &hashes[i]), 0);
  for (int i = 0; i < THREADS; i++) {
    assert_int_equal(pthread_join(threads[i], NULL), 0);
    assert_true(hashes[i] == alone);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(frames_are_pictures_of_their_states),
      cmocka_unit_test(directories_above_are_made),
      cmocka_unit_test(frames_of_another_run_are_kept_or_replaced),
      cmocka_unit_test(places_for_frames_that_are_none),
      cmocka_unit_test(a_frame_that_cannot_be_written_stops_the_run),
      cmocka_unit_test(frames_stream_to_standard_output),
      cmocka_unit_test(statistics_stream_to_standard_output),
      cmocka_unit_test(statistics_are_exact),
      cmocka_unit_test(a_file_without_frames_is_not_kept),
      cmocka_unit_test(trajectories_hold_every_bit),
      cmocka_unit_test(large_trajectories_are_whole),
      cmocka_unit_test(a_run_stopped_early_leaves_whole_files),
      cmocka_unit_test(a_pipe_is_left_as_it_is),
      cmocka_unit_test(a_full_disk_is_told),
      cmocka_unit_test(a_part_of_a_frame_is_forgotten),
      cmocka_unit_test(sinks_with_nowhere_to_go),
      cmocka_unit_test(my_sinks_see_every_frame),
      cmocka_unit_test(a_failing_sink_stops_the_run),
      cmocka_unit_test(a_run_goes_on_where_it_was_stopped),
      cmocka_unit_test(what_poll_returns_comes_back),
      cmocka_unit_test(unsound_frames_are_not_shown),
      cmocka_unit_test(a_run_of_no_iteration_shows_the_scene),
      cmocka_unit_test(threads_share_a_plan),
  };
  return cmocka_run_group_tests_name("run", tests, set_up, tear_down);
}
