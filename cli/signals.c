/* signals.c - handlers that only set a flag: the work looks at it between two steps. */
#include "signals.h"

#include <signal.h>
#include <stddef.h>

static volatile sig_atomic_t caught, times; /* the last signal, or 0; how many */

/* Where a signal goes to a process and to its group it comes twice: the third is impatience. */
static void on_signal(int number) {
  caught = number;
  if (++times < 3 || number == SIGPIPE) return;
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

int signals_caught(void) { return caught; }

void signals_end_by_pipe(void) {
  if (caught != SIGPIPE) return;
  signal(SIGPIPE, SIG_DFL);
  raise(SIGPIPE);
}
