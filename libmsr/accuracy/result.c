/* result.c - what a study says: points in order, measured orders, the front, the answer. */
#include "accuracy/result.h"

#include <math.h>
#include <stdlib.h>

msr_status msri_result_add(msr_accuracy *made, const msr_accuracy_point *point, msr_error *err) {
  msr_accuracy_point *grown =
      msri_grow(made->point, &made->capacity, made->n + 1, sizeof *point, "the points", err);
  if (!grown) return MSR_ENOMEM;
  made->point = grown;
  made->point[made->n++] = *point;
  return MSR_OK;
}

bool msri_result_has(const msr_accuracy *made, const msr_accuracy_point *point) {
  for (size_t i = 0; i < made->n; i++) {
    const msr_accuracy_point *p = &made->point[i];
    if (p->integrator == point->integrator && p->substeps == point->substeps &&
        p->steps == point->steps && p->evaluations == point->evaluations && p->stable &&
        p->max <= point->max && p->max >= point->max)
      return true;
  }
  return false;
}

/* Does a come before b, given the order of methods? */
static bool before(const msr_integrator *const *order, const msr_accuracy_point *a,
                   const msr_accuracy_point *b) {
  if (a->integrator == b->integrator)
    return a->integrator->adaptive ? a->atol > b->atol : a->substeps < b->substeps;
  size_t i = 0;
  while (order[i] != a->integrator && order[i] != b->integrator) i++;
  return order[i] == a->integrator;
}

static void sort(msr_accuracy *made, const msr_integrator *const *order) {
  msr_accuracy_point *p = made->point;
  for (size_t i = 1; i < made->n; i++)
    for (size_t j = i; j > 0 && before(order, &p[j], &p[j - 1]); j--) {
      const msr_accuracy_point swap = p[j];
      p[j] = p[j - 1];
      p[j - 1] = swap;
    }
}

/* log of the ratio of errors over that of steps. */
static void find_orders(msr_accuracy *made) {
  for (size_t i = 1; i < made->n; i++) {
    const msr_accuracy_point *a = &made->point[i - 1];
    msr_accuracy_point *b = &made->point[i];
    const bool comparable = a->integrator == b->integrator && !b->integrator->adaptive;
    if (comparable && a->stable && b->stable && a->max > 0 && b->max > 0)
      b->order = log(a->max / b->max) / log((double)b->substeps / (double)a->substeps);
  }
}

/* An error below the reference's own can't be told from it. */
static double error_of(const msr_accuracy *made, const msr_accuracy_point *p) {
  return msri_max(p->max, made->figures.reference_error);
}

static bool beats(const msr_accuracy *made, const msr_accuracy_point *a,
                  const msr_accuracy_point *b) {
  if (!a->stable) return false;
  const double x = error_of(made, a), y = error_of(made, b);
  return x <= y && a->seconds <= b->seconds && (x < y || a->seconds < b->seconds);
}

static void find_front(msr_accuracy *made) {
  for (size_t i = 0; i < made->n; i++) {
    msr_accuracy_point *p = &made->point[i];
    p->front = p->stable;
    for (size_t j = 0; j < made->n && p->front; j++) p->front = !beats(made, &made->point[j], p);
  }
}

void msri_result_finish(msr_accuracy *made, const msr_integrator *const *order) {
  sort(made, order);
  find_orders(made);
  find_front(made);
}

void msr_accuracy_free(msr_accuracy *accuracy) {
  if (!accuracy) return;
  free(accuracy->point);
  free(accuracy);
}

msr_accuracy_figures msr_accuracy_describe(const msr_accuracy *accuracy) {
  return accuracy->figures;
}

const msr_accuracy_point *msr_accuracy_points(const msr_accuracy *accuracy, size_t *n) {
  *n = accuracy->n;
  return accuracy->point;
}

const msr_accuracy_point *msr_accuracy_cheapest(const msr_accuracy *accuracy, double error) {
  const msr_accuracy_point *best = NULL;
  for (size_t i = 0; i < accuracy->n; i++) {
    const msr_accuracy_point *p = &accuracy->point[i];
    const bool good = p->stable && p->max + accuracy->figures.reference_error <= error;
    if (good && (!best || p->seconds < best->seconds)) best = p;
  }
  return best;
}
