/* frames.c - the sink that draws every frame as a binary PPM: one file each in a directory, or one
 * after the other on standard output. */
#include "base/clock.h"
#include "base/file.h"
#include "base/number.h"
#include "base/pipe.h"
#include "run/renderer.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { NAME_SIZE = 32 }; /* of "/frame-000000.ppm" */

typedef struct frames {
  msr_renderer *renderer;
  double drawing;   /* time that it took so far [s] */
  msri_file stream; /* of a run to standard output */
  size_t directory; /* length of the directory's name; 0: to standard output */
  char path[];      /* directory, then the frame's name */
} frames;

/* ---- The directory */

/* frame-, six digits or more, .ppm */
static bool is_frame(const char *name) {
  static const char stem[] = "frame-";
  const size_t length = sizeof stem - 1;
  if (strncmp(name, stem, length) != 0) return false;
  const size_t digits = strspn(name + length, "0123456789");
  return digits >= 6 && strcmp(name + length + digits, ".ppm") == 0;
}

/* Makes a directory and those above it. */
static msr_status make_directory(char *path, msr_error *err) {
  for (char *end = path + 1;; end++) {
    if (*end != '/' && *end != '\0') continue;
    const char was = *end;
    *end = '\0';
    const bool made = mkdir(path, 0777) == 0 || errno == EEXIST;
    *end = was;
    if (!made) return msri_file_fail(path, "make", err);
    if (was == '\0') return MSR_OK;
  }
}

static const char *next_name(DIR *directory) {
  const struct dirent *entry = readdir(directory); // NOLINT(concurrency-mt-unsafe): its own stream
  return entry ? entry->d_name : NULL;
}

/* Removes the frames of a directory, or refuses if there are any. */
static msr_status clear_frames(frames *f, bool overwrite, msr_error *err) {
  DIR *directory = opendir(f->path);
  if (!directory) return msri_file_fail(f->path, "open", err);
  msr_status status = MSR_OK;
  const char *name;
  while (status == MSR_OK && (name = next_name(directory)) != NULL) {
    if (!is_frame(name)) continue;
    if (!overwrite)
      status = msri_fail(err, MSR_EUSAGE,
                         "%s: frames are there already; name another directory, "
                         "or replace them (--force)",
                         f->path);
    else if (unlinkat(dirfd(directory), name, 0) != 0)
      status = msri_file_fail(f->path, "empty", err);
  }
  closedir(directory);
  return status;
}

/* ---- The sink */

static msr_status take(void *self, const msr_state *state, uint64_t frame, msr_error *err) {
  (void)frame, (void)err;
  frames *f = self;
  const double start = msri_clock_now();
  msri_renderer_take(f->renderer, state);
  f->drawing += msri_clock_now() - start;
  return MSR_OK;
}

/* Rows come in large pieces: another buffer would only copy them. */
static msr_status create_file(const char *path, msri_file *file, msr_error *err) {
  const msr_status status = msri_file_create(path, file, err);
  if (status == MSR_OK) setvbuf(file->stream, NULL, _IONBF, 0);
  return status;
}

static msr_status draw_file(frames *f, msr_error *err) {
  msri_file file;
  msr_status status = create_file(f->path, &file, err);
  if (status != MSR_OK) return status;
  status = msri_renderer_write(f->renderer, &file, &f->drawing, err);
  if (status == MSR_OK) return msri_file_commit(&file, err);
  msri_file_abandon(&file);
  return status;
}

static msr_status draw(void *self, uint64_t frame, msr_error *err) {
  frames *f = self;
  if (f->directory == 0) return msri_renderer_write(f->renderer, &f->stream, &f->drawing, err);
  msri_format(f->path + f->directory, NAME_SIZE, "/frame-%06llu.ppm", (unsigned long long)frame);
  return draw_file(f, err);
}

static msr_status finish(void *self, msr_error *err) {
  frames *f = self;
  const msr_status status = f->directory == 0 ? msri_file_commit(&f->stream, err) : MSR_OK;
  msr_renderer_free(f->renderer);
  free(f);
  return status;
}

static msr_status open_stream(frames *f, msr_error *err) {
  const msr_status status = create_file("-", &f->stream, err);
  if (status == MSR_OK) msri_pipe_widen(fileno(f->stream.stream));
  return status;
}

static msr_status open_place(frames *f, const char *dir, bool overwrite, msr_error *err) {
  if (strcmp(dir, "-") == 0) return open_stream(f, err);
  f->directory = strlen(dir);
  memcpy(f->path, dir, f->directory + 1);
  const msr_status status = make_directory(f->path, err);
  return status == MSR_OK ? clear_frames(f, overwrite, err) : status;
}

msr_status msr_frames_open(const msr_plan *plan, const char *dir, const msr_style *style,
                           bool overwrite, msr_sink *sink, msr_error *err) {
  if (*dir == '\0') return msri_fail(err, MSR_EUSAGE, "the frames' directory needs a name");
  frames *f = msri_alloc(1, sizeof *f + strlen(dir) + NAME_SIZE, "the frames", err);
  if (!f) return MSR_ENOMEM;
  msr_status status = msr_renderer_create(plan, style, &f->renderer, err);
  if (status == MSR_OK) status = open_place(f, dir, overwrite, err);
  if (status == MSR_OK) {
    *sink = (msr_sink){f, take, finish, draw};
    return MSR_OK;
  }
  msr_renderer_free(f->renderer);
  free(f);
  return status;
}

double msr_frames_drawing(const msr_sink *sink) { return ((const frames *)sink->self)->drawing; }
