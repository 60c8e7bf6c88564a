/* target.c - see target.h. */
#if defined(__linux__)
#define _GNU_SOURCE // for F_SETPIPE_SZ
#endif
#include "target.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

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

target target_open(place where) {
  target t = {.place = where};
  snprintf(t.directory, sizeof t.directory, "%s/frames", scratch);
  if (where == FILES) mkdir(t.directory, 0777);
  if (where != PIPE) return t;
  fflush(stdout);
  t.real = dup(STDOUT_FILENO);
  const int to = open_pipe(&t.reader);
#ifdef F_SETPIPE_SZ
  fcntl(to, F_SETPIPE_SZ, 1 << 20);
#endif
  dup2(to, STDOUT_FILENO);
  close(to);
  return t;
}

void target_drain(target *t) {
  if (t->place != PIPE) return;
  dup2(t->real, STDOUT_FILENO);
  close(t->real);
  waitpid(t->reader, NULL, 0);
}

static void name_frame(const target *t, uint64_t frame, char *path, size_t size) {
  snprintf(path, size, "%s/frame-%06d.ppm", t->directory, (int)frame);
}

void target_remove(const target *t, uint64_t frames) {
  char path[600];
  for (uint64_t i = 0; t->place == FILES && i < frames; i++) {
    name_frame(t, i, path, sizeof path);
    remove(path);
  }
  if (t->place == FILES) rmdir(t->directory);
}

/* ---- Frames */

static void write_bytes(int to, const char *bytes, size_t size) {
  while (size > 0) {
    const ssize_t n = write(to, bytes, size < 1 << 18 ? size : 1 << 18);
    if (n <= 0) bench_fail("bytes can't be written");
    bytes += n, size -= (size_t)n;
  }
}

void target_write(const target *t, uint64_t frame, const char *bytes, size_t size) {
  char path[600];
  name_frame(t, frame, path, sizeof path);
  const int to = t->place == PIPE ? STDOUT_FILENO : open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  write_bytes(to, bytes, size);
  if (t->place == FILES) close(to);
}
