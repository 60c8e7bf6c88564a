/* file.h - whole files in, whole files out: no size is trusted on the way in, and nothing half
 * written is left on the way out. */
#ifndef MSRI_FILE_H
#define MSRI_FILE_H

#include "base/base.h"

#include <stdio.h>

/* MSR_EIO from errno: "path: cannot VERB it: reason; what to do". */
msr_status msri_file_fail(const char *path, const char *verb, msr_error *err);

/* Reads a whole file, pipe or device of at most `limit` bytes (below SIZE_MAX); the caller frees
 * *bytes. MSR_EIO; MSR_EINPUT if there is more; MSR_ENOMEM. */
msr_status msri_file_read(const char *path, size_t limit, unsigned char **bytes, size_t *size,
                          msr_error *err);

/* Is it worth reading on? Sees the first MSRI_FILE_HEAD bytes, fewer if the file is shorter. */
enum { MSRI_FILE_HEAD = 64 };
typedef msr_status msri_file_accept(const char *path, const unsigned char *head, size_t size,
                                    msr_error *err);

/* The same, but the rest is read only if `accept` returns MSR_OK on the first bytes. */
msr_status msri_file_read_if(const char *path, size_t limit, msri_file_accept *accept,
                             unsigned char **bytes, size_t *size, msr_error *err);

/* A file being written. It takes its name when it is committed, in one rename, and keeps the
 * permissions of the one that it replaces; a link to a file is followed. What is no regular file (a
 * pipe, /dev/null, /dev/stdout, also called -) is written directly. */
typedef struct msri_file {
  FILE *stream;    /* write here */
  char *path;      /* as it was asked for */
  char *target;    /* where it goes, links resolved */
  char *temporary; /* what it's called meanwhile, beside the target; "": written directly */
} msri_file;

/* MSR_EIO, MSR_ENOMEM; then there is nothing to abandon. */
msr_status msri_file_create(const char *path, msri_file *file, msr_error *err);

/* Writes bytes; the file must still be committed or abandoned. MSR_EIO. */
msr_status msri_file_write(msri_file *file, const void *bytes, size_t size, msr_error *err);

/* Hands on what was written so far, for those who read it meanwhile, and tells of any failure since
 * it was created. MSR_EIO. */
msr_status msri_file_flush(msri_file *file, msr_error *err);

/* Closes the file and gives it its name; on failure it's abandoned. MSR_EIO. */
msr_status msri_file_commit(msri_file *file, msr_error *err);

/* Closes the file and removes it. One that is all zero, committed or abandoned is left alone. */
void msri_file_abandon(msri_file *file);

#endif
