/* child.h - a contestant that is a program of its own: lines go to it, lines come back. It doesn't
 * run but between a question and its answer, so that its waiting costs others nothing. */
#ifndef CHILD_H
#define CHILD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/types.h>

enum { CHILD_PROCESSES = 4, CHILD_LINE = 512 };

typedef struct child {
  FILE *to, *from;
  pid_t started, pid[CHILD_PROCESSES]; /* pid: those that compute, as they say in lines "pid N" */
  size_t pids;
  char line[CHILD_LINE]; /* the last that came */
} child;

/* False: it can't be started. */
bool child_open(child *c, const char *const *argv);

/* Asks, lets it run, and stops it when a line that begins with `answer` has come. False: it has
 * ended before. */
bool child_ask(child *c, const char *answer, const char *question, ...)
    __attribute__((format(printf, 3, 4)));

/* What its processes hold in memory [bytes]. */
double child_resident(const child *c);

void child_close(child *c);

#endif
