/* places.c - tells whether two paths lead to one file, whatever their spelling: the file itself
 * decides if it is there, else the nearest directories above that are. */
#include "places.h"

#include "commands.h"
#include "report.h"

#include <string.h>
#include <sys/stat.h>

enum { PATH_SIZE = 4096, PLACES = 5 };

typedef struct place {
  const char *option, *path; /* path NULL: nothing goes there */
} place;

static bool is_stdout(const char *path) { return path && strcmp(path, "-") == 0; }

/* Devices such as /dev/null have room for all. */
static bool same_file(const char *a, const char *b) {
  struct stat p, q;
  return stat(a, &p) == 0 && stat(b, &q) == 0 && p.st_dev == q.st_dev && p.st_ino == q.st_ino &&
         !S_ISCHR(p.st_mode);
}

/* A path that begins with a directory that is there. */
static void anchor(const char *path, char text[PATH_SIZE]) {
  const char *const name = is_stdout(path) ? "/dev/stdout" : path;
  snprintf(text, PATH_SIZE, "%s%s", *name == '/' ? "/." : "./", name);
}

/* Takes the last name off a path and returns it; NULL: there is but one. */
static const char *take_last(char *path) {
  size_t n = strlen(path);
  while (n > 1 && (path[n - 1] == '/' || strcmp(path + n - 2, "/.") == 0)) path[--n] = '\0';
  char *const slash = strrchr(path, '/');
  if (!slash) return NULL;
  *slash = '\0';
  return slash + 1;
}

static bool same_place(const char *a, const char *b) {
  char p[PATH_SIZE], q[PATH_SIZE];
  anchor(a, p);
  anchor(b, q);
  while (!same_file(p, q)) {
    const char *const m = take_last(p), *const n = take_last(q);
    if (!m || !n || strcmp(m, n) != 0) return false;
  }
  return true;
}

/* Is it a frame in this directory, which --force would remove? */
static bool frame_in(const char *path, const char *dir) {
  const char *const slash = strrchr(path, '/');
  const char *const name = slash ? slash + 1 : path;
  char parent[PATH_SIZE];
  snprintf(parent, sizeof parent, "%.*s", slash ? (int)(name - path) : 1, slash ? path : ".");
  return strncmp(name, "frame-", 6) == 0 && same_file(parent, dir);
}

static msr_status check_input(const settings *s, const char *input, const place *out,
                              msr_error *err) {
  for (size_t i = 0; i < PLACES; i++) {
    const char *const path = out[i].path;
    if (!path || is_stdout(path) || !same_file(input, path)) continue;
    return fail(err, MSR_EUSAGE, "'%s' is an input and can't be written over", path);
  }
  if (!s->force || !frame_in(input, s->output)) return MSR_OK;
  return fail(err, MSR_EUSAGE, "--force would remove '%s', which is an input", input);
}

static msr_status check_pair(const place *a, const place *b, msr_error *err) {
  if (!a->path || !b->path || !same_place(a->path, b->path)) return MSR_OK;
  const bool named = !is_stdout(a->path);
  return fail(err, MSR_EUSAGE, "%s and %s can't both go to %s%s%s", a->option, b->option,
              named ? "'" : "", named ? a->path : "standard output", named ? "'" : "");
}

static const char *frames_place(const settings *s) {
  const bool writes = option_find("--output")->commands & s->command->bit;
  return writes && !s->no_frames ? s->output : NULL;
}

msr_status places_check(const settings *s, msr_error *err) {
  const place out[PLACES] = {{"--output", frames_place(s)},
                             {"--stats", s->stats},
                             {"--trajectory", s->trajectory},
                             {"--csv", s->csv},
                             {"--plot", s->plot}};
  msr_status status = MSR_OK;
  for (size_t i = 0; i < PLACES && status == MSR_OK; i++) {
    for (size_t j = 0; j < i && status == MSR_OK; j++) status = check_pair(&out[j], &out[i], err);
  }
  for (size_t i = 0; i < s->n_files && status == MSR_OK; i++) {
    status = check_input(s, s->file[i], out, err);
  }
  return status;
}
