/* notes.h - what a user should know about a scene or a plan, in order. */
#ifndef MSRI_NOTES_H
#define MSRI_NOTES_H

#include "base/base.h"

typedef struct msri_notes {
  size_t n, capacity;
  char (*text)[MSR_MESSAGE_SIZE];
} msri_notes;

/* MSR_ENOMEM. */
msr_status msri_notes_add(msri_notes *notes, msr_error *err, const char *format, ...)
    MSRI_PRINTF(3, 4);

/* The i-th, NULL past the last. */
const char *msri_notes_at(const msri_notes *notes, size_t i);

void msri_notes_clear(msri_notes *notes);

#endif
