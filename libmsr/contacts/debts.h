/* debts.h - what masses that met something are owed: v += (x, y) times the acceleration at the end
 * of the step, coordinate by coordinate. A list, as few masses meet anything in one step; it grows
 * by doubling, so that after some steps nothing is allocated. */
#ifndef MSRI_DEBTS_H
#define MSRI_DEBTS_H

#include "base/base.h"

typedef struct msri_debt {
  size_t mass;
  double x, y; /* [s] */
} msri_debt;

/* All 0 is an empty list. */
typedef struct msri_debts {
  msri_debt *debt; /* [capacity], n of them used */
  size_t n, capacity;
  msr_status status; /* MSR_ENOMEM: some debts are lost */
} msri_debts;

void msri_debts_add(msri_debts *debts, size_t mass, double x, double y);

/* A mass is owed nothing after all; masses of the list must ascend. */
void msri_debts_cancel(msri_debts *debts, size_t mass);

/* vx, vy and ax, ay are those of mass `first` and on, that of all debts. What the status was;
 * after it the list is empty, and all is well. */
msr_status msri_debts_pay(msri_debts *debts, size_t first, const double *ax, const double *ay,
                          double *vx, double *vy);

void msri_debts_clear(msri_debts *debts);

#endif
