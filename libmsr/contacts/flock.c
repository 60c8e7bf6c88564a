/* flock.c - masses that stay in their pixel, for vectors of several widths. */
#include "contacts/flock.h"

#include "base/machine.h"

#include <math.h>

/* Is it one pixel? What is no number is nowhere. */
MSRI_INLINE int is_same(double x, double to) { return floor(x) == floor(to); }

MSRI_INLINE void move(size_t n, double h, const double *ux, const double *uy, double *restrict x,
                      double *restrict y, int64_t *restrict leaves) {
  for (size_t k = 0; k < n; k++) {
    const double to_x = x[k] + h * ux[k], to_y = y[k] + h * uy[k];
    const int stays = is_same(x[k], to_x) & is_same(y[k], to_y);
    x[k] = stays ? to_x : x[k];
    y[k] = stays ? to_y : y[k];
    leaves[k] = !stays;
  }
}

#if MSRI_WIDE
MSRI_AVX2 static void move_avx2(const msri_flock *b, double h, int64_t *leaves) {
  move(b->n, h, b->ux, b->uy, b->x, b->y, leaves);
}
#endif

void msri_flock_move(const msri_flock *block, double h, int64_t *leaves) {
#if MSRI_WIDE
  if (msri_has_avx2()) {
    move_avx2(block, h, leaves);
    return;
  }
#endif
  move(block->n, h, block->ux, block->uy, block->x, block->y, leaves);
}
