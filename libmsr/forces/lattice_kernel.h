/* lattice_kernel.h - the kernels of lattice.c for vectors of one width: see base/lanes.h.
 *
 * Each spring is computed once, F = k (l - L) / l (dx, dy). Of the forces on a cell those from the
 * row above come first, which that row left behind, then from the left, where the vector before
 * ends, the right, and below: the order in which a loop over the springs, row by row, would add
 * them. The divider is busy all the time; all else happens beside it. */
#include "base/lanes.h"

#define pair            NAMED(pair)
#define spring          NAMED(spring)
#define below_of        NAMED(below_of)
#define less            NAMED(less)
#define more            NAMED(more)
#define acceleration_of NAMED(acceleration_of)
#define move            NAMED(move)
#define go              NAMED(go)

typedef struct pair {
  lanes x, y;
} pair;

/* Nothing, not NaN, where there's no spring, or no length. */
LANES_FN pair spring(const double *k, double L, lanes dx, lanes dy) {
  const lanes l = lanes_root(dx * dx + dy * dy), stiffness = lanes_load(k);
  const lanes f = stiffness * (l - lanes_all(L)) / l;
  const lanes_mask is = lanes_both(lanes_above0(stiffness), lanes_above0(l));
  return (pair){lanes_keep(is, f * dx), lanes_keep(is, f * dy)};
}

/* Of the springs to the cells below, column by column `shift` to the right. */
LANES_FN pair below_of(const msri_cells *s, const msri_motion *motion, size_t c, int way) {
  const ptrdiff_t shift = way == MSRI_BELOW ? 0 : way == MSRI_BELOW_LEFT ? -1 : 1;
  const double *const x = s->below_x + c + shift, *const y = s->below_y + c + shift;
  const lanes dx = lanes_load(x) - lanes_load(s->x + c), dy = lanes_load(y) - lanes_load(s->y + c);
  const pair f = spring(s->k[way] + c, motion->L[way != MSRI_BELOW], dx, dy);
  lanes_store(s->below[way].x + c, f.x);
  lanes_store(s->below[way].y + c, f.y);
  return f;
}

LANES_FN pair less(pair sum, pair f) { return (pair){sum.x - f.x, sum.y - f.y}; }

LANES_FN pair more(pair sum, pair f) { return (pair){sum.x + f.x, sum.y + f.y}; }

/* The force on cells c ... over their mass; `left` is that of the springs to the right of the ones
 * before. */
LANES_FN pair acceleration_of(const msri_cells *s, const msri_motion *motion, size_t c,
                              const msri_task *task, pair *left) {
  const lanes x = lanes_load(s->x + c), y = lanes_load(s->y + c);
  const pair right = spring(s->k[MSRI_RIGHT] + c, motion->L[0], lanes_load(s->x + c + 1) - x,
                            lanes_load(s->y + c + 1) - y);
  pair sum = {lanes_all(0), lanes_all(0)}, below[MSRI_WAYS];
  for (int way = MSRI_BELOW; way < task->ways; way++)
    sum = less(sum, (pair){lanes_load(s->above[way].x + c), lanes_load(s->above[way].y + c)});
  for (int way = MSRI_BELOW; way < task->ways; way++) below[way] = below_of(s, motion, c, way);
  sum = less(sum, (pair){lanes_after(left->x, right.x), lanes_after(left->y, right.y)});
  sum = more(sum, right);
  for (int way = MSRI_BELOW; way < task->ways; way++) sum = more(sum, below[way]);
  *left = right;
  if (task->besides & MSRI_WITH_WEIGHT)
    sum = more(sum, (pair){lanes_all(motion->weight[0]), lanes_all(motion->weight[1])});
  return (pair){sum.x * lanes_all(motion->w), sum.y * lanes_all(motion->w)};
}

/* Kicks, with air between them or not, and drift along one axis. Returns the velocity. */
LANES_FN lanes move(const msri_motion *motion, int axis, const msri_task *task, lanes a, double *at,
                    double *speed) {
  lanes v = lanes_load(speed) + lanes_all(motion->kick[0]) * a;
  for (int n = 0; n < 2 && (task->besides & MSRI_WITH_AIR); n++) {
    const lanes air = lanes_all(motion->air[n][axis]);
    v = air + (v - air) * lanes_all(motion->keep[n]);
  }
  v = v + lanes_all(motion->kick[1]) * a;
  lanes_store(speed, v);
  lanes_store(at, lanes_load(at) + lanes_all(motion->drift) * v);
  return v;
}

/* Goes on from `place`, while there are as many cells as lanes. Copies let compilers see that no
 * store changes a pointer. */
LANES_FN void go(const msri_cells *all_cells, const msri_motion *whole_motion,
                 const msri_task *task, msri_place *place) {
  const msri_cells cells = *all_cells, *const s = &cells;
  const msri_motion the_motion = *whole_motion, *const motion = &the_motion;
  pair left = {lanes_all(place->left[0]), lanes_all(place->left[1])};
  lanes fastest = lanes_all(place->fastest);
  size_t c = place->cell;
  for (; c + LANES <= s->n; c += LANES) {
    if (task->only_below) {
      for (int way = MSRI_BELOW; way < task->ways; way++) below_of(s, motion, c, way);
      continue;
    }
    const pair a = acceleration_of(s, motion, c, task, &left);
    if (task->ax) {
      lanes_store(task->ax + c, a.x);
      lanes_store(task->ay + c, a.y);
    } else {
      fastest = lanes_larger(fastest, move(motion, 0, task, a.x, s->x + c, s->vx + c));
      fastest = lanes_larger(fastest, move(motion, 1, task, a.y, s->y + c, s->vy + c));
    }
  }
  place->cell = c;
  place->fastest = lanes_largest(fastest);
  place->left[0] = lanes_last(left.x), place->left[1] = lanes_last(left.y);
}

#undef pair
#undef spring
#undef below_of
#undef less
#undef more
#undef acceleration_of
#undef move
#undef go
#undef lanes
#undef lanes_mask
#undef lanes_all
#undef lanes_load
#undef lanes_store
#undef lanes_root
#undef lanes_above0
#undef lanes_keep
#undef lanes_after
#undef lanes_last
#undef lanes_both
#undef lanes_larger
#undef lanes_largest
#undef LANES_FN
#undef LANES
#undef NAMED
