/* ppm_write.c - pictures in memory, and out of it as binary PPM. */
#include "formats/ppm.h"

#include "base/file.h"
#include "base/number.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

msr_status msr_picture_create(size_t width, size_t height, msr_picture **picture, msr_error *err) {
  if (width == 0 || height == 0 || width > SIZE_MAX / 3 / height)
    return msri_fail(err, MSR_EUSAGE, "a picture can't be %zu x %zu pixels; %s", width, height,
                     "choose sides of 1 or more that fit in memory");
  msr_picture *p = msri_alloc(1, sizeof *p, "a picture", err);
  if (!p) return MSR_ENOMEM;
  *p = (msr_picture){width, height, msri_alloc(width * height, 3, "the pixels of a picture", err)};
  if (!p->rgb) {
    free(p);
    return MSR_ENOMEM;
  }
  memset(p->rgb, 255, 3 * width * height);
  *picture = p;
  return MSR_OK;
}

void msr_picture_free(msr_picture *picture) {
  if (picture) free(picture->rgb);
  free(picture);
}

msr_status msri_picture_copy(const msr_picture *picture, msr_picture **copy, msr_error *err) {
  const msr_status status = msr_picture_create(picture->width, picture->height, copy, err);
  if (status == MSR_OK) memcpy((*copy)->rgb, picture->rgb, 3 * picture->width * picture->height);
  return status;
}

size_t msri_ppm_header(const msr_picture *picture, char text[MSRI_PPM_HEADER_SIZE]) {
  return (size_t)msri_format(text, MSRI_PPM_HEADER_SIZE, "P6\n%zu %zu\n255\n", picture->width,
                             picture->height);
}

bool msri_ppm_write(FILE *stream, const msr_picture *picture) {
  char header[MSRI_PPM_HEADER_SIZE];
  const size_t n = msri_ppm_header(picture, header), size = 3 * picture->width * picture->height;
  return fwrite(header, 1, n, stream) == n && fwrite(picture->rgb, 1, size, stream) == size;
}

msr_status msr_picture_write(const msr_picture *picture, const char *path, msr_error *err) {
  assert(picture && path);
  msri_file file;
  msr_status status = msri_file_create(path, &file, err);
  if (status) return status;
  if (msri_ppm_write(file.stream, picture)) return msri_file_commit(&file, err);
  status = msri_file_fail(path, "write", err);
  msri_file_abandon(&file);
  return status;
}
