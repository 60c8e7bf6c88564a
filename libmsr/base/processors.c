/* processors.c - see processors.h; sched_setaffinity(2), sysconf(3). */
#if defined(__linux__)
#define _GNU_SOURCE // NOLINT: for sched_getaffinity
#endif
#include "base/processors.h"

#include <sched.h>
#include <unistd.h>

unsigned msri_processors(void) {
  long n = 1;
#ifdef _SC_NPROCESSORS_ONLN
  n = sysconf(_SC_NPROCESSORS_ONLN);
#endif
#ifdef CPU_COUNT
  cpu_set_t ours;
  if (sched_getaffinity(0, sizeof ours, &ours) == 0) n = CPU_COUNT(&ours);
#endif
  return n > 1 ? (unsigned)n : 1;
}
