/* stats.c - the sink that writes energies, momentum and contacts as CSV, one row per frame. */
#include "base/file.h"
#include "base/number.h"
#include "plan/state.h"

#include <stdlib.h>
#include <string.h>

typedef struct stats {
  msri_file file;
  uint64_t frames, contacts; /* so far */
} stats;

static const char header[] = "frame,time,kinetic,spring,gravity,total,px,py,contacts,longest\n";

static msr_status take(void *self, const msr_state *state, uint64_t frame, msr_error *err) {
  stats *s = self;
  const msr_energy e = msr_state_energy(state);
  const uint64_t contacts = msr_state_contacts(state);
  if (s->frames == 0) s->contacts = contacts;
  const double value[] = {
      msr_state_view(state).t, e.kinetic, e.spring, e.gravity, e.total, e.px, e.py};
  char text[MSRI_NUMBER_SIZE];
  msri_print(s->file.stream, "%llu", (unsigned long long)frame);
  for (size_t i = 0; i < sizeof value / sizeof *value; i++)
    msri_print(s->file.stream, ",%s", msri_number_write(value[i], text));
  msri_print(s->file.stream, ",%llu,%s\n", (unsigned long long)(contacts - s->contacts),
             msri_number_write(e.longest, text));
  s->contacts = contacts;
  s->frames++;
  return msri_file_flush(&s->file, err);
}

/* A file without a single row isn't kept. */
static msr_status finish(void *self, msr_error *err) {
  stats *s = self;
  msr_status status = MSR_OK;
  if (s->frames > 0)
    status = msri_file_commit(&s->file, err);
  else
    msri_file_abandon(&s->file);
  free(s);
  return status;
}

msr_status msr_stats_open(const msr_plan *plan, const char *path, msr_sink *sink, msr_error *err) {
  (void)plan;
  stats *s = msri_alloc(1, sizeof *s, "the statistics", err);
  if (!s) return MSR_ENOMEM;
  msr_status status = msri_file_create(path, &s->file, err);
  if (status == MSR_OK) status = msri_file_write(&s->file, header, sizeof header - 1, err);
  if (status == MSR_OK) {
    *sink = (msr_sink){s, take, finish, NULL};
    return MSR_OK;
  }
  msri_file_abandon(&s->file);
  free(s);
  return status;
}
