/* plan.c - msr plan: what would be simulated and why, what it would take; nothing is run. */
#include "commands.h"
#include "effects.h"
#include "inputs.h"
#include "plan_json.h"
#include "report.h"
#include "signals.h"
#include "simulation.h"
#include "steps.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct amount {
  char text[24];
} amount;

/* 12345678 bytes are 12.3 MB. */
static amount bytes(double n) {
  static const char *const units[] = {"bytes", "kB", "MB", "GB", "TB", "PB", "EB"};
  amount a;
  size_t u = 0;
  for (; n >= 1000 && u + 1 < sizeof units / sizeof units[0]; u++) n /= 1000;
  snprintf(a.text, sizeof a.text, "%.3g %s", n, units[u]);
  return a;
}

static void label(const char *text) { printf("%-11s ", text); }

static void print_scene(const msr_plan_figures *f) {
  label("picture");
  printf("%zu x %zu px, %zu of them support\n", f->width, f->height, f->supports);
  label("object");
  printf("masses %zu, springs %zu, springs to fixed points %zu\n", f->masses, f->springs,
         f->anchors);
}

static void print_time(const msr_plan_figures *f) {
  label("time");
  printf("DT %.6g s x %" PRIu64 " iterations = %.6g s, frames %" PRIu64 "\n", f->dt, f->iterations,
         f->dt * (double)f->iterations, f->images);
}

static void print_integrator(const settings *s, const msr_plan_figures *f) {
  const msr_integrator *i = f->integrator;
  const char *const how = s->accuracy > 0 ? " (for --accuracy)" : " (auto)";
  label("integrator");
  printf("%s%s: order %d, ", i->name, s->integrator ? "" : how, i->order);
  if (i->evaluations > 0) {
    printf("%.3g evaluation%s of the forces per step\n", i->evaluations,
           i->evaluations > 1 ? "s" : "");
  } else {
    puts("as many evaluations of the forces as a step needs");
  }
}

static void print_step(const settings *s, const msr_plan *plan, const msr_plan_figures *f) {
  label("step");
  printf("%.6g s: %" PRIu64 " substep%s per DT", f->h, f->substeps, f->substeps > 1 ? "s" : "");
  puts(f->integrator->adaptive ? ", divided as errors ask for" : "");
  steps_print(stdout, s, plan);
  if (f->leaps) {
    label("long steps");
    printf("%s, implicit, wherever cheaper than the substeps that they span\n", f->leaps->name);
  }
  if (f->care) {
    label("energy");
    printf("watched; %s takes over should any come from nowhere\n", f->care->name);
  }
  if (f->integrator->adaptive) {
    label("tolerance");
    printf("%.3g px and px/s, and %.3g of the largest, a step\n", f->atol, f->rtol);
  }
  label("stable step");
  if (isinf(f->stable_step)) {
    puts("any");
  } else if (f->stable_step > 0) {
    printf(
        "%.4g s, at any stretch (Gershgorin); DT is %.3g %% of it; safe steps are up to %.4g s\n",
        f->stable_step, 100 * f->dt / f->stable_step, f->safe_step);
  } else {
    puts("none: this integrator heats whatever the step");
  }
}

static void print_limit(const char *text, const msr_limit *limit, const msr_plan_figures *f) {
  static const char *const ways[] = {[MSR_FOUND_CLOSED_FORM] = "closed form",
                                     [MSR_FOUND_LANCZOS] = "Lanczos",
                                     [MSR_FOUND_BOUND] = "at least: a bound"};
  label(text);
  if (limit->found == MSR_FOUND_ANY) {
    puts("any");
  } else if (limit->found == MSR_FOUND_NONE) {
    puts("none");
  } else {
    printf("%.4g s (%s", limit->step, ways[limit->found]);
    if (limit->iterations > 0) printf(", %d iterations", limit->iterations);
    printf("); DT is %.3g %% of it, a step %.3g %%\n", 100 * f->dt / limit->step,
           100 * f->h / limit->step);
  }
}

static bool damps(const msr_plan *plan) {
  size_t n;
  const msr_effect *const all = msr_plan_effects(plan, &n);
  for (size_t i = 0; i < n && all[i].on; i++) {
    if (all[i].force && all[i].force->uses_velocity) return true;
  }
  return false;
}

static void print_limits(const plan_data *d) {
  print_limit("  at rest", &d->limits.at_rest, &d->f);
  print_limit("  stretched", &d->limits.stretched, &d->f);
  if (d->damps) print_limit("  damped", &d->limits.damped, &d->f);
}

static void print_impacts(const msr_plan_figures *f) {
  static const char *const rules[] = {
      [MSR_IMPACTS_KEPT] = "kept: energy is kept, order 1 through a bounce",
      [MSR_IMPACTS_LOCATED] = "located: the order of the method through a bounce"};
  label("impacts");
  puts(rules[f->impacts]);
}

static double frame_bytes(const settings *s, const msr_plan_figures *f) {
  const double scale = (double)s->scale;
  return 3 * scale * scale * (double)f->width * (double)f->height;
}

static void print_memory(const settings *s, const msr_plan_figures *f) {
  const double frame = s->no_frames ? 0 : frame_bytes(s, f);
  label("memory");
  printf("plan %s, state %s, frame %s\n", bytes((double)f->plan_bytes).text,
         bytes((double)f->state_bytes).text, bytes(frame).text);
}

static void print_frames(const settings *s, const msr_plan_figures *f) {
  const uint64_t scale = s->scale;
  const char *const dir = s->output;
  label("frames");
  if (s->no_frames) {
    puts("none");
    return;
  }
  printf("%" PRIu64 ", each %" PRIu64 " x %" PRIu64 " px, %s in all, ", f->images, scale * f->width,
         scale * f->height, bytes(frame_bytes(s, f) * (double)f->images).text);
  if (strcmp(dir, "-") == 0) {
    puts("to standard output");
  } else {
    printf("in %s%sframe-000000.ppm ...\n", dir, dir[strlen(dir) - 1] == '/' ? "" : "/");
  }
}

static void print_records(const settings *s, const msr_plan_figures *f) {
  if (s->stats) {
    label("stats");
    printf("%" PRIu64 " rows in %s\n", f->images, s->stats);
  }
  if (s->trajectory) {
    label("trajectory");
    printf("%s in %s\n", bytes(32 * (double)f->images * (double)f->masses).text, s->trajectory);
  }
}

static void print_text(const plan_data *d) {
  print_scene(&d->f);
  print_time(&d->f);
  print_integrator(d->s, &d->f);
  print_step(d->s, d->plan, &d->f);
  print_limits(d);
  if (d->contacts) print_impacts(&d->f);
  print_memory(d->s, &d->f);
  print_frames(d->s, &d->f);
  print_records(d->s, &d->f);
  effects_print_costs(stdout, d->list);
}

static msr_status print_plan(const settings *s, const msr_plan *plan, msr_error *err) {
  inputs in = {NULL, NULL};
  plan_data d = {.s = s, .plan = plan, .f = msr_plan_describe(plan)};
  msr_status status = inputs_find(s, &in, err);
  if (status == MSR_OK) status = msr_plan_stability(plan, &d.limits, err);
  if (status != MSR_OK) return status;
  effect_list *const list = effects_create(s, plan);
  if (!list) return fail(err, MSR_ENOMEM, "out of memory for the effects");
  d.picture = in.picture, d.conf = in.conf;
  d.damps = damps(plan), d.contacts = simulation_contacts(plan);
  d.list = list;
  if (s->json) {
    plan_json_print(stdout, &d);
  } else {
    print_text(&d);
  }
  free(list);
  return MSR_OK;
}

msr_status plan_command(const settings *s, msr_error *err) {
  msr_plan *plan = NULL;
  msr_status status = simulation_plan(s, &plan, err);
  if (status != MSR_OK) return status;
  status = print_plan(s, plan, err);
  msr_plan_free(plan);
  if (status == MSR_OK) status = print_end(err);
  signals_end_by_pipe();
  return status;
}
