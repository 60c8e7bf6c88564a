/* sundials.c - SUNDIALS: explicit Runge-Kutta tables of ERKStep and CVODE's Adams methods; for
 * stiff problems CVODE's BDF and DIRK tables of ARKStep, their Newton equations solved by GMRES. */
#include "bench.h"
#include "sundials_vector.h"

#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <stdlib.h>
#include <string.h>
#include <sunlinsol/sunlinsol_spgmr.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

typedef struct sundials_run {
  problem *p;
  const struct package *package;
  SUNContext context;
  N_Vector y;
  SUNLinearSolver linear;       /* NULL: none */
  SUNNonlinearSolver nonlinear; /* NULL: its own */
  void *memory;
} sundials_run;

/* A package: how its memory is made, freed, and carried to T from the start that y holds. */
typedef struct package {
  void (*make)(sundials_run *r, int table, double tolerance);
  int (*solve)(sundials_run *r);
  void (*free)(void **memory);
} package;

typedef struct row {
  const char *name;
  const package *package;
  int table;
} row;

static int rhs(realtype t, N_Vector y, N_Vector dy, void *self) {
  (void)t;
  return differentiate(self, N_VGetArrayPointer(y), N_VGetArrayPointer(dy)) ? 0 : -1;
}

static void silent(int code, const char *module, const char *function, char *message, void *data) {
  (void)code, (void)module, (void)function, (void)message, (void)data;
}

static void check(int flag) {
  if (flag != 0) bench_fail("SUNDIALS can't be set up: %d", flag);
}

/* ---- ERKStep */

static void make_erk(sundials_run *r, int table, double tolerance) {
  r->memory = ERKStepCreate(rhs, 0, r->y, r->context);
  check(ERKStepSetTableNum(r->memory, (ARKODE_ERKTableID)table));
  check(ERKStepSStolerances(r->memory, 0, tolerance));
  check(ERKStepSetUserData(r->memory, r->p));
  check(ERKStepSetMaxNumSteps(r->memory, -1));
  check(ERKStepSetErrHandlerFn(r->memory, silent, NULL));
}

static int solve_erk(sundials_run *r) {
  double t = 0;
  check(ERKStepReInit(r->memory, rhs, 0, r->y));
  check(ERKStepSetStopTime(r->memory, r->p->T));
  return ERKStepEvolve(r->memory, r->p->T, r->y, &t, ARK_NORMAL);
}

static const package erk = {make_erk, solve_erk, ERKStepFree};

/* ---- ARKStep */

static void make_dirk(sundials_run *r, int table, double tolerance) {
  r->memory = ARKStepCreate(NULL, rhs, 0, r->y, r->context);
  r->linear = SUNLinSol_SPGMR(r->y, SUN_PREC_NONE, 0, r->context);
  check(ARKStepSetTableNum(r->memory, (ARKODE_DIRKTableID)table, ARKODE_ERK_NONE));
  check(ARKStepSStolerances(r->memory, 0, tolerance));
  check(ARKStepSetLinearSolver(r->memory, r->linear, NULL));
  check(ARKStepSetUserData(r->memory, r->p));
  check(ARKStepSetMaxNumSteps(r->memory, -1));
  check(ARKStepSetErrHandlerFn(r->memory, silent, NULL));
}

static int solve_dirk(sundials_run *r) {
  double t = 0;
  check(ARKStepReInit(r->memory, NULL, rhs, 0, r->y));
  check(ARKStepSetStopTime(r->memory, r->p->T));
  return ARKStepEvolve(r->memory, r->p->T, r->y, &t, ARK_NORMAL);
}

static const package dirk = {make_dirk, solve_dirk, ARKStepFree};

/* ---- CVODE */

static void make_cvode(sundials_run *r, int family, double tolerance) {
  r->memory = CVodeCreate(family, r->context);
  check(CVodeInit(r->memory, rhs, 0, r->y));
  check(CVodeSStolerances(r->memory, 0, tolerance));
  if (family == CV_ADAMS) {
    r->nonlinear = SUNNonlinSol_FixedPoint(r->y, 0, r->context);
    check(CVodeSetNonlinearSolver(r->memory, r->nonlinear));
  } else {
    r->linear = SUNLinSol_SPGMR(r->y, SUN_PREC_NONE, 0, r->context);
    check(CVodeSetLinearSolver(r->memory, r->linear, NULL));
  }
  check(CVodeSetUserData(r->memory, r->p));
  check(CVodeSetMaxNumSteps(r->memory, -1));
  check(CVodeSetErrHandlerFn(r->memory, silent, NULL));
}

static int solve_cvode(sundials_run *r) {
  double t = 0;
  check(CVodeReInit(r->memory, 0, r->y));
  check(CVodeSetStopTime(r->memory, r->p->T));
  return CVode(r->memory, r->p->T, r->y, &t, CV_NORMAL);
}

static const package cvode = {make_cvode, solve_cvode, CVodeFree};

/* ---- Runs */

static void *open_sundials(const method *self, problem *p, double knob) {
  const row *kind = self->row;
  sundials_run *r = need(1, sizeof *r);
  r->p = p;
  r->package = kind->package;
  check(SUNContext_Create(NULL, &r->context));
  r->y = vector_create(2 * p->n, r->context);
  kind->package->make(r, kind->table, knob);
  return r;
}

static bool run_sundials(void *object, double *z) {
  sundials_run *r = object;
  const size_t bytes = 2 * r->p->n * sizeof *z;
  memcpy(N_VGetArrayPointer(r->y), r->p->start, bytes);
  if (r->package->solve(r) < 0) return false;
  memcpy(z, N_VGetArrayPointer(r->y), bytes);
  return true;
}

static void close_sundials(void *object) {
  sundials_run *r = object;
  r->package->free(&r->memory);
  if (r->linear) SUNLinSolFree(r->linear);
  if (r->nonlinear) SUNNonlinSolFree(r->nonlinear);
  N_VDestroy(r->y);
  SUNContext_Free(&r->context);
  free(r);
}

static size_t list_rows(const row *rows, size_t n, method *list) {
  for (size_t i = 0; i < n; i++)
    list[i] = (method){.family = "SUNDIALS",
                       .name = rows[i].name,
                       .by_tolerance = true,
                       .row = &rows[i],
                       .open = open_sundials,
                       .run = run_sundials,
                       .close = close_sundials};
  return n;
}

size_t sundials_methods(method *list) {
  static const row rows[] = {{"Bogacki-Shampine 3", &erk, ARKODE_BOGACKI_SHAMPINE_4_2_3},
                             {"Cash-Karp 5", &erk, ARKODE_CASH_KARP_6_4_5},
                             {"Dormand-Prince 5", &erk, ARKODE_DORMAND_PRINCE_7_4_5},
                             {"Verner 6", &erk, ARKODE_VERNER_8_5_6},
                             {"Fehlberg 8", &erk, ARKODE_FEHLBERG_13_7_8},
                             {"CVODE Adams", &cvode, CV_ADAMS}};
  return list_rows(rows, sizeof rows / sizeof *rows, list);
}

size_t sundials_stiff_methods(method *list) {
  static const row rows[] = {{"CVODE BDF", &cvode, CV_BDF}, {"DIRK 4", &dirk, ARKODE_SDIRK_5_3_4}};
  return list_rows(rows, sizeof rows / sizeof *rows, list);
}

const char *sundials_version(void) { return SUNDIALS_VERSION; }
