/* inputs.c - tells the picture from the conf. The first bytes of a file decide; those of a pipe can
 * be read only once, so then the other file decides, and if that doesn't help, the names. */
#include "inputs.h"

#include "report.h"

#include <string.h>
#include <sys/stat.h>

typedef enum content { UNKNOWN, PICTURE, OTHER } content;

/* UNKNOWN for what can't be opened, too: the library will say why. */
static content look(const char *path) {
  struct stat info;
  char magic[2] = "";
  FILE *file = stat(path, &info) == 0 && S_ISREG(info.st_mode) ? fopen(path, "rb") : NULL;
  if (!file) return UNKNOWN;
  const size_t n = fread(magic, 1, sizeof magic, file);
  fclose(file);
  return n == 2 && magic[0] == 'P' && magic[1] >= '0' && magic[1] <= '9' ? PICTURE : OTHER;
}

static bool ends_in(const char *path, const char *end) {
  const size_t n = strlen(path), m = strlen(end);
  return n >= m && strcmp(path + n - m, end) == 0;
}

static bool swapped(const char *const file[2], const content what[2]) {
  if (what[0] == what[1]) return ends_in(file[0], ".conf") || ends_in(file[1], ".ppm");
  return what[0] == OTHER || what[1] == PICTURE;
}

msr_status inputs_find(const settings *s, inputs *in, msr_error *err) {
  const content what[] = {look(s->file[0]), look(s->file[1])};
  if (what[0] == PICTURE && what[1] == PICTURE) {
    return fail(err, MSR_EINPUT, "%s and %s are both pictures; one must be a conf", s->file[0],
                s->file[1]);
  }
  const bool swap = swapped(s->file, what);
  *in = (inputs){s->file[swap], s->file[!swap]};
  return MSR_OK;
}
