/* files.h - a directory of the test's own, for tests that write files. */
#ifndef TESTS_FILES_H
#define TESTS_FILES_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

static char directory[256];

static inline int make_directory(void **unused) {
  (void)unused;
  const char *parent = getenv("TMPDIR");
  snprintf(directory, sizeof directory, "%s/msr-test-XXXXXX", parent ? parent : "/tmp");
  return mkdtemp(directory) ? 0 : -1;
}

/* It must be empty again: no temporary file was forgotten. */
static inline int remove_directory(void **unused) {
  (void)unused;
  return rmdir(directory);
}

/* Path of a file in it; the next three calls leave it alone. */
static inline const char *path_of(const char *name) {
  static char paths[4][512];
  static size_t turn;
  char *path = paths[turn++ % 4];
  snprintf(path, sizeof *paths, "%s/%s", directory, name);
  return path;
}

static inline void write_file(const char *path, const char *text) {
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  assert_true(fputs(text, file) >= 0);
  assert_int_equal(fclose(file), 0);
}

#endif
