/* file.c - whole files in, whole files out. Reading grows its buffer as bytes come, whatever the
 * file system says the size is. Writing goes to a temporary file in the target's directory and ends
 * in rename(2), which puts a whole file in place of the old one or does nothing. */
#define _XOPEN_SOURCE 700 // NOLINT: POSIX's own switch for realpath
#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { CHUNK = 1 << 16, TEMPORARY_SIZE = 48 };

static const struct advice {
  int number;
  const char *text;
} advices[] = {
    {ENOENT, "check its name"},
    {ENOTDIR, "check its name"},
    {ENAMETOOLONG, "shorten its name"},
    {EACCES, "check its permissions"},
    {EBADF, "check its name"},
    {EISDIR, "give a file, not a directory"},
    {ENOSPC, "free some space"},
    {EFBIG, "raise the limit of file sizes (ulimit -f), or write to another disk"},
    {EPIPE, "what should read it has ended"},
    {0, "check the disk or the device"},
};

msr_status msri_file_fail(const char *path, const char *verb, msr_error *err) {
  const int number = errno;
  char reason[128] = "unknown error";
  strerror_r(number, reason, sizeof reason);
  const struct advice *advice = advices;
  while (advice->number != 0 && advice->number != number) advice++;
  return msri_fail(err, MSR_EIO, "%s: cannot %s it: %s; %s", path, verb, reason, advice->text);
}

/* open(2); one that waits, as for the other end of a pipe, goes on waiting after a signal. */
static int open_file(const char *path, int flags) {
  int fd;
  do fd = open(path, flags | O_CLOEXEC | O_NOCTTY, 0666);
  while (fd < 0 && errno == EINTR);
  return fd;
}

/* ---- Reading */

typedef struct input {
  const char *path;
  int fd;
  void *bytes;
  size_t size, capacity;
} input;

static msr_status make_room(input *in, size_t size, msr_error *err) {
  void *grown = msri_grow(in->bytes, &in->capacity, size, 1, "the bytes of a file", err);
  if (!grown) return MSR_ENOMEM;
  in->bytes = grown;
  return MSR_OK;
}

/* Reads on until there are `wanted` bytes or the file ends. */
static msr_status fill(input *in, size_t wanted, msr_error *err) {
  while (in->size < wanted) {
    const size_t least = in->size < in->capacity ? in->size : in->size + CHUNK;
    if (make_room(in, least, err)) return MSR_ENOMEM;
    const size_t room = in->capacity - in->size, left = wanted - in->size;
    const ssize_t n = read(in->fd, (char *)in->bytes + in->size, room < left ? room : left);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return msri_file_fail(in->path, "read", err);
    if (n == 0) return MSR_OK;
    in->size += (size_t)n;
  }
  return MSR_OK;
}

static msr_status too_large(const input *in, size_t limit, msr_error *err) {
  return msri_fail(err, MSR_EINPUT, "%s:1:1: larger than the %zu bytes that are read at most; %s",
                   in->path, limit, "check that it is the right file");
}

/* Believes the size that the file system tells only to reserve room and to refuse early. */
static msr_status expect(input *in, size_t limit, msr_error *err) {
  struct stat st;
  if (fstat(in->fd, &st) != 0 || !S_ISREG(st.st_mode)) return MSR_OK;
  if ((uintmax_t)st.st_size > limit) return too_large(in, limit, err);
  return make_room(in, (size_t)st.st_size + 1, err);
}

static msr_status read_all(input *in, size_t limit, msri_file_accept *accept, msr_error *err) {
  msr_status status = fill(in, MSRI_FILE_HEAD, err);
  if (!status && accept) status = accept(in->path, in->bytes, in->size, err);
  if (!status) status = expect(in, limit, err);
  if (!status) status = fill(in, limit + 1, err);
  if (!status && in->size > limit) status = too_large(in, limit, err);
  return status;
}

msr_status msri_file_read_if(const char *path, size_t limit, msri_file_accept *accept,
                             unsigned char **bytes, size_t *size, msr_error *err) {
  input in = {.path = path, .fd = open_file(path, O_RDONLY)};
  if (in.fd < 0) return msri_file_fail(path, "read", err);
  const msr_status status = read_all(&in, limit, accept, err);
  close(in.fd);
  if (status) {
    free(in.bytes);
    return status;
  }
  *bytes = in.bytes;
  *size = in.size;
  return MSR_OK;
}

msr_status msri_file_read(const char *path, size_t limit, unsigned char **bytes, size_t *size,
                          msr_error *err) {
  return msri_file_read_if(path, limit, NULL, bytes, size, err);
}

/* ---- Writing */

/* The open descriptor that a path such as -, /dev/stdout or /dev/fd/3 stands for, or -1. Opening
 * the path anew would write over what the descriptor already wrote. */
static int standing_for(const char *path) {
  static const char directory[] = "/dev/fd/";
  const size_t n = sizeof directory - 1;
  if (strcmp(path, "-") == 0 || strcmp(path, "/dev/stdout") == 0) return STDOUT_FILENO;
  if (strcmp(path, "/dev/stderr") == 0) return STDERR_FILENO;
  if (strncmp(path, directory, n) != 0 || !path[n]) return -1;
  char *end;
  const long fd = strtol(path + n, &end, 10);
  return !*end && fd >= 0 && fd <= INT_MAX ? (int)fd : -1;
}

/* A descriptor of what is to be written directly, or -1. Then *mode is that of the regular file
 * that is there, or 0 and errno says why nothing could be opened. */
static int open_direct(const char *path, mode_t *mode) {
  struct stat st;
  const int standing = standing_for(path);
  if (standing >= 0) return fcntl(standing, F_DUPFD_CLOEXEC, 0);
  const int fd = open_file(path, O_WRONLY);
  if (fd < 0 || fstat(fd, &st) != 0 || !S_ISREG(st.st_mode)) return fd;
  close(fd);
  *mode = st.st_mode;
  return -1;
}

/* mkstemp would make a private file; this one gets what the umask leaves of 0666. */
static int open_temporary(const msri_file *file, mode_t mode) {
  const char *slash = strrchr(file->target, '/');
  const size_t directory = slash ? (size_t)(slash + 1 - file->target) : 0;
  char *name = file->temporary + directory;
  memcpy(file->temporary, file->target, directory);
  int fd = -1;
  errno = EEXIST;
  for (unsigned i = 0; fd < 0 && errno == EEXIST; i++) {
    snprintf(name, TEMPORARY_SIZE, ".msr-%ld-%u.tmp", (long)getpid(), i);
    fd = open_file(file->temporary, O_WRONLY | O_CREAT | O_EXCL);
  }
  if (fd < 0) *file->temporary = '\0';
  if (fd >= 0 && mode) (void)fchmod(fd, mode & 0777);
  return fd;
}

/* path, target and temporary are one block. */
static msr_status name_file(msri_file *file, const char *path, const char *target, msr_error *err) {
  const size_t m = strlen(path) + 1, n = strlen(target) + 1;
  file->path = msri_alloc(m + n + n + TEMPORARY_SIZE, 1, "the name of a file", err);
  if (!file->path) return MSR_ENOMEM;
  file->target = memcpy(file->path + m, target, n);
  file->temporary = file->target + n;
  memcpy(file->path, path, m);
  return MSR_OK;
}

/* Frees all and removes the temporary file, if it still has that name; errno stays. */
static void dispose(msri_file *file) {
  const int number = errno;
  if (*file->temporary) unlink(file->temporary);
  free(file->path);
  *file = (msri_file){.stream = NULL};
  errno = number;
}

/* A stream on fd, which stays the caller's on failure, or on a new temporary file. */
static msr_status open_stream(msri_file *file, int fd, mode_t mode, msr_error *err) {
  const int used = fd >= 0 ? fd : open_temporary(file, mode);
  file->stream = used >= 0 ? fdopen(used, "w") : NULL;
  if (file->stream) return MSR_OK;
  const msr_status status = msri_file_fail(file->path, "write", err);
  if (used >= 0 && used != fd) close(used);
  dispose(file);
  return status;
}

msr_status msri_file_create(const char *path, msri_file *file, msr_error *err) {
  mode_t mode = 0;
  *file = (msri_file){.stream = NULL};
  const int fd = open_direct(path, &mode);
  if (fd < 0 && !mode && errno != ENOENT) return msri_file_fail(path, "write", err);
  char *target = mode ? realpath(path, NULL) : NULL;
  const char *shown = strcmp(path, "-") == 0 ? "standard output" : path;
  msr_status status = name_file(file, shown, target ? target : path, err);
  free(target);
  if (!status) status = open_stream(file, fd, mode, err);
  if (status && fd >= 0) close(fd);
  return status;
}

msr_status msri_file_write(msri_file *file, const void *bytes, size_t size, msr_error *err) {
  if (fwrite(bytes, 1, size, file->stream) == size) return MSR_OK;
  return msri_file_fail(file->path, "write", err);
}

msr_status msri_file_flush(msri_file *file, msr_error *err) {
  const bool sound = !ferror(file->stream);
  errno = EIO; // if the failure was an earlier one, whose errno is gone
  return fflush(file->stream) == 0 && sound ? MSR_OK : msri_file_fail(file->path, "write", err);
}

/* After a successful rename the temporary name may be another thread's. */
static bool take_name(msri_file *file) {
  if (*file->temporary && rename(file->temporary, file->target) != 0) return false;
  *file->temporary = '\0';
  return true;
}

msr_status msri_file_commit(msri_file *file, msr_error *err) {
  const bool sound = !ferror(file->stream);
  errno = EIO; // if the failure was an earlier one, whose errno is gone
  const bool closed = fclose(file->stream) == 0;
  const bool done = sound && closed && take_name(file);
  const msr_status status = done ? MSR_OK : msri_file_fail(file->path, "write", err);
  dispose(file);
  return status;
}

void msri_file_abandon(msri_file *file) {
  if (!file->stream) return;
  fclose(file->stream);
  dispose(file);
}
