/* source.h - what the readers of files share: the place of an error, words of the file in a
 * message, and what a file that isn't the right one seems to be. */
#ifndef MSRI_SOURCE_H
#define MSRI_SOURCE_H

#include "base/base.h"

/* A file in memory. */
typedef struct msri_source {
  const char *name; /* for messages */
  const unsigned char *bytes;
  size_t size;
} msri_source;

/* MSR_EINPUT: "name:line:column: ...", where the byte at offset `at` is; both count from 1, columns
 * in characters. */
msr_status msri_source_fail(const msri_source *source, size_t at, msr_error *err,
                            const char *format, ...) MSRI_PRINTF(4, 5);

enum { MSRI_QUOTE_SIZE = 64 };

/* Puts the bytes at..at+size-1 between quotes, cut if they are many; what can't be shown becomes
 * \xNN. Returns text. */
const char *msri_source_quote(const msri_source *source, size_t at, size_t size,
                              char text[MSRI_QUOTE_SIZE]);

/* A kind of file, told by its first bytes. */
typedef struct msri_kind {
  const char *magic;
  const char *name; /* "a PNG picture" */
  const char *todo; /* for who wants a PPM picture; NULL: it is one */
} msri_kind;

/* NULL: none that is known. */
const msri_kind *msri_source_kind(const msri_source *source);

#endif
