/* machine.c - see machine.h; the processor's name is Linux's. */
#include "machine.h"

#include "msr.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

#ifdef __clang__
static const char compiler[] = __VERSION__;
#else
static const char compiler[] = "gcc " __VERSION__;
#endif

void bench_print_machine(void) {
  char line[128], day[32], model[128] = "unknown machine";
  const time_t now = time(NULL);
  strftime(day, sizeof day, "%Y-%m-%d %H:%M", localtime(&now));
  FILE *cpus = fopen("/proc/cpuinfo", "r");
  while (cpus && fgets(line, sizeof line, cpus))
    if (sscanf(line, "model name : %127[^\n]", model) == 1) break;
  if (cpus) fclose(cpus);
  printf("%s, %s, %ld cores, %s, libmsr %s", day, model, sysconf(_SC_NPROCESSORS_ONLN), compiler,
         msr_version());
}
