/* report.c - errors, warnings and exit statuses. Messages go to standard error, one line each; a
 * line about an input begins with `file:line:column:`, so that an editor can jump there, and every
 * other with `msr:`. */
#include "report.h"

#include "commands.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const int exit_statuses[] = {
    [MSR_OK] = 0,     [MSR_EIO] = 1,       [MSR_ENOMEM] = 1,  [MSR_EUSAGE] = 2,
    [MSR_EINPUT] = 3, [MSR_EUNSTABLE] = 4, [MSR_EINTR] = 130,
};

msr_status fail(msr_error *err, msr_status status, const char *format, ...) {
  va_list args;
  va_start(args, format);
  err->status = status;
  vsnprintf(err->message, sizeof err->message, format, args);
  va_end(args);
  return status;
}

void tell(const settings *s, const char *kind, const char *text) {
  if (!s->quiet) fprintf(stderr, "msr: %s: %s\n", kind, text);
}

static bool names_an_input(const settings *s, const char *message) {
  for (size_t i = 0; i < s->n_files; i++) {
    const size_t length = strlen(s->file[i]);
    if (strncmp(message, s->file[i], length) == 0 && message[length] == ':') return true;
  }
  return false;
}

int report(const settings *s, msr_status status, const msr_error *err) {
  if (status == MSR_OK) return 0;
  const char *message = err->message[0] ? err->message : msr_status_text(status);
  const bool located = status == MSR_EINPUT && names_an_input(s, message);
  fprintf(stderr, "%s%s\n", located ? "" : "msr: ", message);
  if (status == MSR_EUSAGE) fprintf(stderr, "try 'msr %s -h'\n", s->command->name);
  return exit_statuses[status];
}

msr_status print_end(msr_error *err) {
  char reason[128] = "write error";
  errno = 0;
  if (!ferror(stdout) && fflush(stdout) == 0) return MSR_OK;
  if (errno) strerror_r(errno, reason, sizeof reason);
  return fail(err, MSR_EIO, "standard output: %s", reason);
}
