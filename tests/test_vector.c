/* test_vector.c - what is done to vectors has the bits of a plain loop, whatever their length,
 * where they lie and how wide the machine's own vectors are. */
#include "base/vector.h"

#include "scenes.h"

enum { MOST = 70, SHIFTS = 4 };

static void fill(double *a, uint64_t *dice) {
  for (size_t i = 0; i < MOST; i++) a[i] = uniform(dice, -10, 10);
}

static void sums_are_those_of_a_plain_loop(void **state) {
  (void)state;
  uint64_t dice = 1;
  double x[MOST], y[MOST], expected[MOST];
  for (size_t n = 0; n + 2 * SHIFTS <= MOST; n++) {
    const size_t i = random_below(&dice, SHIFTS), j = random_below(&dice, SHIFTS);
    const double c = uniform(&dice, -1, 1);
    fill(x, &dice);
    fill(y, &dice);
    memcpy(expected, y, sizeof y);
    for (size_t k = 0; k < n; k++) expected[j + k] += c * x[i + k];
    msri_add_scaled(n, c, x + i, y + j);
    assert_memory_equal(y, expected, sizeof y);
  }
}

static void products_are_those_of_a_plain_loop(void **state) {
  (void)state;
  uint64_t dice = 2;
  double y[MOST], expected[MOST];
  for (size_t n = 0; n + SHIFTS <= MOST; n++) {
    const size_t i = random_below(&dice, SHIFTS);
    const double c = uniform(&dice, -1, 1);
    fill(y, &dice);
    memcpy(expected, y, sizeof y);
    for (size_t k = 0; k < n; k++) expected[i + k] *= c;
    msri_scale(n, c, y + i);
    assert_memory_equal(y, expected, sizeof y);
  }
}

static void the_largest_is_found_wherever_it_is(void **state) {
  (void)state;
  uint64_t dice = 3;
  const double odd[] = {NO_NUMBER, INFINITE, -INFINITE};
  double x[MOST] = {1}, y[MOST] = {0};
  assert_true(msri_largest(0, x) == 0);
  for (size_t i = 0; i < MOST; i++) {
    fill(x, &dice);
    x[i] = i % 2 ? 11 : -11;
    assert_true(msri_largest(MOST, x) == 11);
    y[MOST - 1 - i] = i % 3 ? 9 : -12;
    assert_true(msri_largest_of_two(MOST, x, y) == (i % 3 ? 11 : 12));
    assert_true(msri_largest_of_two(MOST, y, x) == (i % 3 ? 11 : 12));
    y[MOST - 1 - i] = 0;
    x[i] = odd[i % 3];
    assert_true(!isfinite(msri_largest(MOST, x)) && !isfinite(msri_largest_of_two(MOST, y, x)));
  }
}

/* Of any length, within rounding of a plain sum: n terms of one sign. */
static void squares_are_all_summed(void **unused) {
  (void)unused;
  double x[MOST], w[MOST];
  for (size_t n = 0; n <= MOST; n++) {
    double plain = 0, weighted = 0;
    for (size_t i = 0; i < n; i++) {
      x[i] = sin((double)i + 1), w[i] = 1 + (double)(i % 7);
      plain += x[i] * x[i], weighted += w[i] * x[i] * x[i];
    }
    assert_true(fabs(msri_sum_squares(n, NULL, x) - plain) <= 2 * MOST * DBL_EPSILON * plain);
    assert_true(fabs(msri_sum_squares(n, w, x) - weighted) <= 2 * MOST * DBL_EPSILON * weighted);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sums_are_those_of_a_plain_loop),
      cmocka_unit_test(the_largest_is_found_wherever_it_is),
      cmocka_unit_test(products_are_those_of_a_plain_loop),
      cmocka_unit_test(squares_are_all_summed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
