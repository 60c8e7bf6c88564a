/* test_ppm.c - pictures in and out: what the format allows is read as netpbm reads it, the rest is
 * refused with the message in the table below, and no header makes the reader allocate more than
 * the file justifies. link: --wrap=malloc --wrap=calloc --wrap=realloc */
#include "formats/ppm.h"

#include "alloc.h"
#include "files.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#define BYTES(text)   text, sizeof(text) - 1
#define LENGTH(array) (sizeof(array) / sizeof *(array))

static const struct good {
  const char *what, *bytes;
  size_t size, width, height;
  bool more;
  const char *rgb;
} goods[] = {
    {"plain", BYTES("P3\n2 1\n255\n1 2 3 4 5 6\n"), 2, 1, false, "\1\2\3\4\5\6"},
    {"binary", BYTES("P6\n2 1\n255\n\1\2\3\4\5\6"), 2, 1, false, "\1\2\3\4\5\6"},
    {"every white space", BYTES("P3\t2\v1\f255\r1  2\r\n3\n4\v5\f6"), 2, 1, false, "\1\2\3\4\5\6"},
    {"no line feed at the end", BYTES("P3 1 1 255 65 66 67"), 1, 1, false, "ABC"},
    {"leading zeros", BYTES("P3 01 000001 0255 0065 00066 67"), 1, 1, false, "ABC"},
    {"comments", BYTES("P3#a\n#b\n1#c\n1 #d\n#\n9#e\n1 #f\n2#g\n3#h\n#i"), 1, 1, false,
     "\34\71\125"},
    {"comments end in CR too", BYTES("P3#a\r1 1#b\r9 1 2 3"), 1, 1, false, "\34\71\125"},
    {"comments in a binary header", BYTES("P6 # 9 9\n1\n#\n1\n255\nABC"), 1, 1, false, "ABC"},
    {"a comment may end it", BYTES("P6 1 1 255#c\nABC"), 1, 1, false, "ABC"},
    {"a pixel like a line feed", BYTES("P6 1 1 255\n\n\n\n"), 1, 1, false, "\n\n\n"},
    {"a pixel like a comment", BYTES("P6 1 1 255\n# \n"), 1, 1, false, "# \n"},
    {"a pixel like another image", BYTES("P6 1 1 255\nP6 "), 1, 1, false, "P6 "},
    {"header ends in CR", BYTES("P6 1 1 255\rABC"), 1, 1, false, "ABC"},
    {"maxval 1", BYTES("P6 1 1 1\n\0\1\1"), 1, 1, false, "\0\377\377"},
    {"maxval 100 is rounded", BYTES("P6 1 1 100\n\1\62\144"), 1, 1, false, "\3\200\377"},
    {"maxval 256 takes two bytes", BYTES("P6 1 1 256\n\0\0\0\200\1\0"), 1, 1, false, "\0\200\377"},
    {"maxval 65535", BYTES("P6 1 1 65535\n\200\0\0\200\377\377"), 1, 1, false, "\200\0\377"},
    {"plain, maxval 65535", BYTES("P3 1 1 65535 32768 128 65535"), 1, 1, false, "\200\0\377"},
    {"white space after", BYTES("P6 1 1 255\nABC\r\n \t"), 1, 1, false, "ABC"},
    {"another image after", BYTES("P6 1 1 255\nABCP6 1 1 255\nDEF"), 1, 1, true, "ABC"},
    {"after white space", BYTES("P6 1 1 255\nABC\nP5 1 1 255\nD"), 1, 1, true, "ABC"},
    {"after a plain one", BYTES("P3 1 1 255 65 66 67\nP3 1 1 255 1 2 3"), 1, 1, true, "ABC"},
};

static const struct bad {
  const char *bytes;
  size_t size;
  const char *message; /* after the name and a colon */
} bads[] = {
    {BYTES(""), "1:1: the file is empty; a PPM picture begins with P3 or P6"},
    {BYTES("P"), "1:1: this is no PPM picture: it begins with 'P'; it must begin with P3 or P6 and "
                 "white space"},
    {BYTES("P6"),
     "1:3: the file ends before the width; a header is P3 or P6, width, height and maxval"},
    {BYTES(" P6 1 1 255 ABC"), "1:1: this is no PPM picture: it begins with ' P6 1 1 255 '; it "
                               "must begin with P3 or P6 and white space"},
    {BYTES("P63 2 255 ABC"), "1:1: this is no PPM picture: it begins with 'P63 2 255 AB'; it must "
                             "begin with P3 or P6 and white space"},
    {BYTES("P1\n1 1\n1\n"),
     "1:1: this is a PBM picture (P1), not a PPM picture; convert it: ppmtoppm < x.pbm > x.ppm"},
    {BYTES("P2\n1 1\n255\n1\n"),
     "1:1: this is a PGM picture (P2), not a PPM picture; convert it: ppmtoppm < x.pgm > x.ppm"},
    {BYTES("P4\n1 1\n\1"),
     "1:1: this is a PBM picture (P4), not a PPM picture; convert it: ppmtoppm < x.pbm > x.ppm"},
    {BYTES("P5\n1 1\n255\n\1"),
     "1:1: this is a PGM picture (P5), not a PPM picture; convert it: ppmtoppm < x.pgm > x.ppm"},
    {BYTES("P7\nWIDTH 1\n"),
     "1:1: this is a PAM picture (P7), not a PPM picture; convert it: pamtopnm x.pam > x.ppm"},
    {BYTES("\211PNG\r\n\32\n"),
     "1:1: this is a PNG picture, not a PPM picture; convert it: pngtopnm x.png > x.ppm"},
    {BYTES("\377\330\377\340"), "1:1: this is a JPEG picture, not a PPM picture; convert it: "
                                "jpegtopnm x.jpg > x.ppm (a PNG would be sharper)"},
    {BYTES("GIF89a"),
     "1:1: this is a GIF picture, not a PPM picture; convert it: giftopnm x.gif > x.ppm"},
    {BYTES("BM6\0"),
     "1:1: this is a BMP picture, not a PPM picture; convert it: bmptopnm x.bmp > x.ppm"},
    {BYTES("DT\n0.005\n"), "1:1: this is a conf, not a PPM picture; give it as the conf"},
    {BYTES("# conf\nDT\n"), "1:1: this is no PPM picture: it begins with '# conf\\x0ADT\\x0A'; it "
                            "must begin with P3 or P6 and white space"},
    {BYTES("\0\0\0\0"), "1:1: this is no PPM picture: it begins with '\\x00\\x00\\x00\\x00'; it "
                        "must begin with P3 or P6 and white space"},
    {BYTES("\303\251t\303\251 \377"),
     "1:1: this is no PPM picture: it begins with '\303\251t\303\251 \\xFF'; it must begin with P3 "
     "or P6 and white space"},
    {BYTES("\355\240\200\300\200\364\220\200\200"),
     "1:1: this is no PPM picture: it begins with '\\xED\\xA0\\x80\\xC0\\x80\\xF4\\x90\\x80\\x80'; "
     "it must begin with P3 or P6 and white space"},
    {BYTES("P3#\303\251\r0 1\n255\n"),
     "1:6: width is '0'; it must be a whole number from 1 to 2147483647"},
    {BYTES("P3\n"),
     "2:1: the file ends before the width; a header is P3 or P6, width, height and maxval"},
    {BYTES("P3 #\n2"),
     "2:2: the file ends before the height; a header is P3 or P6, width, height and maxval"},
    {BYTES("P3 2 2 # maxval"),
     "1:16: the file ends before the maxval; a header is P3 or P6, width, height and maxval"},
    {BYTES("P3\n0 1\n255\n"), "2:1: width is '0'; it must be a whole number from 1 to 2147483647"},
    {BYTES("P3\n1 -1\n255\n1 2 3"),
     "2:3: height is '-1'; it must be a whole number from 1 to 2147483647"},
    {BYTES("P3\n+1 1\n255\n1 2 3"),
     "2:1: width is '+1'; it must be a whole number from 1 to 2147483647"},
    {BYTES("P3\n2x1\n255\n1 2 3"),
     "2:1: width is '2x1'; it must be a whole number from 1 to 2147483647"},
    {BYTES("P3\n1 1.0\n255\n1 2 3"),
     "2:3: height is '1.0'; it must be a whole number from 1 to 2147483647"},
    {BYTES("P3\n1 1\n0\n0 0 0"), "3:1: maxval is '0'; it must be a whole number from 1 to 65535"},
    {BYTES("P3\n1 1\n65536\n0 0 0"),
     "3:1: maxval is '65536'; it must be a whole number from 1 to 65535"},
    {BYTES("P6\n99999999999999999999 1\n255\n"),
     "2:1: width is '99999999999999999999'; it must be a whole number from 1 to 2147483647"},
    {BYTES("P6\n2147483648 1\n255\n"),
     "2:1: width is '2147483648'; it must be a whole number from 1 to 2147483647"},
    {BYTES("P6\n2147483647 2147483647\n255\n"), "1:1: 2147483647 x 2147483647 pixels are more than "
                                                "memory can hold; check the width and the height"},
    {BYTES("P6\n100000 100000\n255\nABC"),
     "4:1: the file ends in pixel (1,0): 29999999997 of 30000000000 bytes are missing; add them, "
     "or correct the width and the height"},
    {BYTES("P6\n2 2\n255\n123456789"), "4:1: the file ends in pixel (1,1): 3 of 12 bytes are "
                                       "missing; add them, or correct the width and the height"},
    {BYTES("P6\n2 2\n65535\n123456789"), "4:1: the file ends in pixel (1,0): 15 of 24 bytes are "
                                         "missing; add them, or correct the width and the height"},
    {BYTES("P6\n1 1\n255"), "3:4: the file ends in pixel (0,0): 3 of 3 bytes are missing; add "
                            "them, or correct the width and the height"},
    {BYTES("P6\n2 1\n100\n\1\2\3\4\145\6"),
     "4:1: sample 101 in pixel (1,0) is above maxval, 100; raise maxval"},
    {BYTES("P6\n1 1\n256\n\0\1\1\1\0\2"),
     "4:1: sample 257 in pixel (0,0) is above maxval, 256; raise maxval"},
    {BYTES("P6\n1 1\n255\r\nABC"), "3:5: bytes too many after the last pixel: 1; end the header in "
                                   "a line feed alone, not in CR LF"},
    {BYTES("P6\n1 1\n255\nABCDE"), "4:1: bytes too many after the last pixel: 2; remove them, or "
                                   "correct the width and the height"},
    {BYTES("P6\n1 1\n255\nABC#"), "4:1: bytes too many after the last pixel: 1; remove them, or "
                                  "correct the width and the height"},
    {BYTES("P6\n1 1\n255\nABCP8 "), "4:1: bytes too many after the last pixel: 3; remove them, or "
                                    "correct the width and the height"},
    {BYTES("P3\n2 2\n255\n1 2 3\n4 5 6\n7 8"),
     "6:4: the file ends in pixel (0,1): 4 of 12 samples are missing; add them, or correct the "
     "width and the height"},
    {BYTES("P3\n100000 100000\n255\n1 2 3\n4"),
     "5:2: the file ends in pixel (1,0): 29999999996 of 30000000000 samples are missing; add them, "
     "or correct the width and the height"},
    {BYTES("P3\n1 1\n100\n1 2 101\n"),
     "4:5: '101' in pixel (0,0); a sample is a whole number from 0 to maxval, 100"},
    {BYTES("P3\n1 2\n255\n1 2 3 4 -5 6\n"),
     "4:9: '-5' in pixel (0,1); a sample is a whole number from 0 to maxval, 255"},
    {BYTES("P3\n1 1\n255\n1,2,3\n"),
     "4:1: '1,2,3' in pixel (0,0); a sample is a whole number from 0 to maxval, 255"},
    {BYTES("P3\n1 1\n255\n1 2 99999999999999999999999\n"),
     "4:5: '99999999999999999999999' in pixel (0,0); a sample is a whole number from 0 to maxval, "
     "255"},
    {BYTES("P3\n1 1\n255\n1 2 3\n4 5 6\n"), "5:1: bytes too many after the last pixel: 7; remove "
                                            "them, or correct the width and the height"},
    {BYTES("P3\n1 1\n255\n1 2 3P3 1 1 255 1 2 3"),
     "4:5: '3P3' in pixel (0,0); a sample is a whole number from 0 to maxval, 255"},
};

/* Parses a copy that ends where it ends, so that a sanitizer or valgrind sees a byte read too many.
 */
static msr_status parse(const char *bytes, size_t size, msr_picture **picture, bool *more,
                        msr_error *err) {
  char *copy = malloc(size);
  if (size > 0) memcpy(copy, bytes, size);
  const msr_status status = msr_picture_parse("x.ppm", copy, size, picture, more, err);
  free(copy);
  return status;
}

static void sound_pictures_are_read(void **state) {
  (void)state;
  for (size_t i = 0; i < LENGTH(goods); i++) {
    const struct good *g = &goods[i];
    msr_picture *picture = NULL;
    msr_error err;
    bool more = !g->more;
    if (parse(g->bytes, g->size, &picture, &more, &err)) fail_msg("%s: %s", g->what, err.message);
    const bool same = picture->width == g->width && picture->height == g->height &&
                      memcmp(picture->rgb, g->rgb, 3 * g->width * g->height) == 0;
    if (!same || more != g->more) fail_msg("%s: read as something else", g->what);
    msr_picture_free(picture);
  }
}

static void unsound_pictures_say_why(void **state) {
  (void)state;
  for (size_t i = 0; i < LENGTH(bads); i++) {
    msr_picture *picture = NULL;
    msr_error err = {.status = MSR_OK};
    bool more = true;
    alloc_largest = 0;
    assert_int_equal(parse(bads[i].bytes, bads[i].size, &picture, &more, &err), MSR_EINPUT);
    // What a header claims isn't allocated: a picture's struct is the only excuse.
    assert_true(alloc_largest <= bads[i].size + sizeof *picture);
    assert_int_equal(err.status, MSR_EINPUT);
    assert_memory_equal(err.message, "x.ppm:", 6);
    assert_string_equal(err.message + 6, bads[i].message);
    assert_null(picture);
    assert_true(more);
    assert_int_equal(parse(bads[i].bytes, bads[i].size, &picture, NULL, NULL), MSR_EINPUT);
  }
  msr_picture *picture = NULL;
  assert_int_equal(msr_picture_parse("x.ppm", NULL, 0, &picture, NULL, NULL), MSR_EINPUT);
}

/* A file that was cut short is a smaller sound one only if what is missing doesn't matter. */
static void no_part_of_a_picture_is_another_one(void **state) {
  (void)state;
  for (size_t i = 0; i < LENGTH(goods); i++)
    for (size_t size = 0; size < goods[i].size; size++) {
      const struct good *g = &goods[i];
      msr_picture *picture = NULL;
      if (parse(g->bytes, size, &picture, NULL, NULL)) continue;
      assert_int_equal(picture->width, g->width);
      assert_int_equal(picture->height, g->height);
      // The last sample of a plain picture may have lost digits.
      assert_memory_equal(picture->rgb, g->rgb, 3 * g->width * g->height - 1);
      msr_picture_free(picture);
    }
}

/* Netpbm wants white space after the last number. */
static void put_for_netpbm(const char *path, const char *bytes, size_t size) {
  FILE *stream = fopen(path, "w");
  assert_non_null(stream);
  assert_int_equal(fwrite(bytes, 1, size, stream), size);
  if (bytes[1] == '3') fputc('\n', stream);
  assert_int_equal(fclose(stream), 0);
}

/* Netpbm's own idea of a file, as P6 of maxval 255; false: it refuses. */
static bool read_by_netpbm(const char *path, size_t width, size_t height, unsigned char *rgb) {
  char command[640];
  size_t w = 0, h = 0;
  snprintf(command, sizeof command, "ppmtoppm < %s 2>&- | pamdepth 255 2>&-", path);
  FILE *stream = popen(command, "r");
  assert_non_null(stream);
  const bool read = fscanf(stream, "P6 %zu %zu 255", &w, &h) == 2 && fgetc(stream) != EOF &&
                    w == width && h == height && fread(rgb, 3 * w, h, stream) == h;
  while (fgetc(stream) != EOF) {
  }
  return pclose(stream) == 0 && read;
}

static void netpbm_reads_the_same(void **state) {
  (void)state;
  const char *path = path_of("netpbm.ppm");
  if (system("command -v ppmtoppm pamdepth > /dev/null") != 0) skip();
  for (size_t i = 0; i < LENGTH(goods); i++) {
    const struct good *g = &goods[i];
    unsigned char rgb[64];
    put_for_netpbm(path, g->bytes, g->size);
    if (!read_by_netpbm(path, g->width, g->height, rgb)) fail_msg("netpbm refuses: %s", g->what);
    if (memcmp(rgb, g->rgb, 3 * g->width * g->height) != 0) fail_msg("netpbm differs: %s", g->what);
  }
  unlink(path);
}

static msr_picture *create(size_t width, size_t height) {
  msr_picture *picture = NULL;
  assert_int_equal(msr_picture_create(width, height, &picture, NULL), MSR_OK);
  return picture;
}

static void a_new_picture_is_white(void **state) {
  (void)state;
  msr_picture *picture = create(3, 2);
  assert_int_equal(picture->width, 3);
  assert_int_equal(picture->height, 2);
  for (size_t i = 0; i < 18; i++) assert_int_equal(picture->rgb[i], 255);
  msr_picture_free(picture);
  msr_picture_free(NULL);
}

static void absurd_sizes_are_refused(void **state) {
  (void)state;
  static const size_t sizes[][2] = {{0, 1}, {1, 0}, {SIZE_MAX, 1}, {SIZE_MAX / 3, 2}};
  for (size_t i = 0; i < LENGTH(sizes); i++) {
    msr_picture *picture = NULL;
    assert_int_equal(msr_picture_create(sizes[i][0], sizes[i][1], &picture, NULL), MSR_EUSAGE);
    assert_null(picture);
  }
}

static void what_is_written_reads_back(void **state) {
  (void)state;
  const char *path = path_of("written.ppm");
  msr_picture *picture = create(37, 11), *back = NULL;
  for (size_t i = 0; i < 3 * 37 * 11; i++) picture->rgb[i] = (unsigned char)(i * 7);
  bool more = true;
  struct stat st;
  char header[MSRI_PPM_HEADER_SIZE];
  assert_int_equal(msr_picture_write(picture, path, NULL), MSR_OK);
  assert_int_equal(msr_picture_read(path, &back, &more, NULL), MSR_OK);
  assert_false(more);
  assert_int_equal(back->width, 37);
  assert_int_equal(back->height, 11);
  assert_memory_equal(back->rgb, picture->rgb, 3 * 37 * 11);
  assert_int_equal(stat(path, &st), 0);
  assert_int_equal(st.st_size, msri_ppm_header(picture, header) + 3 * 37 * 11);
  msr_picture_free(picture);
  msr_picture_free(back);
  unlink(path);
}

static void the_largest_header_fits(void **state) {
  (void)state;
  char header[MSRI_PPM_HEADER_SIZE];
  const msr_picture picture = {SIZE_MAX, SIZE_MAX, NULL};
  const size_t n = msri_ppm_header(&picture, header);
  assert_int_equal(n, strlen(header));
  assert_memory_equal(header + n - 5, "\n255\n", 5);
}

static void files_that_fail_say_why(void **state) {
  (void)state;
  msr_picture *picture = NULL, *white = create(100, 100);
  msr_error err;
  assert_int_equal(msr_picture_read("/nowhere/x.ppm", &picture, NULL, &err), MSR_EIO);
  assert_string_equal(err.message,
                      "/nowhere/x.ppm: cannot read it: No such file or directory; check its name");
  // An endless file is refused at its first bytes.
  assert_int_equal(msr_picture_read("/dev/zero", &picture, NULL, &err), MSR_EINPUT);
  assert_memory_equal(err.message, "/dev/zero:1:1: this is no PPM picture", 37);
  assert_null(picture);
  assert_int_equal(msr_picture_write(white, "/nowhere/x.ppm", &err), MSR_EIO);
  msr_picture_free(white);
}

/* A limit on the size of files stands for a full disk. */
static void a_full_disk_leaves_nothing(void **state) {
  (void)state;
  msr_picture *white = create(100, 100);
  msr_error err;
  struct rlimit before;
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
  const struct rlimit limit = {1000, before.rlim_max};
  signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &limit);
  const msr_status status = msr_picture_write(white, path_of("full.ppm"), &err);
  setrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, SIG_DFL);
  assert_int_equal(status, MSR_EIO);
  assert_non_null(strstr(err.message, "full.ppm: cannot write it: File too large; "));
  assert_int_not_equal(access(path_of("full.ppm"), F_OK), 0);
  msr_picture_free(white);
}

static bool attempt_create(void) {
  msr_picture *picture = NULL;
  const bool done = msr_picture_create(3, 2, &picture, NULL) == MSR_OK;
  assert_int_equal(picture != NULL, done);
  msr_picture_free(picture);
  return done;
}

static bool attempt_read(void) {
  msr_picture *picture = NULL;
  const bool done = msr_picture_read(path_of("alloc.ppm"), &picture, NULL, NULL) == MSR_OK;
  assert_int_equal(picture != NULL, done);
  msr_picture_free(picture);
  return done;
}

static bool attempt_write(void) {
  unsigned char rgb[] = {65, 66, 67};
  const msr_picture picture = {1, 1, rgb};
  return msr_picture_write(&picture, path_of("alloc.ppm"), NULL) == MSR_OK;
}

static void running_out_of_memory_is_an_error(void **state) {
  (void)state;
  assert_int_equal(alloc_fail_each(attempt_create), 2);
  assert_int_equal(alloc_fail_each(attempt_write), 1);
  assert_int_equal(alloc_fail_each(attempt_read), 3);
  unlink(path_of("alloc.ppm"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sound_pictures_are_read),
      cmocka_unit_test(unsound_pictures_say_why),
      cmocka_unit_test(no_part_of_a_picture_is_another_one),
      cmocka_unit_test(netpbm_reads_the_same),
      cmocka_unit_test(a_new_picture_is_white),
      cmocka_unit_test(absurd_sizes_are_refused),
      cmocka_unit_test(what_is_written_reads_back),
      cmocka_unit_test(the_largest_header_fits),
      cmocka_unit_test(files_that_fail_say_why),
      cmocka_unit_test(a_full_disk_leaves_nothing),
      cmocka_unit_test(running_out_of_memory_is_an_error),
  };
  return cmocka_run_group_tests(tests, make_directory, remove_directory);
}
