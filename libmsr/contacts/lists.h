/* lists.h - what is known, from step to step, of who may meet whom: masses are looked at only where
 * two of them can.
 *
 * Of each body its own pairs within the diameter and twice a skin are listed. None is missing while
 * no mass is further than that skin from where it would be if the body had kept its form; which is
 * known from how the paths of its masses differ, without a look at any pair. Pairs of two bodies
 * are listed where their boxes meet, and bodies may go against each other by skins of their own.
 * Lists depend on the past; what is found with them doesn't. */
#ifndef MSRI_LISTS_H
#define MSRI_LISTS_H

#include "contacts/displacement.h"
#include "contacts/near.h"

/* Of the pool of pairs. */
typedef struct msri_range {
  size_t begin, end;
} msri_range;

/* For how long a list is good. */
typedef struct msri_reach {
  bool known;
  double skin, used; /* [px] */
} msri_reach;

typedef struct msri_listed {
  msri_reach inner, outer;        /* pairs of its own; with other bodies */
  msri_range pairs;               /* of its own, ascending */
  uint64_t listed;                /* when these were, in drifts */
  double far;                     /* no coordinate is larger than that [px] */
  msri_displacement displacement; /* in this one */
  double away;    /* in this one, how far at most from what goes as bodies do in the mean [px] */
  size_t cluster; /* one of the bodies that listed pairs join it to; alike for all of them */
  bool swift;     /* lists are no good for this drift */
  bool hot;       /* its masses may have to give way in this drift */
} msri_listed;

/* What is kept beside. */
typedef struct msri_lists_kept {
  const double *q;  /* where the last drift left the places; NULL: they may be elsewhere */
  uint64_t drifts;  /* so far */
  size_t used;      /* of the pool */
  msri_range outer; /* pairs of two bodies */
} msri_lists_kept;

typedef struct msri_lists {
  const msri_bodies *bodies;
  double diameter;
  msri_near near;
  msri_lists_kept *kept;
  msri_listed *body; /* [bodies->n] */
  msri_box *box;     /* [bodies->n]: for use */
  size_t *rank;      /* [bodies->n]: bodies from left to right, or zeros */
  double *at;        /* [2n]: where masses were when the pairs of their body were listed */
  msri_pair *pool;   /* [near.capacity] */
  msri_pair *chosen; /* [near.capacity]: for use, but while lists are made */
} msri_lists;

/* The parts of a block from *end on, which becomes what is after them; `block` may be NULL, to
 * count only. It's zeroed at first. */
msri_lists msri_lists_place(const msri_bodies *bodies, double diameter, const msri_ties *ties,
                            char *block, size_t *end);

/* A drift begins at q0, and would go by the paths of which `box` is; q is where places are stored
 * from one drift to the next, or NULL if others may have moved them since. */
void msri_lists_begin(msri_lists *lists, const double *q0, const double *q);

/* Is no pair listed, so that a look at velocities may be worth while? */
bool msri_lists_is_idle(const msri_lists *lists, const double *q);

/* In a drift by h with the velocities of which `box` is, can no two masses meet? If so it begins.
 */
bool msri_lists_foresees(msri_lists *lists, double h);

/* The paths are now those of which `box` is. */
void msri_lists_set_paths(msri_lists *lists);

/* Makes lists, where they aren't good for these paths; bodies for which they can't be are swift. */
void msri_lists_cover_paths(msri_lists *lists, const double *q0);

/* All bodies that hot ones may push are hot, too, and lists are made good for pushes of up to
 * `most`. False: there are too many pairs. */
bool msri_lists_cover_pushes(msri_lists *lists, const double *q0, double most);

/* The drift ends, with these paths; q as for its beginning. */
void msri_lists_end(msri_lists *lists, const double *q);

/* Appends the pairs that were found to the pool; false: there's no room. */
bool msri_lists_store(msri_lists *lists, msri_range *range);

/* Is a list good for paths that are so much longer? */
static inline bool msri_reach_covers(const msri_reach *r, double path) {
  return r->known && r->used + path <= r->skin;
}

/* Makes the list of pairs of two bodies good, as above; paths are as long as `most` or longer.
 * False: there's no room for them all. */
bool msri_lists_cover_outer(msri_lists *lists, const double *q0, double most);

/* Skins are no smaller, and, but for long paths, no larger than that, in diameters; with less than
 * half of what is left of a square's diagonal a lattice at rest has no pairs. And lists are made
 * for so many drifts, if that is within these bounds. */
static const double msri_least_skin = 0.2, msri_most_skin = 0.45, msri_many_drifts = 8;

/* To keep rounding from hiding a pair, reaches are longer by that share. */
static const double msri_more = 1 + 1e-9;

#endif
