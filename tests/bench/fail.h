/* fail.h - how a bench ends that can't go on. */
#ifndef BENCH_FAIL_H
#define BENCH_FAIL_H

#ifdef __cplusplus
extern "C" {
#endif

/* Ends the program with a line on stderr. */
void bench_fail(const char *what, ...) __attribute__((format(printf, 1, 2), noreturn));

#ifdef __cplusplus
}
#endif

#endif
