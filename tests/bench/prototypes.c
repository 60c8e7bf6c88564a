/* prototypes.c - bare loops, as one would write them by hand for this one problem: symplectic
 * splittings, where the end of a step and the beginning of the next are one kick or one drift, and
 * the classical Runge-Kutta method in the form that it takes for q'' = a(q). */
#include "bench.h"

#include <stdlib.h>
#include <string.h>

enum { MOST = 18 };

/* Symmetric: coefficients up to the middle, which their sum, 1, leaves over. */
typedef struct row {
  bool drift_first;
  int kicks, drifts; /* per step; no kicks: a composition of `drifts` Verlet steps */
  double kick[MOST / 2], drift[MOST / 2];
} row;

typedef struct bare_run {
  problem *p;
  size_t steps;
  double h;
  bool drift_first;
  int stages;                     /* evaluations a step */
  double kick[MOST], drift[MOST]; /* times h */
  double *a;                      /* [5n] */
} bare_run;

/* c[n] from its first half. */
static void mirror(int n, const double *half, double h, double *c) {
  const int given = (n - 1) / 2;
  double left = 1;
  for (int i = 0; i < given; i++) {
    c[i] = c[n - 1 - i] = h * half[i];
    left -= 2 * half[i];
  }
  c[given] = c[n - 1 - given] = h * left / (n % 2 ? 1 : 2);
}

static void compose(int n, const double *drift, double *kick) {
  for (int i = 0; i <= n; i++) kick[i] = ((i > 0 ? drift[i - 1] : 0) + (i < n ? drift[i] : 0)) / 2;
}

static void *open_bare(const method *self, problem *p, double knob) {
  const row *from = self->row;
  bare_run *r = need(1, sizeof *r);
  *r = (bare_run){.p = p, .steps = (size_t)knob, .h = p->T / (double)(size_t)knob};
  r->a = need(5 * p->n, sizeof *r->a);
  if (!from) return r;
  r->drift_first = from->drift_first;
  r->stages = from->drift_first ? from->kicks : from->drifts;
  mirror(from->drifts, from->drift, r->h, r->drift);
  if (from->kicks > 0)
    mirror(from->kicks, from->kick, r->h, r->kick);
  else
    compose(from->drifts, r->drift, r->kick);
  return r;
}

static void close_bare(void *object) {
  free(((bare_run *)object)->a);
  free(object);
}

/* ---- Loops */

static void move(size_t n, double h, const double *rate, double *x) {
  for (size_t i = 0; i < n; i++) x[i] += h * rate[i];
}

static bool kick_first(bare_run *r, double *q, double *v) {
  const size_t n = r->p->n;
  if (!accelerate(r->p, q, r->a)) return false;
  move(n, r->kick[0], r->a, v);
  for (size_t step = 1; step <= r->steps; step++) {
    for (int s = 0; s < r->stages; s++) {
      const bool joins = s + 1 == r->stages && step < r->steps;
      move(n, r->drift[s], v, q);
      if (!accelerate(r->p, q, r->a)) return false;
      move(n, r->kick[s + 1] + (joins ? r->kick[0] : 0), r->a, v);
    }
  }
  return true;
}

static bool drift_first(bare_run *r, double *q, double *v) {
  const size_t n = r->p->n;
  move(n, r->drift[0], v, q);
  for (size_t step = 1; step <= r->steps; step++) {
    for (int s = 0; s < r->stages; s++) {
      const bool joins = s + 1 == r->stages && step < r->steps;
      if (!accelerate(r->p, q, r->a)) return false;
      move(n, r->kick[s], r->a, v);
      move(n, r->drift[s + 1] + (joins ? r->drift[0] : 0), v, q);
    }
  }
  return true;
}

static bool run_splitting(void *object, double *z) {
  bare_run *r = object;
  const size_t n = r->p->n;
  memcpy(z, r->p->start, 2 * n * sizeof *z);
  return r->drift_first ? drift_first(r, z, z + n) : kick_first(r, z, z + n);
}

/* b = a at q + h (v + g a'), a' being an earlier stage's. */
static bool stage(const bare_run *r, const double *q, const double *v, double h, double g,
                  const double *before, double *b) {
  const size_t n = r->p->n;
  double *u = r->a + 4 * n;
  for (size_t i = 0; i < n; i++) u[i] = q[i] + h * (v[i] + g * before[i]);
  return accelerate(r->p, u, b);
}

static bool run_rk4(void *object, double *z) {
  const bare_run *r = object;
  const size_t n = r->p->n;
  const double h = r->h;
  double *q = z, *v = z + n, *a = r->a, *b = a + n, *c = b + n, *d = c + n;
  memcpy(z, r->p->start, 2 * n * sizeof *z);
  for (size_t step = 0; step < r->steps; step++) {
    if (!accelerate(r->p, q, a) || !stage(r, q, v, h / 2, 0, a, b) ||
        !stage(r, q, v, h / 2, h / 2, a, c) || !stage(r, q, v, h, h / 2, b, d))
      return false;
    for (size_t i = 0; i < n; i++) {
      q[i] += h * (v[i] + h / 6 * (a[i] + b[i] + c[i]));
      v[i] += h / 6 * (a[i] + 2 * (b[i] + c[i]) + d[i]);
    }
  }
  return true;
}

/* ---- Coefficients */

static const row verlet = {.drifts = 1};

/* Omelyan, Mryglod & Folk 2002, Comput. Phys. Commun. 146, 188. */
static const row pefrl = {
    .drift_first = true,
    .kicks = 4,
    .drifts = 5,
    .kick = {0.5 + 0.2123418310626054},
    .drift = {0.1786178958448091, -0.06626458266981849},
};

/* Blanes & Moan 2002, J. Comput. Appl. Math. 142, 313: S6 of order 4, S11 of order 6. */
static const row srkn4 = {
    .kicks = 7,
    .drifts = 6,
    .kick = {0.0829844064174052, 0.396309801498368, -0.0390563049223486},
    .drift = {0.245298957184271, 0.604872665711080},
};
static const row srkn6 = {
    .kicks = 12,
    .drifts = 11,
    .kick = {0.0414649985182624, 0.198128671918067, -0.0400061921041533, 0.0752539843015807,
             -0.0115113874206879},
    .drift = {0.123229775946271, 0.290553797799558, -0.127049212625417, -0.246331761062075,
              0.357208872795928},
};

/* Kahan & Li 1997, Math. Comput. 66, 1089: s9odr6a and s17odr8a. */
static const row kahan_li_6 = {
    .drifts = 9,
    .drift = {0.39216144400731413928, 0.33259913678935943860, -0.70624617255763935981,
              0.08221359629355080023},
};
static const row kahan_li_8 = {
    .drifts = 17,
    .drift = {0.13020248308889008088, 0.56116298177510838456, -0.38947496264484728641,
              0.15884190655515560090, -0.39590389413323757734, 0.18453964097831570709,
              0.25837438768632204729, 0.29501172360931029887},
};

size_t prototype_methods(method *list) {
  static const struct {
    const char *name;
    const row *row;
  } rows[] = {{"Verlet", &verlet}, {"PEFRL", &pefrl},           {"SRKN4", &srkn4},
              {"SRKN6", &srkn6},   {"Kahan-Li 6", &kahan_li_6}, {"Kahan-Li 8", &kahan_li_8},
              {"RK4", NULL}};
  const size_t n = sizeof rows / sizeof *rows;
  for (size_t i = 0; i < n; i++)
    list[i] = (method){.family = "prototype",
                       .name = rows[i].name,
                       .row = rows[i].row,
                       .open = open_bare,
                       .run = rows[i].row ? run_splitting : run_rk4,
                       .close = close_bare};
  return n;
}
