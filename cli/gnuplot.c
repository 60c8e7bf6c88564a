/* gnuplot.c - gnuplot as a child process: found on PATH, without a shell; it reads its script from
 * a pipe and no configuration of the user (-d). */
#include "gnuplot.h"

#include "report.h"
#include "signals.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

static msr_status cannot_start(int number, msr_error *err) {
  char reason[128] = "unknown error";
  strerror_r(number, reason, sizeof reason);
  if (number != ENOENT) return fail(err, MSR_EIO, "--plot: cannot start gnuplot: %s", reason);
  return fail(
      err, MSR_EIO,
      "--plot needs gnuplot, which isn't there; install it (Debian, Ubuntu: apt-get install "
      "gnuplot-nox); the table and --csv don't need it");
}

/* Standard input from the pipe, standard output to out; 0 or an error's number. */
static int spawn(pid_t *process, int in, int out) {
  static char name[] = "gnuplot", no_files[] = "-d", from_input[] = "-";
  char *const words[] = {name, no_files, from_input, NULL};
  posix_spawn_file_actions_t actions;
  int number = posix_spawn_file_actions_init(&actions);
  if (number) return number;
  number = posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
  if (!number) number = posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
  if (!number) number = posix_spawnp(process, name, &actions, NULL, words, environ);
  posix_spawn_file_actions_destroy(&actions);
  return number;
}

/* Its descriptors must not reach the child, which would wait for itself. */
static bool open_pipe(int ends[2]) {
  if (pipe(ends) != 0) return false;
  for (int i = 0; i < 2; i++) (void)fcntl(ends[i], F_SETFD, FD_CLOEXEC);
  return true;
}

msr_status gnuplot_start(gnuplot *g, int out, msr_error *err) {
  int ends[2];
  if (!open_pipe(ends)) return cannot_start(errno, err);
  g->script = fdopen(ends[1], "w");
  const int number = g->script ? spawn(&g->process, ends[0], out) : errno;
  close(ends[0]);
  if (number) {
    if (g->script) fclose(g->script);
    if (!g->script) close(ends[1]);
    return cannot_start(number, err);
  }
  // If it ends before its script does, that is told by its status.
  const struct sigaction ignore = {.sa_handler = SIG_IGN};
  sigaction(SIGPIPE, &ignore, &g->broken);
  return MSR_OK;
}

msr_status gnuplot_end(gnuplot *g, msr_error *err) {
  int status = 0;
  pid_t ended;
  fclose(g->script);
  sigaction(SIGPIPE, &g->broken, NULL);
  do ended = waitpid(g->process, &status, 0);
  while (ended < 0 && errno == EINTR);
  if (ended == g->process && WIFEXITED(status) && WEXITSTATUS(status) == 0) return MSR_OK;
  // Ctrl-C on a terminal reaches gnuplot too.
  if (signals_caught()) return fail(err, MSR_EINTR, "interrupted while gnuplot was at work");
  return fail(err, MSR_EIO, "--plot: gnuplot failed; the table and --csv don't need it");
}
