/* team.h - threads that do one thing together, again and again. */
#ifndef MSRI_TEAM_H
#define MSRI_TEAM_H

#include "base/base.h"

typedef struct msri_team msri_team;

/* What each of them does; `thread` is 0 .. threads-1. */
typedef void msri_team_work(void *self, unsigned thread);

/* Starts threads - 1 threads: the caller is number 0. They wait until there is work, awake for some
 * microseconds, then asleep. MSR_ENOMEM if the system gives no more threads. */
msr_status msri_team_create(unsigned threads, msri_team **team, msr_error *err);
void msri_team_free(msri_team *team);

/* All do the work; returns when all have. */
void msri_team_run(msri_team *team, msri_team_work *work, void *self);

/* Waits until *count, which another thread of the team raises, is at least `least`, modulo
 * 2^32. */
void msri_team_wait(const _Atomic unsigned *count, unsigned least);

#endif
