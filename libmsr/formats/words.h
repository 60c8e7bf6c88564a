/* words.h - the words of a text file: what stands between blanks, comments apart. */
#ifndef MSRI_WORDS_H
#define MSRI_WORDS_H

#include "formats/source.h"

/* A file being read word by word. */
typedef struct msri_words {
  msri_source source;
  size_t at; /* next byte */
  msr_error *err;
} msri_words;

/* Size 0: the end of the file. */
typedef struct msri_word {
  const char *text; /* [size], in the source */
  size_t at, size;
  bool new_line; /* it's the first one of its line */
} msri_word;

/* The next word; # begins a comment, which goes on to the end of the line. */
msri_word msri_words_next(msri_words *words);

bool msri_word_is(msri_word word, const char *name);

/* Insertions, deletions and changes of a byte that make `name` (of 15 at most) of the word,
 * capitals ignored (Levenshtein 1966). */
size_t msri_word_distance(msri_word word, const char *name);

#endif
