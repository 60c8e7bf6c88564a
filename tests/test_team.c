/* test_team.c - threads that work together: each does each round's work once, none before the one
 * before is done by all; teams come and go. Threads may be refused.
 *
 * link: --wrap=malloc --wrap=calloc --wrap=realloc --wrap=pthread_create */
#include "base/team.h"

#include "alloc.h"
#include "scenes.h"

#include <errno.h>
#include <pthread.h>
#include <stdatomic.h>
#include <time.h>

enum { MOST = 8 };

/* Plain numbers: rounds order who writes and who reads them. */
typedef struct tally {
  unsigned threads;
  uint64_t rounds[MOST], seen[MOST]; /* by each; and what it saw of the next one's */
} tally;

static void count(void *self, unsigned thread) { ((tally *)self)->rounds[thread]++; }

/* What another thread counted in the round before. */
static void look(void *self, unsigned thread) {
  tally *t = self;
  t->seen[thread] += t->rounds[(thread + 1) % t->threads];
}

static msri_team *team_of(unsigned threads) {
  msri_team *team;
  must(msri_team_create(threads, &team, &why));
  return team;
}

static void each_works_once_a_round(void **state) {
  (void)state;
  enum { ROUNDS = 50 };
  for (unsigned threads = 1; threads <= MOST; threads++) {
    tally t = {.threads = threads};
    msri_team *team = team_of(threads);
    for (uint64_t n = 1; n <= ROUNDS; n++) {
      msri_team_run(team, count, &t);
      for (unsigned i = 0; i < MOST; i++) assert_true(t.rounds[i] == (i < threads ? n : 0));
      msri_team_run(team, look, &t);
      for (unsigned i = 0; i < MOST; i++)
        assert_true(t.seen[i] == (i < threads ? n * (n + 1) / 2 : 0));
    }
    msri_team_free(team);
  }
}

/* Threads fall asleep between rounds, and wake. */
static void sleepers_wake(void **state) {
  (void)state;
  const struct timespec nap = {.tv_nsec = 20000000};
  tally t = {.threads = 3};
  msri_team *team = team_of(3);
  for (int n = 0; n < 5; n++) {
    msri_team_run(team, count, &t);
    nanosleep(&nap, NULL);
  }
  for (unsigned i = 0; i < 3; i++) assert_true(t.rounds[i] == 5);
  msri_team_free(team);
}

/* With work or without, awake or asleep. */
static void teams_come_and_go(void **state) {
  (void)state;
  const struct timespec nap = {.tv_nsec = 10000000};
  for (unsigned n = 0; n < 100; n++) {
    tally t = {.threads = 1 + n % MOST};
    msri_team *team = team_of(t.threads);
    if (n % 3 == 0) msri_team_run(team, count, &t);
    if (n % 20 == 0) nanosleep(&nap, NULL);
    msri_team_free(team);
    for (unsigned i = 0; i < t.threads; i++) assert_true(t.rounds[i] == (n % 3 == 0));
  }
  msri_team_free(NULL);
}

/* ---- One thread waits for another */

enum { LINKS = 100 };

/* Each adds a link to a chain once the one before it has added its own. */
typedef struct chain {
  unsigned threads, begin;
  _Atomic unsigned links[MOST];
  unsigned length; /* plain: who waits sees what was written before */
} chain;

static void add_links(void *self, unsigned thread) {
  chain *c = self;
  const unsigned before = (thread + c->threads - 1) % c->threads;
  for (unsigned n = 1; n <= LINKS; n++) {
    msri_team_wait(&c->links[before], c->begin + (thread == 0 ? n - 1 : n));
    c->length++;
    atomic_store_explicit(&c->links[thread], c->begin + n, memory_order_release);
  }
}

static void wait_in_a_chain(unsigned threads, unsigned begin) {
  chain c = {.threads = threads, .begin = begin};
  for (unsigned i = 0; i < MOST; i++) atomic_init(&c.links[i], begin);
  msri_team *team = team_of(threads);
  msri_team_run(team, add_links, &c);
  assert_int_equal(c.length, threads * LINKS);
  msri_team_free(team);
}

/* Counts go round after 2^32, too. */
static void who_waits_goes_on_in_turn(void **state) {
  (void)state;
  for (unsigned threads = 1; threads <= 4; threads++) {
    wait_in_a_chain(threads, 0);
    wait_in_a_chain(threads, UINT32_MAX - LINKS / 2);
  }
}

/* ---- What is refused */

typedef void *thread_function(void *self);
int __real_pthread_create(pthread_t *thread, const pthread_attr_t *attr, thread_function *function,
                          void *self);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attr, thread_function *function,
                          void *self);

static unsigned threads_left = UINT32_MAX; /* that the system gives */

int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attr, thread_function *function,
                          void *self) {
  if (threads_left == 0) return EAGAIN;
  threads_left--;
  return __real_pthread_create(thread, attr, function, self);
}

/* Those that did start end. */
static void threads_may_be_refused(void **state) {
  (void)state;
  for (unsigned given = 0; given < 4; given++) {
    msri_team *team = NULL;
    threads_left = given;
    assert_int_equal(msri_team_create(5, &team, &why), MSR_ENOMEM);
    assert_null(team);
    char wanted[64];
    snprintf(wanted, sizeof wanted, "only %u of 5 threads", given + 1);
    assert_non_null(strstr(why.message, wanted));
  }
  threads_left = UINT32_MAX;
}

static bool create_team(void) {
  msri_team *team = NULL;
  const bool done = msri_team_create(1, &team, &why) == MSR_OK;
  if (done) msri_team_free(team);
  return done;
}

static void memory_may_run_out(void **state) {
  (void)state;
  assert_int_equal(alloc_fail_each(create_team), 1);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(each_works_once_a_round), cmocka_unit_test(sleepers_wake),
      cmocka_unit_test(teams_come_and_go),       cmocka_unit_test(who_waits_goes_on_in_turn),
      cmocka_unit_test(threads_may_be_refused),  cmocka_unit_test(memory_may_run_out),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
