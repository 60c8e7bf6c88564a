/* beside.c - see beside.h. The two threads take turns with the sinks: while one frame is completed
 * the next is simulated, but not taken before. Nothing else is shared. */
#include "run/beside.h"

#include <signal.h>

msr_status msri_beside_hand_on(msr_status status, const msr_error *said, uint64_t frame,
                               msr_error *err) {
  if (status == MSR_OK) return MSR_OK;
  return msri_hand_on(err, status, said, "frame %llu: %s", (unsigned long long)frame,
                      msr_status_text(status));
}

static msr_status complete(const msr_run_options *options, uint64_t frame, msr_error *err) {
  msr_status status = MSR_OK;
  for (size_t s = 0; s < options->n_sinks && status == MSR_OK; s++) {
    const msr_sink *sink = &options->sinks[s];
    msr_error said = {MSR_OK, ""};
    if (!sink->complete) continue;
    status = msri_beside_hand_on(sink->complete(sink->self, frame, &said), &said, frame, err);
  }
  return status;
}

/* ---- The thread */

static void *complete_all(void *self) {
  msri_beside *b = self;
  pthread_mutex_lock(&b->lock);
  for (;;) {
    while (!b->busy && !b->ending) pthread_cond_wait(&b->turned, &b->lock);
    if (!b->busy) break;
    pthread_mutex_unlock(&b->lock);
    b->status = complete(b->options, b->frame, &b->said);
    pthread_mutex_lock(&b->lock);
    b->busy = false;
    pthread_cond_signal(&b->turned);
  }
  pthread_mutex_unlock(&b->lock);
  return NULL;
}

/* Signals are for the program's own threads, but for those that a thread brings on itself. */
static void block_signals(sigset_t *before) {
  static const int own[] = {SIGABRT, SIGBUS,  SIGFPE, SIGILL, SIGPIPE,
                            SIGSEGV, SIGTRAP, SIGSYS, SIGXFSZ};
  sigset_t others;
  sigfillset(&others);
  for (size_t i = 0; i < sizeof own / sizeof *own; i++) sigdelset(&others, own[i]);
  pthread_sigmask(SIG_BLOCK, &others, before);
}

static bool begin_thread(msri_beside *b) {
  sigset_t before;
  block_signals(&before);
  const bool begun = pthread_create(&b->thread, NULL, complete_all, b) == 0;
  pthread_sigmask(SIG_SETMASK, &before, NULL);
  return begun;
}

static bool is_called_for(const msr_run_options *options) {
  for (size_t s = 0; s < options->n_sinks; s++)
    if (options->sinks[s].complete) return options->threads > 1;
  return false;
}

static void destroy(msri_beside *b) {
  pthread_mutex_destroy(&b->lock);
  pthread_cond_destroy(&b->turned);
}

void msri_beside_begin(msri_beside *beside, const msr_run_options *options) {
  *beside = (msri_beside){.options = options};
  if (!is_called_for(options)) return;
  if (pthread_mutex_init(&beside->lock, NULL) != 0) return;
  if (pthread_cond_init(&beside->turned, NULL) != 0) {
    pthread_mutex_destroy(&beside->lock);
    return;
  }
  beside->threaded = begin_thread(beside);
  if (!beside->threaded) destroy(beside);
}

/* ---- Turns */

msr_status msri_beside_complete(msri_beside *beside, uint64_t frame, msr_error *err) {
  if (!beside->threaded) return complete(beside->options, frame, err);
  pthread_mutex_lock(&beside->lock);
  beside->frame = frame;
  beside->busy = true;
  pthread_cond_signal(&beside->turned);
  pthread_mutex_unlock(&beside->lock);
  return MSR_OK;
}

msr_status msri_beside_wait(msri_beside *beside, msr_error *err) {
  if (!beside->threaded) return MSR_OK;
  pthread_mutex_lock(&beside->lock);
  while (beside->busy) pthread_cond_wait(&beside->turned, &beside->lock);
  pthread_mutex_unlock(&beside->lock);
  if (beside->status != MSR_OK && err) *err = beside->said;
  return beside->status;
}

msr_status msri_beside_end(msri_beside *beside, msr_error *err) {
  if (!beside->threaded) return MSR_OK;
  const msr_status status = msri_beside_wait(beside, err);
  pthread_mutex_lock(&beside->lock);
  beside->ending = true;
  pthread_cond_signal(&beside->turned);
  pthread_mutex_unlock(&beside->lock);
  pthread_join(beside->thread, NULL);
  destroy(beside);
  return status;
}
