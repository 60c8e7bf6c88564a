/* machine.h - where and with what something was measured. */
#ifndef CLI_MACHINE_H
#define CLI_MACHINE_H

#include "options.h"

typedef struct machine {
  char processor[128]; /* its model and the system: "AMD EPYC, Linux x86_64" */
  char compiler[128];  /* "gcc 12.2.0" */
  char date[32];       /* UTC, ISO 8601: "2026-11-22T15:41:00Z" */
} machine;

machine machine_describe(void);

/* Version of the GSL that msr runs with. */
const char *machine_gsl(void);

#endif
