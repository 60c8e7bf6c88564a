/* trajectory.c - the sink that writes every frame's positions and velocities as a NumPy array. */
#include "base/file.h"
#include "formats/npy.h"
#include "plan/state.h"

#include <stdlib.h>

enum { ROWS = 1024 }; /* masses per write */

typedef struct trajectory {
  msri_file file;
  uint64_t masses, planned, frames; /* planned: in the header; frames: so far */
  double row[ROWS][4];
} trajectory;

static msr_status take(void *self, const msr_state *state, uint64_t frame, msr_error *err) {
  (void)frame;
  trajectory *tr = self;
  const msr_view s = msr_state_view(state);
  msr_status status = MSR_OK;
  for (size_t first = 0; first < s.n && status == MSR_OK; first += ROWS) {
    const size_t count = s.n - first < ROWS ? s.n - first : ROWS;
    for (size_t r = 0; r < count; r++) {
      const size_t i = first + r;
      tr->row[r][0] = s.x[i], tr->row[r][1] = s.y[i];
      tr->row[r][2] = s.vx[i], tr->row[r][3] = s.vy[i];
    }
    status = msri_file_write(&tr->file, tr->row, count * sizeof *tr->row, err);
  }
  tr->frames++;
  return status;
}

static msr_status write_header(trajectory *tr, uint64_t frames, msr_error *err) {
  unsigned char header[MSRI_NPY_HEADER_SIZE];
  msri_npy_header(frames, tr->masses, header);
  return msri_file_write(&tr->file, header, sizeof header, err);
}

/* A run that stopped early has fewer frames than the header says; a pipe can't be mended. */
static msr_status mend_header(trajectory *tr, msr_error *err) {
  if (tr->frames == tr->planned || fseek(tr->file.stream, 0, SEEK_SET) != 0) return MSR_OK;
  return write_header(tr, tr->frames, err);
}

static msr_status finish(void *self, msr_error *err) {
  trajectory *tr = self;
  msr_status status = tr->frames > 0 ? mend_header(tr, err) : MSR_OK;
  if (status == MSR_OK && tr->frames > 0)
    status = msri_file_commit(&tr->file, err);
  else
    msri_file_abandon(&tr->file);
  free(tr);
  return status;
}

msr_status msr_trajectory_open(const msr_plan *plan, const char *path, msr_sink *sink,
                               msr_error *err) {
  trajectory *tr = msri_alloc(1, sizeof *tr, "the trajectory", err);
  if (!tr) return MSR_ENOMEM;
  tr->masses = plan->figures.masses;
  tr->planned = plan->figures.images;
  msr_status status = msri_file_create(path, &tr->file, err);
  if (status == MSR_OK) status = write_header(tr, tr->planned, err);
  if (status == MSR_OK) {
    *sink = (msr_sink){tr, take, finish, NULL};
    return MSR_OK;
  }
  msri_file_abandon(&tr->file);
  free(tr);
  return status;
}
