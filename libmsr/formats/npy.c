/* npy.c - the header of a NumPy array file, version 1.0: magic, version, the length of what
 * follows (16 bits, little endian), a Python dictionary, spaces and a line feed. The data begin at
 * a multiple of 64 bytes. */
#include "formats/npy.h"

#include "base/number.h"

#include <inttypes.h>
#include <string.h>

enum { PREAMBLE = 10, LENGTH = MSRI_NPY_HEADER_SIZE - PREAMBLE };

static char byte_order(void) {
  const uint16_t one = 1;
  unsigned char low;
  memcpy(&low, &one, 1);
  return low ? '<' : '>';
}

void msri_npy_header(uint64_t frames, uint64_t masses, unsigned char header[MSRI_NPY_HEADER_SIZE]) {
  static const unsigned char preamble[] = {0x93, 'N', 'U', 'M', 'P', 'Y', 1, 0, LENGTH, 0};
  char text[LENGTH];
  const int n = msri_format(text, sizeof text,
                            "{'descr': '%cf8', 'fortran_order': False, 'shape': (%" PRIu64
                            ", %" PRIu64 ", 4), }",
                            byte_order(), frames, masses);
  memset(header, ' ', MSRI_NPY_HEADER_SIZE);
  memcpy(header, preamble, PREAMBLE);
  memcpy(header + PREAMBLE, text, (size_t)n);
  header[MSRI_NPY_HEADER_SIZE - 1] = '\n';
}
