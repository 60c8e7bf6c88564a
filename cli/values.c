/* values.c - reads the values of options, strictly: the whole text or nothing, decimal, in the C
 * locale, within range. A field of settings is set only if its text is right. */
#include "values.h"

#include "guess.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool made_of(const char *text, const char *alphabet) {
  return *text && text[strspn(text, alphabet)] == '\0';
}

static bool read_flag(const kind *k, const char *text, void *field) {
  (void)k, (void)text;
  *(bool *)field = true;
  return true;
}

/* Other names of standard output. */
static const char *const standard_output[] = {"/dev/stdout", "/dev/fd/1", NULL};

static bool read_path(const kind *k, const char *text, void *field) {
  (void)k;
  const char **path = field;
  *path = text;
  for (const char *const *i = standard_output; *i; i++) {
    if (strcmp(text, *i) == 0) *path = "-";
  }
  return *text != '\0';
}

/* The alphabet leaves out what strtod also takes: blanks, hexadecimal, inf and nan. */
static bool read_real(const kind *k, const char *text, void *field) {
  char *end;
  if (!made_of(text, "0123456789.eE+-")) return false;
  const double value = strtod(text, &end);
  if (*end || !isfinite(value) || value < k->min || value > k->max) return false;
  *(double *)field = value;
  return true;
}

static bool read_whole(const kind *k, const char *text, void *field) {
  for (const named_value *n = k->names; n && n->name; n++) {
    if (strcmp(text, n->name) != 0) continue;
    *(uint64_t *)field = n->value;
    return true;
  }
  if (k->most == 0 || !made_of(text, "0123456789")) return false;
  errno = 0;
  const unsigned long long value = strtoull(text, NULL, 10);
  if (errno || value < k->least || value > k->most) return false;
  *(uint64_t *)field = value;
  return true;
}

static const msr_integrator *find_integrator(const char *name) {
  const msr_integrator *const *i = msr_integrators;
  while (*i && strcmp((*i)->name, name) != 0) i++;
  return *i;
}

static bool read_integrator(const kind *k, const char *text, void *field) {
  const msr_integrator *const found = find_integrator(text);
  (void)k;
  if (found) *(const msr_integrator **)field = found;
  return found || strcmp(text, "auto") == 0;
}

static const char *nearest_integrator(const char *text) {
  guess g = {.word = text};
  for (const msr_integrator *const *i = msr_integrators; *i; i++) guess_consider(&g, (*i)->name);
  return g.best;
}

/* Reads up to a comma, or to the end for the last, and moves past it. */
static bool read_part(const kind *k, const char **text, bool last, void *field) {
  char part[64];
  const size_t length = strcspn(*text, ",");
  if (length >= sizeof part || ((*text)[length] == '\0') != last) return false;
  memcpy(part, *text, length);
  part[length] = '\0';
  *text += length + !last;
  return k->read(k, part, field);
}

static const kind a_name = {.read = read_integrator};

/* One that is named twice counts once. */
static bool add_integrator(settings *s, const msr_integrator *integrator) {
  if (!integrator) return false;
  for (size_t i = 0; i < s->n_integrators; i++) {
    if (s->integrators[i] == integrator) return true;
  }
  if (s->n_integrators == MOST_INTEGRATORS) return false;
  s->integrators[s->n_integrators++] = integrator;
  return true;
}

static bool read_integrators(const kind *k, const char *text, void *field) {
  const msr_integrator *integrator;
  bool last;
  (void)k;
  do {
    last = !strchr(text, ',');
    integrator = NULL;
    if (!read_part(&a_name, &text, last, &integrator)) return false;
    if (!add_integrator(field, integrator)) return false;
  } while (!last);
  return true;
}

/* Of the first that is no name. */
static const char *nearest_of_list(const char *text) {
  for (bool last = false; !last;) {
    char name[64] = "";
    const size_t length = strcspn(text, ",");
    snprintf(name, sizeof name, "%.*s", (int)length, text);
    if (!find_integrator(name)) return nearest_integrator(name);
    last = !text[length];
    text += length + 1;
  }
  return NULL;
}

/* The end of the name tells the format. */
static bool read_figure(const kind *k, const char *text, void *field) {
  const size_t n = strlen(text);
  const char *const end = text + (n > 4 ? n - 4 : n);
  return (strcmp(end, ".svg") == 0 || strcmp(end, ".png") == 0) && read_path(k, text, field);
}

static bool read_push(const kind *k, const char *text, void *field) {
  static const struct kind place = {.read = read_whole, .most = 2147483647};
  settings *s = field;
  push *p = &s->pushes[s->n_pushes];
  (void)k;
  if (!read_part(&place, &text, false, &p->column) || !read_part(&place, &text, false, &p->row) ||
      !read_part(&a_real, &text, false, &p->fx) || !read_part(&a_real, &text, true, &p->fy)) {
    return false;
  }
  s->n_pushes++;
  return true;
}

/* Black ends in 1: a style that is all zero asks for the library's own colour. */
#define COLOURS(X)                                                                                 \
  X(red, 0xff0000)                                                                                 \
  X(orange, 0xff8000)                                                                              \
  X(yellow, 0xffff00)                                                                              \
  X(green, 0x00a000)                                                                               \
  X(cyan, 0x00c0c0)                                                                                \
  X(blue, 0x0000ff)                                                                                \
  X(magenta, 0xff00ff)                                                                             \
  X(grey, 0x808080)                                                                                \
  X(black, 0x000001)

#define COLOUR_WORD(name, rgb) {#name, rgb},
#define COLOUR_NAME(name, rgb) #name " "
static const named_value colours[] = {COLOURS(COLOUR_WORD){NULL, 0}};

static bool read_colour(const char *text, unsigned char rgb[3]) {
  static const kind named = {.names = colours};
  uint64_t value = 0;
  if (*text == '#') {
    if (strlen(text) != 7 || !made_of(text + 1, "0123456789abcdefABCDEF")) return false;
    value = strtoull(text + 1, NULL, 16);
    if (value == 0) value = 1;
  } else if (!read_whole(&named, text, &value)) {
    return false;
  }
  for (int c = 0; c < 3; c++) rgb[c] = (unsigned char)(value >> (16 - 8 * c) & 0xff);
  return true;
}

static bool read_stripe(const kind *k, const char *text, void *field) {
  msr_style *style = field;
  char rows[24];
  uint64_t n;
  const size_t length = strcspn(text, ":");
  if (length >= sizeof rows) return false;
  memcpy(rows, text, length);
  rows[length] = '\0';
  if (!read_whole(k, rows, &n)) return false;
  style->stripes = (unsigned)n;
  return text[length] == '\0' || read_colour(text + length + 1, style->stripe_colour);
}

static const named_value degrees[] = {{"4", 4}, {"8", 8}, {NULL, 0}};
static const named_value borders[] = {{"open", 0}, {"closed", 1}, {NULL, 0}};
static const named_value steps[] = {{"auto", 0}, {"off", 1}, {NULL, 0}};

static const named_value rules[] = {
    {"kept", MSR_IMPACTS_KEPT}, {"located", MSR_IMPACTS_LOCATED}, {NULL, 0}};

const kind a_flag = {.read = read_flag};
const kind a_path = {.wants = "the name of a file", .read = read_path};
const kind a_directory = {.wants = "the name of a directory, or -", .read = read_path};
const kind a_real = {.wants = "a number", .read = read_real, .min = -DBL_MAX, .max = DBL_MAX};
const kind a_positive = {"a number above 0", read_real, .min = DBL_MIN, .max = DBL_MAX};
const kind a_size = {.wants = "a number, 0 or more", .read = read_real, .max = DBL_MAX};
const kind a_share = {.wants = "a number from 0 to 1", .read = read_real, .max = 1};
const kind a_count = {"a whole number from 1 to 2147483647", read_whole, .least = 1,
                      .most = 2147483647};
const kind a_team = {"a whole number from 1 to 256", read_whole, .least = 1, .most = 256};
const kind a_seed = {"a whole number from 0 to 18446744073709551615", read_whole,
                     .most = UINT64_MAX};
const kind a_degree = {.wants = "4 or 8", .read = read_whole, .names = degrees};
const kind a_border = {.wants = "open or closed", .read = read_whole, .names = borders};
const kind a_substeps = {"auto, off or a whole number from 1 to 1000000000", read_whole, .least = 1,
                         .most = 1000000000, .names = steps};
const kind a_rule = {.wants = "kept or located", .read = read_whole, .names = rules};
const kind integrators = {.wants = "names that 'msr list' shows, with commas between them",
                          .read = read_integrators,
                          .nearest = nearest_of_list};
const kind a_figure = {.wants = "a file whose name ends in .svg or .png", .read = read_figure};
const kind an_integrator = {.wants = "auto or a name that 'msr list' shows",
                            .read = read_integrator,
                            .nearest = nearest_integrator};
const kind a_push = {.wants = "X,Y,FX,FY: a pixel, whole numbers from 0 to 2147483647, and a force",
                     .read = read_push};
const kind a_stripe = {
    "N or N:COLOUR: N from 1 to 2147483647, COLOUR one of " COLOURS(COLOUR_NAME) "or #rrggbb",
    read_stripe, .least = 1, .most = 2147483647};
