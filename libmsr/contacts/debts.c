/* debts.c - see debts.h. */
#include "contacts/debts.h"

#include <stdlib.h>

void msri_debts_add(msri_debts *debts, size_t mass, double x, double y) {
  msri_debt *grown = msri_grow(debts->debt, &debts->capacity, debts->n + 1, sizeof *grown,
                               "what impacts owe", NULL);
  if (!grown) {
    debts->status = MSR_ENOMEM;
    return;
  }
  debts->debt = grown;
  debts->debt[debts->n++] = (msri_debt){mass, x, y};
}

static int compare(const void *mass, const void *debt) {
  const size_t a = *(const size_t *)mass, b = ((const msri_debt *)debt)->mass;
  return (a > b) - (a < b);
}

void msri_debts_cancel(msri_debts *debts, size_t mass) {
  if (debts->n == 0) return;
  msri_debt *found = bsearch(&mass, debts->debt, debts->n, sizeof *found, compare);
  if (found) found->x = found->y = 0;
}

msr_status msri_debts_pay(msri_debts *debts, size_t first, const double *ax, const double *ay,
                          double *vx, double *vy) {
  const msr_status status = debts->status;
  for (size_t k = 0; k < debts->n; k++) {
    const msri_debt *d = &debts->debt[k];
    const size_t i = d->mass - first;
    vx[i] += d->x * ax[i];
    vy[i] += d->y * ay[i];
  }
  debts->n = 0;
  debts->status = MSR_OK;
  return status;
}

void msri_debts_clear(msri_debts *debts) {
  free(debts->debt);
  *debts = (msri_debts){0};
}
