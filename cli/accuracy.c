/* accuracy.c - msr accuracy: studies what accuracy costs in time on a scene; table, CSV, figure. */
#include "commands.h"
#include "csv.h"
#include "figure.h"
#include "report.h"
#include "signals.h"
#include "simulation.h"
#include "study.h"
#include "table.h"
#include "whole_file.h"

#include <string.h>

typedef struct files {
  whole_file csv, figure; /* all zero: not asked for, or no figure can be drawn */
  msr_error no_figure;    /* why it can't */
} files;

/* The study, the table and the CSV are worth having without the figure. */
static msr_status check_figure(const settings *s, files *out, msr_error *err) {
  const msr_status status = s->plot ? figure_check(s, &out->no_figure) : MSR_OK;
  if (status == MSR_EIO) tell(s, "warning", out->no_figure.message);
  if (status == MSR_OK || status == MSR_EIO) return MSR_OK;
  *err = out->no_figure;
  return status;
}

/* Before the study, so that what can't be written is told at once. */
static msr_status open_files(const settings *s, files *out, msr_error *err) {
  msr_status status = check_figure(s, out, err);
  const bool drawn = s->plot && out->no_figure.status == MSR_OK;
  if (status == MSR_OK && s->csv) status = whole_file_open(s->csv, &out->csv, err);
  if (status == MSR_OK && drawn) status = whole_file_open(s->plot, &out->figure, err);
  return status;
}

static void abandon_files(files *out) {
  whole_file_abandon(&out->csv);
  whole_file_abandon(&out->figure);
}

/* The table goes where the CSV doesn't. */
static msr_status print_table(const study *st, msr_error *err) {
  const bool taken = st->s->csv && strcmp(st->s->csv, "-") == 0;
  if (!taken) table_print(stdout, st);
  if (taken && !st->s->quiet) table_print(stderr, st);
  return print_end(err);
}

static msr_status write_csv(const study *st, files *out, msr_error *err) {
  if (!out->csv.stream) return MSR_OK;
  csv_print(out->csv.stream, st);
  return whole_file_commit(&out->csv, err);
}

/* After a signal, which is told instead, a figure that can't be drawn is no further failure. */
static msr_status write_figure(const study *st, files *out, msr_error *err) {
  if (out->no_figure.status != MSR_OK && !signals_caught()) {
    *err = out->no_figure;
    return err->status;
  }
  if (!out->figure.stream) return MSR_OK;
  const msr_status status = figure_draw(st, fileno(out->figure.stream), err);
  return status == MSR_OK ? whole_file_commit(&out->figure, err) : status;
}

/* Each, whatever becomes of the others; the first failure is told. */
static msr_status write_all(const study *st, files *out, msr_error *err) {
  static msr_status (*const writers[])(const study *, files *, msr_error *) = {write_csv,
                                                                               write_figure};
  msr_status first = print_table(st, err);
  for (size_t i = 0; i < sizeof writers / sizeof writers[0]; i++) {
    msr_error other = {MSR_OK, ""};
    const msr_status status = writers[i](st, out, first == MSR_OK ? err : &other);
    if (first == MSR_OK) first = status;
  }
  return first;
}

static msr_status finish(const study *st, files *out, msr_error *err) {
  const int caught = signals_caught();
  const msr_status status = write_all(st, out, err);
  if (status != MSR_OK) return status;
  study_tell_limits(st);
  if (caught)
    return fail(err, MSR_EINTR, "interrupted after %zu point%s", st->n, st->n == 1 ? "" : "s");
  if (!st->figures.complete) {
    tell(st->s, "note", "time ran out before all was measured; --budget SECONDS gives more");
  }
  return MSR_OK;
}

static msr_status study_scene(const settings *s, const msr_scene *scene, msr_error *err) {
  study st = {.s = s};
  files out = {.csv = {.stream = NULL}};
  signals_catch();
  msr_status status = open_files(s, &out, err);
  if (status == MSR_OK) status = study_run(&st, s, scene, err);
  if (status == MSR_OK) status = finish(&st, &out, err);
  abandon_files(&out);
  study_free(&st);
  signals_end_by_pipe();
  return status;
}

msr_status accuracy_command(const settings *s, msr_error *err) {
  msr_scene *scene = NULL;
  msr_status status = simulation_scene(s, &scene, err);
  if (status != MSR_OK) return status;
  status = study_scene(s, scene, err);
  msr_scene_free(scene);
  return status;
}
