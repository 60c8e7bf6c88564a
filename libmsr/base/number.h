/* number.h - numbers to and from text in the C locale, whatever the program's locale is, so that
 * a file means the same to everyone. */
#ifndef MSRI_NUMBER_H
#define MSRI_NUMBER_H

#include "base/base.h"

#include <stdarg.h>
#include <stdio.h>

/* Why a text is no number: each completes "'0,005' ". */
#define MSRI_NUMBER_FAULTS(X)                                                                      \
  X(MSRI_NUMBER_OK, "is a number")                                                                 \
  X(MSRI_NUMBER_EMPTY, "is empty; write a number")                                                 \
  X(MSRI_NUMBER_COMMA, "has a decimal comma; write a decimal point")                               \
  X(MSRI_NUMBER_HEX, "is hexadecimal; write it in decimal")                                        \
  X(MSRI_NUMBER_INFINITE, "is not finite; write a finite number")                                  \
  X(MSRI_NUMBER_JUNK, "is not a number; write one such as 0.005 or 5e-3")                          \
  X(MSRI_NUMBER_LARGE, "is too large; write a smaller number")                                     \
  X(MSRI_NUMBER_LONG, "is too long; write fewer digits")                                           \
  X(MSRI_NUMBER_WHOLE, "is no count; write a whole number in digits only, such as 20000")

#define MSRI_NUMBER_NAME(name, text) name,
typedef enum msri_number_fault { MSRI_NUMBER_FAULTS(MSRI_NUMBER_NAME) } msri_number_fault;
#undef MSRI_NUMBER_NAME

const char *msri_number_fault_text(msri_number_fault fault);

/* A decimal number: sign, digits with at most one point, exponent; nothing before or after. What
 * is too small for a double becomes the nearest one, 0 at worst. `value` is set on success only. */
msri_number_fault msri_number_parse(const char *text, size_t size, double *value);

/* A whole number from 0 to 2^64 - 1: digits only. `value` is set on success only. */
msri_number_fault msri_number_parse_count(const char *text, size_t size, uint64_t *value);

enum { MSRI_NUMBER_SIZE = 32 };

/* Writes the shortest text that reads back as `value`, and returns it. */
const char *msri_number_write(double value, char text[MSRI_NUMBER_SIZE]);

/* snprintf and fprintf, and their v-forms, in the C locale. */
int msri_format(char *text, size_t size, const char *format, ...) MSRI_PRINTF(3, 4);
int msri_vformat(char *text, size_t size, const char *format, va_list arguments) MSRI_PRINTF(3, 0);
int msri_print(FILE *stream, const char *format, ...) MSRI_PRINTF(2, 3);
int msri_vprint(FILE *stream, const char *format, va_list arguments) MSRI_PRINTF(2, 0);

#endif
