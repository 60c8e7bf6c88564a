/* assignment.c - the assignment to the letter, as a student writes and compiles it (-O2): an array
 * of particules, an array of ressorts that point into it, and its five steps. */
#include "speed.h"

#include <stdlib.h>

typedef struct particule {
  double masse;
  double positionX;
  double positionY;
  double vitesseX;
  double vitesseY;
  double accelerationX;
  double accelerationY;
  double forceX;
  double forceY;
  unsigned char couleur[3];
} particule;

typedef struct ressort {
  particule *particule1;
  particule *particule2;
  double distanceRepos;
  double tensionRessort;
} ressort;

typedef struct simulation {
  size_t nb_particules, nb_ressorts;
  particule *particules;
  ressort *ressorts;
} simulation;

/* Formula (1). */
static void contribution(const ressort *r) {
  particule *p1 = r->particule1, *p2 = r->particule2;
  const double dx = p2->positionX - p1->positionX, dy = p2->positionY - p1->positionY;
  const double distance = sqrt(dx * dx + dy * dy);
  const double force = r->tensionRessort * (distance - r->distanceRepos);
  p1->forceX += force * dx / distance;
  p1->forceY += force * dy / distance;
  p2->forceX -= force * dx / distance;
  p2->forceY -= force * dy / distance;
}

static void iteration(simulation *s) {
  for (size_t i = 0; i < s->nb_particules; i++)
    s->particules[i].forceX = s->particules[i].forceY = 0;
  for (size_t i = 0; i < s->nb_ressorts; i++) contribution(&s->ressorts[i]);
  for (size_t i = 0; i < s->nb_particules; i++) {
    particule *p = &s->particules[i];
    p->accelerationX = p->forceX / p->masse;
    p->accelerationY = p->forceY / p->masse;
  }
  for (size_t i = 0; i < s->nb_particules; i++) {
    particule *p = &s->particules[i];
    p->vitesseX += step * p->accelerationX;
    p->vitesseY += step * p->accelerationY;
  }
  for (size_t i = 0; i < s->nb_particules; i++) {
    particule *p = &s->particules[i];
    p->positionX += step * p->vitesseX;
    p->positionY += step * p->vitesseY;
  }
}

/* ---- As a contestant */

static entry open_assignment(const contestant *c, const work *w, int threads) {
  (void)c, (void)threads;
  simulation *s = need(1, sizeof *s);
  s->nb_particules = w->n, s->nb_ressorts = w->n_springs;
  s->particules = need(w->n, sizeof *s->particules);
  s->ressorts = need(w->n_springs, sizeof *s->ressorts);
  for (size_t i = 0; i < w->n; i++)
    s->particules[i] = (particule){.masse = mass,
                                   .positionX = w->x[i],
                                   .positionY = w->y[i],
                                   .vitesseX = w->u[i],
                                   .vitesseY = w->v[i]};
  for (size_t i = 0; i < w->n_springs; i++)
    s->ressorts[i] = (ressort){&s->particules[w->i[i]], &s->particules[w->j[i]], rest, stiffness};
  const size_t bytes = w->n * sizeof(particule) + w->n_springs * sizeof(ressort);
  return (entry){s, w->n_springs, (double)bytes, true, NULL};
}

static double run_assignment(void *self, size_t steps) {
  const double begin = seconds_now();
  for (size_t i = 0; i < steps; i++) iteration(self);
  return seconds_now() - begin;
}

static void read_assignment(void *self, double *x, double *y) {
  const simulation *s = self;
  for (size_t i = 0; i < s->nb_particules; i++) {
    x[i] = s->particules[i].positionX;
    y[i] = s->particules[i].positionY;
  }
}

static void close_assignment(void *self) {
  simulation *s = self;
  free(s->particules);
  free(s->ressorts);
  free(s);
}

const contestant assignment = {
    .name = "assignment's program",
    .grain = 1,
    .threads = 1,
    .open = open_assignment,
    .run = run_assignment,
    .read = read_assignment,
    .close = close_assignment,
};
