/* study.c - studies and choices, followed: a line on a terminal, an end by Ctrl-C. */
#include "study.h"

#include "report.h"
#include "signals.h"
#include "simulation.h"
#include "status_line.h"
#include "texts.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

static msr_status follow(void *data, const msr_accuracy_progress *progress) {
  if (signals_caught()) return MSR_EINTR;
  if (status_line_due(data)) {
    status_line_show("%3.0f %%  %s", 100 * progress->share, progress->text);
  }
  return MSR_OK;
}

/* What only a plan knows. */
static msr_status look(const msr_scene *scene, const msr_integrator *integrator, bool *contacts,
                       msr_plan_figures *figures, msr_error *err) {
  const msr_plan_options options = {.integrator = integrator, .substeps = 1};
  msr_plan *plan = NULL;
  const msr_status status = msr_plan_create(scene, &options, &plan, err);
  if (status != MSR_OK) return status;
  *figures = msr_plan_describe(plan);
  *contacts = simulation_contacts(plan);
  msr_plan_free(plan);
  return MSR_OK;
}

bool study_short(const study *st) { return st->figures.horizon < st->time * (1 - 1e-9); }

/* The step of a point, and the largest that is safe. What chooses its own steps is safe at any
 * where nothing is hit; else, if its tolerance makes it follow every spring, as Verlet has to. */
static bool is_risky(const study *st, const msr_accuracy_point *p, double safe, double follows) {
  if (!p->stable) return false;
  if (!p->integrator->adaptive) return st->dt / (double)p->substeps > safe;
  return st->contacts && st->figures.horizon / (double)p->steps > follows;
}

/* A run that goes on where the study ended may explode there: the library's own steps don't. */
static msr_status look_for_risks(study *st, const msr_scene *scene, msr_error *err) {
  msr_plan_figures plan = {.dt = 0};
  msr_status status = look(scene, NULL, &st->contacts, &plan, err);
  st->risky = calloc(st->n + 1, sizeof *st->risky);
  if (!st->risky) return fail(err, MSR_ENOMEM, "out of memory for the table");
  st->dt = plan.dt;
  st->time = plan.dt * (double)plan.iterations;
  if (!study_short(st)) return status;
  const double follows = plan.safe_step;
  for (size_t i = 0; i < st->n && status == MSR_OK; i++) {
    const msr_accuracy_point *p = &st->point[i];
    if (plan.integrator != p->integrator) {
      status = look(scene, p->integrator, &st->contacts, &plan, err);
    }
    st->risky[i] = is_risky(st, p, plan.safe_step, follows);
  }
  return status;
}

static msr_status interrupted(msr_error *err) {
  return fail(err, MSR_EINTR, "interrupted before anything was measured");
}

msr_status study_run(study *st, const settings *s, const msr_scene *scene, msr_error *err) {
  status_line line;
  *st = (study){.s = s};
  const msr_accuracy_options options = {.integrators = s->integrators,
                                        .n_integrators = s->n_integrators,
                                        .until = s->until,
                                        .budget = s->budget,
                                        .poll = follow,
                                        .data = &line};
  status_line_start(&line, s);
  const msr_status status = msr_accuracy_study(scene, &options, &st->result, err);
  status_line_end(&line);
  if (status == MSR_EINTR) return interrupted(err);
  if (status != MSR_OK) return status;
  st->figures = msr_accuracy_describe(st->result);
  st->point = msr_accuracy_points(st->result, &st->n);
  return st->n == 0 && signals_caught() ? interrupted(err) : look_for_risks(st, scene, err);
}

void study_free(study *st) {
  msr_accuracy_free(st->result);
  free(st->risky);
}

static void tell_until(const study *st) {
  char text[128];
  const double until = st->s->until;
  const bool early = until > 0 && until < st->dt * (1 - 1e-9);
  const bool late = until > st->time * (1 + 1e-9);
  if (early)
    snprintf(text, sizeof text, "--until %g is less than one DT: the first DT, %g s, is compared",
             until, st->dt);
  if (late)
    snprintf(text, sizeof text, "--until %g is after the scene's end: all of its %.6g s count",
             until, st->time);
  if (early || late) tell(st->s, "note", text);
}

/* Where it's so little that the table may mislead. */
static void tell_horizon(const study *st) {
  char text[256];
  const msr_accuracy_figures *f = &st->figures;
  const char *const plural = f->frames == 1 ? "" : "s";
  if (f->frames >= 3 && f->horizon >= 0.01 * f->until) return;
  if (f->horizon >= f->until * (1 - 1e-9)) {
    snprintf(text, sizeof text,
             "only %" PRIu64 " instant%s up to %.6g s compared: no error in between is seen",
             f->frames, plural, f->horizon);
  } else {
    snprintf(text, sizeof text,
             "only the first %.6g s of %.6g s could be compared, at %" PRIu64 " instant%s: nothing "
             "is known of errors after that; a larger --budget may get further, unless impacts "
             "make the motion chaotic",
             f->horizon, f->until, f->frames, plural);
  }
  tell(st->s, "note", text);
}

void study_tell_limits(const study *st) {
  tell_until(st);
  tell_horizon(st);
}

/* Smaller errors are the reference's own, or rounding. */
static bool measurable(const study *st, const msr_accuracy_point *p) {
  return p->max >= fmax(st->figures.reference_error, 1e-12);
}

double study_order(const study *st, size_t i) {
  const msr_accuracy_point *p = &st->point[i];
  return i > 0 && measurable(st, p - 1) && measurable(st, p) ? p->order : (double)NAN;
}

msr_status study_choose(const settings *s, const msr_scene *scene, msr_accuracy_choice *choice,
                        msr_error *err) {
  status_line line;
  const msr_accuracy_options options = {.poll = follow, .data = &line};
  status_line_start(&line, s);
  signals_catch();
  const msr_status status = msr_accuracy_choose(scene, s->accuracy, &options, choice, err);
  status_line_end(&line);
  if (status != MSR_EINTR) return status;
  return fail(err, status, "interrupted while it chose for --accuracy");
}

void study_tell_choice(const settings *s, const msr_accuracy_choice *choice) {
  char text[2 * MSR_MESSAGE_SIZE];
  const bool brief = choice->seconds < 1;
  snprintf(text, sizeof text, "--accuracy %s: %s", number_exact(s->accuracy).text, choice->reason);
  tell(s, "note", text);
  snprintf(text, sizeof text, "that is%s, in about %.3g %ss", method_options(&choice->options).text,
           choice->seconds * (brief ? 1000 : 1), brief ? "m" : "");
  tell(s, "note", text);
}
