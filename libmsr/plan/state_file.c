/* state_file.c - a state in a file: a header of 8-byte words, then x, y, vx, vy as they are in
 * memory. The header says the byte order and a hash, so that a foreign or damaged file is refused.
 */
#include "plan/state.h"

#include "base/file.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

typedef struct header {
  char magic[8];
  uint64_t order;            /* byte_order as the writer's machine holds it */
  uint64_t masses, substeps; /* of the plan, and DT: what the rest belongs to */
  double dt;
  uint64_t iteration, substep, contacts, frames;
  uint64_t hash; /* of all of the header before it and of what follows */
} header;

static const char magic[8] = "msrstat1";
static const uint64_t byte_order = 0x0102030405060708U;

static uint64_t hash_of(const header *h, const double *q, const double *v) {
  const uint64_t hash = msri_hash_words(MSRI_HASH_START, h, offsetof(header, hash) / 8);
  return msri_hash_words(msri_hash_words(hash, q, 2 * h->masses), v, 2 * h->masses);
}

msr_status msr_state_save(const msr_state *state, const char *path, msr_error *err) {
  const size_t n = state->plan->figures.masses, vector = 2 * n * sizeof(double);
  header h = {.order = byte_order,
              .masses = n,
              .substeps = state->plan->figures.substeps,
              .dt = state->plan->figures.dt,
              .iteration = state->iteration,
              .substep = state->substep,
              .contacts = state->contacts,
              .frames = state->frames};
  memcpy(h.magic, magic, sizeof magic);
  h.hash = hash_of(&h, state->q, state->v);
  msri_file file;
  msr_status status = msri_file_create(path, &file, err);
  if (status != MSR_OK) return status;
  status = msri_file_write(&file, &h, sizeof h, err);
  if (status == MSR_OK) status = msri_file_write(&file, state->q, vector, err);
  if (status == MSR_OK) status = msri_file_write(&file, state->v, vector, err);
  if (status == MSR_OK) return msri_file_commit(&file, err);
  msri_file_abandon(&file);
  return status;
}

static msr_status check(const msr_state *state, const char *path, const header *h, size_t size,
                        msr_error *err) {
  const size_t n = state->plan->figures.masses;
  if (size < sizeof *h || memcmp(h->magic, magic, sizeof magic) != 0 || h->order != byte_order)
    return msri_fail(err, MSR_EINPUT, "%s: this is no state that this machine saved", path);
  if (h->masses != n)
    return msri_fail(err, MSR_EINPUT,
                     "%s: it has %llu masses and the scene has %zu; load it into "
                     "a state of the scene that it was saved from",
                     path, (unsigned long long)h->masses, n);
  const msr_plan_figures *f = &state->plan->figures;
  if (h->dt != f->dt || h->substeps != f->substeps)
    return msri_fail(
        err, MSR_EINPUT,
        "%s: its iterations are %g s in %llu substeps, those of the plan %g s in %llu; "
        "load it into a state of the plan that it was saved from",
        path, h->dt, (unsigned long long)h->substeps, f->dt, (unsigned long long)f->substeps);
  if (size != sizeof *h + 4 * n * sizeof(double))
    return msri_fail(err, MSR_EINPUT, "%s: %zu bytes where %zu are due; it is damaged", path, size,
                     sizeof *h + 4 * n * sizeof(double));
  return MSR_OK;
}

/* Puts what was read into a copy of the state, and keeps it if the hash is right. */
static msr_status restore(msr_state *state, const char *path, const header *h,
                          const unsigned char *bytes, msr_error *err) {
  msr_state *read;
  const size_t vector = 2 * state->plan->figures.masses * sizeof(double);
  const msr_status status = msr_state_create(state->plan, &read, err);
  if (status != MSR_OK) return status;
  memcpy(read->q, bytes, vector);
  memcpy(read->v, bytes + vector, vector);
  read->iteration = h->iteration;
  read->substep = h->substep;
  read->contacts = h->contacts;
  read->frames = h->frames;
  const bool sound = hash_of(h, read->q, read->v) == h->hash;
  if (sound) msr_state_copy(state, read);
  msr_state_free(read);
  return sound ? MSR_OK : msri_fail(err, MSR_EINPUT, "%s: its hash is wrong; it is damaged", path);
}

msr_status msr_state_load(msr_state *state, const char *path, msr_error *err) {
  unsigned char *bytes;
  size_t size;
  msr_status status = msri_file_read(path, SIZE_MAX / 2, &bytes, &size, err);
  if (status != MSR_OK) return status;
  header h = {.masses = 0};
  memcpy(&h, bytes, size < sizeof h ? size : sizeof h);
  status = check(state, path, &h, size, err);
  if (status == MSR_OK) status = restore(state, path, &h, bytes + sizeof h, err);
  free(bytes);
  return status;
}
