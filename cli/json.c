/* json.c - see json.h. */
#include "json.h"

#include "texts.h"

#include <inttypes.h>
#include <math.h>

/* ---- Text */

/* Bytes of the character that begins here, if it's well-formed UTF-8 (RFC 3629), else 0. */
static size_t character(const unsigned char *c) {
  static const struct {
    unsigned char first, last, low, high; /* of the first byte, of the second one */
    size_t bytes;
  } rows[] = {
      {0x20, 0x7f, 0, 0xff, 1},    {0xc2, 0xdf, 0x80, 0xbf, 2}, {0xe0, 0xe0, 0xa0, 0xbf, 3},
      {0xe1, 0xec, 0x80, 0xbf, 3}, {0xed, 0xed, 0x80, 0x9f, 3}, {0xee, 0xef, 0x80, 0xbf, 3},
      {0xf0, 0xf0, 0x90, 0xbf, 4}, {0xf1, 0xf3, 0x80, 0xbf, 4}, {0xf4, 0xf4, 0x80, 0x8f, 4}};
  for (size_t r = 0; r < sizeof rows / sizeof rows[0]; r++) {
    if (*c < rows[r].first || *c > rows[r].last) continue;
    if (c[1] < rows[r].low || c[1] > rows[r].high) return 0;
    for (size_t b = 2; b < rows[r].bytes; b++) {
      if (c[b] < 0x80 || c[b] > 0xbf) return 0;
    }
    return rows[r].bytes;
  }
  return 0;
}

static void print_text(FILE *out, const char *text) {
  const unsigned char *c = (const unsigned char *)text;
  fputc('"', out);
  while (*c) {
    const size_t bytes = character(c);
    if (*c < 0x20) {
      fprintf(out, "\\u%04x", *c);
    } else if (bytes == 0) {
      fputs("\\ufffd", out);
    } else {
      if (*c == '"' || *c == '\\') fputc('\\', out);
      fwrite(c, 1, bytes, out);
    }
    c += bytes > 0 ? bytes : 1;
  }
  fputc('"', out);
}

/* ---- Values */

static void begin(json *j, const char *name) {
  if (j->more) fputc(',', j->out);
  if (j->depth > 0) fprintf(j->out, "\n%*s", 2 * j->depth, "");
  j->more = true;
  if (!name) return;
  print_text(j->out, name);
  fputs(": ", j->out);
}

void json_open(json *j, const char *name, char bracket) {
  begin(j, name);
  fputc(bracket, j->out);
  j->depth++;
  j->more = false;
}

void json_close(json *j, char bracket) {
  j->depth--;
  if (j->more) fprintf(j->out, "\n%*s", 2 * j->depth, "");
  fputc(bracket, j->out);
  j->more = true;
  if (j->depth == 0) fputc('\n', j->out);
}

void json_text(json *j, const char *name, const char *text) {
  begin(j, name);
  if (text) {
    print_text(j->out, text);
  } else {
    fputs("null", j->out);
  }
}

void json_number(json *j, const char *name, double value) {
  begin(j, name);
  fputs(isfinite(value) ? number_exact(value).text : "null", j->out);
}

void json_count(json *j, const char *name, uint64_t value) {
  begin(j, name);
  fprintf(j->out, "%" PRIu64, value);
}

void json_bool(json *j, const char *name, bool value) {
  begin(j, name);
  fputs(value ? "true" : "false", j->out);
}
