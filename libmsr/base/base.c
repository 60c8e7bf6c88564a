/* base.c - errors with a message for the user, and allocation that can't overflow. */
#include "base/base.h"

#include "base/number.h"

#include <stdarg.h>
#include <stdlib.h>

#define MSRI_STATUS_TEXT(name, text) text,
static const char *const status_texts[] = {MSR_STATUSES(MSRI_STATUS_TEXT)};

const char *msr_version(void) { return MSR_VERSION; }

const char *msr_status_text(msr_status status) {
  const size_t i = (size_t)status;
  return i < sizeof status_texts / sizeof *status_texts ? status_texts[i] : "unknown status";
}

static void fill(msr_error *err, msr_status status, const char *format, va_list arguments)
    MSRI_PRINTF(3, 0);

static void fill(msr_error *err, msr_status status, const char *format, va_list arguments) {
  err->status = status;
  msri_vformat(err->message, sizeof err->message, format, arguments);
  for (char *c = err->message; *c; c++)
    if ((unsigned char)*c < ' ' || *c == 0x7f) *c = '?';
}

msr_status msri_fail(msr_error *err, msr_status status, const char *format, ...) {
  if (!err) return status;
  va_list arguments;
  va_start(arguments, format);
  fill(err, status, format, arguments);
  va_end(arguments);
  return status;
}

msr_status msri_hand_on(msr_error *err, msr_status status, const msr_error *said,
                        const char *format, ...) {
  if (!err) return status;
  if (said->status != MSR_OK) {
    *err = *said;
    return status;
  }
  va_list arguments;
  va_start(arguments, format);
  fill(err, status, format, arguments);
  va_end(arguments);
  return status;
}

void *msri_alloc(size_t count, size_t size, const char *what, msr_error *err) {
  const bool empty = count == 0 || size == 0;
  void *block = empty ? calloc(1, 1) : calloc(count, size);
  if (!block)
    msri_fail(err, MSR_ENOMEM, "out of memory for %s (%zu x %zu bytes)", what, count, size);
  return block;
}

void *msri_grow(void *block, size_t *capacity, size_t count, size_t size, const char *what,
                msr_error *err) {
  if (count <= *capacity) return block;
  size_t wanted = *capacity < 8 ? 8 : *capacity;
  while (wanted < count && wanted <= SIZE_MAX / 2) wanted *= 2;
  void *grown = wanted >= count && wanted <= SIZE_MAX / size ? realloc(block, wanted * size) : NULL;
  if (!grown)
    msri_fail(err, MSR_ENOMEM, "out of memory for %s (%zu x %zu bytes)", what, count, size);
  else
    *capacity = wanted;
  return grown;
}
