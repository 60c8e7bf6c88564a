/* signals.c - handlers that only take a note: the work looks at it between two steps. SIGPIPE comes
 * to the thread that writes, the others to any: what they share is atomic. */
#include "signals.h"

#include <signal.h>
#include <stdatomic.h>
#include <stddef.h>
#include <time.h>

_Static_assert(ATOMIC_INT_LOCK_FREE == 2, "handlers may use no locks (C11 7.14.1.1)");

enum { ONE_PRESS = 200 }; /* [ms] */

static _Atomic int caught;     /* the last signal, or 0 */
static _Atomic unsigned since; /* when the first came that asks msr to end [ms]; 0: none did */

/* Any clock that goes on; not 0. */
static unsigned milliseconds(void) {
  struct timespec t = {0};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return ((unsigned)t.tv_sec * 1000 + (unsigned)(t.tv_nsec / 1000000)) | 1;
}

/* Where a signal goes to a process and to its group it comes twice; after a while, a second one is
 * impatience: a write to a pipe that nobody reads never ends. */
static void on_signal(int number) {
  unsigned first = 0;
  const unsigned now = milliseconds();
  atomic_store(&caught, number);
  if (number == SIGPIPE || atomic_compare_exchange_strong(&since, &first, now)) return;
  if (now - first < ONE_PRESS) return;
  signal(number, SIG_DFL);
  raise(number);
}

/* With SIGXFSZ ignored, a file that would grow too large is an error of write(2). */
static const struct answer {
  int number;
  void (*handler)(int);
} answers[] = {{SIGINT, on_signal},
               {SIGTERM, on_signal},
               {SIGHUP, on_signal},
               {SIGPIPE, on_signal},
               {SIGXFSZ, SIG_IGN}};

/* A signal that the caller had ignored (nohup, a job in the background) stays ignored. */
void signals_catch(void) {
  for (size_t i = 0; i < sizeof answers / sizeof answers[0]; i++) {
    struct sigaction old, action = {.sa_handler = answers[i].handler, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    if (sigaction(answers[i].number, NULL, &old) != 0 || old.sa_handler == SIG_IGN) continue;
    sigaction(answers[i].number, &action, NULL);
  }
}

int signals_caught(void) { return atomic_load(&caught); }

void signals_end_by_pipe(void) {
  if (signals_caught() != SIGPIPE) return;
  signal(SIGPIPE, SIG_DFL);
  raise(SIGPIPE);
}
