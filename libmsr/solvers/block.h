/* block.h - vectors of two numbers and matrices of 2 x 2, symmetric or not. */
#ifndef MSRI_BLOCK_H
#define MSRI_BLOCK_H

typedef struct msri_vector {
  double x, y;
} msri_vector;

typedef struct msri_block {
  double xx, xy, yy;
} msri_block;

typedef struct msri_square {
  double xx, xy, yx, yy;
} msri_square;

static inline msri_vector msri_sum(msri_vector a, msri_vector b) {
  return (msri_vector){a.x + b.x, a.y + b.y};
}

static inline double msri_product(msri_vector a, msri_vector b) { return a.x * b.x + a.y * b.y; }

static inline msri_block msri_block_sum(msri_block a, msri_block b) {
  return (msri_block){a.xx + b.xx, a.xy + b.xy, a.yy + b.yy};
}

static inline msri_vector msri_block_times(msri_block a, msri_vector v) {
  return (msri_vector){a.xx * v.x + a.xy * v.y, a.xy * v.x + a.yy * v.y};
}

static inline msri_square msri_block_product(msri_block a, msri_block b) {
  return (msri_square){a.xx * b.xx + a.xy * b.xy, a.xx * b.xy + a.xy * b.yy,
                       a.xy * b.xx + a.yy * b.xy, a.xy * b.xy + a.yy * b.yy};
}

static inline msri_vector msri_square_times(msri_square a, msri_vector v) {
  return (msri_vector){a.xx * v.x + a.xy * v.y, a.yx * v.x + a.yy * v.y};
}

/* The transpose of a, times v. */
static inline msri_vector msri_square_times_from_left(msri_square a, msri_vector v) {
  return (msri_vector){a.xx * v.x + a.yx * v.y, a.xy * v.x + a.yy * v.y};
}

#endif
