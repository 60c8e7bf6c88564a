/* machine.c - where and with what something was measured. */
#include "machine.h"

#include <string.h>
#include <sys/utsname.h>
#include <time.h>

#if defined(__clang__)
#define COMPILER __VERSION__
#elif defined(__GNUC__)
#define COMPILER "gcc " __VERSION__
#else
#define COMPILER "an unknown compiler"
#endif

#if defined(__GNUC__) && !defined(__OPTIMIZE__)
#define OPTIMISED ", not optimised"
#else
#define OPTIMISED ""
#endif

/* GSL's own: the command includes no header but the library's. */
extern const char *gsl_version;

const char *machine_gsl(void) { return gsl_version; }

/* From a line such as "model name : AMD EPYC" of Linux; "" elsewhere. */
static void read_model(char *model, size_t size) {
  static const char key[] = "model name";
  char line[256];
  FILE *const file = fopen("/proc/cpuinfo", "r");
  *model = '\0';
  while (file && !*model && fgets(line, sizeof line, file)) {
    const char *const colon = strchr(line, ':');
    if (!colon || strncmp(line, key, sizeof key - 1) != 0) continue;
    const char *const name = colon + 1 + strspn(colon + 1, " \t");
    snprintf(model, size, "%.*s", (int)strcspn(name, "\n"), name);
  }
  if (file) fclose(file);
}

static void describe_processor(char *text, size_t size) {
  char model[96];
  struct utsname system;
  read_model(model, sizeof model);
  const bool known = uname(&system) >= 0;
  snprintf(text, size, "%s%s%.12s %.12s", model, *model ? ", " : "",
           known ? system.sysname : "unknown", known ? system.machine : "system");
}

machine machine_describe(void) {
  machine m = {.compiler = COMPILER OPTIMISED};
  const time_t now = time(NULL);
  struct tm utc;
  describe_processor(m.processor, sizeof m.processor);
  if (gmtime_r(&now, &utc)) strftime(m.date, sizeof m.date, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return m;
}
