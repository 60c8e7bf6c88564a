/* beside.h - what sinks still do with a frame once they have taken it: beside the simulation, in a
 * thread of its own, or at once. */
#ifndef MSRI_BESIDE_H
#define MSRI_BESIDE_H

#include "base/base.h"

#include <pthread.h>

typedef struct msri_beside {
  const msr_run_options *options;
  bool threaded;
  pthread_t thread;
  pthread_mutex_t lock; /* of what follows */
  pthread_cond_t turned;
  bool busy, ending; /* with a frame; after it */
  uint64_t frame;    /* the last one */
  msr_status status; /* that sinks returned for it, and what they said */
  msr_error said;
} msri_beside;

/* Begins the thread if the options ask for one, a sink has something to do there and there is one
 * to be had; the options must outlive it. */
void msri_beside_begin(msri_beside *beside, const msr_run_options *options);

/* All sinks took the frame: completes it, or lets it be completed. What a sink returns. */
msr_status msri_beside_complete(msri_beside *beside, uint64_t frame, msr_error *err);

/* Waits for the frame that is being completed. What a sink returned. */
msr_status msri_beside_wait(msri_beside *beside, msr_error *err);

/* Likewise, and ends the thread. */
msr_status msri_beside_end(msri_beside *beside, msr_error *err);

/* What a sink returned for a frame, with what it said. */
msr_status msri_beside_hand_on(msr_status status, const msr_error *said, uint64_t frame,
                               msr_error *err);

#endif
