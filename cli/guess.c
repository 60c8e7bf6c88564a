/* guess.c - "did you mean": the restricted Damerau-Levenshtein distance (Damerau 1964), which
 * counts letters inserted, left out, changed, and neighbours swapped. */
#include "guess.h"

#include <string.h>

enum { LONGEST = 32 };

static size_t least(size_t a, size_t b) { return a < b ? a : b; }

/* d[i][j] is the distance between the first i letters of a and the first j of b. */
static size_t distance(const char *a, const char *b) {
  const size_t n = strlen(a), m = strlen(b);
  size_t d[LONGEST + 1][LONGEST + 1];
  if (n > LONGEST || m > LONGEST) return n + m;
  for (size_t i = 0; i <= n; i++) {
    for (size_t j = 0; j <= m; j++) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = d[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
      d[i][j] = least(d[i][j], least(d[i - 1][j], d[i][j - 1]) + 1);
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        d[i][j] = least(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
  }
  return d[n][m];
}

/* A beginning of the word counts as one letter away: it was cut short. */
void guess_consider(guess *g, const char *candidate) {
  const size_t length = strlen(g->word);
  size_t d = distance(g->word, candidate);
  if (length > 1 && strncmp(g->word, candidate, length) == 0) d = least(d, 1);
  if (d >= length || d > 1 + length / 4 || (g->best && d >= g->distance)) return;
  g->best = candidate;
  g->distance = d;
}
