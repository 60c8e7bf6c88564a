/* ppm.h - pictures as PPM streams; msr.h has the functions on files. */
#ifndef MSRI_PPM_H
#define MSRI_PPM_H

#include "base/base.h"

#include <stdio.h>

/* MSR_ENOMEM. */
msr_status msri_picture_copy(const msr_picture *picture, msr_picture **copy, msr_error *err);

enum { MSRI_PPM_HEADER_SIZE = 64 };

/* Writes the P6 header of a picture, and returns its length: a frame is this, then rgb. */
size_t msri_ppm_header(const msr_picture *picture, char text[MSRI_PPM_HEADER_SIZE]);

/* Writes the picture as P6, maxval 255. On failure it returns false, and errno says why. */
bool msri_ppm_write(FILE *stream, const msr_picture *picture);

#endif
