/* target.h - where frames go: through a pipe to someone who reads them, or into files. */
#ifndef SPEED_TARGET_H
#define SPEED_TARGET_H

#include "speed.h"

#include <sys/types.h>

typedef enum place { PIPE, FILES, NOWHERE } place;

typedef struct target {
  place place;
  int real; /* standard output meanwhile */
  pid_t reader;
  char directory[512];
} target;

/* A pipe is standard output until it's drained, and holds as much as it may, as libmsr's do. */
target target_open(place where);

/* Writes a frame as a bare program does. */
void target_write(const target *t, uint64_t frame, const char *bytes, size_t size);

/* Waits until all is read. */
void target_drain(target *t);

/* Removes files. */
void target_remove(const target *t, uint64_t frames);

#endif
