/* assignment.c - the assignment's algorithm to the letter: its two structures, its five steps, one
 * step per DT, and its rule of contact, for x first, then for y. What it leaves open (damping,
 * wind, restitution) is put where it says that other forces go, and on the reflected velocity. */
#include "beside.h"

#include <math.h>

typedef struct particule {
  double masse;
  double positionX, positionY;
  double vitesseX, vitesseY;
  double accelerationX, accelerationY;
  double forceX, forceY;
} particule;

typedef struct ressort {
  particule *particule1, *particule2;
  double distanceRepos;
  double tensionRessort;
} ressort;

typedef struct simulation {
  const problem *p;
  particule *particules;
  ressort *ressorts;
} simulation;

static void *open_assignment(const problem *p) {
  simulation *s = need(1, sizeof *s);
  s->p = p;
  s->particules = need(p->n, sizeof *s->particules);
  s->ressorts = need(p->n_bonds, sizeof *s->ressorts);
  for (size_t i = 0; i < p->n; i++)
    s->particules[i] = (particule){.masse = p->m[i],
                                   .positionX = p->x[i],
                                   .positionY = p->y[i],
                                   .vitesseX = p->vx[i],
                                   .vitesseY = p->vy[i]};
  for (size_t i = 0; i < p->n_bonds; i++) {
    const bond *l = &p->bonds[i];
    s->ressorts[i] = (ressort){&s->particules[l->i], &s->particules[l->j], l->L, l->k};
  }
  return s;
}

/* Formula (1). It says nothing of masses at one place: there it is 0 / 0. */
static void pull(const ressort *r, double damping) {
  particule *p1 = r->particule1, *p2 = r->particule2;
  const double dx = p2->positionX - p1->positionX, dy = p2->positionY - p1->positionY;
  const double distance = sqrt(dx * dx + dy * dy), ux = dx / distance, uy = dy / distance;
  const double rate = (p2->vitesseX - p1->vitesseX) * ux + (p2->vitesseY - p1->vitesseY) * uy;
  const double f = r->tensionRessort * (distance - r->distanceRepos) + damping * rate;
  p1->forceX += f * ux, p1->forceY += f * uy;
  p2->forceX -= f * ux, p2->forceY -= f * uy;
}

static void move(const problem *p, particule *m) {
  const double x = m->positionX + p->dt * m->vitesseX;
  if (is_black(p, x, m->positionY))
    m->vitesseX *= -p->restitution;
  else
    m->positionX = x;
  const double y = m->positionY + p->dt * m->vitesseY;
  if (is_black(p, m->positionX, y))
    m->vitesseY *= -p->restitution;
  else
    m->positionY = y;
}

static void iterate(simulation *s) {
  const problem *p = s->p;
  for (size_t i = 0; i < p->n; i++) s->particules[i].forceX = s->particules[i].forceY = 0;
  for (size_t i = 0; i < p->n_bonds; i++) pull(&s->ressorts[i], p->damping);
  for (size_t i = 0; i < p->n; i++) {
    particule *m = &s->particules[i];
    m->forceX += p->air * (p->wind - m->vitesseX);
    m->forceY -= m->masse * p->gravity + p->air * m->vitesseY;
  }
  for (size_t i = 0; i < p->n; i++) {
    particule *m = &s->particules[i];
    m->accelerationX = m->forceX / m->masse;
    m->accelerationY = m->forceY / m->masse;
  }
  for (size_t i = 0; i < p->n; i++) {
    particule *m = &s->particules[i];
    m->vitesseX += p->dt * m->accelerationX;
    m->vitesseY += p->dt * m->accelerationY;
  }
  for (size_t i = 0; i < p->n; i++) move(p, &s->particules[i]);
}

static bool advance_assignment(void *self, uint64_t iterations, char *text) {
  (void)text;
  for (uint64_t i = 0; i < iterations; i++) iterate(self);
  return true;
}

static void read_assignment(void *self, double *x, double *y, double *vx, double *vy) {
  const simulation *s = self;
  for (size_t i = 0; i < s->p->n; i++) {
    const particule *m = &s->particules[i];
    x[i] = m->positionX, y[i] = m->positionY, vx[i] = m->vitesseX, vy[i] = m->vitesseY;
  }
}

static const char *decline_assignment(const problem *p) {
  return p->diameter > 0 ? "it leaves out collisions between masses" : NULL;
}

const solver solver_assignment = {decline_assignment, open_assignment, advance_assignment,
                                  read_assignment};
