/* whole_file.c - a temporary file in the directory of the target, then rename(2): what msr's
 * library does for its own files. */
#define _XOPEN_SOURCE 700 // NOLINT: POSIX's own switch for realpath
#include "whole_file.h"

#include "report.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { NAME_SIZE = 48 };

static msr_status cannot_write(const char *path, msr_error *err) {
  char reason[128] = "unknown error";
  strerror_r(errno, reason, sizeof reason);
  return fail(err, MSR_EIO, "%s: cannot write it: %s",
              strcmp(path, "-") == 0 ? "standard output" : path, reason);
}

/* Frees all; a temporary file goes. errno stays. */
static void dispose(whole_file *file) {
  const int number = errno;
  if (file->temporary) unlink(file->temporary);
  free(file->temporary);
  free(file->target);
  *file = (whole_file){.stream = NULL};
  errno = number;
}

/* Not mkstemp's private file: this one gets what the umask leaves of 0666, or the permissions of
 * the one that it will replace. */
static int open_temporary(whole_file *file, mode_t mode) {
  const char *const slash = strrchr(file->target, '/');
  const int directory = slash ? (int)(slash + 1 - file->target) : 0;
  const size_t size = (size_t)directory + NAME_SIZE;
  int fd = -1;
  file->temporary = malloc(size);
  if (!file->temporary) return -1;
  errno = EEXIST;
  for (unsigned i = 0; fd < 0 && errno == EEXIST; i++) {
    snprintf(file->temporary, size, "%.*s.msr-%ld-%u.tmp", directory, file->target, (long)getpid(),
             i);
    fd = open(file->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  }
  if (fd >= 0 && mode) (void)fchmod(fd, mode & 0777);
  if (fd < 0) {
    free(file->temporary);
    file->temporary = NULL;
  }
  return fd;
}

static int open_descriptor(whole_file *file) {
  struct stat info;
  if (strcmp(file->path, "-") == 0) return fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
  const bool there = stat(file->path, &info) == 0;
  if (there && !S_ISREG(info.st_mode)) return open(file->path, O_WRONLY | O_CLOEXEC | O_NOCTTY);
  if (there && access(file->path, W_OK) != 0) return -1;
  file->target = there ? realpath(file->path, NULL) : strdup(file->path);
  return file->target ? open_temporary(file, there ? info.st_mode : 0) : -1;
}

msr_status whole_file_open(const char *path, whole_file *file, msr_error *err) {
  *file = (whole_file){.path = path};
  const int fd = open_descriptor(file);
  file->stream = fd >= 0 ? fdopen(fd, "w") : NULL;
  if (file->stream) return MSR_OK;
  const msr_status status = cannot_write(path, err);
  if (fd >= 0) close(fd);
  dispose(file);
  return status;
}

msr_status whole_file_commit(whole_file *file, msr_error *err) {
  const bool sound = !ferror(file->stream);
  msr_status status = MSR_OK;
  errno = EIO; // if the failure was an earlier one, whose errno is gone
  const bool closed = fclose(file->stream) == 0;
  const bool renamed =
      sound && closed && (!file->temporary || rename(file->temporary, file->target) == 0);
  if (!renamed) status = cannot_write(file->path, err);
  if (renamed) {
    free(file->temporary);
    file->temporary = NULL;
  }
  dispose(file);
  return status;
}

void whole_file_abandon(whole_file *file) {
  if (!file->stream) return;
  fclose(file->stream);
  dispose(file);
}
