/* fuzz_ppm.c - no bytes may make the picture reader misbehave, and what it accepts it writes and
 * reads back as the same picture. */
#include "formats/ppm.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool condition) {
  if (!condition) abort();
}

static void check_message(const msr_error *err) {
  require(err->status == MSR_EINPUT || err->status == MSR_ENOMEM);
  require(strncmp(err->message, "fuzz:", 5) == 0 && !strchr(err->message, '\n'));
}

static void check_round_trip(const msr_picture *picture) {
  char *bytes = NULL;
  size_t size = 0;
  bool more = true;
  msr_picture *back = NULL;
  FILE *stream = open_memstream(&bytes, &size);
  require(stream && msri_ppm_write(stream, picture) && fclose(stream) == 0);
  require(msr_picture_parse("fuzz", bytes, size, &back, &more, NULL) == MSR_OK && !more);
  require(back->width == picture->width && back->height == picture->height);
  require(memcmp(back->rgb, picture->rgb, 3 * picture->width * picture->height) == 0);
  msr_picture_free(back);
  free(bytes);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  msr_picture *picture = NULL;
  msr_error err = {.status = MSR_OK};
  if (msr_picture_parse("fuzz", data, size, &picture, NULL, &err)) {
    check_message(&err);
    return 0;
  }
  // Three bytes a pixel is the least that a file can take.
  require(picture->width > 0 && picture->height > 0);
  require(3 * picture->width * picture->height <= size);
  check_round_trip(picture);
  msr_picture_free(picture);
  return 0;
}
