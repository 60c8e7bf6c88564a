/* plan_json.c - a plan as one JSON object: what is infinite, unknown or not asked for is null. */
#include "plan_json.h"

#include "json.h"

#include <math.h>

static void print_scene(json *j, const plan_data *d) {
  json_open(j, "scene", '{');
  json_text(j, "picture", d->picture);
  json_text(j, "conf", d->conf);
  json_count(j, "width", d->f.width);
  json_count(j, "height", d->f.height);
  json_count(j, "supports", d->f.supports);
  json_count(j, "masses", d->f.masses);
  json_count(j, "springs", d->f.springs);
  json_count(j, "anchors", d->f.anchors);
  json_close(j, '}');
}

static void print_time(json *j, const plan_data *d) {
  json_open(j, "time", '{');
  json_number(j, "dt", d->f.dt);
  json_count(j, "iterations", d->f.iterations);
  json_number(j, "seconds", d->f.dt * (double)d->f.iterations);
  json_count(j, "frames", d->f.images);
  json_close(j, '}');
}

static const char *name_of(const msr_integrator *i) { return i ? i->name : NULL; }

static void print_integrator(json *j, const plan_data *d) {
  const msr_integrator *const i = d->f.integrator;
  json_open(j, "integrator", '{');
  json_text(j, "name", i->name);
  json_text(j, "chosen_by",
            d->s->accuracy > 0 ? "--accuracy"
            : d->s->integrator ? "--integrator"
                               : "auto");
  json_count(j, "order", (uint64_t)i->order);
  json_number(j, "evaluations", i->evaluations > 0 ? i->evaluations : (double)NAN);
  json_text(j, "leaps", name_of(d->f.leaps));
  json_text(j, "care", name_of(d->f.care));
  json_number(j, "atol", i->adaptive ? d->f.atol : (double)NAN);
  json_number(j, "rtol", i->adaptive ? d->f.rtol : (double)NAN);
  json_close(j, '}');
}

static void print_step(json *j, const plan_data *d) {
  json_open(j, "step", '{');
  json_number(j, "seconds", d->f.h);
  json_count(j, "substeps", d->f.substeps);
  json_bool(j, "adaptive", d->f.integrator->adaptive);
  json_number(j, "safe", d->f.safe_step);
  json_bool(j, "row_by_row", !d->f.by_vectors);
  json_text(j, "by_vectors", d->f.by_vectors);
  json_count(j, "threads", d->f.threads);
  json_count(j, "threads_asked", d->s->threads > 0 ? d->s->threads : 1);
  json_close(j, '}');
}

static void print_limit(json *j, const char *name, const msr_limit *limit) {
  static const char *const found[] = {[MSR_FOUND_ANY] = "any",
                                      [MSR_FOUND_NONE] = "none",
                                      [MSR_FOUND_CLOSED_FORM] = "closed form",
                                      [MSR_FOUND_LANCZOS] = "Lanczos",
                                      [MSR_FOUND_BOUND] = "bound"};
  json_open(j, name, '{');
  json_text(j, "found", found[limit->found]);
  json_number(j, "step", limit->step);
  json_number(j, "omega", limit->omega);
  json_count(j, "iterations", (uint64_t)limit->iterations);
  json_close(j, '}');
}

static void print_limits(json *j, const plan_data *d) {
  json_open(j, "stable_step", '{');
  json_number(j, "bound", d->f.stable_step);
  print_limit(j, "at_rest", &d->limits.at_rest);
  print_limit(j, "stretched", &d->limits.stretched);
  if (d->damps) print_limit(j, "damped", &d->limits.damped);
  if (!d->damps) json_text(j, "damped", NULL);
  json_close(j, '}');
}

static void print_effects(json *j, const plan_data *d) {
  json_open(j, "effects", '[');
  for (size_t i = 0; i < d->list->n; i++) {
    const effect_row *const e = &d->list->effect[i];
    json_open(j, NULL, '{');
    json_text(j, "name", e->name);
    json_bool(j, "on", e->on);
    json_text(j, "why", e->why);
    json_number(j, "calls", e->cost.calls);
    json_number(j, "operations", e->cost.operations);
    json_number(j, "bytes", e->cost.bytes);
    json_bool(j, "at_least", e->cost.at_least);
    json_close(j, '}');
  }
  json_close(j, ']');
}

static void print_memory(json *j, const plan_data *d) {
  const uint64_t pixels = d->s->scale * d->s->scale * d->f.width * d->f.height;
  json_open(j, "memory", '{');
  json_count(j, "plan", d->f.plan_bytes);
  json_count(j, "state", d->f.state_bytes);
  json_count(j, "frame", d->s->no_frames ? 0 : 3 * pixels);
  json_close(j, '}');
}

static void print_outputs(json *j, const plan_data *d) {
  json_open(j, "outputs", '{');
  json_text(j, "frames", d->s->no_frames ? NULL : d->s->output);
  json_text(j, "stats", d->s->stats);
  json_text(j, "trajectory", d->s->trajectory);
  json_close(j, '}');
}

static void print_notes(json *j, const plan_data *d) {
  const char *text;
  json_open(j, "notes", '[');
  for (size_t i = 0; (text = msr_plan_warning(d->plan, i)); i++) json_text(j, NULL, text);
  json_close(j, ']');
}

void plan_json_print(FILE *out, const plan_data *d) {
  const char *const rule = d->f.impacts == MSR_IMPACTS_KEPT ? "kept" : "located";
  json j = {.out = out};
  json_open(&j, NULL, '{');
  json_text(&j, "msr", msr_version());
  print_scene(&j, d);
  print_time(&j, d);
  print_integrator(&j, d);
  print_step(&j, d);
  print_limits(&j, d);
  json_text(&j, "impacts", d->contacts ? rule : NULL);
  print_effects(&j, d);
  print_memory(&j, d);
  print_outputs(&j, d);
  print_notes(&j, d);
  json_close(&j, '}');
}
