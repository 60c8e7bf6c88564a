/* main.c - msr, the command of libmsr: reads the command line and hands it to a command. */
#include "commands.h"
#include "help.h"
#include "parse.h"
#include "report.h"

#include <fcntl.h>
#include <unistd.h>

/* A standard stream that came closed would give its number to the next file that is opened. */
static void hold_standard_streams(void) {
  int fd = 0;
  while (fd >= 0 && fd <= STDERR_FILENO) fd = open("/dev/null", O_RDONLY);
  if (fd > STDERR_FILENO) close(fd);
}

/* What a command prints goes out at its end, in one piece: then there is a reason to tell if it
 * fails. */
static void hold_output(void) {
  static char buffer[1 << 18];
  setvbuf(stdout, buffer, _IOFBF, sizeof buffer);
}

static msr_status print_help(const settings *s, msr_error *err) {
  if (s->version) {
    help_print_version(stdout);
  } else if (s->named) {
    help_print_command(stdout, s->command);
  } else {
    help_print(stdout);
  }
  return print_end(err);
}

static msr_status obey(const settings *s, msr_error *err) {
  if (s->help || s->version) return print_help(s, err);
  const msr_status status = settings_check(s, err);
  return status == MSR_OK ? s->command->run(s, err) : status;
}

int main(int argc, char **argv) {
  settings s;
  msr_error err = {MSR_OK, ""};
  hold_standard_streams();
  hold_output();
  if (argc < 2) {
    help_print(stderr);
    return 2;
  }
  msr_status status = settings_parse(argc, argv, &s, &err);
  if (status == MSR_OK) status = obey(&s, &err);
  const int exit_status = report(&s, status, &err);
  settings_free(&s);
  return exit_status;
}
