/* chipmunk.c - Chipmunk2D as it comes: a pixel is a unit, a mass a disc of a pixel's width that
 * meets supports only, a spring a cpDampedSpring, a stretch of black pixels a static box; one step
 * per DT, 10 iterations. */
#include "beside.h"

#include <chipmunk/chipmunk.h>
#include <stdio.h>

typedef struct chipmunk_run {
  const problem *p;
  cpSpace *space;
  cpBody **bodies; /* [n] */
} chipmunk_run;

const char *chipmunk_version(void) { return cpVersionString; }

static void add_box(void *self, double from, double to, double row) {
  const chipmunk_run *r = self;
  cpBody *ground = cpSpaceGetStaticBody(r->space);
  const cpBB box = cpBBNew(from, row, to, row + 1);
  cpShape *shape = cpSpaceAddShape(r->space, cpBoxShapeNew2(ground, box, 0));
  cpShapeSetElasticity(shape, r->p->restitution);
}

static cpBody *add_mass(const chipmunk_run *r, size_t i) {
  const problem *p = r->p;
  cpBody *body = cpSpaceAddBody(r->space, cpBodyNew(p->m[i], (cpFloat)INFINITY));
  cpBodySetPosition(body, cpv(p->x[i], p->y[i]));
  cpBodySetVelocity(body, cpv(p->vx[i], p->vy[i]));
  cpShape *shape = cpSpaceAddShape(r->space, cpCircleShapeNew(body, 0.5, cpvzero));
  cpShapeSetElasticity(shape, 1);
  if (!(p->diameter > 0)) cpShapeSetFilter(shape, cpShapeFilterNew(1, ~0U, ~0U));
  return body;
}

static void add_spring(const chipmunk_run *r, const bond *l) {
  cpBody *a = r->bodies[l->i], *b = r->bodies[l->j];
  cpConstraint *spring = cpDampedSpringNew(a, b, cpvzero, cpvzero, l->L, l->k, r->p->damping);
  cpConstraintSetCollideBodies(spring, cpFalse);
  cpSpaceAddConstraint(r->space, spring);
}

static void *open_chipmunk(const problem *p) {
  chipmunk_run *r = need(1, sizeof *r);
  r->p = p;
  /* Debian's greets on stdout, which the bench doesn't need here. */
  if (!freopen("/dev/null", "w", stdout)) bench_fail("no /dev/null");
  r->space = cpSpaceNew();
  r->bodies = need(p->n, sizeof *r->bodies);
  cpSpaceSetGravity(r->space, cpv(0, -p->gravity));
  for_stretches(p, add_box, r);
  for (size_t i = 0; i < p->n; i++) r->bodies[i] = add_mass(r, i);
  for (size_t i = 0; i < p->n_bonds; i++) add_spring(r, &p->bonds[i]);
  return r;
}

static void blow(const problem *p, cpBody *body) {
  const cpVect v = cpBodyGetVelocity(body);
  cpBodySetForce(body, cpv(p->air * (p->wind - v.x), -p->air * v.y));
}

static bool advance_chipmunk(void *self, uint64_t iterations, char *text) {
  (void)text;
  const chipmunk_run *r = self;
  for (uint64_t i = 0; i < iterations; i++) {
    for (size_t k = 0; r->p->air > 0 && k < r->p->n; k++) blow(r->p, r->bodies[k]);
    cpSpaceStep(r->space, r->p->dt);
  }
  return true;
}

static void read_chipmunk(void *self, double *x, double *y, double *vx, double *vy) {
  const chipmunk_run *r = self;
  for (size_t i = 0; i < r->p->n; i++) {
    const cpVect q = cpBodyGetPosition(r->bodies[i]), v = cpBodyGetVelocity(r->bodies[i]);
    x[i] = q.x, y[i] = q.y, vx[i] = v.x, vy[i] = v.y;
  }
}

const solver solver_chipmunk = {NULL, open_chipmunk, advance_chipmunk, read_chipmunk};
