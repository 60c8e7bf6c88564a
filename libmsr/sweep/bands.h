/* bands.h - a mesh that a program built: a wave runs over its bands, each stage one band behind the
 * one before, so that a band goes through all stages of a pass while it is in cache. */
#ifndef MSRI_SWEEP_BANDS_H
#define MSRI_SWEEP_BANDS_H

#include "sweep/rows.h"

/* How many of so many threads share it. */
unsigned msri_bands_parts(const msri_bands *bands, unsigned threads);

/* Stages of a pass: as many as keep bands in cache, and parts from being all wedge. */
int msri_bands_stages(const msri_bands *bands, unsigned parts);

/* Doubles of memory for a part; they are 0 before the first pass. */
size_t msri_bands_size(const msri_bands *bands, unsigned parts, int stages);

/* Takes a part, as those of rows, through all stages of a pass. Returns the largest speed along an
 * axis. */
double msri_bands_run(const msri_pass *pass, const msri_part *part);

#endif
