/* scene.h - the work as libmsr takes it, for all tables that measure libmsr. */
#ifndef SPEED_SCENE_H
#define SPEED_SCENE_H

#include "speed.h"

#include "msr.h"

/* Ends the program with the reason, which calls of libmsr put here. */
void must(msr_status status);
msr_error *reason(void);

/* Verlet, one step per DT. */
msr_plan_options verlet_with(int threads);

/* The work at t = 0. With `images` above 1 as many iterations. The plan is the caller's, too. */
msr_state *state_of(const work *w, double dt, uint64_t images, const msr_plan_options *options,
                    msr_plan **plan);

#endif
