/* plan.h - a scene compiled: what the state, the evaluation and the run read. */
#ifndef MSRI_PLAN_H
#define MSRI_PLAN_H

#include "base/base.h"
#include "base/notes.h"
#include "contacts/contact.h"
#include "contacts/discs.h"
#include "plan/bands.h"
#include "plan/mesh.h"
#include "plan/objects.h"
#include "scene/scene.h"
#include "solvers/graph.h"

/* Of a state. */
enum { MSRI_MOST_THREADS = 256 };

/* Of an iteration. */
#define MSRI_MOST_SUBSTEPS 1e9

/* A force that the scene calls for, compiled. */
typedef struct msri_term {
  const msr_force *force;
  void *params;     /* the plan's copy */
  const void *self; /* what prepare made, or params */
  void *made;       /* what prepare made, for release */
  size_t scratch;   /* offset into the state's scratch */
} msri_term;

/* Long implicit steps in place of substeps, if figures.leaps; costs are in evaluations of the
 * acceleration. */
typedef struct msri_leaping {
  double substep;   /* cost of one */
  uint64_t stretch; /* substeps: a leap lies between two multiples of it */
} msri_leaping;

extern const double msri_leap_least; /* cost of the cheapest leap */
extern const double msri_leap_share; /* of the cost of all substeps that may be spent in vain */
extern const double msri_leap_reach; /* how far what meets something may be from it [px] */

/* Numbers of effects; n_effects where they are off. */
typedef struct msri_rows {
  size_t contact; /* that the time of all contacts goes to */
  size_t integrator, leaps, guard, care;
} msri_rows;

/* What was asked for that says which steps are taken. */
typedef struct msri_asked {
  bool integrator, substeps;
} msri_asked;

struct msr_plan {
  msr_plan_figures figures;
  size_t n_picture;
  msri_grid *grid;            /* the scene's; NULL: no picture */
  const msr_picture *picture; /* the grid's; NULL: none */
  double *added;   /* [2][figures.masses - n_picture]: x, y of masses added by a program; */
  bool added_move; /* then as many vx, vy */
  unsigned char *added_rgb; /* [figures.masses - n_picture][3] */
  double uniform_mass;
  double *m; /* [figures.masses]; NULL: all are uniform_mass */
  msri_mesh mesh;
  msri_term *term; /* [n_terms], in the order in which they act */
  size_t n_terms;
  size_t scratch_bytes; /* of all terms */
  bool midpoint;        /* a force on v has no flow of its own: states have room for one */
  bool driven;          /* a force drives: states follow its work */
  bool followed;        /* one of them doesn't tell its power: likewise, mass by mass */
  bool middle;          /* a force without between() acts in the middle of a step: likewise */
  unsigned threads;     /* that a state may step with */
  char by_vectors[128]; /* what figures.by_vectors says */
  int neighbours;       /* of a mass of the picture: 4 or 8 */
  msri_objects objects; /* of the picture, if states sweep; */
  msri_bands bands;     /* or of the mesh that a program built */
  msri_graph *graph;    /* of the springs, if the integrator is implicit */
  msri_contact contact; /* drift NULL: nothing stands in the way */
  msri_discs *discs;    /* NULL: masses don't collide with each other */
  msr_effect *effect;   /* [n_effects]; the first n_terms are the terms */
  char (*reason)[MSR_MESSAGE_SIZE]; /* of the effects */
  size_t n_effects, n_contacts;     /* contacts that are on come after the terms */
  msri_rows row;
  bool timed; /* states measure the time of effects */
  msri_leaping leaping;
  double safe_share; /* of the stable step, that steps are no larger than */
  bool conserves;    /* nothing gives energy or takes it */
  bool cares;        /* states watch their energy, and step with care once it grows */
  bool careful;      /* from the start */
  msri_notes notes;
};

/* Can the force bring in energy that no potential tells of? */
static inline bool msri_force_drives(const msr_force *force) {
  return !force->dissipative && (!force->conservative || force->uses_time);
}

/* Has it a potential that a fall or a push loses? */
static inline bool msri_force_is_outer(const msr_force *force) {
  return force->conservative && force != &msr_force_springs;
}

/* Does anything depend on v? */
static inline bool msri_plan_damps(const msr_plan *plan) {
  for (size_t i = 0; i < plan->n_terms; i++)
    if (plan->term[i].force->uses_velocity) return true;
  return false;
}

/* May anything ever be in the way? */
static inline bool msri_plan_meets(const msr_plan *plan) {
  return plan->contact.drift || plan->discs;
}

/* Do steps end at impacts, of methods that don't see to them as they drift? */
static inline bool msri_plan_ends_at_impacts(const msr_plan *plan) {
  return plan->contact.meet && !plan->discs;
}

/* Does the library see to contacts after each step? Where the integrator doesn't, or where it would
 * do so after each of its own, but impacts are better located by its dense steps. */
static inline bool msri_plan_bounces(const msr_plan *plan) {
  const msr_integrator *integrator = plan->figures.integrator;
  if (!msri_plan_meets(plan) || (integrator->holds && plan->contact.hold && !plan->discs))
    return false;
  return !integrator->bounces || (integrator->adaptive && msri_plan_ends_at_impacts(plan));
}

/* Are masses that can't reach a support left untested? */
static inline bool msri_plan_arms(const msr_plan *plan) {
  return plan->contact.clearance && !plan->discs && !msri_plan_bounces(plan);
}

/* Does what met something need the acceleration at the end of the step? Implicit methods, whose
 * steps may be too long for what that would say, do without; so do methods that leave contacts to
 * the library, where places are kept, masses that others may push away, and steps so long that what
 * the modified energy leaves out is most of it. */
static inline bool msri_plan_settles(const msr_plan *plan) {
  const msr_integrator *integrator = plan->figures.integrator;
  if (!plan->contact.drift || integrator->implicit) return false;
  if (plan->contact.meet) return true;
  return integrator->bounces && !plan->discs && plan->figures.h <= plan->figures.safe_step;
}

/* The time after so many iterations and substeps: made of whole numbers, never summed, so that
 * nothing depends on how a run is cut in pieces. */
static inline double msri_plan_time(const msr_plan_figures *f, uint64_t iteration,
                                    uint64_t substep) {
  if (substep == f->substeps) return (double)(iteration + 1) * f->dt;
  return (double)iteration * f->dt + (double)substep * f->h;
}

/* Terms, contacts and effects that the scene calls for at its start. MSR_ENOMEM, what
 * force->prepare returns. */
msr_status msri_plan_call_for_effects(msr_plan *plan, const msr_scene *scene, const msr_view *start,
                                      msr_error *err);

/* Completes the effects, once the steps are chosen, by what steps, by what is off, and by what each
 * takes. */
void msri_plan_complete_effects(msr_plan *plan, const msri_asked *asked);

/* Does the plan step row by row, or band by band? If not, the figures get the reason. */
bool msri_plan_sweeps(const msr_plan *plan);
void msri_plan_say_vectors(msr_plan *plan);

/* Fills the costs of all effects that are on. */
void msri_plan_count_costs(msr_plan *plan);

/* Calls of a force in a step of so many evaluations. Of flows there are two or, where a composition
 * of Verlet's keeps its order in air, two to an evaluation. */
static inline double msri_force_calls(const msr_force *force, const msr_integrator *integrator,
                                      double evaluations) {
  if (!force->uses_velocity || !integrator->splits) return evaluations;
  return integrator->damped_order == 0 ? 2 * evaluations : 2;
}

/* Steps between two looks of the guard: at speeds, at all energies; drifts between two looks at
 * speeds where steps go row by row. */
enum { MSRI_GLANCE = 16, MSRI_LOOK = 256, MSRI_SPEEDS = 64 };

/* Iterations between two looks with care: 64; where they are one or two steps, 256 steps. */
static inline uint64_t msri_care_period(const msr_plan_figures *f) {
  enum { ITERATIONS = 64, STEPS = 256 };
  return f->substeps < 3 ? STEPS / f->substeps : ITERATIONS;
}

/* Keeps what a program's masses begin with. MSR_ENOMEM. */
msr_status msri_plan_keep_start(msr_plan *plan, const msr_scene *scene, msr_error *err);

/* Start of every mass. x, y, vx, vy [masses]; vx and vy are zeros before: of what begins at rest
 * they are left alone. */
void msri_plan_start(const msr_plan *plan, double *x, double *y, double *vx, double *vy);

/* Colours of all masses, rgb [masses][3]. */
void msri_plan_colours(const msr_plan *plan, unsigned char *rgb);

/* A view of the plan's masses with the arrays q = x[n], y[n] and v = vx[n], vy[n] (both may be
 * NULL).
 */
msr_view msri_plan_view(const msr_plan *plan, double t, const double *q, const double *v);

/* Kinetic energy. */
double msri_kinetic(const msr_view *s);

/* "pixel (12,5)" or "mass 7": what a user calls a mass. Returns text. */
const char *msri_plan_mass_name(const msr_plan *plan, size_t mass, char *text, size_t size);

/* Steps that are safe are no larger than this share of the stable one. `start` is the scene there.
 */
double msri_plan_safe_share(const msr_plan *plan, const msr_view *start);

/* Can what moves at the start crush the springs? */
bool msri_plan_crushes(const msr_plan *plan, const msr_view *start);

/* Stability limit of the explicit midpoint rule, which stands in for a flow that isn't given. */
extern const double msri_midpoint_limit;

/* Fills the stable step and the substeps in the figures, and what the user should know of them. */
msr_status msri_plan_choose_step(msr_plan *plan, const msr_view *start, uint64_t substeps,
                                 msr_error *err);

/* Size of the acceleration by gravity [px/s^2]. */
double msri_plan_gravity(const msr_plan *plan);

/* Why implicit steps can't be taken past whatever is in the way; NULL: they can. */
const char *msri_plan_cannot_leap(const msr_plan *plan);

/* Lets the plan leap if that may cost less than its substeps, and says so. */
msr_status msri_plan_choose_leaps(msr_plan *plan, msr_error *err);

/* The largest step that is safe with Verlet; DT if nothing limits it. */
double msri_plan_verlet_step(const msr_plan *plan);

#endif
