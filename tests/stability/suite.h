/* suite.h - the stability suite: hard cases as rows, and what is measured on each.
 *
 * A row says how its scene is made, how long it runs in the short form and in the long one, what
 * must come of it, and why its bounds are what they are. */
#ifndef STABILITY_SUITE_H
#define STABILITY_SUITE_H

#include "../scenes.h"

#include "base/number.h"

typedef enum wanted {
  SOUND,    /* no error, all numbers finite, energy within its bounds, nothing in a support */
  RESTS,    /* the same, and in the second half the kinetic energy is at most `rest` */
  EXPLODES, /* MSR_EUNSTABLE, with a message */
  GROWS,    /* the same, or a growth of a million times, which tensions may hide from the guard */
  STOPS     /* any error with a message: the case is beyond what numbers can hold */
} wanted;

enum { NAME_SIZE = 40 }; /* with the 0 */

typedef struct hard_case {
  char name[NAME_SIZE];
  /* The scene: `make`, or else `draw`, or else `art`, or else the assignment's picture, in the
   * short form at a quarter of its size. `brief` tells that it's the short form. */
  msr_scene *(*make)(const struct hard_case *row, bool brief);
  msr_picture *(*draw)(const struct hard_case *row);
  const char *art;
  bool whole;    /* not at a quarter */
  msr_conf conf; /* iterations and images aren't used */
  msr_scene_options scene;
  double softness, friction;               /* of supports: restitution is 1 - softness */
  double diameter;                         /* of discs that collide; 0: points */
  double damping, drag, wind, gust, push;  /* 0: none; the push is on mass 0, to the right */
  double vx, vy;                           /* of every mass at the start */
  void (*place)(size_t n, msr_mass *mass); /* where they are then, if not as drawn; by a program */
  void (*arrange)(const struct hard_case *row, const world *w); /* of the start */
  double parameter;                                             /* of make, draw, arrange, check */
  msr_plan_options plan;                                        /* zero: defaults */
  uint64_t brief, full; /* iterations; 0: not in that form */
  wanted wanted;
  bool from_rest;      /* the springs' energy at the start isn't to give: they hold each other */
  bool of_total;       /* the bounds are shares of the total energy at the start */
  double growth, loss; /* most change of the energy over what there was to give; loss 0: any */
  double rest;         /* likewise, kinetic */
  /* What else must be so at the end: NULL, or what is wrong. */
  const char *(*check)(const struct hard_case *row, const world *w);
  const char *why; /* the reason of the bounds */
} hard_case;

/* What came of a case. */
typedef struct outcome {
  char integrator[40]; /* with "+leaps" if there were any, "+care" if it came to that */
  uint64_t substeps;
  double growth, loss, rest; /* measured; growth and loss are both 0 or more */
  double penetration;        /* the deepest in a support [px]; INFINITY: through one */
  uint64_t not_finite;       /* numbers of the state, at the end */
  double seconds;            /* of processor time */
  bool failed;
  char verdict[200];
} outcome;

typedef struct suite {
  hard_case *row; /* [n] */
  size_t n, room;
} suite;

static const msr_conf conf_of_assignment = {0.005, 9.8, 0.1, 1500, 1, 1};

/* Reasons that rows share. */
static const char why_modified[] =
    "impacts: Verlet keeps an energy that differs from the true one by a share of what is in the "
    "fastest modes; beyond 2 % a state goes back, and beyond 5 %, where it can't, msr warns";
static const char why_care[] =
    "masses pass through each other; that is seen at 2 % of what there was to give, and kept from "
    "there on";
static const char why_exact[] =
    "crushed at the start: steps of energy-momentum, kept to the tolerance of their equations";
static const char why_crushed[] =
    "masses pass through each other, and a spring's force turns round within a step: by a share of "
    "steps that is 1/8 to 1/64, where impacts are located, up to 3 % were measured";

/* The row is copied. */
void add_case(suite *s, const hard_case *row);

void add_stiff(suite *s);
void add_steps(suite *s);
void add_masses(suite *s);
void add_shapes(suite *s);
void add_impacts(suite *s);
void add_falls(suite *s);
void add_collisions(suite *s);
void add_effects(suite *s);
void add_rest(suite *s);
void add_numbers(suite *s);
void add_limits(suite *s);
void add_ages(suite *s); /* last: it takes a quarter of an hour */

/* The picture (NULL: none) is the caller's. MSR_EINPUT if the library refuses it. */
msr_status make_scene(const hard_case *row, bool brief, msr_picture **picture, msr_scene **scene);

outcome run_case(const hard_case *row, bool brief);

void print_head(void);
void print_outcome(const hard_case *row, const outcome *o);

#endif
