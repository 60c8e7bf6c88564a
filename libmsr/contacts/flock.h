/* flock.h - masses on their way, some in a row: those that stay in their pixel, which can meet
 * nothing, and the others. */
#ifndef MSRI_FLOCK_H
#define MSRI_FLOCK_H

#include "contacts/contact.h"

/* Masses that are looked at together; more of them would more often have one near a support. */
enum { MSRI_FLOCK_BLOCK = 64 };

static inline size_t msri_flock_blocks(size_t n) {
  return (n + MSRI_FLOCK_BLOCK - 1) / MSRI_FLOCK_BLOCK;
}

/* All masses; u = ux[n], uy[n], likewise the others; a may be NULL. */
static inline msri_flock msri_flock_of(size_t n, const double *u, const double *a, double *q,
                                       double *v) {
  return (msri_flock){.n = n,
                      .x = q,
                      .y = q + n,
                      .vx = v,
                      .vy = v + n,
                      .ux = u,
                      .uy = u + n,
                      .ax = a,
                      .ay = a ? a + n : NULL};
}

/* Of those from `from` on the next MSRI_FLOCK_BLOCK, or as many as there are. */
static inline msri_flock msri_flock_part(const msri_flock *f, size_t from) {
  const size_t left = f->n - from;
  return (msri_flock){.n = left < MSRI_FLOCK_BLOCK ? left : MSRI_FLOCK_BLOCK,
                      .first = f->first + from,
                      .x = f->x + from,
                      .y = f->y + from,
                      .vx = f->vx + from,
                      .vy = f->vy + from,
                      .ux = f->ux + from,
                      .uy = f->uy + from,
                      .ax = f->ax ? f->ax + from : NULL,
                      .ay = f->ay ? f->ay + from : NULL};
}

/* What is done to masses by vectors of some width: same bits by each of them. */
typedef struct msri_flock_kernel {
  bool (*runs_here)(void); /* has this machine got such vectors? NULL: every one has */
  /* x += h u. */
  void (*glide)(const msri_flock *flock, double h);
  /* Which of a block have left the pixel where they were, the first one's bit being the lowest?
   * What is no number has. */
  uint64_t (*leave)(const msri_flock *block, const msri_places *from);
} msri_flock_kernel;

/* Widest first; the last runs anywhere. */
extern const msri_flock_kernel msri_flock_kernels[];

/* The widest that runs here. */
const msri_flock_kernel *msri_flock_widest(void);

#endif
