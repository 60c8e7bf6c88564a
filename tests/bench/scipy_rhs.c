/* scipy_rhs.c - the deformed block as a shared library, for scipy_peer.py. */
#include "bench.h"

#include <math.h>
#include <string.h>

static problem block;

MSR_API size_t peer_open(double *end);
MSR_API void peer_start(double *y);
MSR_API void peer_differentiate(const double *y, double *dy);

/* Numbers in y: q and v. */
size_t peer_open(double *end) {
  problem_create(&block, DEFORMED, 1500, INFINITY);
  block.deadline = (double)INFINITY;
  *end = block.T;
  return 2 * block.n;
}

void peer_start(double *y) { memcpy(y, block.start, 2 * block.n * sizeof *y); }

void peer_differentiate(const double *y, double *dy) { differentiate(&block, y, dy); }
