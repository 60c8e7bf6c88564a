/* whole_file.h - a file that appears whole or not at all. */
#ifndef CLI_WHOLE_FILE_H
#define CLI_WHOLE_FILE_H

#include "options.h"

typedef struct whole_file {
  FILE *stream;     /* write here; NULL: there is no file */
  const char *path; /* as it was asked for */
  char *temporary;  /* what it is called meanwhile, in the same directory; NULL: written directly */
  char *target;     /* where it goes, links resolved */
} whole_file;

/* "-" and what is no regular file (a pipe, a device) are written directly. MSR_EIO, MSR_ENOMEM. */
msr_status whole_file_open(const char *path, whole_file *file, msr_error *err);

/* Closes it and gives it its name, which may replace a file. MSR_EIO: then it is as if abandoned.
 */
msr_status whole_file_commit(whole_file *file, msr_error *err);

/* Removes it, unless it was written directly. One that is all zero or committed is left alone. */
void whole_file_abandon(whole_file *file);

#endif
