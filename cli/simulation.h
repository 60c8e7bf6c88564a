/* simulation.h - from settings to a scene, and to a plan. */
#ifndef CLI_SIMULATION_H
#define CLI_SIMULATION_H

#include "options.h"

/* Loads the scene and adds what the options ask for; tells warnings to the user. MSR_EUSAGE,
 * MSR_EINPUT (an input that can't be read, too), MSR_ENOMEM. */
msr_status simulation_scene(const settings *s, msr_scene **scene, msr_error *err);

/* The same, compiled. */
msr_status simulation_plan(const settings *s, msr_plan **plan, msr_error *err);

/* The style of the frames that the settings ask for. */
msr_style simulation_style(const settings *s);

/* Is there anything to hit? */
bool simulation_contacts(const msr_plan *plan);

#endif
