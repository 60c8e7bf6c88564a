/* team.c - see team.h. Work is shorter than what it takes to wake a thread, so that threads look
 * for more for a while before they sleep; where there are fewer processors than threads, they give
 * way to each other meanwhile. */
#include "base/team.h"

#include "base/machine.h"

#include <limits.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>

enum { AWAKE = 20000, PATIENT = 2000 }; /* looks until a thread sleeps, or gives way */

typedef struct member {
  msri_team *team;
  pthread_t thread;
  unsigned number;
} member;

struct msri_team {
  unsigned threads, started;
  _Atomic unsigned round; /* of work; its last is to end */
  _Atomic unsigned ready; /* threads that have done this round's */
  _Atomic bool ends;
  msri_team_work *work;
  void *self;
  pthread_mutex_t mutex;
  pthread_cond_t more;
  member member[];
};

static void rest_a_moment(unsigned looks) {
  if (looks % PATIENT == PATIENT - 1)
    sched_yield();
  else
    msri_pause();
}

void msri_team_wait(const _Atomic unsigned *count, unsigned least) {
  for (unsigned looks = 0; atomic_load_explicit(count, memory_order_acquire) - least > UINT_MAX / 2;
       looks++)
    rest_a_moment(looks);
}

/* The round after `done`, once it begins. */
static unsigned next_round(msri_team *team, unsigned done) {
  for (unsigned looks = 0; looks < AWAKE; looks++) {
    if (atomic_load_explicit(&team->round, memory_order_acquire) != done) return done + 1;
    rest_a_moment(looks);
  }
  pthread_mutex_lock(&team->mutex);
  while (atomic_load(&team->round) == done) pthread_cond_wait(&team->more, &team->mutex);
  pthread_mutex_unlock(&team->mutex);
  return done + 1;
}

static void *serve(void *self) {
  const member *me = self;
  msri_team *team = me->team;
  for (unsigned round = 0;;) {
    round = next_round(team, round);
    if (atomic_load(&team->ends)) return NULL;
    team->work(team->self, me->number);
    atomic_fetch_add_explicit(&team->ready, 1, memory_order_release);
  }
}

static void begin_round(msri_team *team) {
  pthread_mutex_lock(&team->mutex);
  atomic_fetch_add_explicit(&team->round, 1, memory_order_release);
  pthread_cond_broadcast(&team->more);
  pthread_mutex_unlock(&team->mutex);
}

void msri_team_run(msri_team *team, msri_team_work *work, void *self) {
  team->work = work;
  team->self = self;
  atomic_store_explicit(&team->ready, 0, memory_order_relaxed);
  begin_round(team);
  work(self, 0);
  msri_team_wait(&team->ready, team->threads - 1);
}

/* Signals are for the program's own threads, but for those that a thread brings on itself. */
static bool begin_thread(member *m) {
  static const int own[] = {SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGSEGV, SIGTRAP, SIGSYS};
  sigset_t others, before;
  sigfillset(&others);
  for (size_t i = 0; i < sizeof own / sizeof *own; i++) sigdelset(&others, own[i]);
  pthread_sigmask(SIG_BLOCK, &others, &before);
  const bool begun = pthread_create(&m->thread, NULL, serve, m) == 0;
  pthread_sigmask(SIG_SETMASK, &before, NULL);
  return begun;
}

msr_status msri_team_create(unsigned threads, msri_team **team, msr_error *err) {
  const size_t size = sizeof(msri_team) + threads * sizeof(member);
  msri_team *made = msri_alloc(1, size, "threads", err);
  if (!made) return MSR_ENOMEM;
  made->threads = threads;
  pthread_mutex_init(&made->mutex, NULL);
  pthread_cond_init(&made->more, NULL);
  for (unsigned n = 1; n < threads; n++, made->started++) {
    made->member[n] = (member){.team = made, .number = n};
    if (begin_thread(&made->member[n])) continue;
    msri_team_free(made);
    return msri_fail(err, MSR_ENOMEM, "only %u of %u threads can be started; ask for fewer", n,
                     threads);
  }
  *team = made;
  return MSR_OK;
}

void msri_team_free(msri_team *team) {
  if (!team) return;
  atomic_store(&team->ends, true);
  begin_round(team);
  for (unsigned n = 1; n <= team->started; n++) pthread_join(team->member[n].thread, NULL);
  pthread_cond_destroy(&team->more);
  pthread_mutex_destroy(&team->mutex);
  free(team);
}
