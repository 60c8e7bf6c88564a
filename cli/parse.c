/* parse.c - the command line into settings: one pass over the words, whose order is free. Options
 * are `--name value`, `--name=value`, `-o value` and `-ovalue`; flags of one letter may share
 * a dash; after `--` all words are operands. The first operand may be a command. */
#include "parse.h"

#include "commands.h"
#include "guess.h"
#include "report.h"
#include "values.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct parser {
  char **next; /* words still to read; ends with NULL */
  settings *s;
  msr_error *err;
  bool literal; /* `--` was seen */
} parser;

static msr_status unknown_option(msr_error *err, const char *word) {
  char name[64];
  const int length = (int)strcspn(word, "=");
  const int dashes = (int)strspn(word, "-");
  snprintf(name, sizeof name, "%.*s", length - dashes, word + dashes);
  guess g = {.word = name};
  for (const option *o = all_options; o->help; o++) {
    if (o->name) guess_consider(&g, o->name);
  }
  return fail(err, MSR_EUSAGE, "unknown option '%.*s'%s%s%s", length, word,
              g.best ? "; did you mean '--" : "", g.best ? g.best : "", g.best ? "'?" : "");
}

static msr_status bad_value(msr_error *err, const option *o, const char *value) {
  const char *const near = o->kind->nearest ? o->kind->nearest(value) : NULL;
  return fail(err, MSR_EUSAGE, "%s takes %s, not '%s'%s%s%s", option_spelling(o).text,
              o->kind->wants, value, near ? "; did you mean '" : "", near ? near : "",
              near ? "'?" : "");
}

static msr_status set(parser *p, const option *o, const char *value) {
  const bool repeatable = !o->argument || o->kind == &a_push;
  if ((p->s->given & option_bit(o)) && !repeatable) {
    return fail(p->err, MSR_EUSAGE, "%s is given twice; keep one", option_spelling(o).text);
  }
  p->s->given |= option_bit(o);
  p->s->typed[p->s->n_typed++] = (typed){o, value};
  if (o->kind->read(o->kind, value, (char *)p->s + o->field)) return MSR_OK;
  return bad_value(p->err, o, value);
}

/* The value is the next word, whatever it looks like (-20, -), unless that is an option. */
static msr_status set_from_next(parser *p, const option *o) {
  const char *const value = *p->next;
  if (!value || option_find(value)) {
    return fail(p->err, MSR_EUSAGE, "%s needs a value: %s", option_spelling(o).text,
                o->kind->wants);
  }
  p->next++;
  return set(p, o, value);
}

static msr_status read_name(parser *p, const char *word) {
  const option *const o = option_find(word);
  const char *const equals = strchr(word, '=');
  if (!o) return unknown_option(p->err, word);
  if (!o->argument && equals) {
    return fail(p->err, MSR_EUSAGE, "%s takes no value", option_spelling(o).text);
  }
  if (!o->argument) return set(p, o, "");
  return equals ? set(p, o, equals + 1) : set_from_next(p, o);
}

static msr_status read_letters(parser *p, const char *word) {
  msr_status status = MSR_OK;
  for (const char *at = word + 1; *at && status == MSR_OK; at++) {
    const option *const o = option_find((char[]){'-', *at, '\0'});
    if (!o) return unknown_option(p->err, word);
    if (o->argument) return at[1] ? set(p, o, at + 1) : set_from_next(p, o);
    status = set(p, o, "");
  }
  return status;
}

static void read_operand(parser *p, const char *word) {
  settings *s = p->s;
  const bool first = !s->named && !p->literal && s->n_files == 0;
  const command *const named = first ? command_find(word) : NULL;
  if (named) {
    s->command = named;
    s->named = true;
  } else if (s->n_files < sizeof s->file / sizeof s->file[0]) {
    s->file[s->n_files++] = word;
  }
}

static msr_status read_word(parser *p, const char *word) {
  const bool dashed = !p->literal && word[0] == '-' && word[1] != '\0';
  if (dashed && strcmp(word, "--") != 0) {
    return word[1] == '-' ? read_name(p, word) : read_letters(p, word);
  }
  p->literal |= dashed;
  if (!dashed) read_operand(p, word);
  return MSR_OK;
}

/* Room for as many as there are words; flags of one letter may be as many as letters. */
static msr_status make_room(int argc, char **argv, settings *s, msr_error *err) {
  size_t letters = 0;
  for (int i = 0; i < argc; i++) letters += strlen(argv[i]);
  s->pushes = calloc((size_t)argc + 1, sizeof *s->pushes);
  s->typed = calloc(letters + 1, sizeof *s->typed);
  if (s->pushes && s->typed) return MSR_OK;
  return fail(err, MSR_ENOMEM, "out of memory for the command line");
}

msr_status settings_parse(int argc, char **argv, settings *s, msr_error *err) {
  *s = (settings){.command = commands, .output = "frames", .gust = -1, .program = argv[0]};
  s->gust_time = s->restitution = s->diameter = 1;
  s->neighbours = 4;
  s->seed = s->scale = 1;
  s->atol = 1e-6;
  parser p = {.next = argv + (argc > 0), .s = s, .err = err};
  msr_status status = make_room(argc, argv, s, err);
  while (*p.next && status == MSR_OK) status = read_word(&p, *p.next++);
  if (!option_given(s, "--gust")) s->gust = fabs(s->wind) / 2;
  return status;
}

void settings_free(settings *s) {
  free(s->pushes);
  free(s->typed);
}
