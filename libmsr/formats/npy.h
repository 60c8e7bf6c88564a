/* npy.h - the header of a NumPy array file, format version 1.0.
 * https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html */
#ifndef MSRI_NPY_H
#define MSRI_NPY_H

#include "base/base.h"

enum { MSRI_NPY_HEADER_SIZE = 128 };

/* The header of float64 [frames, masses, 4] in C order, in this machine's byte order. Its size is
 * always the same, so that it can be written again when the number of frames is known. */
void msri_npy_header(uint64_t frames, uint64_t masses, unsigned char header[MSRI_NPY_HEADER_SIZE]);

#endif
