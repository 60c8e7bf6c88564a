/* pipe.c - see pipe.h; pipe(7), "Pipe capacity". */
#if defined(__linux__)
#define _GNU_SOURCE // NOLINT: for F_SETPIPE_SZ
#endif
#include "base/pipe.h"

#include <fcntl.h>

void msri_pipe_widen(int fd) {
#ifdef F_SETPIPE_SZ
  (void)fcntl(fd, F_SETPIPE_SZ, 1 << 20);
#else
  (void)fd;
#endif
}
