/* duel.c - two unrelated methods, side by side, as far as they agree. The largest difference of the
 * two over all masses is the error of either; were they related, it might be less. */
#include "accuracy/duel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double atol_ratio = 100;

typedef struct duel {
  msri_setting *setting;
  msri_reference *made;
  msri_trial truth, witness;
  double parted;
} duel;

static msr_status options_of(const msri_setting *setting, const msri_entrant *e, int level,
                             msr_plan_options *options, msr_error *err) {
  uint64_t fewest;
  const msr_status status = msri_setting_fewest(setting, e->integrator, false, &fewest, err);
  if (status != MSR_OK) return status;
  if (fewest == 0)
    return msri_fail(err, MSR_EUNSTABLE, "%s has no stable step here", e->integrator->name);
  const double substeps = ceil((double)fewest * e->fineness * pow(2, level));
  *options =
      msri_setting_options(setting, e->integrator, e->integrator->adaptive ? 1 : (uint64_t)substeps,
                           e->atol * pow(atol_ratio, -level));
  return MSR_OK;
}

/* Largest distance of a mass between the two; no number if one isn't. */
static double distance(const msr_state *a, const msr_state *b) {
  const size_t n = a->plan->figures.masses;
  double most = 0;
  for (size_t i = 0; i < n; i++)
    most = msri_worse(hypot(a->q[i] - b->q[i], a->q[n + i] - b->q[n + i]), most);
  return most;
}

/* Do they agree? Then the instant is added. */
static bool record(const duel *d) {
  msri_reference *r = d->made;
  const msr_state *truth = d->truth.state;
  const size_t n = 2 * d->setting->masses;
  const double gap = distance(truth, d->witness.state);
  if (!(gap <= d->parted)) return false;
  memcpy(r->q + r->n * n, truth->q, n * sizeof *r->q);
  r->energy[r->n] = msri_state_energies(truth).total;
  r->gap[r->n] = r->n > 0 ? msri_max(gap, r->gap[r->n - 1]) : gap;
  r->n++;
  return true;
}

static msr_status advance(duel *d, uint64_t iteration, msr_error *err) {
  const msr_status status = msri_trial_step(d->setting, &d->truth, iteration, err);
  return status == MSR_OK ? msri_trial_step(d->setting, &d->witness, iteration, err) : status;
}

/* Being stopped, or unstable, ends it where they are. */
static msr_status fight(duel *d, msr_error *err) {
  msr_status status = MSR_OK;
  for (size_t i = 0; i < d->setting->n && status == MSR_OK; i++) {
    status = advance(d, d->setting->iteration[i], err);
    if (status == MSR_OK && !record(d)) {
      d->made->parted = true;
      break;
    }
  }
  d->made->cost = msri_trial_cost(d->truth.state) + msri_trial_cost(d->witness.state);
  if (d->setting->watch.over) return MSR_OK;
  d->made->parted |= status == MSR_EUNSTABLE;
  return status == MSR_EUNSTABLE ? MSR_OK : status;
}

static msr_status reserve(const msri_setting *setting, msri_reference *r, msr_error *err) {
  const size_t n = setting->n;
  r->q = msri_alloc(n, 2 * setting->masses * sizeof *r->q, "the reference", err);
  r->energy = msri_alloc(n, sizeof *r->energy, "the reference", err);
  r->gap = msri_alloc(n, sizeof *r->gap, "the reference", err);
  return r->q && r->energy && r->gap ? MSR_OK : MSR_ENOMEM;
}

msr_status msri_duel(msri_setting *setting, const msri_rivals *pair, int level, double parted,
                     msri_reference *reference, msr_error *err) {
  duel d = {.setting = setting, .made = reference, .parted = parted};
  *reference = (msri_reference){0};
  msr_status status = options_of(setting, &pair->truth, level, &reference->truth, err);
  if (status == MSR_OK)
    status = options_of(setting, &pair->witness, level, &reference->witness, err);
  if (status == MSR_OK) status = reserve(setting, reference, err);
  if (status == MSR_OK) status = msri_trial_open(setting, &reference->truth, &d.truth, err);
  if (status == MSR_OK) status = msri_trial_open(setting, &reference->witness, &d.witness, err);
  if (status == MSR_OK) status = fight(&d, err);
  msri_trial_close(setting, &d.truth);
  msri_trial_close(setting, &d.witness);
  if (status != MSR_OK) msri_reference_clear(reference);
  return status;
}
