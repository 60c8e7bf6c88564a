/* command_line.c - command lines to type, with quotes where a shell needs them. */
#include "command_line.h"

#include "commands.h"
#include "texts.h"

#include <string.h>

static const char plain[] =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789@%+=:,./_-";

/* In single quotes nothing is special but they themselves, which are left for a moment: '\''. A
 * newline is written in words: one command, one line. */
static void print_word(FILE *out, const char *word) {
  if (*word && word[strspn(word, plain)] == '\0') {
    fputs(word, out);
    return;
  }
  fputc('\'', out);
  for (; *word; word++) {
    if (*word == '\'') fputs("'\\'", out);
    if (*word == '\n') fputs("'$'\\n''", out);
    if (*word != '\n') fputc(*word, out);
  }
  fputc('\'', out);
}

/* A name that could be taken for an option or a command is that of a file here. */
static void print_file(FILE *out, const char *file) {
  fputs(*file == '-' || command_find(file) ? " ./" : " ", out);
  print_word(out, file);
}

static void print_option(FILE *out, const typed *t) {
  fprintf(out, " %s", option_spelling(t->option).text);
  if (!t->option->argument) return;
  fputc(' ', out);
  print_word(out, t->value);
}

static void print_files(FILE *out, const settings *s) {
  for (size_t i = 0; i < s->n_files; i++) print_file(out, s->file[i]);
}

void command_line_print(FILE *out, const settings *s) {
  print_word(out, s->program);
  fprintf(out, " %s", s->command->name);
  print_files(out, s);
  for (size_t i = 0; i < s->n_typed; i++) print_option(out, &s->typed[i]);
}

void command_line_print_run(FILE *out, const settings *s, const msr_plan_options *options) {
  print_word(out, s->program);
  print_files(out, s);
  for (size_t i = 0; i < s->n_typed; i++) {
    if (s->typed[i].option->commands & OF_SCENE) print_option(out, &s->typed[i]);
  }
  fputs(method_options(options).text, out);
}
