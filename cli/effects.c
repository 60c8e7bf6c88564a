/* effects.c - the effects of a run, each with its reason, in terms of the command's options, and
 * with what it takes. */
#include "effects.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_CALLERS = 6 };

/* The options that call for an effect, the first of all, or say how it is. */
typedef struct caller {
  const char *effect;
  const char *hint; /* how to ask for what wasn't asked for; NULL: no option does that */
  const char *option[MOST_CALLERS];
} caller;

static const caller callers[] = {
    {"springs", NULL, {"--neighbours", "--attach"}},
    {"damping", "--damping C", {"--damping"}},
    {"drag", "--drag C", {"--drag"}},
    {"wind", "--wind SPEED", {"--wind", "--gust", "--gust-time", "--seed", "--drag"}},
    {"push", "--push X,Y,FX,FY", {"--push"}},
    {"supports", NULL, {"--restitution", "--friction", "--impacts"}},
    {"border", "--border closed", {"--border", "--restitution", "--friction", "--impacts"}},
    {"collisions", "--collide", {"--collide", "--diameter", "--restitution"}},
    {"integrator", NULL, {"--integrator", "--accuracy", "--atol", "--rtol"}},
    {"leaps", NULL, {"--integrator", "--substeps", "--accuracy"}},
    {"care", NULL, {"--integrator", "--substeps", "--accuracy"}},
    {"drawing", NULL, {"--no-frames", "--scale", "--stripes"}},
    {"writing", NULL, {"--no-frames", "--output", "--force"}},
    {"stats", "--stats FILE.csv", {"--stats"}},
    {"trajectory", "--trajectory FILE.npy", {"--trajectory"}},
    {NULL, NULL, {NULL}},
};

static const caller *caller_of(const char *name) {
  const caller *c = callers;
  while (c->effect && strcmp(c->effect, name) != 0) c++;
  return c;
}

/* ---- Why */

static void append(effect_row *e, const char *text) {
  const size_t length = strlen(e->why);
  snprintf(e->why + length, sizeof e->why - length, "%s", text);
}

static void append_option(effect_row *e, const typed *t, bool first) {
  append(e, first ? " (" : " ");
  append(e, option_spelling(t->option).text);
  if (*t->value) append(e, " ");
  append(e, t->value);
}

static bool calls(const caller *c, const option *o) {
  for (int i = 0; i < MOST_CALLERS && c->option[i]; i++) {
    if (option_find(c->option[i]) == o) return true;
  }
  return false;
}

/* Each push is an effect of its own: this is number `nth` of those that are on, or off. */
static void append_push(const settings *s, effect_row *e, size_t nth) {
  const option *const of_push = option_find("--push");
  size_t p = 0;
  for (size_t i = 0; i < s->n_typed; i++) {
    if (s->typed[i].option != of_push) continue;
    const bool acts = s->pushes[p].fx != 0 || s->pushes[p].fy != 0;
    p++;
    if (acts != e->on || nth-- > 0) continue;
    append_option(e, &s->typed[i], true);
    append(e, ")");
    return;
  }
}

/* The drag of the air that the wind moves is the wind's. */
static bool is_the_winds(const settings *s, const effect_row *e) {
  return strcmp(e->name, "drag") == 0 && option_given(s, "--wind");
}

/* The options that were typed, in brackets. */
static void append_typed(const settings *s, const caller *c, effect_row *e) {
  bool any = false;
  for (size_t i = 0; i < s->n_typed; i++) {
    if (!calls(c, s->typed[i].option)) continue;
    append_option(e, &s->typed[i], !any);
    any = true;
  }
  if (any) append(e, ")");
}

static void append_hint(const caller *c, effect_row *e) {
  append(e, " (");
  append(e, c->hint);
  append(e, ")");
}

static void append_options(const settings *s, effect_row *e, size_t nth) {
  const caller *const c = caller_of(e->name);
  if (is_the_winds(s, e)) {
    append(e, ": the wind has its own");
  } else if (!e->on && c->hint && !option_given(s, c->option[0])) {
    append_hint(c, e);
  } else if (strcmp(e->name, "push") == 0) {
    append_push(s, e, nth);
  } else {
    append_typed(s, c, e);
  }
}

/* ---- The command's own */

static double frame_bytes(const settings *s, const msr_plan_figures *f) {
  const double scale = (double)s->scale;
  return 3 * scale * scale * (double)f->width * (double)f->height;
}

/* Shared among all steps and masses, as the library's costs are. */
static msr_cost cost_of(const msr_plan_figures *f, double operations, double bytes) {
  const double steps = (double)f->iterations * (double)f->substeps, masses = (double)f->masses;
  if (!(steps * masses > 0)) return (msr_cost){0};
  const double calls = (double)f->images / steps;
  return (msr_cost){calls, calls * operations / masses, calls * bytes / masses, false};
}

/* Drawing reads x, y, makes 4 operations of them, and writes every pixel twice: air and supports,
 * then masses at least; statistics are energies, momentum, the longest spring. */
static void add_tasks(const settings *s, const msr_plan_figures *f, effect_row *tasks) {
  const double masses = (double)f->masses, springs = (double)f->springs;
  const double frame = frame_bytes(s, f);
  tasks[DRAWING] = (effect_row){.name = "drawing", .on = !s->no_frames};
  tasks[WRITING] = (effect_row){.name = "writing", .on = !s->no_frames};
  tasks[STATS] = (effect_row){.name = "stats", .on = s->stats};
  tasks[TRAJECTORY] = (effect_row){.name = "trajectory", .on = s->trajectory};
  for (int t = 0; t < TASKS; t++)
    append(&tasks[t], tasks[t].on ? "" : t < STATS ? "not wanted" : "not asked for");
  if (s->stats) tasks[STATS].cost = cost_of(f, 12 * masses + 17 * springs, 32 * masses);
  if (s->trajectory) tasks[TRAJECTORY].cost = cost_of(f, 0, 64 * masses);
  if (s->no_frames) return;
  tasks[DRAWING].cost = cost_of(f, 4 * masses, 16 * masses + frame);
  tasks[DRAWING].cost.at_least = true;
  tasks[WRITING].cost = cost_of(f, 0, frame);
}

static void describe_tasks(const settings *s, const msr_plan_figures *f, effect_row *tasks) {
  const uint64_t scale = s->scale;
  char text[160];
  snprintf(text, sizeof text, "NB_IMAGES = %" PRIu64 ": frames of %" PRIu64 " x %" PRIu64 " px",
           f->images, scale * f->width, scale * f->height);
  if (!s->no_frames) append(&tasks[DRAWING], text);
  snprintf(text, sizeof text, "NB_IMAGES = %" PRIu64 ": %.3g MB", f->images,
           1e-6 * frame_bytes(s, f) * (double)f->images);
  if (!s->no_frames) append(&tasks[WRITING], text);
  snprintf(text, sizeof text, "NB_IMAGES = %" PRIu64 " rows", f->images);
  if (s->stats) append(&tasks[STATS], text);
  snprintf(text, sizeof text, "NB_IMAGES = %" PRIu64 ": %.3g MB", f->images,
           32e-6 * (double)f->images * (double)f->masses);
  if (s->trajectory) append(&tasks[TRAJECTORY], text);
}

/* ---- The list */

/* How many of the same name and kind come before it? */
static size_t number_of(const effect_list *list, size_t i) {
  size_t n = 0;
  for (size_t j = 0; j < i; j++) {
    const effect_row *const a = &list->effect[j], *const b = &list->effect[i];
    n += a->on == b->on && strcmp(a->name, b->name) == 0;
  }
  return n;
}

effect_list *effects_create(const settings *s, const msr_plan *plan) {
  const msr_plan_figures figures = msr_plan_describe(plan);
  size_t n;
  const msr_effect *const of_plan = msr_plan_effects(plan, &n);
  effect_list *const list = calloc(1, sizeof *list + (n + TASKS) * sizeof list->effect[0]);
  if (!list) return NULL;
  list->library = n;
  list->n = n + TASKS;
  for (size_t i = 0; i < n; i++) {
    const msr_effect *const from = &of_plan[i];
    list->effect[i] = (effect_row){.name = from->name, .on = from->on, .cost = from->cost};
    append(&list->effect[i], from->reason);
  }
  add_tasks(s, &figures, list->effect + n);
  describe_tasks(s, &figures, list->effect + n);
  for (size_t i = 0; i < list->n; i++) append_options(s, &list->effect[i], number_of(list, i));
  return list;
}

/* ---- In print */

typedef struct cell {
  char text[16];
} cell;

static cell number(double value, bool at_least) {
  cell c = {"as needed"};
  if (isnan(value)) return c;
  snprintf(c.text, sizeof c.text, "%s%.3g", at_least ? ">=" : "", value);
  return c;
}

static void print_cost(FILE *out, const effect_row *e) {
  const msr_cost *const c = &e->cost;
  fprintf(out, "  on   %-10s %9s %10s %9s  %s\n", e->name, number(c->calls, false).text,
          number(c->operations, c->at_least).text, number(c->bytes, c->at_least).text, e->why);
}

void effects_print(FILE *out, const effect_list *list) {
  for (int on = 1; on >= 0; on--) {
    for (size_t i = 0; i < list->n; i++) {
      const effect_row *const e = &list->effect[i];
      if (e->on == on) fprintf(out, "  %-3s  %-10s %s\n", on ? "on" : "off", e->name, e->why);
    }
  }
}

void effects_print_costs(FILE *out, const effect_list *list) {
  fprintf(out, "%-17s %9s %10s %9s  %s\n", "effects", "calls", "operations", "bytes",
          "a step; operations and bytes a mass");
  for (size_t i = 0; i < list->n; i++) {
    if (list->effect[i].on) print_cost(out, &list->effect[i]);
  }
  for (size_t i = 0; i < list->n; i++) {
    const effect_row *const e = &list->effect[i];
    if (!e->on) fprintf(out, "  off  %-10s %30s  %s\n", e->name, "", e->why);
  }
}
