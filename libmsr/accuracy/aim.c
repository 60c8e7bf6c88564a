/* aim.c - one method aims at an error.
 *
 * The next fineness is r (error / wanted)^(1/order), with the order as declared or, from the second
 * run on, as measured. Between a run that failed and one that passed the middle is tried, while
 * the difference in work is worth it. */
#include "accuracy/aim.h"

#include "accuracy/ladder.h"

#include <math.h>

/* What is aimed at is a little less than what is wanted. */
static const double margin = 0.7;

/* A cost smaller by so much is worth another run. */
static const double worth = 0.8;

enum { MOST_TRIES = 12 };

msr_status msri_aim_begin(const msri_setting *setting, const msr_integrator *integrator,
                          uint64_t iterations, bool careful, double wanted, msri_aim *aim,
                          msr_error *err) {
  uint64_t substeps;
  const msr_status status = msri_setting_fewest(setting, integrator, careful, &substeps, err);
  if (status != MSR_OK) return status;
  const bool adaptive = integrator->adaptive;
  const double coarsest = adaptive ? 1 / MSRI_COARSEST_ATOL : careful ? (double)substeps : 1;
  const double first = adaptive ? msri_max(coarsest, 1 / wanted) : (double)substeps;
  const double order = msri_setting_order(setting, integrator);
  *aim = (msri_aim){
      .integrator = integrator,
      .order = adaptive ? 1 : order,
      .growth = adaptive ? 1 / order : 1,
      .coarsest = coarsest,
      .r = first,
      .done = substeps == 0,
      .cost = msri_trial_foretell(setting, integrator, iterations, substeps),
  };
  return MSR_OK;
}

msr_plan_options msri_aim_options(const msri_setting *setting, const msri_aim *aim) {
  if (aim->integrator->adaptive) return msri_ladder_tolerance(setting, aim->integrator, 1 / aim->r);
  return msri_setting_options(setting, aim->integrator, (uint64_t)aim->r, 0);
}

/* Error at the horizon; of a run that was ended, as if it grew with t^1.5 from there on. */
static double final_error(const msri_measured *m) {
  return m->share > 0 ? m->error * pow(m->share, -1.5) : (double)INFINITY;
}

/* Between this run and the one before. */
static double measured_order(const msri_aim *aim, double error) {
  const double e = aim->last_error, least = aim->order / 2, most = 2 * aim->order;
  if (!(aim->last_r > 0 && e > 0 && error > 0) || !isfinite(e) || !isfinite(error))
    return aim->order;
  const double order = log(e / error) / log(aim->r / aim->last_r);
  return msri_max(least, msri_min(order, most));
}

/* Fineness that should be just enough. */
static double foretell(const msri_aim *aim, double error, double wanted) {
  if (!isfinite(error)) return 2 * aim->r;
  const double most = pow(100, 1 / aim->growth);
  const double times = pow(error / (margin * wanted), 1 / measured_order(aim, error));
  return aim->r * msri_max(1 / most, msri_min(times, most));
}

/* Strictly between what failed and what passed. */
static double bracket(const msri_aim *aim, double r) {
  r = msri_max(r, aim->coarsest);
  const bool below = r <= aim->failed, above = aim->passed > 0 && r >= aim->passed;
  if (below && aim->passed > 0) r = sqrt(aim->failed * aim->passed);
  if (below && !(aim->passed > 0)) r = 1.1 * aim->failed;
  if (above && aim->failed > 0) r = sqrt(aim->failed * aim->passed);
  return aim->integrator->adaptive ? r : ceil(r);
}

static bool worthwhile(const msri_aim *aim, double r) {
  const double finest = aim->integrator->adaptive ? 1 / MSRI_FINEST_ATOL : MSRI_MOST_SUBSTEPS;
  if (r > finest || aim->tries >= MOST_TRIES || r <= aim->failed) return false;
  return !(aim->passed > 0) || pow(r / aim->passed, aim->growth) <= worth;
}

void msri_aim_next(msri_aim *aim, const msri_measured *m, double wanted, bool good) {
  const double error = final_error(m);
  if (good)
    aim->passed = aim->r;
  else
    aim->failed = aim->r;
  const double r = bracket(aim, foretell(aim, error, wanted));
  aim->tries++;
  aim->done = !worthwhile(aim, r);
  aim->cost = m->cost * pow(r / aim->r, aim->growth);
  aim->last_r = aim->r;
  aim->last_error = error;
  aim->r = r;
}
