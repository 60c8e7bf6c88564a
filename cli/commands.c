/* commands.c - the table of commands. */
#include "commands.h"

#include <string.h>

const command commands[] = {
    {"run", "SCENE.ppm SCENE.conf [options]", "write the frames; the default command", FOR_RUN, 2,
     run_command},
    {"plan", "SCENE.ppm SCENE.conf [options]", "what would be simulated, and why", FOR_PLAN, 2,
     plan_command},
    {"accuracy", "SCENE.ppm SCENE.conf [options]", "what accuracy costs in time", FOR_ACCURACY, 2,
     accuracy_command},
    {"list", "", "integrators, forces, their properties", FOR_LIST, 0, list_command},
    {NULL, NULL, NULL, 0, 0, NULL},
};

const command *command_find(const char *name) {
  for (const command *c = commands; c->name; c++) {
    if (strcmp(c->name, name) == 0) return c;
  }
  return NULL;
}
