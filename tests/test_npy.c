/* test_npy.c - the header of a NumPy array against the definition of format 1.0:
 * https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html */
#include "formats/npy.h"

#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static const struct shape {
  uint64_t frames, masses;
} shapes[] = {{0, 0}, {1, 1}, {800, 1000}, {UINT64_MAX, UINT64_MAX}};

static void check_header(const struct shape *shape) {
  unsigned char header[MSRI_NPY_HEADER_SIZE + 1] = {[MSRI_NPY_HEADER_SIZE] = 0xAA};
  char text[128];
  msri_npy_header(shape->frames, shape->masses, header);
  assert_memory_equal(header, "\x93NUMPY\x01\x00", 8);
  assert_int_equal(header[8] + 256 * header[9], MSRI_NPY_HEADER_SIZE - 10);
  assert_int_equal(MSRI_NPY_HEADER_SIZE % 64, 0);
  const uint16_t one = 1;
  snprintf(text, sizeof text,
           "{'descr': '%cf8', 'fortran_order': False, 'shape': (%" PRIu64 ", %" PRIu64 ", 4), }",
           *(const unsigned char *)&one ? '<' : '>', shape->frames, shape->masses);
  assert_memory_equal(header + 10, text, strlen(text));
  for (size_t i = 10 + strlen(text); i < MSRI_NPY_HEADER_SIZE - 1; i++)
    assert_int_equal(header[i], ' ');
  assert_int_equal(header[MSRI_NPY_HEADER_SIZE - 1], '\n');
  assert_int_equal(header[MSRI_NPY_HEADER_SIZE], 0xAA);
}

static void the_header_is_as_defined(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) check_header(&shapes[i]);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_header_is_as_defined)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
