/* commands.h - what msr can do: one row per command. */
#ifndef CLI_COMMANDS_H
#define CLI_COMMANDS_H

#include "options.h"

/* Where an option applies: a set of commands. OF_SCENE: it says what is simulated, whatever is done
 * with it. */
enum {
  FOR_RUN = 1,
  FOR_PLAN = 2,
  FOR_ACCURACY = 4,
  FOR_LIST = 8,
  OF_SCENE = 16,
  FOR_RUNS = FOR_RUN | FOR_PLAN,
  FOR_SCENES = FOR_RUNS | FOR_ACCURACY | OF_SCENE,
  FOR_ALL = FOR_RUNS | FOR_ACCURACY | FOR_LIST
};

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
msr_status accuracy_command(const settings *s, msr_error *err);
msr_status list_command(const settings *s, msr_error *err);

#endif
