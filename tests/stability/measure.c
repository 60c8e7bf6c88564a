/* measure.c - runs a case and judges it.
 *
 * Energies are over what the scene had to give: kinetic and spring energy at the start, what the
 * other potentials have lost at most, and one kick of 2 h g, which a mass that rests on a support
 * swings by. What a state goes back from is no part of its run. Where wind blows, the growth is
 * what the library's guard saw; its own bound of the wind's work is tested in test_guard.c. */
#include "walls.h"

#include <time.h>

/* A run under way. */
typedef struct trial {
  const hard_case *row;
  bool brief;
  world w;
  walls walls;
  double first, outer, given; /* energies: total and of outer potentials at the start; to give */
  double halfway;             /* the most kinetic energy since the middle */
  outcome o;
} trial;

static msr_status open_world_of(const hard_case *row, msr_scene *scene, world *w) {
  const msr_status status = msr_plan_create(scene, &row->plan, &w->plan, &why);
  msr_scene_free(scene);
  return status == MSR_OK ? msr_state_create(w->plan, &w->state, &why) : status;
}

/* ---- Measuring */

static double of_outer(const msr_energy *e) { return e->total - e->kinetic - e->spring; }

static void begin(trial *t) {
  const msr_view s = msr_state_view(t->w.state);
  const msr_energy e = msr_state_energy(t->w.state);
  const msr_plan_figures f = msr_plan_describe(t->w.plan);
  double kick = 0;
  for (size_t i = 0; i < s.n; i++)
    kick += 2 * msr_view_mass(&s, i) * pow(f.h * t->row->conf.gravity, 2);
  t->first = e.total;
  t->outer = of_outer(&e);
  const double rounding = DBL_EPSILON * (double)s.n * fabs(e.total);
  t->given = e.kinetic + (t->row->from_rest ? 0 : e.spring) + kick + rounding;
  t->o.substeps = f.substeps;
}

static uint64_t count_not_finite(const msr_view *s) {
  uint64_t n = 0;
  for (size_t i = 0; i < s->n; i++)
    n += (uint64_t)(!isfinite(s->x[i]) + !isfinite(s->y[i]) + !isfinite(s->vx[i]) +
                    !isfinite(s->vy[i]));
  return n;
}

static double over(double energy, double given) {
  return energy == 0 ? 0 : given > 0 ? energy / given : INFINITE;
}

static bool blows(const hard_case *row) { return row->wind != 0 || row->gust > 0; }

static void look(trial *t, bool late) {
  const msr_view s = msr_state_view(t->w.state);
  const msr_energy e = msr_state_energy(t->w.state);
  const double lost = t->outer - of_outer(&e);
  const double given = t->row->of_total ? t->first : t->given + fmax(0, lost);
  const double change = over(e.total - t->first, given);
  t->o.not_finite = count_not_finite(&s);
  t->o.penetration = fmax(t->o.penetration, deepest(&t->walls, &s));
  if (late) t->o.rest = fmax(t->o.rest, over(e.kinetic, given));
  if (blows(t->row))
    t->o.growth = msr_state_energy_gain(t->w.state);
  else
    t->o.growth = isnan(change) ? INFINITE : fmax(t->o.growth, change);
  if (change < 0) t->o.loss = fmax(t->o.loss, -change);
}

/* What did it go by? Told at the end. */
static void name_methods(trial *t) {
  const msr_work work = msr_state_work(t->w.state);
  msri_format(t->o.integrator, sizeof t->o.integrator, "%s%s%s",
              msr_plan_describe(t->w.plan).integrator->name,
              msr_plan_describe(t->w.plan).leaps && work.leaps > 0 ? "+leaps" : "",
              work.careful == UINT64_MAX ? "" : "+care");
}

static msr_status go(trial *t) {
  enum { LOOKS = 200 };
  const uint64_t all = t->brief ? t->row->brief : t->row->full;
  const uint64_t piece = all < LOOKS ? 1 : all / LOOKS;
  msr_status status = MSR_OK;
  for (uint64_t done = 0; done < all && status == MSR_OK; done += piece) {
    const uint64_t careful = msr_state_work(t->w.state).careful;
    status = msr_state_step(t->w.state, piece < all - done ? piece : all - done, &why);
    if (msr_state_work(t->w.state).careful != careful) t->o.growth = t->o.loss = 0;
    if (status == MSR_OK) status = msr_state_check(t->w.state, &why);
    look(t, 2 * done >= all);
  }
  return status;
}

/* ---- Judging */

static const char *breach(const trial *t) {
  const hard_case *row = t->row;
  const outcome *o = &t->o;
  if (o->not_finite > 0) return "numbers that aren't finite";
  if (o->penetration > 0) return "a mass is in a support, or through one";
  if (!(o->growth <= row->growth)) return "the energy grew";
  if (row->loss > 0 && !(o->loss <= row->loss)) return "the energy fell";
  if (row->wanted == RESTS && !(o->rest <= row->rest)) return "it doesn't come to rest";
  return row->check ? row->check(row, &t->w) : NULL;
}

static void say(outcome *o, bool failed, const char *text, const char *more) {
  o->failed = failed;
  msri_format(o->verdict, sizeof o->verdict, "%s%s%s", failed ? "FAILED: " : "", text, more);
}

static void judge(trial *t, msr_status status) {
  const hard_case *row = t->row;
  const bool ends = row->wanted > RESTS, explodes = row->wanted == EXPLODES || row->wanted == GROWS;
  char kinetic[40] = "";
  if (row->wanted == RESTS) msri_format(kinetic, sizeof kinetic, ", kinetic %.2g", t->o.rest);
  if (ends && status == MSR_OK && row->wanted == GROWS && t->o.growth > 1e6)
    say(&t->o, false, "grows a million times, as it must", "");
  else if (ends && status == MSR_OK)
    say(&t->o, true, "it should have been stopped", "");
  else if (explodes && status != MSR_EUNSTABLE)
    say(&t->o, true, "stopped, but not as unstable: ", why.message);
  else if (ends)
    say(&t->o, why.message[0] == '\0', "stopped, as it must be: ", why.message);
  else if (status != MSR_OK)
    say(&t->o, true, why.message, "");
  else if (breach(t))
    say(&t->o, true, breach(t), kinetic);
  else
    say(&t->o, false, row->wanted == RESTS ? "at rest" : "sound", kinetic);
}

outcome run_case(const hard_case *row, bool brief) {
  trial t = {.row = row, .brief = brief};
  const clock_t from = clock();
  msr_picture *picture;
  msr_scene *scene;
  why.message[0] = '\0';
  msr_status status = make_scene(row, brief, &picture, &scene);
  if (status == MSR_OK) status = open_world_of(row, scene, &t.w);
  if (status == MSR_OK) {
    if (row->arrange) row->arrange(row, &t.w);
    const msr_view s = msr_state_view(t.w.state);
    t.walls = walls_of(picture, row->scene.closed_border, &s);
    begin(&t);
    status = go(&t);
  }
  if (t.w.state) name_methods(&t);
  judge(&t, status);
  close_world(t.w);
  forget_walls(&t.walls);
  msr_picture_free(picture);
  t.o.seconds = (double)(clock() - from) / CLOCKS_PER_SEC;
  return t.o;
}
