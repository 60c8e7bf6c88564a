/* simulation.h - from settings to a plan: what run and plan have in common. */
#ifndef CLI_SIMULATION_H
#define CLI_SIMULATION_H

#include "options.h"

/* Loads the scene, adds what the options ask for and compiles it; tells warnings to the user.
 * Nothing is written. MSR_EUSAGE, MSR_EINPUT (an input that can't be read, too), MSR_ENOMEM. */
msr_status simulation_plan(const settings *s, msr_plan **plan, msr_error *err);

/* The style of the frames that the settings ask for. */
msr_style simulation_style(const settings *s);

/* A line per effect: on or off, and why. */
void simulation_print_effects(FILE *out, const msr_plan *plan);

#endif
