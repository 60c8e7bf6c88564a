/* bands.h - the masses of a mesh that a program built, in bands: springs join masses of one band or
 * of two that follow each other. */
#ifndef MSRI_BANDS_H
#define MSRI_BANDS_H

#include "base/base.h"
#include "forces/springs.h"

typedef struct msri_bands {
  size_t n, length; /* masses of each but the last */
  size_t masses;
  msri_bundle *springs; /* [n] that begin in each, counted from its first mass */
} msri_bands;

/* Those of springs that were sorted by groups of masses: band by band they come in the same order.
 * MSR_ENOMEM: then nothing is left. */
msr_status msri_bands_create(size_t masses, const msr_springs *springs, msri_bands *bands,
                             msr_error *err);
void msri_bands_clear(msri_bands *bands);
size_t msri_bands_bytes(const msri_bands *bands);

/* Masses of band b. */
static inline size_t msri_bands_masses(const msri_bands *bands, size_t b) {
  const size_t left = bands->masses - b * bands->length;
  return left < bands->length ? left : bands->length;
}

#endif
