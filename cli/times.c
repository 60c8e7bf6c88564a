/* times.c - times are rounded to microseconds before they are added, so that the column sums up. */
#include "times.h"

#include <inttypes.h>
#include <math.h>

typedef struct table {
  FILE *out;
  int64_t all, rest; /* [us] */
} table;

static void print_row(const table *t, const char *name, int64_t time) {
  fprintf(t->out, "  %-10s %13.6f s %6.1f %%", name, 1e-6 * (double)time,
          t->all > 0 ? 100 * (double)time / (double)t->all : 0);
}

static void print_effect(table *t, const char *name, double seconds, uint64_t calls,
                         const char *unit) {
  const int64_t time = (int64_t)llround(1e6 * seconds);
  t->rest -= time;
  print_row(t, name, time);
  fprintf(t->out, " %12" PRIu64 " %s%s", calls, unit, calls == 1 ? "" : "s");
}

/* What is done beside the run is no part of its time. */
static void print_task(table *t, const char *name, const outputs *written, task w) {
  const uint64_t frames = written->frames[w == DRAWING ? WRITING : w];
  print_effect(t, name, written->seconds[w], frames, "frame");
  if (written->beside[w] > 0) fprintf(t->out, ", %.6f s beside", written->beside[w]);
}

void times_print(FILE *out, const effect_list *list, const msr_state *state, const outputs *written,
                 const times *looks, double seconds) {
  const int64_t all = (int64_t)llround(1e6 * seconds);
  table t = {out, all, all};
  for (size_t i = 0; i < list->n; i++) {
    const effect_row *const e = &list->effect[i];
    if (e->on && i < list->library) {
      print_effect(&t, e->name, msr_state_seconds(state, i), msr_state_calls(state, i), "call");
    } else if (e->on) {
      print_task(&t, e->name, written, (task)(i - list->library));
    }
    if (e->on) fputs("\n", out);
  }
  print_effect(&t, "energy", looks->seconds, looks->calls, "look");
  fputs("\n", out);
  print_row(&t, "other", t.rest);
  fputs("\n", out);
  print_row(&t, "all", t.all);
  fputs("\n", out);
}
