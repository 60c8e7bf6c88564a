/* setting.h - what all runs of a study share: the scene, the instants at which runs are compared.
 */
#ifndef MSRI_SETTING_H
#define MSRI_SETTING_H

#include "accuracy/instants.h"
#include "accuracy/watch.h"

typedef struct msri_setting {
  const msr_scene *scene;
  msri_watch watch;
  msr_plan *plan; /* of no run: for figures, and to draw the reference */
  size_t masses;
  double until;                  /* asked for [s] */
  double far;                    /* an error as large as the picture, or as what it holds [px] */
  const msr_integrator **method; /* [n_methods] asked for, none twice */
  size_t n_methods;
  bool contacts;       /* something may be in the way */
  bool damped;         /* a force depends on velocity */
  size_t n;            /* instants */
  double cost;         /* of all runs so far */
  uint64_t *iteration; /* [n] rising, from 1 on: the last one is the end of what is asked for */
} msri_setting;

/* What is for a study, or for a choice. */
typedef struct msri_setting_defaults {
  double budget;   /* [s] */
  uint64_t fewest; /* instants: fewer frames have others between them */
  double ratio;    /* of early instants; 0: any */
} msri_setting_defaults;

/* MSR_EUSAGE, MSR_EINPUT, MSR_ENOMEM, and as msr_plan_create. */
msr_status msri_setting_open(msri_setting *setting, const msr_scene *scene,
                             const msr_accuracy_options *options,
                             const msri_setting_defaults *defaults, msr_error *err);
void msri_setting_close(msri_setting *setting);

/* Options of a run's plan; an adaptive method ignores what a fixed step needs, and the other way
 * round. */
msr_plan_options msri_setting_options(const msri_setting *setting, const msr_integrator *integrator,
                                      uint64_t substeps, double atol);

/* The scene's time at an instant [s]. */
double msri_setting_time(const msri_setting *setting, size_t instant);

/* The fewest substeps that are stable at any stretch or, `safe`, ever so long; 0: too many. As
 * msr_plan_create. */
msr_status msri_setting_fewest(const msri_setting *setting, const msr_integrator *integrator,
                               bool safe, uint64_t *substeps, msr_error *err);

/* Order of a method here. */
int msri_setting_order(const msri_setting *setting, const msr_integrator *integrator);

/* How long a run of a cost (msri_trial_cost) takes on a common machine [s]: for plans that don't
 * depend on this one. */
double msri_setting_seconds(const msri_setting *setting, double cost);

/* Verlet's largest stable steps up to an iteration. */
double msri_setting_verlet(const msri_setting *setting, uint64_t iteration);

/* Hash of all that the scene holds: masses, springs, forces, supports, times. */
uint64_t msri_scene_hash(const msr_scene *scene);

#endif
