/* base.h - what every file of the library may use: the public nouns, errors and allocation. */
#ifndef MSRI_BASE_H
#define MSRI_BASE_H

#include "msr.h"

#if defined(__GNUC__)
#define MSRI_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define MSRI_PRINTF(text, first)
#endif

/* Fills err (may be NULL) and returns status. A message too long is cut at MSR_MESSAGE_SIZE; what
 * would not stay on one line of a terminal (from a file's name, say) becomes '?'. */
msr_status msri_fail(msr_error *err, msr_status status, const char *format, ...) MSRI_PRINTF(3, 4);

/* Hands on the status of a callback with what it said, or with this sentence if it said nothing. */
msr_status msri_hand_on(msr_error *err, msr_status status, const msr_error *said,
                        const char *format, ...) MSRI_PRINTF(4, 5);

/* calloc with the error filled: NULL on failure and on overflow; count or size 0 gives a block
 * that free takes. `what` completes "out of memory for ". */
void *msri_alloc(size_t count, size_t size, const char *what, msr_error *err);

/* A block of elements of `size` bytes that holds at least `count`, from one that holds *capacity
 * (NULL: 0), which is updated; it grows by doubling and new elements aren't set. NULL on failure,
 * with the error filled and the old block as it was. */
void *msri_grow(void *block, size_t *capacity, size_t count, size_t size, const char *what,
                msr_error *err);

static inline double msri_min(double a, double b) { return a < b ? a : b; }
static inline double msri_max(double a, double b) { return a > b ? a : b; }

/* Masses 0 .. of the view's that may differ: one stands for all if all are equal. */
static inline size_t msri_masses_that_differ(const msr_view *s) {
  return s->m_stride ? s->n : s->n > 0;
}

/* The least multiple of `unit` that isn't below n. */
static inline size_t msri_round_up(size_t n, size_t unit) { return (n + unit - 1) / unit * unit; }

static inline size_t msri_lesser(size_t a, size_t b) { return a < b ? a : b; }

/* The larger, but what is no number before any. */
static inline double msri_worse(double a, double b) { return a >= b || a != a ? a : b; }

#endif
