/* notes.c - a growing list of sentences. */
#include "base/notes.h"

#include "base/number.h"

#include <stdarg.h>
#include <stdlib.h>

msr_status msri_notes_add(msri_notes *notes, msr_error *err, const char *format, ...) {
  void *grown =
      msri_grow(notes->text, &notes->capacity, notes->n + 1, sizeof *notes->text, "a note", err);
  if (!grown) return MSR_ENOMEM;
  notes->text = grown;
  va_list arguments;
  va_start(arguments, format);
  msri_vformat(notes->text[notes->n], sizeof *notes->text, format, arguments);
  va_end(arguments);
  notes->n++;
  return MSR_OK;
}

const char *msri_notes_at(const msri_notes *notes, size_t i) {
  return i < notes->n ? notes->text[i] : NULL;
}

void msri_notes_clear(msri_notes *notes) {
  free(notes->text);
  *notes = (msri_notes){0};
}
