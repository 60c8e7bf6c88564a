/* words.c - the words of a text file. */
#include "formats/words.h"

#include <string.h>

enum { LONGEST_NAME = 15 };

static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

msri_word msri_words_next(msri_words *words) {
  const char *text = (const char *)words->source.bytes;
  const size_t end = words->source.size;
  bool new_line = words->at == 0, comment = false;
  size_t at = words->at;
  for (; at < end; at++) {
    if (text[at] == '\n') new_line = true;
    comment = text[at] == '#' || (comment && text[at] != '\n');
    if (!comment && !is_blank(text[at])) break;
  }
  const size_t start = at;
  while (at < end && !is_blank(text[at]) && text[at] != '#') at++;
  words->at = at;
  return (msri_word){text + start, start, at - start, new_line};
}

bool msri_word_is(msri_word word, const char *name) {
  return word.size == strlen(name) && memcmp(word.text, name, word.size) == 0;
}

size_t msri_word_distance(msri_word word, const char *name) {
  size_t row[LONGEST_NAME + 1]; // from the bytes of the word so far to j bytes of the name
  const size_t n = strlen(name);
  for (size_t j = 0; j <= n; j++) row[j] = j;
  for (size_t i = 0; i < word.size; i++) {
    size_t diagonal = row[0]++;
    for (size_t j = 0; j < n; j++) {
      const size_t changed = diagonal + ((word.text[i] | 0x20) != (name[j] | 0x20));
      diagonal = row[j + 1];
      row[j + 1] = (row[j] < diagonal ? row[j] : diagonal) + 1;
      if (changed < row[j + 1]) row[j + 1] = changed;
    }
  }
  return row[n];
}
