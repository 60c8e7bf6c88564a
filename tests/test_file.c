/* test_file.c - files in and out: whatever is read comes whole or not at all, and a file that is
 * written replaces the old one at once or leaves everything as it was.
 * link: --wrap=malloc --wrap=calloc --wrap=realloc */
#include "base/file.h"
#include "base/pipe.h"

#include "alloc.h"
#include "files.h"

#include <dirent.h>
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

static void check_content(const char *path, const char *text) {
  unsigned char *bytes = NULL;
  size_t size = 0;
  msr_error err;
  if (msri_file_read(path, 1000, &bytes, &size, &err)) fail_msg("%s", err.message);
  assert_int_equal(size, strlen(text));
  assert_memory_equal(bytes, text, size);
  free(bytes);
}

/* Files in the directory, `.` and `..` apart. */
static int count_files(void) {
  DIR *stream = opendir(directory);
  int n = -2;
  assert_non_null(stream);
  while (readdir(stream)) n++;
  closedir(stream);
  return n;
}

static int free_descriptor; /* the lowest one at the start */

static int lowest_free_descriptor(void) {
  const int fd = dup(STDIN_FILENO);
  close(fd);
  return fd;
}

static int set_up(void **state) {
  free_descriptor = lowest_free_descriptor();
  return make_directory(state);
}

/* ---- Reading */

static void check_unreadable(const char *path, size_t limit, msr_status status,
                             const char *message) {
  unsigned char *bytes = NULL;
  size_t size = 7;
  msr_error err;
  char text[MSR_MESSAGE_SIZE];
  snprintf(text, sizeof text, "%s%s", path, message);
  assert_int_equal(msri_file_read(path, limit, &bytes, &size, &err), status);
  assert_string_equal(err.message, text);
  assert_null(bytes);
  assert_int_equal(size, 7);
}

static void files_are_read_whole(void **state) {
  (void)state;
  write_file(path_of("empty"), "");
  check_content(path_of("empty"), "");
  write_file(path_of("short"), "short");
  check_content(path_of("short"), "short");
  unlink(path_of("empty"));
  unlink(path_of("short"));
}

static void what_cannot_be_read_says_why(void **state) {
  (void)state;
  check_unreadable(path_of("none"), 9, MSR_EIO,
                   ": cannot read it: No such file or directory; check its name");
  check_unreadable(directory, 9, MSR_EIO,
                   ": cannot read it: Is a directory; give a file, not a directory");
  check_unreadable("/dev/null/x", 9, MSR_EIO, ": cannot read it: Not a directory; check its name");
}

static void no_more_than_the_limit_is_read(void **state) {
  (void)state;
  static const char message[] =
      ":1:1: larger than the 9 bytes that are read at most; check that it is the right file";
  write_file(path_of("ten"), "0123456789");
  check_unreadable(path_of("ten"), 9, MSR_EINPUT, message);
  check_unreadable("/dev/zero", 9, MSR_EINPUT, message);
  assert_int_equal(truncate(path_of("ten"), 1 << 30), 0);
  alloc_largest = 0;
  check_unreadable(path_of("ten"), 9, MSR_EINPUT, message);
  assert_true(alloc_largest < 1 << 20);
  unlink(path_of("ten"));
}

static msr_status refuse(const char *path, const unsigned char *head, size_t size, msr_error *err) {
  assert_int_equal(size, MSRI_FILE_HEAD);
  assert_int_equal(head[size - 1], 0);
  return msri_fail(err, MSR_EUSAGE, "%s: no", path);
}

static void a_look_at_the_head_is_enough(void **state) {
  (void)state;
  unsigned char *bytes = NULL;
  size_t size = 7;
  assert_int_equal(msri_file_read_if("/dev/zero", 1 << 30, refuse, &bytes, &size, NULL),
                   MSR_EUSAGE);
  assert_null(bytes);
}

static void ignore(int number) { (void)number; }

/* Runs `child` in another process; the parent gets its id. */
static pid_t run(void (*child)(const char *), const char *path) {
  const pid_t pid = fork();
  assert_true(pid >= 0);
  if (pid > 0) return pid;
  child(path);
  _exit(0);
}

/* A signal to the reader while it waits. */
static void disturb(void) {
  const struct timespec pause = {0, 2000000};
  nanosleep(&pause, NULL);
  kill(getppid(), SIGUSR1);
  nanosleep(&pause, NULL);
}

/* 300 000 bytes in small pieces, with signals before and between them. */
static void dribble(const char *path) {
  char bytes[3000];
  memset(bytes, 'x', sizeof bytes);
  disturb();
  const int fd = open(path, O_WRONLY);
  for (int i = 0; i < 100; i++) {
    if (i % 10 == 0) disturb();
    if (write(fd, bytes, sizeof bytes) != sizeof bytes) _exit(1);
  }
  close(fd);
}

static void a_pipe_is_read_through_signals(void **state) {
  (void)state;
  const struct sigaction action = {.sa_handler = ignore}; // no SA_RESTART
  struct sigaction before;
  unsigned char *bytes = NULL;
  size_t size = 0;
  int status = 1;
  assert_int_equal(mkfifo(path_of("pipe"), 0600), 0);
  sigaction(SIGUSR1, &action, &before);
  const pid_t pid = run(dribble, path_of("pipe"));
  msr_error err;
  if (msri_file_read(path_of("pipe"), 1 << 20, &bytes, &size, &err)) fail_msg("%s", err.message);
  assert_int_equal(size, 300000);
  for (size_t i = 0; i < size; i++) assert_true(bytes[i] == 'x');
  while (waitpid(pid, &status, 0) < 0) {
  }
  assert_int_equal(status, 0);
  sigaction(SIGUSR1, &before, NULL);
  free(bytes);
  unlink(path_of("pipe"));
}

/* ---- Writing */

static msri_file create(const char *path) {
  msri_file file;
  msr_error err;
  if (msri_file_create(path, &file, &err)) fail_msg("%s", err.message);
  if (msri_file_write(&file, "new", 3, &err)) fail_msg("%s", err.message);
  return file;
}

/* For devices: a file that isn't written directly is never committed, lest it replace one. */
static msri_file create_direct(const char *path) {
  msri_file file = create(path);
  const bool direct = !*file.temporary;
  if (!direct) msri_file_abandon(&file);
  assert_true(direct);
  return file;
}

static void commit(msri_file *file) {
  msr_error err;
  if (msri_file_commit(file, &err)) fail_msg("%s", err.message);
  assert_null(file->stream);
}

static void a_file_appears_whole(void **state) {
  (void)state;
  msri_file file = create(path_of("new"));
  assert_int_equal(msri_file_flush(&file, NULL), MSR_OK);
  assert_int_not_equal(access(path_of("new"), F_OK), 0);
  commit(&file);
  check_content(path_of("new"), "new");
  assert_int_equal(count_files(), 1);
  unlink(path_of("new"));
}

static void an_abandoned_file_leaves_nothing(void **state) {
  (void)state;
  write_file(path_of("old"), "old");
  msri_file file = create(path_of("old")), other = create(path_of("other")),
            none = {.stream = NULL};
  msri_file_abandon(&file);
  msri_file_abandon(&file);
  msri_file_abandon(&other);
  msri_file_abandon(&none);
  check_content(path_of("old"), "old");
  assert_int_equal(count_files(), 1);
  unlink(path_of("old"));
}

static void two_may_be_written_at_once(void **state) {
  (void)state;
  msri_file first = create(path_of("a")), second = create(path_of("a"));
  msri_file_abandon(&first);
  commit(&second);
  check_content(path_of("a"), "new");
  assert_int_equal(count_files(), 1);
  unlink(path_of("a"));
}

static mode_t mode_of(const char *path) {
  struct stat st;
  assert_int_equal(lstat(path, &st), 0);
  return st.st_mode & 07777;
}

static void permissions_are_the_usual_ones(void **state) {
  (void)state;
  const mode_t before = umask(027);
  msri_file file = create(path_of("new"));
  commit(&file);
  assert_int_equal(mode_of(path_of("new")), 0640);
  assert_int_equal(chmod(path_of("new"), 0604), 0);
  file = create(path_of("new"));
  commit(&file);
  assert_int_equal(mode_of(path_of("new")), 0604);
  umask(before);
  unlink(path_of("new"));
}

static void a_link_is_followed(void **state) {
  (void)state;
  struct stat st;
  write_file(path_of("file"), "old");
  assert_int_equal(symlink("file", path_of("link")), 0);
  msri_file file = create(path_of("link"));
  commit(&file);
  check_content(path_of("file"), "new");
  assert_int_equal(lstat(path_of("link"), &st), 0);
  assert_true(S_ISLNK(st.st_mode));
  assert_int_equal(count_files(), 2);
  unlink(path_of("link"));
  unlink(path_of("file"));
}

static void a_name_alone_is_enough(void **state) {
  (void)state;
  char before[512];
  assert_non_null(getcwd(before, sizeof before));
  assert_int_equal(chdir(directory), 0);
  msri_file file = create("alone");
  commit(&file);
  assert_int_equal(chdir(before), 0);
  check_content(path_of("alone"), "new");
  unlink(path_of("alone"));
}

static void read_new(const char *path) {
  char text[8] = "";
  const int fd = open(path, O_RDONLY);
  _exit(read(fd, text, sizeof text) == 3 && memcmp(text, "new", 3) == 0 ? 0 : 1);
}

static void devices_and_pipes_are_written_directly(void **state) {
  (void)state;
  int status = 1;
  assert_int_equal(mkfifo(path_of("pipe"), 0600), 0);
  const pid_t pid = run(read_new, path_of("pipe"));
  msri_file file = create_direct(path_of("pipe"));
  commit(&file);
  assert_int_equal(waitpid(pid, &status, 0), pid);
  assert_int_equal(status, 0);
  file = create_direct("/dev/null");
  commit(&file);
  assert_int_equal(count_files(), 1);
  unlink(path_of("pipe"));
}

/* Bytes that a pipe takes before anybody reads. */
static size_t capacity_of(bool widened) {
  static const char bytes[4096];
  int ends[2];
  assert_int_equal(pipe(ends), 0);
  if (widened) msri_pipe_widen(ends[1]);
  assert_int_equal(fcntl(ends[1], F_SETFL, O_NONBLOCK), 0);
  size_t size = 0;
  for (ssize_t n = 0; n >= 0; size += n > 0 ? (size_t)n : 0)
    n = write(ends[1], bytes, sizeof bytes);
  close(ends[0]);
  close(ends[1]);
  return size;
}

static void pipes_are_widened(void **state) {
  (void)state;
  const size_t before = capacity_of(false), after = capacity_of(true);
#ifdef __linux__
  assert_true(after > before);
#else
  assert_true(after >= before);
#endif
  msri_pipe_widen(-1); // what is no pipe is left alone
}

/* Redirects `fd` to a file that holds "old" and writes to `path`, which stands for it. */
static void check_standing(int fd, const char *path) {
  const int before = dup(fd), file_fd = open(path_of("out"), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  assert_true(before >= 0 && file_fd >= 0);
  assert_int_equal(write(file_fd, "old", 3), 3);
  assert_int_equal(dup2(file_fd, fd), fd);
  msri_file file = create(path);
  commit(&file);
  const ssize_t written = write(fd, "!", 1);
  dup2(before, fd);
  close(before);
  close(file_fd);
  assert_int_equal(written, 1);
  check_content(path_of("out"), "oldnew!");
  assert_int_equal(count_files(), 1);
  unlink(path_of("out"));
}

static void standard_output_goes_on_where_it_was(void **state) {
  (void)state;
  char path[32];
  fflush(stdout);
  check_standing(STDOUT_FILENO, "/dev/stdout");
  check_standing(STDERR_FILENO, "/dev/stderr");
  const int fd = open("/dev/null", O_WRONLY);
  snprintf(path, sizeof path, "/dev/fd/%d", fd);
  check_standing(fd, path);
  close(fd);
}

static void check_unwritable(const char *path, const char *message) {
  msri_file file;
  msr_error err;
  char text[MSR_MESSAGE_SIZE];
  snprintf(text, sizeof text, "%s%s", path, message);
  assert_int_equal(msri_file_create(path, &file, &err), MSR_EIO);
  assert_string_equal(err.message, text);
}

static void what_cannot_be_written_says_why(void **state) {
  (void)state;
  check_unwritable(directory, ": cannot write it: Is a directory; give a file, not a directory");
  check_unwritable(path_of("none/x"),
                   ": cannot write it: No such file or directory; check its name");
  check_unwritable("/dev/fd/99999", ": cannot write it: Bad file descriptor; check its name");
  check_unwritable("/dev/fd/x", ": cannot write it: No such file or directory; check its name");
  check_unwritable("/dev/fd/", ": cannot write it: Is a directory; give a file, not a directory");
  char path[32];
  const int fd = open("/dev/null", O_RDONLY);
  snprintf(path, sizeof path, "/dev/fd/%d", fd);
  check_unwritable(path, ": cannot write it: Invalid argument; check the disk or the device");
  close(fd);
}

static void a_full_disk_is_noticed(void **state) {
  (void)state;
  static const char message[] =
      "/dev/full: cannot write it: No space left on device; free some space";
  static const char bytes[100000];
  msr_error err;
  // When the file is flushed,
  msri_file file = create_direct("/dev/full");
  assert_int_equal(msri_file_flush(&file, &err), MSR_EIO);
  assert_string_equal(err.message, message);
  msri_file_abandon(&file);
  // when it is closed,
  file = create_direct("/dev/full");
  assert_int_equal(msri_file_commit(&file, &err), MSR_EIO);
  assert_string_equal(err.message, message);
  // at once,
  file = create_direct("/dev/full");
  assert_int_equal(msri_file_write(&file, bytes, sizeof bytes, &err), MSR_EIO);
  assert_string_equal(err.message, message);
  // and by those who didn't look when it happened,
  assert_int_equal(msri_file_flush(&file, &err), MSR_EIO);
  // even when it's closed.
  assert_int_equal(msri_file_commit(&file, &err), MSR_EIO);
  assert_memory_equal(err.message, message, 27);
}

static void a_file_that_cannot_take_its_name_is_removed(void **state) {
  (void)state;
  msri_file file = create(path_of("new"));
  assert_int_equal(mkdir(path_of("new"), 0700), 0);
  msr_error err;
  assert_int_equal(msri_file_commit(&file, &err), MSR_EIO);
  assert_non_null(strstr(err.message, "new: cannot write it: "));
  assert_int_equal(count_files(), 1);
  assert_int_equal(rmdir(path_of("new")), 0);
}

static bool attempt_create(void) {
  msri_file file;
  if (msri_file_create("/dev/null", &file, NULL)) return false;
  msri_file_abandon(&file);
  return true;
}

static bool attempt_read(void) {
  unsigned char *bytes = NULL;
  size_t size = 0;
  const bool done = msri_file_read(path_of("large"), 1 << 20, &bytes, &size, NULL) == MSR_OK;
  assert_int_equal(size, done ? 100000 : 0);
  free(bytes);
  return done;
}

static void running_out_of_memory_is_an_error(void **state) {
  (void)state;
  msri_file file = create(path_of("large"));
  assert_int_equal(ftruncate(fileno(file.stream), 100000), 0);
  commit(&file);
  assert_int_equal(alloc_fail_each(attempt_create), 1);
  assert_int_equal(alloc_fail_each(attempt_read), 2);
  unlink(path_of("large"));
}

static void no_descriptor_is_left_open(void **state) {
  (void)state;
  assert_int_equal(lowest_free_descriptor(), free_descriptor);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(files_are_read_whole),
      cmocka_unit_test(what_cannot_be_read_says_why),
      cmocka_unit_test(no_more_than_the_limit_is_read),
      cmocka_unit_test(a_look_at_the_head_is_enough),
      cmocka_unit_test(a_pipe_is_read_through_signals),
      cmocka_unit_test(a_file_appears_whole),
      cmocka_unit_test(an_abandoned_file_leaves_nothing),
      cmocka_unit_test(two_may_be_written_at_once),
      cmocka_unit_test(permissions_are_the_usual_ones),
      cmocka_unit_test(a_link_is_followed),
      cmocka_unit_test(a_name_alone_is_enough),
      cmocka_unit_test(devices_and_pipes_are_written_directly),
      cmocka_unit_test(pipes_are_widened),
      cmocka_unit_test(standard_output_goes_on_where_it_was),
      cmocka_unit_test(what_cannot_be_written_says_why),
      cmocka_unit_test(a_full_disk_is_noticed),
      cmocka_unit_test(a_file_that_cannot_take_its_name_is_removed),
      cmocka_unit_test(running_out_of_memory_is_an_error),
      cmocka_unit_test(no_descriptor_is_left_open),
  };
  return cmocka_run_group_tests(tests, set_up, remove_directory);
}
