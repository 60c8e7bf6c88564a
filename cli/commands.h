/* commands.h - what msr can do: one row per command. */
#ifndef CLI_COMMANDS_H
#define CLI_COMMANDS_H

#include "options.h"

/* Where an option applies: a set of commands. */
enum { FOR_RUN = 1, FOR_PLAN = 2, FOR_LIST = 4, FOR_SCENES = FOR_RUN | FOR_PLAN, FOR_ALL = 7 };

typedef struct command {
  const char *name;
  const char *usage;   /* its operands */
  const char *summary; /* one line */
  unsigned bit;        /* FOR_... */
  size_t files;        /* operands that it takes */
  msr_status (*run)(const settings *s, msr_error *err);
} command;

/* The first is what msr does when none is named; the last has no name. */
extern const command commands[];

/* NULL: there is none. */
const command *command_find(const char *name);

msr_status run_command(const settings *s, msr_error *err);
msr_status plan_command(const settings *s, msr_error *err);
msr_status list_command(const settings *s, msr_error *err);

#endif
