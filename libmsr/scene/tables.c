/* tables.c - the built-in forces and integrators: a new one is a row here. */
#include "base/base.h"

const msr_force *const msr_forces[] = {
    &msr_force_springs,
    &msr_force_gravity,
    &msr_force_damping,
    &msr_force_drag,
    &msr_force_wind,
    &msr_force_push,
    NULL,
};

const msr_integrator *const msr_integrators[] = {
    &msr_integrator_euler,
    &msr_integrator_symplectic_euler,
    &msr_integrator_verlet,
    &msr_integrator_pefrl,
    &msr_integrator_srkn4,
    &msr_integrator_srkn6,
    &msr_integrator_kahan_li_6,
    &msr_integrator_kahan_li_8,
    &msr_integrator_rk4,
    &msr_integrator_rkf45,
    &msr_integrator_rkck,
    &msr_integrator_rk8pd,
    &msr_integrator_msadams,
    &msr_integrator_backward_euler,
    &msr_integrator_implicit_midpoint,
    &msr_integrator_sdirk2,
    &msr_integrator_energy_momentum,
    NULL,
};
