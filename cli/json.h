/* json.h - writes JSON (RFC 8259): commas, indentation, escapes. Names and values alternate within
 * an object; `name` is NULL within an array. */
#ifndef CLI_JSON_H
#define CLI_JSON_H

#include "options.h"

/* All but out starts at zero. */
typedef struct json {
  FILE *out;
  int depth;
  bool more; /* a value came before, in the same object or array */
} json;

/* `bracket` is { or [; close ends with its counterpart. */
void json_open(json *j, const char *name, char bracket);
void json_close(json *j, char bracket);

/* NULL is null. Bytes that aren't UTF-8 become U+FFFD. */
void json_text(json *j, const char *name, const char *text);

/* As few digits as give the same number back; what isn't finite is null. */
void json_number(json *j, const char *name, double value);

void json_count(json *j, const char *name, uint64_t value);
void json_bool(json *j, const char *name, bool value);

#endif
