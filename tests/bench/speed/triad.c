/* triad.c - how fast memory is: a = b + s c on arrays far larger than the caches (McCalpin's STREAM
 * triad, 24 bytes an element counted, as there). */
#include "speed.h"

#include <pthread.h>
#include <stdlib.h>

enum { ELEMENTS = 1 << 24 };

typedef struct part {
  double *restrict a;
  const double *b, *c;
  size_t n;
} part;

static void *add(void *arg) {
  const part p = *(part *)arg;
  double *restrict a = p.a;
  for (size_t i = 0; i < p.n; i++) a[i] = p.b[i] + 3 * p.c[i];
  return NULL;
}

/* [GB/s] */
static double once(double *block, size_t threads) {
  part parts[MOST_THREADS];
  pthread_t other[MOST_THREADS];
  const size_t n = ELEMENTS / threads;
  const double begin = seconds_now();
  for (size_t i = threads; i-- > 0;) {
    double *at = block + i * n;
    parts[i] = (part){at, at + ELEMENTS, at + 2 * (size_t)ELEMENTS, n};
    if (i == 0)
      add(&parts[0]);
    else if (pthread_create(&other[i], NULL, add, &parts[i]) != 0)
      bench_fail("there is no thread");
  }
  for (size_t i = 1; i < threads; i++) pthread_join(other[i], NULL);
  return 24.0 * ELEMENTS / (seconds_now() - begin) / 1e9;
}

void triad_table(void) {
  double *block = need(3 * (size_t)ELEMENTS, sizeof *block), rate[MOST_THREADS][ROUNDS];
  for (size_t i = 0; i < 3 * (size_t)ELEMENTS; i++) block[i] = 1; /* pages must be there */
  for (int i = 0; i < ROUNDS; i++)
    for (size_t t = 0; t < MOST_THREADS; t++) rate[t][i] = once(block, t + 1);
  printf("\n== Memory, STREAM triad\n");
  for (size_t t = 0; t < MOST_THREADS; t++) {
    const spread s = spread_of(rate[t], ROUNDS);
    printf("%zu thread%s %6.1f GB/s (%.1f..%.1f)\n", t + 1, t > 0 ? "s" : " ", s.median, s.low,
           s.high);
  }
  free(block);
}
