/* grid.h - the picture of a scene and where its masses are. It never changes, so that the scene and
 * its plans share one, which the last of them frees. */
#ifndef MSRI_GRID_H
#define MSRI_GRID_H

#include "base/pixel.h"

#include <stdatomic.h>

typedef struct msri_grid {
  msr_picture *picture;
  size_t masses, supports; /* coloured and black pixels */
  size_t *before;          /* [height + 1]: masses in the rows above; of all, at the end */
  atomic_size_t owners;    /* of any threads */
} msri_grid;

/* Takes the picture. MSR_EINPUT if a pixel is neither air, nor a support, nor a mass, `name`
 * standing for the picture; then, and on MSR_ENOMEM, the picture stays the caller's. */
msr_status msri_grid_create(const char *name, msr_picture *picture, msri_grid **grid,
                            msr_error *err);

/* One more owner. Returns the grid. */
msri_grid *msri_grid_share(msri_grid *grid);

/* One owner less. NULL is fine. */
void msri_grid_free(msri_grid *grid);

/* Bytes of memory; 0 of NULL. */
size_t msri_grid_bytes(const msri_grid *grid);

/* The mass of a pixel that is one. */
size_t msri_grid_mass(const msri_grid *grid, size_t column, size_t row);

/* The pixel of a mass below grid->masses. */
void msri_grid_pixel(const msri_grid *grid, size_t mass, size_t *column, size_t *row);

/* Are the masses one full rectangle? Its sides go to side[2]: columns, rows. */
bool msri_grid_is_rectangle(const msri_grid *grid, size_t side[2]);

#endif
