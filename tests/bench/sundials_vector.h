/* sundials_vector.h - see sundials_vector.c. */
#ifndef SUNDIALS_VECTOR_H
#define SUNDIALS_VECTOR_H

#include <sundials/sundials_nvector.h>

/* A serial vector of n numbers whose operations are the benchmark's; so are those of its clones. */
N_Vector vector_create(size_t n, SUNContext context);

#endif
