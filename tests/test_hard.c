/* test_hard.c - the stability suite: hard cases, each with bounds of its own, from
 * tests/stability/. Without an argument it's a test program that runs their short form; `long
 * [WORDS]` or `short [WORDS]` prints a table, of the cases whose names hold WORDS. */
#include "stability/suite.h"

static suite all_cases(void) {
  static void (*const points[])(suite *) = {add_stiff,   add_steps,   add_masses,     add_shapes,
                                            add_impacts, add_falls,   add_collisions, add_effects,
                                            add_rest,    add_numbers, add_limits,     add_ages};
  suite s = {0};
  for (size_t p = 0; p < LENGTH(points); p++) points[p](&s);
  return s;
}

static uint64_t iterations(const hard_case *row, bool brief) {
  return brief ? row->brief : row->full;
}

static int print_table(const suite *s, bool brief, const char *words) {
  size_t passed = 0, failed = 0;
  print_head();
  for (size_t i = 0; i < s->n; i++) {
    const hard_case *row = &s->row[i];
    if (iterations(row, brief) == 0 || !strstr(row->name, words)) continue;
    const outcome o = run_case(row, brief);
    print_outcome(row, &o);
    *(o.failed ? &failed : &passed) += 1;
  }
  printf("%zu passed, %zu failed\n", passed, failed);
  return failed > 0 || passed == 0;
}

static void check_case(void **state) {
  const hard_case *row = *state;
  const outcome o = run_case(row, true);
  if (o.failed) fail_msg("%s (%s)", o.verdict, row->why);
}

static int run_short(const suite *s) {
  struct CMUnitTest *test = zeroed(s->n, sizeof *test);
  size_t n = 0;
  for (size_t i = 0; i < s->n; i++)
    if (s->row[i].brief > 0)
      test[n++] = (struct CMUnitTest){s->row[i].name, check_case, NULL, NULL, &s->row[i]};
  const int failed = _cmocka_run_group_tests("hard cases", test, n, NULL, NULL);
  free(test);
  return failed;
}

int main(int argc, char **argv) {
  suite s = all_cases();
  const bool brief = argc > 1 && strcmp(argv[1], "short") == 0;
  const int failed = argc > 1 ? print_table(&s, brief, argc > 2 ? argv[2] : "") : run_short(&s);
  free(s.row);
  return failed;
}
