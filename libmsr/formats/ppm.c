/* ppm.c - reads pictures in PPM, plain (P3) and binary (P6), as netpbm defines them:
 * magic, width, height, maxval, then the samples, red, green, blue, rows from the top. White space
 * and comments may stand before any number; after the maxval of a P6 one single byte, of white
 * space, ends the header. https://netpbm.sourceforge.net/doc/ppm.html */
#include "formats/ppm.h"

#include "base/file.h"
#include "formats/source.h"

#include <stdlib.h>
#include <string.h>

enum { WIDTH, HEIGHT, MAXVAL, N_FIELDS };

static const struct field {
  const char *name;
  size_t most;
} fields[N_FIELDS] = {{"width", INT32_MAX}, {"height", INT32_MAX}, {"maxval", 65535}};

/* A picture being read. */
typedef struct reader {
  msri_source source;
  size_t at; /* next byte */
  bool plain;
  size_t header[N_FIELDS];
  size_t samples;     /* 3 * width * height */
  size_t sample_size; /* bytes that one takes at least: plain ones follow white space */
  msr_error *err;
} reader;

static bool is_space(unsigned char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

static bool is_break(const msri_source *s, size_t at) {
  return at == s->size || is_space(s->bytes[at]) || s->bytes[at] == '#';
}

/* The first byte from `at` on that is neither white space nor, if asked, in a comment. */
static size_t skip(const msri_source *s, size_t at, bool comments) {
  for (bool comment = false; at < s->size; at++) {
    const unsigned char c = s->bytes[at];
    if (comments && c == '#') comment = true;
    if (c == '\n' || c == '\r') comment = false;
    if (!comment && !is_space(c)) break;
  }
  return at;
}

/* The word at `at`, for a message. */
static const char *quote(const msri_source *s, size_t at, char text[MSRI_QUOTE_SIZE]) {
  size_t end = at;
  while (!is_break(s, end)) end++;
  return msri_source_quote(s, at, end - at, text);
}

/* ---- Header */

static bool is_magic(const msri_source *s, size_t at, char first, char last) {
  return s->size - at >= 2 && s->bytes[at] == 'P' && s->bytes[at + 1] >= first &&
         s->bytes[at + 1] <= last && is_break(s, at + 2);
}

static msr_status check_magic(const msri_source *s, msr_error *err) {
  char word[MSRI_QUOTE_SIZE];
  if (is_magic(s, 0, '3', '3') || is_magic(s, 0, '6', '6')) return MSR_OK;
  if (s->size == 0)
    return msri_source_fail(s, 0, err, "the file is empty; a PPM picture begins with P3 or P6");
  const msri_kind *kind = msri_source_kind(s);
  if (kind && kind->todo)
    return msri_source_fail(s, 0, err, "this is %s, not a PPM picture; %s", kind->name, kind->todo);
  const size_t shown = s->size < 12 ? s->size : 12;
  return msri_source_fail(s, 0, err, "this is no PPM picture: it begins with %s; %s",
                          msri_source_quote(s, 0, shown, word),
                          "it must begin with P3 or P6 and white space");
}

/* Reads a whole number at *at and moves there; false if it is above `most` or isn't one. */
static bool read_number(const msri_source *s, size_t *at, size_t most, size_t *value) {
  size_t p = *at;
  uint64_t number = 0;
  for (; p < s->size && number <= most; p++) {
    const unsigned digit = s->bytes[p] - (unsigned)'0';
    if (digit > 9) break;
    number = number * 10 + digit;
  }
  const bool sound = p > *at && number <= most && is_break(s, p);
  *at = p;
  *value = (size_t)number;
  return sound;
}

static msr_status read_field(reader *r, size_t i) {
  const msri_source *s = &r->source;
  char word[MSRI_QUOTE_SIZE];
  const size_t start = r->at = skip(s, r->at, true);
  if (start == s->size)
    return msri_source_fail(s, start, r->err, "the file ends before the %s; a header is %s",
                            fields[i].name, "P3 or P6, width, height and maxval");
  if (!read_number(s, &r->at, fields[i].most, &r->header[i]) || r->header[i] == 0)
    return msri_source_fail(s, start, r->err, "%s is %s; it must be a whole number from 1 to %zu",
                            fields[i].name, quote(s, start, word), fields[i].most);
  return MSR_OK;
}

/* To the raster of a P6: past one byte, or past a comment and the end of its line. */
static size_t end_header(const msri_source *s, size_t at) {
  if (at < s->size && s->bytes[at] == '#')
    while (at < s->size && s->bytes[at] != '\n' && s->bytes[at] != '\r') at++;
  return at < s->size ? at + 1 : at;
}

static msr_status read_header(reader *r) {
  msr_status status = check_magic(&r->source, r->err);
  r->at = 2;
  for (size_t i = 0; !status && i < N_FIELDS; i++) status = read_field(r, i);
  if (status) return status;
  const size_t width = r->header[WIDTH], height = r->header[HEIGHT];
  if ((uint64_t)width * height > SIZE_MAX / 6) // a pixel takes 6 bytes at most
    return msri_source_fail(&r->source, 0, r->err, "%zu x %zu pixels are more than memory can %s",
                            width, height, "hold; check the width and the height");
  r->plain = r->source.bytes[1] == '3';
  if (!r->plain) r->at = end_header(&r->source, r->at);
  r->samples = 3 * width * height;
  r->sample_size = r->plain || r->header[MAXVAL] > 255 ? 2 : 1;
  return MSR_OK;
}

/* ---- Samples */

static unsigned char scale(size_t sample, size_t maxval) {
  return (unsigned char)((sample * 255 + maxval / 2) / maxval);
}

static const char missing_todo[] = "add them, or correct the width and the height";

/* What is wrong with P3 sample i, at `start`. */
static msr_status bad_sample(const reader *r, size_t start, size_t i) {
  char word[MSRI_QUOTE_SIZE];
  const msri_source *s = &r->source;
  const size_t column = i / 3 % r->header[WIDTH], row = i / 3 / r->header[WIDTH];
  if (start == s->size)
    return msri_source_fail(s, start, r->err,
                            "the file ends in pixel (%zu,%zu): %zu of %zu samples are missing; %s",
                            column, row, r->samples - i, r->samples, missing_todo);
  return msri_source_fail(s, start, r->err,
                          "%s in pixel (%zu,%zu); a sample is a whole number from 0 to maxval, %zu",
                          quote(s, start, word), column, row, r->header[MAXVAL]);
}

/* Where the next sample begins: mostly after a single white space. */
static inline size_t next_sample(const msri_source *s, size_t at) {
  const bool usual = at + 1 < s->size && is_space(s->bytes[at]) && s->bytes[at + 1] >= '0' &&
                     s->bytes[at + 1] <= '9';
  return usual ? at + 1 : skip(s, at, true);
}

static msr_status read_plain(reader *r, unsigned char *rgb) {
  const msri_source s = r->source;
  const size_t maxval = r->header[MAXVAL];
  size_t at = r->at;
  for (size_t i = 0; i < r->samples; i++) {
    size_t sample;
    const size_t start = at = next_sample(&s, at);
    if (!read_number(&s, &at, maxval, &sample)) return bad_sample(r, start, i);
    rgb[i] = maxval == 255 ? (unsigned char)sample : scale(sample, maxval);
  }
  r->at = at;
  return MSR_OK;
}

static size_t raw_sample(const unsigned char *raster, size_t i, bool wide) {
  return wide ? (size_t)raster[2 * i] << 8 | raster[2 * i + 1] : raster[i];
}

/* Scales n samples. Returns the index of the first above maxval, or n. */
static size_t scale_raw(const unsigned char *raster, size_t n, size_t maxval, unsigned char *rgb) {
  const bool wide = maxval > 255;
  for (size_t i = 0; i < n; i++) {
    const size_t sample = raw_sample(raster, i, wide);
    if (sample > maxval) return i;
    rgb[i] = scale(sample, maxval);
  }
  return n;
}

/* Samples that the bytes left can hold. */
static size_t held(const reader *r) {
  const size_t most = (r->source.size - r->at) / r->sample_size;
  return most < r->samples ? most : r->samples;
}

static msr_status bad_raster(const reader *r, size_t i) {
  const msri_source *s = &r->source;
  const size_t column = i / 3 % r->header[WIDTH], row = i / 3 / r->header[WIDTH];
  const size_t wanted = r->samples * r->sample_size, left = s->size - r->at;
  if (left < wanted)
    return msri_source_fail(s, r->at, r->err,
                            "the file ends in pixel (%zu,%zu): %zu of %zu bytes are missing; %s",
                            column, row, wanted - left, wanted, missing_todo);
  return msri_source_fail(
      s, r->at, r->err, "sample %zu in pixel (%zu,%zu) is above maxval, %zu; raise maxval",
      raw_sample(s->bytes + r->at, i, r->sample_size == 2), column, row, r->header[MAXVAL]);
}

static msr_status read_raw(reader *r, unsigned char *rgb) {
  const unsigned char *raster = r->source.bytes + r->at;
  const size_t n = held(r);
  size_t sound = n;
  if (n == r->samples && r->header[MAXVAL] == 255)
    memcpy(rgb, raster, n);
  else if (n == r->samples)
    sound = scale_raw(raster, n, r->header[MAXVAL], rgb);
  if (sound < r->samples) return bad_raster(r, sound);
  r->at += n * r->sample_size;
  return MSR_OK;
}

/* ---- The file */

/* After the samples the file may end or go on with another image. */
static msr_status check_tail(const reader *r, size_t raster, bool *more) {
  const msri_source *s = &r->source;
  const size_t at = skip(s, r->at, r->plain);
  *more = is_magic(s, at, '1', '7');
  if (at == s->size || *more) return MSR_OK;
  const size_t excess = s->size - r->at;
  const bool crlf = !r->plain && excess == 1 && memcmp(s->bytes + raster - 1, "\r\n", 2) == 0;
  return msri_source_fail(s, r->plain ? at : raster, r->err,
                          "bytes too many after the last pixel: %zu; %s", excess,
                          crlf ? "end the header in a line feed alone, not in CR LF"
                               : "remove them, or correct the width and the height");
}

static msr_status read_picture(reader *r, msr_picture *picture, bool *more) {
  // What a header claims is not allocated on its word.
  picture->rgb = msri_alloc(held(r), 1, "the pixels of a picture", r->err);
  if (!picture->rgb) return MSR_ENOMEM;
  const size_t raster = r->at;
  const msr_status status = (r->plain ? read_plain : read_raw)(r, picture->rgb);
  return status ? status : check_tail(r, raster, more);
}

msr_status msr_picture_parse(const char *name, const void *bytes, size_t size,
                             msr_picture **picture, bool *more, msr_error *err) {
  reader r = {.source = {name, bytes, size}, .err = err};
  bool others = false;
  msr_status status = read_header(&r);
  if (status) return status;
  msr_picture *p = msri_alloc(1, sizeof *p, "a picture", err);
  if (!p) return MSR_ENOMEM;
  *p = (msr_picture){r.header[WIDTH], r.header[HEIGHT], NULL};
  status = read_picture(&r, p, &others);
  if (status) {
    msr_picture_free(p);
    return status;
  }
  *picture = p;
  if (more) *more = others;
  return MSR_OK;
}

/* Stops at the first bytes of what is no picture, however long it is. */
static msr_status accept(const char *path, const unsigned char *head, size_t size, msr_error *err) {
  return check_magic(&(msri_source){path, head, size}, err);
}

msr_status msr_picture_read(const char *path, msr_picture **picture, bool *more, msr_error *err) {
  const size_t limit = (size_t)msri_min(0x1p32, (double)(SIZE_MAX / 4));
  unsigned char *bytes;
  size_t size;
  msr_status status = msri_file_read_if(path, limit, accept, &bytes, &size, err);
  if (status) return status;
  status = msr_picture_parse(path, bytes, size, picture, more, err);
  free(bytes);
  return status;
}
