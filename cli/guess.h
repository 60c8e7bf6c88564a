/* guess.h - the nearest valid word to one that isn't. */
#ifndef CLI_GUESS_H
#define CLI_GUESS_H

#include <stddef.h>

/* All but word starts at zero. */
typedef struct guess {
  const char *word; /* what the user wrote */
  const char *best; /* the nearest so far; NULL: none is near enough to have been meant */
  size_t distance;
} guess;

void guess_consider(guess *g, const char *candidate);

#endif
