/* test_corpus.c - runs every fuzzer on every file of its corpus, so that what fuzzing found stays
 * found. The entry of fuzz/fuzz_x.c is called fuzz_x here. */
#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

typedef int fuzzer(const uint8_t *data, size_t size);
fuzzer fuzz_ppm, fuzz_conf;

/* The bytes are in a block of their size, so that a sanitizer or valgrind sees one read too many.
 */
static void run_file(fuzzer *run, const char *path) {
  FILE *stream = fopen(path, "rb");
  if (!stream || fseek(stream, 0, SEEK_END) != 0) fail_msg("%s", path);
  const size_t size = (size_t)ftell(stream);
  uint8_t *bytes = malloc(size);
  rewind(stream);
  assert_int_equal(fread(bytes, 1, size, stream), size);
  fclose(stream);
  assert_int_equal(run(bytes, size), 0);
  free(bytes);
}

static void run_directory(fuzzer *run, const char *directory) {
  char path[512];
  size_t files = 0;
  DIR *stream = opendir(directory);
  if (!stream) fail_msg("%s", directory);
  for (const struct dirent *entry; (entry = readdir(stream));) {
    if (entry->d_name[0] == '.') continue;
    snprintf(path, sizeof path, "%s/%s", directory, entry->d_name);
    run_file(run, path);
    files++;
  }
  closedir(stream);
  assert_true(files > 10);
}

static void pictures(void **state) {
  (void)state;
  run_directory(fuzz_ppm, "tests/fuzz/corpus/ppm");
}

static void confs(void **state) {
  (void)state;
  run_directory(fuzz_conf, "tests/fuzz/corpus/conf");
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(pictures), cmocka_unit_test(confs)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
