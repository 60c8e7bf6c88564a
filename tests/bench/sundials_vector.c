/* sundials_vector.c - the operations on vectors that SUNDIALS' steps are made of, compiled with the
 * benchmark: those of Debian's package aren't optimised, and a step is little else. */
#include "sundials_vector.h"

#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdbool.h>

#define EACH(i, v) (sunindextype i = 0, length = NV_LENGTH_S(v); i < length; i++)

static void linear_sum(double a, N_Vector x, double b, N_Vector y, N_Vector z) {
  const double *p = NV_DATA_S(x), *q = NV_DATA_S(y);
  double *r = NV_DATA_S(z);
  for
    EACH(i, z) r[i] = a * p[i] + b * q[i];
}

static void scale(double a, N_Vector x, N_Vector z) {
  const double *p = NV_DATA_S(x);
  double *r = NV_DATA_S(z);
  for
    EACH(i, z) r[i] = a * p[i];
}

static void constant(double a, N_Vector z) {
  double *r = NV_DATA_S(z);
  for
    EACH(i, z) r[i] = a;
}

static void product(N_Vector x, N_Vector y, N_Vector z) {
  const double *p = NV_DATA_S(x), *q = NV_DATA_S(y);
  double *r = NV_DATA_S(z);
  for
    EACH(i, z) r[i] = p[i] * q[i];
}

static void absolute(N_Vector x, N_Vector z) {
  const double *p = NV_DATA_S(x);
  double *r = NV_DATA_S(z);
  for
    EACH(i, z) r[i] = fabs(p[i]);
}

static void inverse(N_Vector x, N_Vector z) {
  const double *p = NV_DATA_S(x);
  double *r = NV_DATA_S(z);
  for
    EACH(i, z) r[i] = 1 / p[i];
}

static void add_constant(N_Vector x, double a, N_Vector z) {
  const double *p = NV_DATA_S(x);
  double *r = NV_DATA_S(z);
  for
    EACH(i, z) r[i] = p[i] + a;
}

static inline double product_of(double p, double q, bool squared) {
  return squared ? p * q * (p * q) : p * q;
}

/* In four parts, so that it can be vectorised. */
static inline double sum_of(N_Vector x, N_Vector y, bool squared) {
  const double *p = NV_DATA_S(x), *q = NV_DATA_S(y);
  const sunindextype n = NV_LENGTH_S(x);
  double part[4] = {0};
  sunindextype i = 0;
  for (; i + 4 <= n; i += 4)
    for (int k = 0; k < 4; k++) part[k] += product_of(p[i + k], q[i + k], squared);
  for (; i < n; i++) part[0] += product_of(p[i], q[i], squared);
  return part[0] + part[1] + part[2] + part[3];
}

static double sum_of_products(N_Vector x, N_Vector y) { return sum_of(x, y, false); }

static double mean_square_root(N_Vector x, N_Vector weight) {
  return sqrt(sum_of(x, weight, true) / (double)NV_LENGTH_S(x));
}

/* z may be the first of the vectors, and is no other. */
static int combine(int vectors, double *c, N_Vector *x, N_Vector z) {
  scale(c[0], x[0], z);
  for (int k = 1; k < vectors; k++) linear_sum(1, z, c[k], x[k], z);
  return 0;
}

N_Vector vector_create(size_t n, SUNContext context) {
  N_Vector v = N_VNew_Serial((sunindextype)n, context);
  v->ops->nvlinearsum = linear_sum;
  v->ops->nvscale = scale;
  v->ops->nvconst = constant;
  v->ops->nvprod = product;
  v->ops->nvabs = absolute;
  v->ops->nvinv = inverse;
  v->ops->nvaddconst = add_constant;
  v->ops->nvdotprod = sum_of_products;
  v->ops->nvwrmsnorm = mean_square_root;
  v->ops->nvlinearcombination = combine;
  return v;
}
