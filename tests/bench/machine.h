/* machine.h - when, where and with what a benchmark ran. */
#ifndef BENCH_MACHINE_H
#define BENCH_MACHINE_H

#ifdef __cplusplus
extern "C" {
#endif

/* Prints "2026-11-23 00:01, AMD EPYC, 2 cores, gcc 12.2.0, libmsr 0.1.0", without an end of line.
 */
void bench_print_machine(void);

#ifdef __cplusplus
}
#endif

#endif
