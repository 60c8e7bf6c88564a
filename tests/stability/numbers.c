/* numbers.c - values at the edges of double precision, and counters that have run for ages. */
#include "suite.h"

#include "plan/state.h"

#include <stdio.h>

static const char pegged[] = "............\n"
                             "..ooooo.....\n"
                             "..ooooo.....\n"
                             "............\n"
                             "............\n"
                             "...#....#...\n"
                             "............\n"
                             "############\n";
static const char one[] = ".....\n..o..\n.....\n#####\n";
static const char free_pair[] = "......\n..oo..\n......\n......\n";

/* ---- Counters */

static void set_counter(const hard_case *row, const world *w) {
  w->state->iteration = (uint64_t)row->parameter;
  msri_state_touched(w->state);
}

/* Nothing here depends on t: what follows has the bits of a run that began at 0. */
static const char *same_as_young(const hard_case *row, const world *w) {
  const size_t n = msr_plan_describe(w->plan).masses;
  msr_state *young;
  must(msr_state_create(w->plan, &young, &why));
  must(msr_state_step(young, msr_state_iteration(w->state) - (uint64_t)row->parameter, &why));
  const msr_view a = msr_state_view(young), b = msr_state_view(w->state);
  const size_t bytes = n * sizeof(double);
  const bool same = memcmp(a.x, b.x, bytes) == 0 && memcmp(a.y, b.y, bytes) == 0 &&
                    memcmp(a.vx, b.vx, bytes) == 0 && memcmp(a.vy, b.vy, bytes) == 0;
  const bool late = b.t == (double)msr_state_iteration(w->state) * row->conf.dt;
  msr_state_free(young);
  return same && late ? NULL : "it isn't what a run from 0 is";
}

static void add_counters(suite *s) {
  // multiples of 256, by which iterations are grouped where energies are watched
  static const double from[] = {1e9, 1e12, 0x1p52, 0x1p53 - 0x1p20};
  for (size_t i = 0; i < LENGTH(from); i++) {
    hard_case row = {.art = pegged,
                     .conf = conf_of_assignment,
                     .scene = {.closed_border = true},
                     .arrange = set_counter,
                     .parameter = from[i],
                     .brief = 1000,
                     .full = 100000,
                     .growth = 0.025,
                     .loss = 0.05,
                     .check = same_as_young,
                     .why = "the same bits as from t = 0, though DT is below the ulp of t"};
    snprintf(row.name, sizeof row.name, "numbers: iteration %.10g", from[i]);
    add_case(s, &row);
  }
}

/* ---- Values */

/* All velocities; `parameter` is added to each x. */
static void move_away(const hard_case *row, const world *w) {
  const msr_arrays s = msr_state_edit(w->state);
  for (size_t i = 0; i < msr_plan_describe(w->plan).masses; i++) s.x[i] += row->parameter;
}

#define CLOSED .scene = {.closed_border = true}

static const char why_scaled[] = "the assignment's example in other units: the same bounds";
static const char why_beyond[] = "beyond what a double can hold";

static const hard_case rows[] = {
    {.name = "numbers: m 1e-300, k 1.5e-296",
     .art = pegged,
     CLOSED,
     .conf = {0.005, 9.8, 1e-300, 1.5e-296, 1, 1},
     .brief = 1000,
     .full = 20000,
     .growth = 0.05,
     .loss = 0.1,
     .why = why_scaled},
    {.name = "numbers: m 1e300, k 1.5e304",
     .art = pegged,
     CLOSED,
     .conf = {0.005, 9.8, 1e300, 1.5e304, 1, 1},
     .brief = 1000,
     .full = 2000,
     .growth = 0.05,
     .loss = 0.1,
     .why = "the same; squares of residuals overflow, so that steps with care cost far more"},
    {.name = "numbers: m 1e307, k 1.5e308",
     .art = pegged,
     CLOSED,
     .conf = {0.005, 9.8, 1e307, 1.5e308, 1, 1},
     .brief = 1000,
     .full = 20000,
     .wanted = STOPS,
     .why = why_beyond},
    {.name = "numbers: m denormal, 1e-310",
     .art = pegged,
     CLOSED,
     .conf = {0.005, 9.8, 1e-310, 1.5e-306, 1, 1},
     .brief = 100,
     .full = 1000,
     .wanted = STOPS,
     .why = "1 / m is beyond what a double can hold"},
    {.name = "numbers: k denormal, 5e-324",
     .art = pegged,
     CLOSED,
     .conf = {0.005, 9.8, 0.1, 5e-324, 1, 1},
     .brief = 1000,
     .full = 20000,
     .growth = 0.05,
     .loss = 0.1,
     .why = "as good as no springs: free masses that bounce"},
    {.name = "numbers: g denormal, 5e-324",
     .art = pegged,
     CLOSED,
     .conf = {0.005, 5e-324, 0.1, 1500, 1, 1},
     .brief = 1000,
     .full = 20000,
     .growth = 0.05,
     .loss = 0.1,
     .why = "as good as no gravity"},
    {.name = "numbers: g 1e300",
     .art = pegged,
     CLOSED,
     .conf = {0.005, 1e300, 0.1, 1500, 1, 1},
     .brief = 100,
     .full = 1000,
     .wanted = STOPS,
     .why = why_beyond},
    {.name = "numbers: g 1e150",
     .art = pegged,
     CLOSED,
     .conf = {0.005, 1e150, 0.1, 1500, 1, 1},
     .brief = 100,
     .full = 1000,
     .growth = 0.05,
     .why = "squares of it are still numbers"},
    {.name = "numbers: speed 1e300",
     .art = free_pair,
     .conf = {0.005, 9.8, 0.1, 1500, 1, 1},
     .vx = 1e300,
     .brief = 100,
     .full = 1000,
     .wanted = STOPS,
     .why = why_beyond},
    {.name = "numbers: speed 1e100 in a room",
     .art = pegged,
     CLOSED,
     .conf = {0.005, 9.8, 0.1, 1500, 1, 1},
     .vx = 1e100,
     .brief = 1000,
     .full = 20000,
     .growth = 0.05,
     .loss = 0.1,
     .why = "nothing but walls: each reflection is exact"},
    {.name = "numbers: DT 1e300, springs",
     .art = pegged,
     CLOSED,
     .conf = {1e300, 9.8, 0.1, 1500, 1, 1},
     .brief = 1,
     .full = 1,
     .wanted = STOPS,
     .why = "no number of substeps is enough"},
    {.name = "numbers: DT 1e300, one mass",
     .art = one,
     .conf = {1e300, 9.8, 0.1, 1500, 1, 1},
     .brief = 10,
     .full = 10,
     .wanted = STOPS,
     .why = why_beyond},
    {.name = "numbers: DT denormal, 5e-324",
     .art = pegged,
     CLOSED,
     .conf = {5e-324, 9.8, 0.1, 1500, 1, 1},
     .brief = 1000,
     .full = 20000,
     .growth = 1e-9,
     .loss = 1e-9,
     .why = "nothing moves"},
    {.name = "numbers: DT 1e-300",
     .art = pegged,
     CLOSED,
     .conf = {1e-300, 9.8, 0.1, 1500, 1, 1},
     .vx = 1,
     .brief = 1000,
     .full = 20000,
     .growth = 1e-9,
     .loss = 1e-9,
     .why = "nothing moves"},
    {.name = "numbers: 1e15 px away",
     .art = free_pair,
     .conf = {0.005, 9.8, 0.1, 1500, 1, 1},
     .arrange = move_away,
     .parameter = 1e15,
     .brief = 1000,
     .full = 20000,
     .growth = 1e-6,
     .loss = 1e-6,
     .why = "springs are computed from differences; the ulp there is 1/8 px"},
    {.name = "numbers: 1e200 px away",
     .art = free_pair,
     .conf = {0.005, 9.8, 0.1, 1500, 1, 1},
     .arrange = move_away,
     .parameter = 1e200,
     .brief = 1000,
     .full = 20000,
     .growth = 10,
     .loss = 10,
     .why = "the pair is at one place: finite is all that can be asked"},
};

void add_numbers(suite *s) {
  add_counters(s);
  for (size_t i = 0; i < LENGTH(rows); i++) add_case(s, &rows[i]);
}
