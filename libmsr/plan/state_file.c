/* state_file.c - a state in a file: a header of 8-byte words, then x, y, vx, vy as they are in
 * memory and, if the plan cares, once more as they were kept. The header says the byte order and a
 * hash, so that a foreign or damaged file is refused.
 */
#include "plan/state.h"

#include "base/file.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

/* The numbers of a msri_guard, and all of it in whole words. */
#define NUMBERS(X)      X(energy) X(slack) X(gravity) X(outer) X(lost) X(work) X(gain) X(power) X(most)
#define DECLARE(number) double number;
#define COPY(number)    .number = from->number,
typedef struct record {
  uint64_t begun, looked;
  NUMBERS(DECLARE)
} record;

typedef struct header {
  char magic[8];
  uint64_t order;            /* byte_order as the writer's machine holds it */
  uint64_t masses, substeps; /* of the plan, and DT: what the rest belongs to */
  double dt;
  uint64_t iteration, substep, contacts, frames;
  record guard, care_guard; /* what the guard knows, and knew where q, v were kept */
  uint64_t cares, care_begun, care_on, care_at, care_substep;
  double care_lost;
  uint64_t hash; /* of all of the header before it and of what follows */
} header;

static const char magic[8] = "msrstat2";
static const uint64_t byte_order = 0x0102030405060708U;

static record record_of(const msri_guard *from) {
  return (record){.begun = from->begun, .looked = from->looked, NUMBERS(COPY)};
}

static msri_guard guard_of(const record *from) {
  return (msri_guard){
      .begun = from->begun != 0, .stale = true, .looked = from->looked, NUMBERS(COPY)};
}

/* The arrays of a state in a file, of vector bytes each. */
typedef struct arrays {
  size_t n;
  double *part[3];
  size_t words[3];
} arrays;

static arrays arrays_of(const msr_state *state) {
  const size_t n = 2 * state->plan->figures.masses;
  return (arrays){
      state->plan->cares ? 3 : 2, {state->q, state->v, state->care.kept}, {n, n, 2 * n}};
}

static uint64_t hash_of(const header *h, const arrays *a) {
  uint64_t hash = msri_hash_words(MSRI_HASH_START, h, offsetof(header, hash) / 8);
  for (size_t i = 0; i < a->n; i++) hash = msri_hash_words(hash, a->part[i], a->words[i]);
  return hash;
}

static size_t bytes_of(const arrays *a) {
  size_t words = 0;
  for (size_t i = 0; i < a->n; i++) words += a->words[i];
  return words * sizeof(double);
}

msr_status msr_state_save(const msr_state *state, const char *path, msr_error *err) {
  const arrays a = arrays_of(state);
  const msri_care *care = &state->care;
  header h = {.order = byte_order,
              .masses = state->plan->figures.masses,
              .substeps = state->plan->figures.substeps,
              .dt = state->plan->figures.dt,
              .iteration = state->iteration,
              .substep = state->substep,
              .contacts = state->contacts,
              .frames = state->frames,
              .guard = record_of(&state->guard),
              .care_guard = record_of(&care->guard),
              .cares = state->plan->cares,
              .care_begun = care->begun,
              .care_on = care->on,
              .care_at = care->at,
              .care_substep = care->substep,
              .care_lost = care->lost};
  memcpy(h.magic, magic, sizeof magic);
  h.hash = hash_of(&h, &a);
  msri_file file;
  msr_status status = msri_file_create(path, &file, err);
  if (status != MSR_OK) return status;
  status = msri_file_write(&file, &h, sizeof h, err);
  for (size_t i = 0; i < a.n && status == MSR_OK; i++)
    status = msri_file_write(&file, a.part[i], a.words[i] * sizeof(double), err);
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
  if (h->cares != state->plan->cares)
    return msri_fail(
        err, MSR_EINPUT,
        "%s: the plan that it was saved from chose its integrator or substeps %s; load "
        "it into a state of such a plan",
        path, h->cares ? "by itself" : "as it was told");
  const arrays a = arrays_of(state);
  if (size != sizeof *h + bytes_of(&a))
    return msri_fail(err, MSR_EINPUT, "%s: %zu bytes where %zu are due; it is damaged", path, size,
                     sizeof *h + bytes_of(&a));
  return MSR_OK;
}

/* Puts what was read into a copy of the state, and keeps it if the hash is right. */
static msr_status restore(msr_state *state, const char *path, const header *h,
                          const unsigned char *bytes, msr_error *err) {
  msr_state *read;
  const msr_status status = msr_state_create(state->plan, &read, err);
  if (status != MSR_OK) return status;
  const arrays a = arrays_of(read);
  for (size_t i = 0; i < a.n; i++) {
    memcpy(a.part[i], bytes, a.words[i] * sizeof(double));
    bytes += a.words[i] * sizeof(double);
  }
  read->iteration = h->iteration;
  read->substep = h->substep;
  read->contacts = h->contacts;
  read->frames = h->frames;
  read->guard = guard_of(&h->guard);
  read->care.guard = guard_of(&h->care_guard);
  read->care.begun = h->care_begun != 0;
  read->care.on = h->care_on != 0;
  read->care.at = h->care_at;
  read->care.substep = h->care_substep;
  read->care.lost = h->care_lost;
  const bool sound = hash_of(h, &a) == h->hash;
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
