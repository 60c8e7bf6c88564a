/* test_number.c - numbers to and from text: what is accepted, why the rest is refused, and that the
 * user's locale changes nothing. */
#include "base/number.h"

#include <float.h>
#include <locale.h>
#include <math.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const struct good {
  const char *text;
  double value;
} goods[] = {
    {"0", 0},
    {"-0", -0.0},
    {"42", 42},
    {"+42", 42},
    {"-9.8", -9.8},
    {".5", 0.5},
    {"5.", 5},
    {"1500.0", 1500},
    {"5e-3", 0.005},
    {"5E+3", 5000},
    {"1.e1", 10},
    {"00012", 12},
    {"1.7976931348623157e308", DBL_MAX},
    {"4.9406564584124654e-324", DBL_TRUE_MIN},
    {"1e-400", 0},
    {"0.1000000000000000055511151231257827021181583404541015625", 0.1},
};

static const struct bad {
  const char *text;
  msri_number_fault fault;
} bads[] = {
    {"", MSRI_NUMBER_EMPTY},           {"0,005", MSRI_NUMBER_COMMA},
    {"-1,5e3", MSRI_NUMBER_COMMA},     {"1,234.5", MSRI_NUMBER_JUNK},
    {"0x10", MSRI_NUMBER_HEX},         {"-0X1p3", MSRI_NUMBER_HEX},
    {"inf", MSRI_NUMBER_INFINITE},     {"-INF", MSRI_NUMBER_INFINITE},
    {"nan", MSRI_NUMBER_INFINITE},     {"+Infinity", MSRI_NUMBER_INFINITE},
    {"information", MSRI_NUMBER_JUNK}, {".", MSRI_NUMBER_JUNK},
    {"-", MSRI_NUMBER_JUNK},           {"+-1", MSRI_NUMBER_JUNK},
    {"e5", MSRI_NUMBER_JUNK},          {"1e", MSRI_NUMBER_JUNK},
    {"1e+", MSRI_NUMBER_JUNK},         {"1e5.", MSRI_NUMBER_JUNK},
    {"1.2.3", MSRI_NUMBER_JUNK},       {"1 ", MSRI_NUMBER_JUNK},
    {" 1", MSRI_NUMBER_JUNK},          {"12kg", MSRI_NUMBER_JUNK},
    {"1e309", MSRI_NUMBER_LARGE},      {"-1e999", MSRI_NUMBER_LARGE},
};

static const struct count {
  const char *text;
  msri_number_fault fault;
  uint64_t value;
} counts[] = {
    {"0", MSRI_NUMBER_OK, 0},
    {"00020000", MSRI_NUMBER_OK, 20000},
    {"18446744073709551615", MSRI_NUMBER_OK, UINT64_MAX},
    {"18446744073709551616", MSRI_NUMBER_LARGE, 0},
    {"99999999999999999999", MSRI_NUMBER_LARGE, 0},
    {"", MSRI_NUMBER_EMPTY, 0},
    {"2e4", MSRI_NUMBER_WHOLE, 0},
    {"20000.0", MSRI_NUMBER_WHOLE, 0},
    {"-1", MSRI_NUMBER_WHOLE, 0},
    {"+1", MSRI_NUMBER_WHOLE, 0},
    {"1 ", MSRI_NUMBER_WHOLE, 0},
};

#define LENGTH(array) (sizeof(array) / sizeof *(array))

/* A copy without a terminator, so that a sanitizer or valgrind sees a byte read too many. */
static msri_number_fault parse(const char *text, double *value) {
  const size_t size = strlen(text);
  char *copy = malloc(size + 1);
  assert_non_null(copy);
  memset(copy, '7', size + 1);
  memcpy(copy, text, size);
  const msri_number_fault fault = msri_number_parse(copy, size, value);
  free(copy);
  return fault;
}

static void check_goods(void) {
  for (size_t i = 0; i < LENGTH(goods); i++) {
    double value = 7;
    const msri_number_fault fault = parse(goods[i].text, &value);
    if (fault || memcmp(&value, &goods[i].value, sizeof value) != 0)
      fail_msg("'%s': %s, %a", goods[i].text, msri_number_fault_text(fault), value);
  }
}

static void numbers_are_read(void **state) {
  (void)state;
  check_goods();
}

static void what_is_no_number_says_why(void **state) {
  (void)state;
  for (size_t i = 0; i < LENGTH(bads); i++) {
    double value = 7;
    const msri_number_fault fault = parse(bads[i].text, &value);
    if (fault != bads[i].fault) fail_msg("'%s': %s", bads[i].text, msri_number_fault_text(fault));
    assert_true(value > 6.9 && value < 7.1);
  }
}

static void long_numbers_are_refused(void **state) {
  (void)state;
  char text[2000];
  double value;
  memset(text, '1', sizeof text);
  assert_int_equal(msri_number_parse(text, sizeof text, &value), MSRI_NUMBER_LONG);
  memset(text, '0', sizeof text);
  assert_int_equal(msri_number_parse(text, 1023, &value), MSRI_NUMBER_OK);
}

static void counts_are_digits_only(void **state) {
  (void)state;
  for (size_t i = 0; i < LENGTH(counts); i++) {
    uint64_t value = 0;
    const msri_number_fault fault =
        msri_number_parse_count(counts[i].text, strlen(counts[i].text), &value);
    if (fault != counts[i].fault || value != counts[i].value)
      fail_msg("'%s': %s", counts[i].text, msri_number_fault_text(fault));
  }
}

static void check_writing(void) {
  char text[MSRI_NUMBER_SIZE];
  assert_string_equal(msri_number_write(0.005, text), "0.005");
  assert_string_equal(msri_number_write(-1500, text), "-1500");
  assert_string_equal(msri_number_write(0.1 + 0.2, text), "0.30000000000000004");
  assert_string_equal(msri_number_write(1e300, text), "1e+300");
  assert_string_equal(msri_number_write((double)INFINITY, text), "inf");
  assert_non_null(strstr(msri_number_write((double)NAN, text), "nan"));
  msri_format(text, sizeof text, "%.3f %s", 1234.5, "px");
  assert_string_equal(text, "1234.500 px");
}

/* The longest text there is, and numbers of all sizes, read back as the same bits. */
static void what_is_written_reads_back(void **state) {
  (void)state;
  uint64_t bits = UINT64_C(0x9E3779B97F4A7C15);
  char text[MSRI_NUMBER_SIZE];
  check_writing();
  for (int i = 0; i < 20000; i++) {
    double value, back = 0;
    bits = bits * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    memcpy(&value, &bits, sizeof value);
    if (!isfinite(value)) continue;
    msri_number_write(value, text);
    assert_int_equal(msri_number_parse(text, strlen(text), &back), MSRI_NUMBER_OK);
    assert_memory_equal(&back, &value, sizeof value);
  }
}

static void a_stream_is_written(void **state) {
  (void)state;
  char text[32] = "";
  FILE *stream = fmemopen(text, sizeof text, "w");
  assert_non_null(stream);
  assert_int_equal(msri_print(stream, "%g,%d", 0.5, 3), 5);
  assert_int_equal(fclose(stream), 0);
  assert_string_equal(text, "0.5,3");
}

static void a_french_locale_changes_nothing(void **state) {
  char text[8];
  if (!setlocale(LC_ALL, "fr_FR.UTF-8")) skip();
  snprintf(text, sizeof text, "%.1f", 0.5);
  assert_string_equal(text, "0,5");
  check_goods();
  check_writing();
  what_is_no_number_says_why(state);
  a_stream_is_written(state);
  // The program's own locale is as it was.
  snprintf(text, sizeof text, "%.1f", 0.5);
  assert_string_equal(text, "0,5");
  setlocale(LC_ALL, "C");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(numbers_are_read),
      cmocka_unit_test(what_is_no_number_says_why),
      cmocka_unit_test(long_numbers_are_refused),
      cmocka_unit_test(counts_are_digits_only),
      cmocka_unit_test(what_is_written_reads_back),
      cmocka_unit_test(a_stream_is_written),
      cmocka_unit_test(a_french_locale_changes_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
