/* number.c - numbers to and from text in the C locale. The syntax is checked here; rounding is
 * left to strtod and printf, under a C locale that this thread alone uses meanwhile. */
#include "base/number.h"

#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { LONGEST = 1023 }; /* characters of a number: an exact double takes up to 1077, 17 do */

#define MSRI_NUMBER_TEXT(name, text) text,
static const char *const fault_texts[] = {MSRI_NUMBER_FAULTS(MSRI_NUMBER_TEXT)};

const char *msri_number_fault_text(msri_number_fault fault) { return fault_texts[fault]; }

typedef struct c_locale {
  locale_t ours, before;
} c_locale;

static c_locale c_locale_enter(void) {
  const locale_t ours = newlocale(LC_ALL_MASK, "C", (locale_t)0);
  return (c_locale){ours, uselocale(ours)};
}

static void c_locale_leave(c_locale locale) {
  uselocale(locale.before);
  if (locale.ours) freelocale(locale.ours);
}

static size_t sign(const char *text, size_t size) {
  return size > 0 && (*text == '+' || *text == '-');
}

static size_t digits(const char *text, size_t size) {
  size_t n = 0;
  while (n < size && text[n] >= '0' && text[n] <= '9') n++;
  return n;
}

/* Length of the exponent at the start of text; 0: there is none. */
static size_t exponent(const char *text, size_t size) {
  if (size == 0 || (*text != 'e' && *text != 'E')) return 0;
  const size_t n = 1 + sign(text + 1, size - 1);
  const size_t power = digits(text + n, size - n);
  return power ? n + power : 0;
}

static bool is_decimal(const char *text, size_t size, char point) {
  size_t n = sign(text, size);
  const size_t whole = digits(text + n, size - n);
  n += whole;
  size_t fraction = 0;
  if (n < size && text[n] == point) {
    fraction = digits(text + n + 1, size - n - 1);
    n += 1 + fraction;
  }
  n += exponent(text + n, size - n);
  return whole + fraction > 0 && n == size;
}

/* What is wrong with a text that isn't decimal. */
static msri_number_fault diagnose(const char *text, size_t size) {
  static const char *const words[] = {"inf", "infinity", "nan"};
  if (is_decimal(text, size, ',')) return MSRI_NUMBER_COMMA;
  const size_t n = sign(text, size);
  text += n;
  size -= n;
  if (size > 1 && strncasecmp(text, "0x", 2) == 0) return MSRI_NUMBER_HEX;
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    if (size == strlen(words[i]) && strncasecmp(text, words[i], size) == 0)
      return MSRI_NUMBER_INFINITE;
  return MSRI_NUMBER_JUNK;
}

static double c_strtod(const char *text) {
  const c_locale locale = c_locale_enter();
  const double value = strtod(text, NULL);
  c_locale_leave(locale);
  return value;
}

msri_number_fault msri_number_parse(const char *text, size_t size, double *value) {
  char copy[LONGEST + 1];
  if (size == 0) return MSRI_NUMBER_EMPTY;
  if (!is_decimal(text, size, '.')) return diagnose(text, size);
  if (size > LONGEST) return MSRI_NUMBER_LONG;
  memcpy(copy, text, size);
  copy[size] = '\0';
  const double number = c_strtod(copy);
  if (isinf(number)) return MSRI_NUMBER_LARGE;
  *value = number;
  return MSRI_NUMBER_OK;
}

msri_number_fault msri_number_parse_count(const char *text, size_t size, uint64_t *value) {
  if (size == 0) return MSRI_NUMBER_EMPTY;
  if (digits(text, size) != size) return MSRI_NUMBER_WHOLE;
  uint64_t count = 0;
  for (size_t i = 0; i < size; i++) {
    const uint64_t digit = (uint64_t)(text[i] - '0');
    if (count > (UINT64_MAX - digit) / 10) return MSRI_NUMBER_LARGE;
    count = count * 10 + digit;
  }
  *value = count;
  return MSRI_NUMBER_OK;
}

const char *msri_number_write(double value, char text[MSRI_NUMBER_SIZE]) {
  // 15 digits are always a double's own, 17 always suffice.
  for (int precision = 15; precision <= 17; precision++) {
    msri_format(text, MSRI_NUMBER_SIZE, "%.*g", precision, value);
    if (!(c_strtod(text) < value || c_strtod(text) > value)) break;
  }
  return text;
}

int msri_vformat(char *text, size_t size, const char *format, va_list arguments) {
  const c_locale locale = c_locale_enter();
  const int length = vsnprintf(text, size, format, arguments);
  c_locale_leave(locale);
  return length;
}

int msri_format(char *text, size_t size, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  const int length = msri_vformat(text, size, format, arguments);
  va_end(arguments);
  return length;
}

int msri_vprint(FILE *stream, const char *format, va_list arguments) {
  const c_locale locale = c_locale_enter();
  const int length = vfprintf(stream, format, arguments);
  c_locale_leave(locale);
  return length;
}

int msri_print(FILE *stream, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  const int length = msri_vprint(stream, format, arguments);
  va_end(arguments);
  return length;
}
