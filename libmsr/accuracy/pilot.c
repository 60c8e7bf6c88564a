/* pilot.c - every method aims at the error; the one whose next run promises to be the cheapest is
 * always the next, until none can be cheaper than the best that was as accurate as wanted. */
#include "accuracy/pilot.h"

#include <math.h>

static const double most_of_it = 0.8; /* of the time up to where the references part */

static msr_status begin_aims(msri_pilot *pilot, msr_error *err) {
  const uint64_t iterations = pilot->setting.iteration[pilot->reference.n - 1];
  const bool careful = pilot->reference.n < pilot->all;
  const bool given = pilot->setting.watch.options->n_integrators != 0;
  const size_t n = pilot->setting.n_methods;
  msr_status status = MSR_OK;
  pilot->aim = msri_alloc(n, sizeof *pilot->aim, "the methods", err);
  if (!pilot->aim) return MSR_ENOMEM;
  for (size_t i = 0; i < n && status == MSR_OK; i++)
    status = msri_aim_begin(&pilot->setting, pilot->setting.method[i], iterations, careful,
                            pilot->wanted, &pilot->aim[i], err);
  /* Beyond what was tried a method of order 1 may heat, above all at supports. */
  for (size_t i = 0; i < n && careful && !given; i++)
    pilot->aim[i].done |= msri_setting_order(&pilot->setting, pilot->setting.method[i]) < 2;
  return status;
}

/* The aim whose next run is the shortest, if it is shorter than the best. */
static msri_aim *shortest(msri_pilot *pilot) {
  msri_aim *least = NULL;
  double most = pilot->best.point.integrator ? pilot->best.cost : HUGE_VAL;
  for (size_t i = 0; i < pilot->setting.n_methods; i++) {
    if (pilot->aim[i].done || !(pilot->aim[i].cost < most)) continue;
    least = &pilot->aim[i];
    most = least->cost;
  }
  return least;
}

/* As accurate as wanted up to the horizon; or, where the two references part, for most of the time
 * up to there: in chaos the last bit of it would cost as much again and again. */
static bool is_good(const msri_pilot *pilot, const msri_measured *m) {
  const uint64_t *iteration = pilot->setting.iteration;
  if (m->good == pilot->reference.n) return true;
  if (m->good == 0 || !pilot->reference.parted || !m->sound) return false;
  return (double)iteration[m->good - 1] >= most_of_it * (double)iteration[pilot->reference.n - 1];
}

static msr_status try(msri_pilot *pilot, msri_aim *aim, msr_error *err) {
  const bool any = pilot->best.point.integrator != NULL;
  const msri_limits limits = {msri_min(100 * pilot->error, pilot->setting.far), pilot->wanted,
                              any ? pilot->best.cost : HUGE_VAL};
  const msr_plan_options options = msri_aim_options(&pilot->setting, aim);
  msri_measured m;
  msri_watch_next(&pilot->setting.watch, 1, "choosing: %s", aim->integrator->name);
  const msr_status status =
      msri_measure(&pilot->setting, &pilot->reference, NULL, &options, &limits, &m, err);
  if (m.good > pilot->longest.good) pilot->longest = m;
  if (pilot->setting.watch.over) return MSR_OK;
  aim->done = status == MSR_EUSAGE;
  if (status != MSR_OK) return aim->done ? MSR_OK : status;
  const bool good = is_good(pilot, &m);
  m.cost /= msri_max(m.share, 1e-9);
  if (good && (!any || m.cost < pilot->best.cost)) pilot->best = m;
  msri_aim_next(aim, &m, pilot->wanted, good);
  return MSR_OK;
}

msr_status msri_pilot_run(msri_pilot *pilot, msr_error *err) {
  msr_status status = pilot->aim ? MSR_OK : begin_aims(pilot, err);
  if (status != MSR_OK) return status;
  for (msri_aim *next = shortest(pilot); next && status == MSR_OK; next = shortest(pilot)) {
    status = try(pilot, next, err);
    if (pilot->setting.watch.over) break;
  }
  return status;
}
