/* bands.c - see bands.h. A band is made of whole groups of masses by which springs are sorted (see
 * mesh_added.c), as few as the longest offset takes. */
#include "plan/bands.h"

#include "plan/mesh.h"

#include <stdlib.h>

/* Masses of a band: no spring goes further. */
static size_t length_for(size_t masses, const msr_springs *s) {
  size_t longest = 1;
  for (size_t r = 0; r < s->n_runs; r++)
    if (s->run[r].offset > longest) longest = s->run[r].offset;
  const size_t length = msri_round_up(longest, MSRI_MESH_GROUP);
  return length < masses ? length : masses;
}

/* Takes the springs that begin before mass `end`, from the place on that the band before left:
 * spring `at` of run r. */
static void take(const msr_springs *s, size_t end, size_t *r, size_t *at, msri_bundle *bundle) {
  bundle->run = s->run + *r;
  bundle->skip = *at;
  for (; *r < s->n_runs && s->run[*r].first + *at < end; ++*r, *at = 0) {
    const msr_run_of_springs *run = &s->run[*r];
    const size_t before = end - run->first;
    bundle->n_runs++;
    bundle->stop = before < run->count ? before : run->count;
    if (bundle->stop == run->count) continue;
    *at = bundle->stop;
    return;
  }
}

msr_status msri_bands_create(size_t masses, const msr_springs *springs, msri_bands *bands,
                             msr_error *err) {
  const size_t length = length_for(masses, springs), n = (masses + length - 1) / length;
  msri_bundle *bundle = msri_alloc(n, sizeof *bundle, "the springs", err);
  if (!bundle) return MSR_ENOMEM;
  size_t r = 0, at = 0;
  for (size_t b = 0; b < n; b++) {
    bundle[b].base = b * length;
    take(springs, (b + 1) * length, &r, &at, &bundle[b]);
  }
  *bands = (msri_bands){n, length, masses, bundle};
  return MSR_OK;
}

void msri_bands_clear(msri_bands *bands) {
  free(bands->springs);
  *bands = (msri_bands){0};
}

size_t msri_bands_bytes(const msri_bands *bands) { return bands->n * sizeof *bands->springs; }
