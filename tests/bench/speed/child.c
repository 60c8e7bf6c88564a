/* child.c - see child.h. */
#include "child.h"

#include "speed.h"

#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* ---- Beginning and end */

/* All that were started and haven't been seen to end: what is stopped would stay for ever. */
enum { MOST = 16 };
static volatile pid_t alive[MOST];

static void forget(pid_t pid) {
  for (size_t i = 0; i < MOST; i++)
    if (alive[i] == pid) alive[i] = 0;
}

static void remember(pid_t pid) {
  for (size_t i = 0; i < MOST; i++)
    if (alive[i] == 0) {
      alive[i] = pid;
      return;
    }
}

static void end_all(void) {
  for (size_t i = 0; i < MOST; i++)
    if (alive[i] > 0) kill(alive[i], SIGKILL);
}

static void interrupted(int what) {
  end_all();
  _exit(128 + what);
}

static void see_to_the_end(void) {
  static bool done;
  if (done) return;
  done = true;
  atexit(end_all);
  signal(SIGINT, interrupted);
  signal(SIGTERM, interrupted);
  signal(SIGPIPE, SIG_IGN);
}

static void become(const int *in, const int *out, const char *const *argv) {
  const int nowhere = open("/dev/null", O_WRONLY);
  char **args = need(64, sizeof *args);
  for (size_t i = 0; argv[i] && i < 63; i++) args[i] = strdup(argv[i]);
  dup2(in[0], STDIN_FILENO);
  dup2(out[1], STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  for (int end = 0; end < 2; end++) close(in[end]), close(out[end]);
  execvp(args[0], args);
  _exit(EXIT_FAILURE);
}

bool child_open(child *c, const char *const *argv) {
  int in[2], out[2];
  *c = (child){0};
  if (pipe(in) != 0 || pipe(out) != 0) bench_fail("there is no pipe");
  see_to_the_end();
  for (int end = 0; end < 2; end++) {
    fcntl(in[end], F_SETFD, FD_CLOEXEC);
    fcntl(out[end], F_SETFD, FD_CLOEXEC);
  }
  fflush(stdout);
  c->started = fork();
  if (c->started < 0) bench_fail("%s can't be started", argv[0]);
  if (c->started == 0) become(in, out, argv);
  close(in[0]);
  close(out[1]);
  c->to = fdopen(in[1], "w");
  c->from = fdopen(out[0], "r");
  return c->to && c->from;
}

/* ---- Questions */

static void signal_all(const child *c, int what) {
  for (size_t i = 0; i < c->pids; i++) kill(c->pid[i], what);
}

bool child_ask(child *c, const char *answer, const char *question, ...) {
  va_list args;
  va_start(args, question);
  vfprintf(c->to, question, args);
  va_end(args);
  fflush(c->to);
  signal_all(c, SIGCONT);
  while (fgets(c->line, sizeof c->line, c->from)) {
    const long pid = strncmp(c->line, "pid ", 4) == 0 ? strtol(c->line + 4, NULL, 10) : 0;
    if (pid > 1 && c->pids < CHILD_PROCESSES) {
      c->pid[c->pids++] = (pid_t)pid;
      remember((pid_t)pid);
    }
    if (strncmp(c->line, answer, strlen(answer)) != 0) continue;
    signal_all(c, SIGSTOP);
    return true;
  }
  return false;
}

double child_resident(const child *c) {
  double bytes = 0;
  for (size_t i = 0; i < c->pids; i++) {
    char path[64];
    unsigned long all, resident;
    snprintf(path, sizeof path, "/proc/%ld/statm", (long)c->pid[i]);
    FILE *f = fopen(path, "r");
    if (f && fscanf(f, "%lu %lu", &all, &resident) == 2)
      bytes += (double)resident * (double)sysconf(_SC_PAGESIZE);
    if (f) fclose(f);
  }
  return bytes;
}

void child_close(child *c) {
  fclose(c->to);
  signal_all(c, SIGCONT);
  fclose(c->from);
  waitpid(c->started, NULL, 0);
  for (size_t i = 0; i < c->pids; i++) forget(c->pid[i]);
}
