/* conf.c - reads the assignment's parameter files: six names in a fixed order, each on a line of
 * its own, its value on the next line that isn't blank. A row of `parameters` is all there is to
 * know about one of them. */
#include "formats/conf.h"

#include "base/file.h"
#include "base/number.h"
#include "formats/words.h"

#include <float.h>
#include <inttypes.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_BYTES = 1 << 20 };

typedef struct parameter {
  const char *name;
  size_t offset; /* in msr_conf: of a uint64_t if it's a count, else of a double */
  bool count;
  double least, most;
  const char *range;
} parameter;

static const parameter parameters[] = {
    {"DT", offsetof(msr_conf, dt), false, DBL_TRUE_MIN, DBL_MAX, "greater than 0"},
    {"GRAVITE", offsetof(msr_conf, gravity), false, -DBL_MAX, DBL_MAX, "finite"},
    {"MASSE", offsetof(msr_conf, mass), false, DBL_TRUE_MIN, DBL_MAX, "greater than 0"},
    {"TENSION_RESSORT", offsetof(msr_conf, stiffness), false, 0, DBL_MAX, "0 or more"},
    {"NB_ITERATIONS", offsetof(msr_conf, iterations), true, 0, 0x1p53, "at most 2^53"},
    {"NB_IMAGES", offsetof(msr_conf, images), true, 1, 1e9, "from 1 to 10^9"},
};

enum { N_PARAMETERS = sizeof parameters / sizeof *parameters, NAMES_SIZE = 128 };

/* ---- Ranges */

static double real(const parameter *p, const msr_conf *conf) {
  double value;
  memcpy(&value, (const char *)conf + p->offset, sizeof value);
  return value;
}

static uint64_t count(const parameter *p, const msr_conf *conf) {
  uint64_t value;
  memcpy(&value, (const char *)conf + p->offset, sizeof value);
  return value;
}

static bool in_range(const parameter *p, const msr_conf *conf) {
  if (!p->count) return real(p, conf) >= p->least && real(p, conf) <= p->most;
  return count(p, conf) >= (uint64_t)p->least && count(p, conf) <= (uint64_t)p->most;
}

/* Writes what is wrong with a value, if anything is. */
static bool is_wrong(const parameter *p, const msr_conf *conf, char why[MSR_MESSAGE_SIZE]) {
  char value[MSRI_NUMBER_SIZE];
  if (in_range(p, conf)) return false;
  if (p->count) msri_format(value, sizeof value, "%" PRIu64, count(p, conf));
  if (!p->count) msri_number_write(real(p, conf), value);
  msri_format(why, MSR_MESSAGE_SIZE, "%s is %s; it must be %s", p->name, value, p->range);
  return true;
}

/* The same for all values together. */
static bool is_contradictory(const msr_conf *conf, char why[MSR_MESSAGE_SIZE]) {
  if (conf->images <= conf->iterations || conf->images == 1) return false;
  msri_format(why, MSR_MESSAGE_SIZE,
              "NB_IMAGES is %" PRIu64 " and NB_ITERATIONS %" PRIu64
              "; ask for at most one image per iteration",
              conf->images, conf->iterations);
  return true;
}

msr_status msri_conf_check(const char *name, const msr_conf *conf, msr_error *err) {
  char why[MSR_MESSAGE_SIZE];
  bool wrong = false;
  for (size_t i = 0; i < N_PARAMETERS && !wrong; i++) wrong = is_wrong(&parameters[i], conf, why);
  if (!wrong) wrong = is_contradictory(conf, why);
  return wrong ? msri_fail(err, MSR_EINPUT, "%s: %s", name, why) : MSR_OK;
}

/* ---- Names */

typedef msri_word word;

/* The parameter that the word names, or N_PARAMETERS. */
static size_t find(word w) {
  size_t i = 0;
  while (i < N_PARAMETERS && !msri_word_is(w, parameters[i].name)) i++;
  return i;
}

/* The name that was probably meant, or NULL. */
static const char *nearest(word w) {
  const char *best = NULL;
  size_t least = SIZE_MAX;
  for (size_t i = 0; i < N_PARAMETERS; i++) {
    const char *name = parameters[i].name;
    const size_t d = msri_word_distance(w, name);
    if (d > (strlen(name) + 2) / 3 || d >= least) continue;
    least = d;
    best = name;
  }
  return best;
}

/* Is it a name and something after it, such as DT=0.005? */
static bool is_glued(word w) {
  const char *end = memchr(w.text, '=', w.size);
  if (!end) end = memchr(w.text, ':', w.size);
  return end && nearest((word){.text = w.text, .size = (size_t)(end - w.text)});
}

/* "DT, GRAVITE, ..." */
static const char *all_names(char text[NAMES_SIZE]) {
  size_t n = 0;
  for (size_t i = 0; i < N_PARAMETERS; i++)
    n += (size_t)msri_format(text + n, NAMES_SIZE - n, "%s%s", i ? ", " : "", parameters[i].name);
  return text;
}

static msr_status bad_name(const msri_words *s, word w, size_t i) {
  char text[MSRI_QUOTE_SIZE], names[NAMES_SIZE];
  double number;
  const char *due = parameters[i].name, *near = nearest(w);
  const size_t found = find(w);
  const msri_source *source = &s->source;
  msri_source_quote(source, w.at, w.size, text);
  if (found < i)
    return msri_source_fail(source, w.at, s->err, "%s is given twice; remove one of them",
                            parameters[found].name);
  if (found < N_PARAMETERS)
    return msri_source_fail(source, w.at, s->err, "%s stands where %s is due; the order is %s",
                            parameters[found].name, due, all_names(names));
  if (is_glued(w))
    return msri_source_fail(source, w.at, s->err, "%s is a name with its value; %s", text,
                            "put the value on the next line, alone");
  if (i > 0 && msri_number_parse(w.text, w.size, &number) == MSRI_NUMBER_OK)
    return msri_source_fail(source, w.at, s->err, "%s is a second value for %s; keep one", text,
                            parameters[i - 1].name);
  if (near && msri_word_distance(w, near) == 0)
    return msri_source_fail(source, w.at, s->err, "%s isn't in capitals; write %s", text, near);
  if (near)
    return msri_source_fail(source, w.at, s->err, "unknown name %s; did you mean %s?", text, near);
  return msri_source_fail(source, w.at, s->err, "unknown name %s; %s is due here", text, due);
}

/* ---- The file */

/* What follows the value of parameter i - 1 must begin a line. */
static msr_status check_line(const msri_words *s, word w, size_t i) {
  char text[MSRI_QUOTE_SIZE];
  if (w.new_line || w.size == 0) return MSR_OK;
  return msri_source_fail(&s->source, w.at, s->err, "%s follows the value of %s; %s",
                          msri_source_quote(&s->source, w.at, w.size, text), parameters[i - 1].name,
                          "keep one value on the line, and comments after #");
}

static msr_status check_name(const msri_words *s, word w, size_t i) {
  if (msri_word_is(w, parameters[i].name) && w.new_line) return MSR_OK;
  if (w.size == 0)
    return msri_source_fail(&s->source, w.at, s->err, "the file ends before %s; %s",
                            parameters[i].name, "write the name, and its value on the next line");
  const msr_status status = check_line(s, w, i);
  return status ? status : bad_name(s, w, i);
}

/* Puts the value in the conf. */
static msr_status store(const msri_words *s, word w, const parameter *p, msr_conf *conf) {
  char text[MSRI_QUOTE_SIZE];
  double value;
  uint64_t number;
  const msri_number_fault fault = p->count ? msri_number_parse_count(w.text, w.size, &number)
                                           : msri_number_parse(w.text, w.size, &value);
  if (fault)
    return msri_source_fail(&s->source, w.at, s->err, "%s: %s %s", p->name,
                            msri_source_quote(&s->source, w.at, w.size, text),
                            msri_number_fault_text(fault));
  memcpy((char *)conf + p->offset, p->count ? (void *)&number : (void *)&value, sizeof value);
  return MSR_OK;
}

static msr_status check_value(const msri_words *s, word w, size_t i, msr_conf *conf) {
  char text[MSR_MESSAGE_SIZE];
  const parameter *p = &parameters[i];
  if (w.size == 0 || find(w) < N_PARAMETERS)
    return msri_source_fail(&s->source, w.at, s->err, "%s has no value; write it on the next line",
                            p->name);
  if (!w.new_line)
    return msri_source_fail(&s->source, w.at, s->err, "%s is on the line of %s; %s",
                            msri_source_quote(&s->source, w.at, w.size, text), p->name,
                            "put the value on the next line, alone");
  const msr_status status = store(s, w, p, conf);
  if (status) return status;
  const bool last = i + 1 == N_PARAMETERS;
  if (is_wrong(p, conf, text) || (last && is_contradictory(conf, text)))
    return msri_source_fail(&s->source, w.at, s->err, "%s", text);
  return MSR_OK;
}

static msr_status check_end(const msri_words *s, word w) {
  char text[MSRI_QUOTE_SIZE];
  const msr_status status = check_line(s, w, N_PARAMETERS);
  if (status || w.size == 0) return status;
  return msri_source_fail(&s->source, w.at, s->err, "%s follows the last value; remove it",
                          msri_source_quote(&s->source, w.at, w.size, text));
}

/* The bytes of a file, a byte order mark in UTF-8 apart. */
static msri_source open_source(const char *name, const void *bytes, size_t size) {
  const size_t mark = size >= 3 && memcmp(bytes, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
  return (msri_source){name, (const unsigned char *)bytes + mark, size - mark};
}

static msr_status check_text(const msri_source *source, msr_error *err) {
  static const char todo[] = "give a text in UTF-8 that begins with DT";
  const msri_kind *kind = msri_source_kind(source);
  if (kind && strcmp(kind->name, "a conf") != 0)
    return msri_source_fail(source, 0, err, "this is %s, not a conf; %s", kind->name, todo);
  const unsigned char *nul = source->size ? memchr(source->bytes, 0, source->size) : NULL;
  if (!nul) return MSR_OK;
  return msri_source_fail(source, (size_t)(nul - source->bytes), err,
                          "a zero byte: this is a binary file, not a conf; %s", todo);
}

static msr_status check_breaks(const msri_source *source, msr_error *err) {
  for (size_t i = 0; i < source->size; i++)
    if (source->bytes[i] == '\r' && (i + 1 == source->size || source->bytes[i + 1] != '\n'))
      return msri_source_fail(source, i, err, "a carriage return alone; end lines in LF or CR LF");
  return MSR_OK;
}

msr_status msr_conf_parse(const char *name, const char *text, size_t size, msr_conf *conf,
                          msr_error *err) {
  msr_conf read = {.dt = 0};
  msri_words s = {open_source(name, size ? text : "", size), 0, err};
  if (size > MOST_BYTES)
    return msri_source_fail(&s.source, 0, err, "%zu bytes: this is no conf; %s", size,
                            "check that it is the right file");
  msr_status status = check_text(&s.source, err);
  if (!status) status = check_breaks(&s.source, err);
  for (size_t i = 0; !status && i < N_PARAMETERS; i++) {
    status = check_name(&s, msri_words_next(&s), i);
    if (!status) status = check_value(&s, msri_words_next(&s), i, &read);
  }
  if (!status) status = check_end(&s, msri_words_next(&s));
  if (!status) *conf = read;
  return status;
}

/* Stops at the first bytes of what is no text, however long it is. */
static msr_status accept(const char *path, const unsigned char *head, size_t size, msr_error *err) {
  const msri_source source = open_source(path, head, size);
  return check_text(&source, err);
}

msr_status msr_conf_read(const char *path, msr_conf *conf, msr_error *err) {
  unsigned char *bytes;
  size_t size;
  msr_status status = msri_file_read_if(path, MOST_BYTES, accept, &bytes, &size, err);
  if (status) return status;
  status = msr_conf_parse(path, (const char *)bytes, size, conf, err);
  free(bytes);
  return status;
}
