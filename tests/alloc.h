/* alloc.h - an allocator that fails when told, for test programs whose opening comment holds
 * "link: --wrap=malloc --wrap=calloc --wrap=realloc". */
#ifndef TESTS_ALLOC_H
#define TESTS_ALLOC_H

#include <stdbool.h>
#include <stddef.h>

static size_t alloc_calls;   /* allocations so far */
static size_t alloc_failing; /* the one that fails; 0: none */
static size_t alloc_largest; /* bytes of the largest one so far */

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *block, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *block, size_t size);

static bool alloc_fails(size_t size) {
  if (size > alloc_largest) alloc_largest = size;
  return ++alloc_calls == alloc_failing;
}

void *__wrap_malloc(size_t size) { return alloc_fails(size) ? NULL : __real_malloc(size); }

void *__wrap_calloc(size_t count, size_t size) {
  return alloc_fails(count * size) ? NULL : __real_calloc(count, size);
}

void *__wrap_realloc(void *block, size_t size) {
  return alloc_fails(size) ? NULL : __real_realloc(block, size);
}

/* Calls `attempt` with its first allocation failing, then its second, and so on until it makes
 * fewer. It returns whether it succeeded, which must be so exactly when none failed. Returns the
 * number of allocations that were made to fail; 0 if success and failure were mixed up. */
static inline size_t alloc_fail_each(bool (*attempt)(void)) {
  for (size_t failing = 1;; failing++) {
    alloc_calls = 0;
    alloc_failing = failing;
    const bool succeeded = attempt();
    alloc_failing = 0;
    if (succeeded != (alloc_calls < failing)) return 0;
    if (succeeded) return failing - 1;
  }
}

#endif
