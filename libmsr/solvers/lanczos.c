/* lanczos.c - the largest eigenvalue by the three-term recurrence of Lanczos (1950, J. Res. Nat.
 * Bur. Stand. 45, 255), r[j+1] = A q[j] - a[j] q[j] - b[j] q[j-1], from a vector at random.
 *
 * The largest eigenvalue of the tridiagonal matrix (a, b) grows towards that of A. Loss of
 * orthogonality repeats eigenvalues that were found and does no harm to the largest (Paige 1972, J.
 * Inst. Maths. Applics. 10, 373). Where the spectrum is dense up to its end, as of a lattice, what
 * is missing after j products falls as 1 / j^2 (Kuczynski & Wozniakowski 1992, SIAM J. Matrix Anal.
 * Appl. 13, 1094), so that the growth over the last products tells how much that is. */
#include "solvers/lanczos.h"

#include "base/vector.h"

#include <math.h>
#include <stdlib.h>

enum { MOST = 400, WINDOW = 8, FEWEST = 24 };
static const double tolerance = 5e-4;

typedef struct tridiagonal {
  int n;
  double a[MOST], b[MOST]; /* b[j] beside a[j] and a[j + 1] */
} tridiagonal;

/* Are all eigenvalues below x? By the signs of the pivots of T - x (Sylvester's law of inertia). */
static bool all_below(const tridiagonal *T, double x) {
  double pivot = T->a[0] - x;
  for (int j = 1; j < T->n && pivot < 0; j++)
    pivot = T->a[j] - x - T->b[j - 1] * T->b[j - 1] / pivot;
  return pivot < 0;
}

/* The largest eigenvalue, by bisection. */
static double largest_of(const tridiagonal *T) {
  double low = -1, high = 1 + 1e-9;
  while (high - low > 1e-9) {
    const double middle = (low + high) / 2;
    *(all_below(T, middle) ? &high : &low) = middle;
  }
  return low;
}

/* By SplitMix64 (Steele, Lea & Flood 2014). */
void msri_fill_at_random(size_t n, double *x) {
  for (size_t i = 0; i < n; i++) {
    uint64_t z = (i + 1) * UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    x[i] = (double)((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
  }
}

/* Has it grown enough? `value` [n + 1], the largest after 0 .. n products. */
static bool settled(int n, const double *value) {
  if (value[n] > 1 - tolerance) return true;
  if (n < FEWEST) return false;
  const double missing = n * (value[n] - value[n - WINDOW]) / (2 * WINDOW);
  return missing <= tolerance * value[n];
}

msr_status msri_lanczos_largest(const msri_symmetric *A, double *value, int *iterations) {
  const size_t n = A->n;
  double *block = msri_alloc(3 * n, sizeof *block, "the stable step", NULL);
  if (!block) return MSR_ENOMEM;
  double *q = block, *r = block + n, *before = block + 2 * n, grown[MOST + 1] = {0};
  tridiagonal T = {0};
  msri_fill_at_random(n, q);
  msri_scale(n, 1 / sqrt(msri_dot(n, q, q)), q);
  for (bool done = n == 0; !done;) {
    double *const b = &T.b[T.n];
    A->apply(A->self, q, r);
    if (T.n > 0) msri_add_scaled(n, -T.b[T.n - 1], before, r);
    T.a[T.n++] = msri_dot(n, r, q);
    msri_add_scaled(n, -T.a[T.n - 1], q, r);
    *b = sqrt(msri_dot(n, r, r));
    grown[T.n] = msri_max(0, largest_of(&T));
    done = *b < 1e-10 || T.n == MOST || settled(T.n, grown);
    if (!done) msri_scale(n, 1 / *b, r);
    double *const spare = before;
    before = q, q = r, r = spare;
  }
  free(block);
  *value = grown[T.n];
  *iterations = T.n;
  return MSR_OK;
}
