/* test_conf.c - confs: the assignment's example and all that is tolerated around it; for everything
 * else, the message that users see.
 * link: --wrap=malloc --wrap=calloc --wrap=realloc */
#include "formats/conf.h"

#include "alloc.h"
#include "files.h"

#include <float.h>
#include <locale.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#define BYTES(text)   text, sizeof(text) - 1
#define LENGTH(array) (sizeof(array) / sizeof *(array))

static const char example[] = "DT\n0.005\nGRAVITE\n9.8\nMASSE\n0.1\nTENSION_RESSORT\n1500.0\n"
                              "NB_ITERATIONS\n20000\nNB_IMAGES\n800\n";

/* What comes before and after a part of the example that a row replaces. */
#define GRAVITE       "GRAVITE\n9.8\n"
#define FROM_MASSE    "MASSE\n0.1\nTENSION_RESSORT\n1500\nNB_ITERATIONS\n20000\nNB_IMAGES\n800\n"
#define FROM_GRAVITE  GRAVITE FROM_MASSE
#define FROM_TENSION  "TENSION_RESSORT\n1500\nNB_ITERATIONS\n20000\nNB_IMAGES\n800\n"
#define TO_GRAVITE    "DT\n0.005\n" GRAVITE
#define TO_MASSE      TO_GRAVITE "MASSE\n0.1\n"
#define TO_TENSION    TO_MASSE "TENSION_RESSORT\n1500\n"
#define TO_ITERATIONS TO_TENSION "NB_ITERATIONS\n20000\n"

/* All of them say what the example says. */
static const struct good {
  const char *bytes;
  size_t size;
} goods[] = {
    {BYTES("DT\n0.005\n" FROM_GRAVITE)},
    {BYTES("DT\r\n0.005\r\nGRAVITE\r\n9.8\r\n" FROM_MASSE)},
    {BYTES(TO_ITERATIONS "NB_IMAGES\n800")},
    {BYTES("\n\n \t\nDT\n\n\n0.005\n" FROM_GRAVITE "\n\n")},
    {BYTES("  DT\t \n\t 5e-3  \n" FROM_GRAVITE)},
    {BYTES("# DT\n#\nDT # seconds\n0.005# = 5 ms\n  # r\303\251el\n" FROM_GRAVITE "# end")},
    {BYTES("\357\273\277DT\n0.005\n" FROM_GRAVITE)},
    {BYTES("\357\273\277# BOM\nDT\n+.5E-2\n" FROM_GRAVITE)},
    {BYTES(TO_TENSION "NB_ITERATIONS\n0020000\nNB_IMAGES\n800\n")},
};

static const struct bad {
  const char *bytes;
  size_t size;
  const char *message; /* after the name and a colon */
} bads[] = {
    {BYTES(""), "1:1: the file ends before DT; write the name, and its value on the next line"},
    {BYTES("# nothing\n\n"),
     "3:1: the file ends before DT; write the name, and its value on the next line"},
    {BYTES("DT"), "1:3: DT has no value; write it on the next line"},
    {BYTES("DT\n0.005\n"),
     "3:1: the file ends before GRAVITE; write the name, and its value on the next line"},
    {BYTES("DT\n0.005\n" FROM_MASSE), "3:1: MASSE stands where GRAVITE is due; the order is DT, "
                                      "GRAVITE, MASSE, TENSION_RESSORT, NB_ITERATIONS, NB_IMAGES"},
    {BYTES("GRAVITE\n9.8\nDT\n0.005\n" FROM_MASSE),
     "1:1: GRAVITE stands where DT is due; the order is DT, GRAVITE, MASSE, TENSION_RESSORT, "
     "NB_ITERATIONS, NB_IMAGES"},
    {BYTES("DT\n0.005\nDT\n0.005\n" FROM_GRAVITE), "3:1: DT is given twice; remove one of them"},
    {BYTES(TO_ITERATIONS "NB_IMAGES\n800\nNB_IMAGES\n800\n"),
     "13:1: 'NB_IMAGES' follows the last value; remove it"},
    {BYTES("DT\nGRAVITE\n9.8\n"), "2:1: DT has no value; write it on the next line"},
    {BYTES(TO_ITERATIONS "NB_IMAGES\n# none\n"),
     "13:1: NB_IMAGES has no value; write it on the next line"},
    {BYTES("DT 0.005\n" FROM_GRAVITE),
     "1:4: '0.005' is on the line of DT; put the value on the next line, alone"},
    {BYTES("DT = 0.005\n" FROM_GRAVITE),
     "1:4: '=' is on the line of DT; put the value on the next line, alone"},
    {BYTES("DT=0.005\n" FROM_GRAVITE),
     "1:1: 'DT=0.005' is a name with its value; put the value on the next line, alone"},
    {BYTES("dt: 0.005\n" FROM_GRAVITE),
     "1:1: 'dt:' is a name with its value; put the value on the next line, alone"},
    {BYTES("DT\n0.005 0.006\n" FROM_GRAVITE),
     "2:7: '0.006' follows the value of DT; keep one value on the line, and comments after #"},
    {BYTES("DT\n0.005 GRAVITE\n9.8\n" FROM_MASSE),
     "2:7: 'GRAVITE' follows the value of DT; keep one value on the line, and comments after #"},
    {BYTES("DT\n0.005 s\n" FROM_GRAVITE),
     "2:7: 's' follows the value of DT; keep one value on the line, and comments after #"},
    {BYTES("DT\n0.005\n0.006\n" FROM_GRAVITE), "3:1: '0.006' is a second value for DT; keep one"},
    {BYTES(TO_ITERATIONS "NB_IMAGES\n800 # all\nof them\n"),
     "13:1: 'of' follows the last value; remove it"},
    {BYTES(TO_ITERATIONS "NB_IMAGES\n800 images\n"),
     "12:5: 'images' follows the value of NB_IMAGES; keep one value on the line, and comments "
     "after #"},
    {BYTES("dt\n0.005\n" FROM_GRAVITE), "1:1: 'dt' isn't in capitals; write DT"},
    {BYTES("DT\n0.005\nGravite\n9.8\n" FROM_MASSE),
     "3:1: 'Gravite' isn't in capitals; write GRAVITE"},
    {BYTES("DT\n0.005\nGRAVIT\303\211\n9.8\n" FROM_MASSE),
     "3:1: unknown name 'GRAVIT\303\211'; did you mean GRAVITE?"},
    {BYTES("DT\n0.005\nGRAVITY\n9.8\n" FROM_MASSE),
     "3:1: unknown name 'GRAVITY'; did you mean GRAVITE?"},
    {BYTES(TO_GRAVITE "MASS\n0.1\n" FROM_TENSION), "5:1: unknown name 'MASS'; did you mean MASSE?"},
    {BYTES(TO_MASSE "TENSION RESSORT\n1500\n"),
     "7:1: unknown name 'TENSION'; TENSION_RESSORT is due here"},
    {BYTES(TO_TENSION "NB_ITERATION\n20000\n"),
     "9:1: unknown name 'NB_ITERATION'; did you mean NB_ITERATIONS?"},
    {BYTES("0.005\n9.8\n0.1\n"), "1:1: unknown name '0.005'; DT is due here"},
    {BYTES("DELTA_T\n0.005\n"), "1:1: unknown name 'DELTA_T'; DT is due here"},
    {BYTES("{\"DT\": 0.005}\n"), "1:1: unknown name '{\"DT\":'; DT is due here"},
    {BYTES("a_word_that_is_much_longer_than_any_name_and_than_what_a_message_shows\n"),
     "1:1: unknown name 'a_word_that_is_much_longer_than_any_name_and_than_what_a_m...'; DT is due "
     "here"},
    {BYTES("DT\n0,005\n" FROM_GRAVITE),
     "2:1: DT: '0,005' has a decimal comma; write a decimal point"},
    {BYTES("DT\n0x1p-8\n" FROM_GRAVITE), "2:1: DT: '0x1p-8' is hexadecimal; write it in decimal"},
    {BYTES("DT\nnan\n" FROM_GRAVITE), "2:1: DT: 'nan' is not finite; write a finite number"},
    {BYTES("DT\n0.005\nGRAVITE\n-inf\n" FROM_MASSE),
     "4:1: GRAVITE: '-inf' is not finite; write a finite number"},
    {BYTES("DT\n0.005\nGRAVITE\n1e309\n" FROM_MASSE),
     "4:1: GRAVITE: '1e309' is too large; write a smaller number"},
    {BYTES("DT\nfast\n" FROM_GRAVITE),
     "2:1: DT: 'fast' is not a number; write one such as 0.005 or 5e-3"},
    {BYTES("DT\n5ms\n" FROM_GRAVITE),
     "2:1: DT: '5ms' is not a number; write one such as 0.005 or 5e-3"},
    {BYTES("DT\n0\n" FROM_GRAVITE), "2:1: DT is 0; it must be greater than 0"},
    {BYTES("DT\n-0.005\n" FROM_GRAVITE), "2:1: DT is -0.005; it must be greater than 0"},
    {BYTES("DT\n1e-400\n" FROM_GRAVITE), "2:1: DT is 0; it must be greater than 0"},
    {BYTES(TO_GRAVITE "MASSE\n0\n" FROM_TENSION), "6:1: MASSE is 0; it must be greater than 0"},
    {BYTES(TO_MASSE "TENSION_RESSORT\n-1500\n"),
     "8:1: TENSION_RESSORT is -1500; it must be 0 or more"},
    {BYTES(TO_TENSION "NB_ITERATIONS\n2e4\n"),
     "10:1: NB_ITERATIONS: '2e4' is no count; write a whole number in digits only, such as 20000"},
    {BYTES(TO_TENSION "NB_ITERATIONS\n20000.0\n"),
     "10:1: NB_ITERATIONS: '20000.0' is no count; write a whole number in digits only, such as "
     "20000"},
    {BYTES(TO_TENSION "NB_ITERATIONS\n-1\n"),
     "10:1: NB_ITERATIONS: '-1' is no count; write a whole number in digits only, such as 20000"},
    {BYTES(TO_TENSION "NB_ITERATIONS\n9007199254740993\n"),
     "10:1: NB_ITERATIONS is 9007199254740993; it must be at most 2^53"},
    {BYTES(TO_TENSION "NB_ITERATIONS\n18446744073709551616\n"),
     "10:1: NB_ITERATIONS: '18446744073709551616' is too large; write a smaller number"},
    {BYTES(TO_ITERATIONS "NB_IMAGES\n0\n"), "12:1: NB_IMAGES is 0; it must be from 1 to 10^9"},
    {BYTES(TO_ITERATIONS "NB_IMAGES\n20001\n"),
     "12:1: NB_IMAGES is 20001 and NB_ITERATIONS 20000; ask for at most one image per iteration"},
    {BYTES(TO_TENSION "NB_ITERATIONS\n0\nNB_IMAGES\n2\n"),
     "12:1: NB_IMAGES is 2 and NB_ITERATIONS 0; ask for at most one image per iteration"},
    {BYTES("DT\r0.005\rGRAVITE\r9.8\r"), "1:3: a carriage return alone; end lines in LF or CR LF"},
    {BYTES("DT\n0.005\n\0"), "3:1: a zero byte: this is a binary file, not a conf; give a text in "
                             "UTF-8 that begins with DT"},
    {BYTES("P6\n1 1\n255\nABC"),
     "1:1: this is a PPM picture (P6), not a conf; give a text in UTF-8 that begins with DT"},
    {BYTES("P3\n1 1\n255\n1 2 3\n"),
     "1:1: this is a PPM picture (P3), not a conf; give a text in UTF-8 that begins with DT"},
    {BYTES("\211PNG\r\n\32\n"),
     "1:1: this is a PNG picture, not a conf; give a text in UTF-8 that begins with DT"},
    {BYTES("\377\376D\0T\0"),
     "1:1: this is UTF-16 text, not a conf; give a text in UTF-8 that begins with DT"},
    {BYTES("\33[1mDT\n"), "1:1: unknown name '\\x1B[1mDT'; DT is due here"},
};

/* Parses a copy that ends where it ends, so that a sanitizer or valgrind sees a byte read too many.
 */
static msr_status parse(const char *bytes, size_t size, msr_conf *conf, msr_error *err) {
  char *copy = calloc(1, size);
  if (size > 0) memcpy(copy, bytes, size);
  const msr_status status = msr_conf_parse("x.conf", copy, size, conf, err);
  free(copy);
  return status;
}

/* Exact: a decimal number has one nearest double. */
static void check_example(const msr_conf *conf) {
  static const double reals[] = {0.005, 9.8, 0.1, 1500};
  const double read[] = {conf->dt, conf->gravity, conf->mass, conf->stiffness};
  assert_memory_equal(read, reals, sizeof reals);
  assert_int_equal(conf->iterations, 20000);
  assert_int_equal(conf->images, 800);
}

static void the_assignment_is_read(void **state) {
  (void)state;
  msr_conf conf;
  msr_error err;
  if (parse(BYTES(example), &conf, &err)) fail_msg("%s", err.message);
  check_example(&conf);
}

static void harmless_differences_are_tolerated(void **state) {
  (void)state;
  for (size_t i = 0; i < LENGTH(goods); i++) {
    msr_conf conf;
    msr_error err;
    if (parse(goods[i].bytes, goods[i].size, &conf, &err)) fail_msg("%s", err.message);
    check_example(&conf);
  }
}

static void check_bads(void) {
  for (size_t i = 0; i < LENGTH(bads); i++) {
    msr_conf conf, before;
    msr_error err = {.status = MSR_OK};
    memset(&conf, 0x55, sizeof conf);
    before = conf;
    assert_int_equal(parse(bads[i].bytes, bads[i].size, &conf, &err), MSR_EINPUT);
    assert_int_equal(err.status, MSR_EINPUT);
    assert_memory_equal(err.message, "x.conf:", 7);
    assert_string_equal(err.message + 7, bads[i].message);
    assert_memory_equal(&conf, &before, sizeof conf);
    assert_int_equal(parse(bads[i].bytes, bads[i].size, &conf, NULL), MSR_EINPUT);
  }
}

static void everything_else_says_why(void **state) {
  (void)state;
  msr_conf conf;
  check_bads();
  assert_int_equal(msr_conf_parse("x.conf", NULL, 0, &conf, NULL), MSR_EINPUT);
}

/* Cut anywhere, it's refused, except in the last number. */
static void no_part_of_a_conf_is_another_one(void **state) {
  (void)state;
  for (size_t size = 0; size < sizeof example - 1; size++) {
    msr_conf conf;
    const msr_status status = parse(example, size, &conf, NULL);
    if (size < sizeof example - 4) assert_int_equal(status, MSR_EINPUT);
  }
}

static void no_length_is_too_much(void **state) {
  (void)state;
  const size_t size = (1 << 20) + 1;
  char *text = malloc(size);
  msr_conf conf;
  msr_error err;
  assert_non_null(text);
  memset(text, '\n', size);
  memcpy(text, example, sizeof example - 1);
  assert_int_equal(msr_conf_parse("x.conf", text, size - 1, &conf, &err), MSR_OK);
  check_example(&conf);
  assert_int_equal(msr_conf_parse("x.conf", text, size, &conf, &err), MSR_EINPUT);
  assert_string_equal(
      err.message, "x.conf:1:1: 1048577 bytes: this is no conf; check that it is the right file");
  memset(text, 'x', size - 1);
  assert_int_equal(msr_conf_parse("x.conf", text, size - 1, &conf, &err), MSR_EINPUT);
  free(text);
}

static void write_example(const char *path) {
  FILE *stream = fopen(path, "w");
  assert_non_null(stream);
  assert_true(fputs(example, stream) >= 0);
  assert_int_equal(fclose(stream), 0);
}

static void files_are_read(void **state) {
  (void)state;
  const char *path = path_of("read.conf");
  msr_conf conf;
  msr_error err;
  write_example(path);
  if (msr_conf_read(path, &conf, &err)) fail_msg("%s", err.message);
  check_example(&conf);
  unlink(path);
  assert_int_equal(msr_conf_read(path, &conf, &err), MSR_EIO);
  // An endless file is refused at its first bytes.
  assert_int_equal(msr_conf_read("/dev/zero", &conf, &err), MSR_EINPUT);
  assert_memory_equal(err.message, "/dev/zero:1:1: a zero byte", 26);
}

static bool attempt_read(void) {
  msr_conf conf;
  return msr_conf_read(path_of("alloc.conf"), &conf, NULL) == MSR_OK;
}

static void running_out_of_memory_is_an_error(void **state) {
  (void)state;
  write_example(path_of("alloc.conf"));
  assert_int_equal(alloc_fail_each(attempt_read), 1);
  unlink(path_of("alloc.conf"));
}

static const struct range {
  msr_conf conf;
  const char *message; /* NULL: it's sound */
} ranges[] = {
    {{0.005, 9.8, 0.1, 1500, 20000, 800}, NULL},
    {{DBL_TRUE_MIN, -DBL_MAX, DBL_MAX, 0, 0, 1}, NULL},
    {{1, 0, 1, -0.0, UINT64_C(1) << 53, 1000000000}, NULL},
    {{0, 0, 1, 1, 1, 1}, "scene: DT is 0; it must be greater than 0"},
    {{(double)INFINITY, 0, 1, 1, 1, 1}, "scene: DT is inf; it must be greater than 0"},
    {{1, (double)-INFINITY, 1, 1, 1, 1}, "scene: GRAVITE is -inf; it must be finite"},
    {{1, 0, -0.5, 1, 1, 1}, "scene: MASSE is -0.5; it must be greater than 0"},
    {{1, 0, 1, -1e-3, 1, 1}, "scene: TENSION_RESSORT is -0.001; it must be 0 or more"},
    {{1, 0, 1, 1, (UINT64_C(1) << 53) + 1, 1},
     "scene: NB_ITERATIONS is 9007199254740993; it must be at most 2^53"},
    {{1, 0, 1, 1, 1, 0}, "scene: NB_IMAGES is 0; it must be from 1 to 10^9"},
    {{1, 0, 1, 1, UINT64_C(1) << 53, 1000000001},
     "scene: NB_IMAGES is 1000000001; it must be from 1 to 10^9"},
    {{1, 0, 1, 1, 1, 2},
     "scene: NB_IMAGES is 2 and NB_ITERATIONS 1; ask for at most one image per iteration"},
};

static void check_ranges(void) {
  for (size_t i = 0; i < LENGTH(ranges); i++) {
    const char *message = ranges[i].message;
    msr_error err = {.message = ""};
    const msr_status status = msri_conf_check("scene", &ranges[i].conf, &err);
    assert_int_equal(status, message ? MSR_EINPUT : MSR_OK);
    assert_string_equal(err.message, message ? message : "");
  }
}

static void programs_are_checked_too(void **state) {
  (void)state;
  check_ranges();
  const msr_conf conf = {.dt = (double)NAN, .mass = 1, .images = 1};
  assert_int_equal(msri_conf_check("scene", &conf, NULL), MSR_EINPUT);
}

static void a_french_locale_changes_nothing(void **state) {
  if (!setlocale(LC_ALL, "fr_FR.UTF-8")) skip();
  the_assignment_is_read(state);
  check_bads();
  check_ranges();
  setlocale(LC_ALL, "C");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_assignment_is_read),
      cmocka_unit_test(harmless_differences_are_tolerated),
      cmocka_unit_test(everything_else_says_why),
      cmocka_unit_test(no_part_of_a_conf_is_another_one),
      cmocka_unit_test(no_length_is_too_much),
      cmocka_unit_test(files_are_read),
      cmocka_unit_test(running_out_of_memory_is_an_error),
      cmocka_unit_test(programs_are_checked_too),
      cmocka_unit_test(a_french_locale_changes_nothing),
  };
  return cmocka_run_group_tests(tests, make_directory, remove_directory);
}
