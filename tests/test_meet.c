/* test_meet.c - cells past supports: whatever their masses do, in whatever order what is known of
 * them is kept or forgotten, no mass passes a support untested. Against a kick, a drift that tests
 * all masses, and debts that are paid one by one: bit for bit. */
#include "scenes.h"

#include "plan/plan.h"
#include "sweep/meet.h"

enum { CELLS = 16, BLOCKS = CELLS / MSRI_LANES, AROUND = 8, SIZE = CELLS + 2 * AROUND, SIDE = 40 };

/* Masses without springs. */
typedef struct crowd {
  double x[SIZE], y[SIZE], vx[SIZE], vy[SIZE];
} crowd;

/* Black pixels at random, one of them at (column, row) from the bottom; and a mass, so that there
 * is a plan. */
static msr_plan *plan_at_random(uint64_t *dice, int n, size_t column, size_t row) {
  const msr_conf conf = {0.005, 9.8, 0.1, 300, 1, 1};
  const msr_scene_options options = {.closed_border = n % 2};
  msr_picture *p;
  msr_plan *plan;
  must(msr_picture_create(SIDE, SIDE, &p, &why));
  for (size_t i = 0; i < SIDE * SIDE; i++)
    memcpy(p->rgb + 3 * i, rgb_of(random_below(dice, 600) ? '.' : '#'), 3);
  memcpy(p->rgb, rgb_of('o'), 3);
  memcpy(p->rgb + 3 * ((SIDE - 1 - row) * SIDE + column), rgb_of('#'), 3);
  msr_scene *scene = scene_from(p, &conf, &options);
  must(msr_scene_set_contact(scene, n % 3 ? 1 : 0.5, n % 3 ? 0 : 0.2, &why));
  must(msr_plan_create(
      scene,
      &(msr_plan_options){.integrator = &msr_integrator_verlet,
                          .substeps = 1,
                          .impacts = n / 2 % 2 ? MSR_IMPACTS_LOCATED : MSR_IMPACTS_KEPT},
      &plan, &why));
  msr_scene_free(scene);
  return plan;
}

/* ---- Cells, and what is done to them */

typedef struct trial {
  msr_plan *plan;
  msri_pass pass;
  msri_stage stage;
  crowd watched, tested;
  size_t n_blocks;
  msri_block block[BLOCKS];
  double pulls[4][SIZE], gone, until[BLOCKS], *memory;
  msri_tally tally;
  msri_meet meet;
  msri_debt debt[CELLS];
  msri_debts debts;
  uint64_t met;
  double x, y; /* of a support */
} trial;

static bool is_mass(const trial *t, size_t cell) {
  for (size_t b = 0; b < t->n_blocks; b++)
    if (t->block[b].cell == cell / MSRI_LANES * MSRI_LANES)
      return t->block[b].mass >> cell % MSRI_LANES & 1;
  return false;
}

/* Blocks are close together, as masses are that springs tie, or not; some are full. */
static void place_cells(trial *t, uint64_t *dice) {
  crowd *c = &t->watched;
  const double speed = pow(10, uniform(dice, -2, 3));
  t->n_blocks = 0;
  for (uint32_t cell = 0; cell < CELLS; cell += MSRI_LANES) {
    const unsigned mass = random_below(dice, 2) ? UINT8_MAX : (unsigned)random_below(dice, 256);
    if (mass) t->block[t->n_blocks++] = (msri_block){cell, (uint8_t)mass, {0}, {0}};
    const double far = random_below(dice, 2) ? 1 : 12;
    const double x = uniform(dice, 0, SIDE), y = uniform(dice, 0, SIDE);
    for (size_t k = AROUND + cell; mass && k < AROUND + cell + MSRI_LANES; k++) {
      if (!(mass >> (k - AROUND - cell) & 1)) continue;
      c->x[k] = x + uniform(dice, 0, far), c->y[k] = y + uniform(dice, 0, far);
      c->vx[k] = uniform(dice, -speed, speed), c->vy[k] = uniform(dice, -speed, speed);
    }
  }
  t->tested = *c;
}

/* Those that run here, in turn. */
static const msri_lattice_kernel *kernel_here(size_t n) {
  const msri_lattice_kernel *widest = msri_lattice_widest();
  size_t kernels = 1;
  while (widest[kernels - 1].runs_here) kernels++;
  return &widest[n % kernels];
}

static void open_trial(trial *t, uint64_t *dice, int n) {
  const msri_lattice_kernel *kernel = kernel_here((size_t)n);
  const size_t column = 1 + random_below(dice, SIDE - 1), row = random_below(dice, SIDE);
  const double most = random_below(dice, 4) ? 5 : 5000;
  memset(t, 0, sizeof *t);
  t->x = (double)column + 0.5, t->y = (double)row + 0.5;
  t->plan = plan_at_random(dice, n, column, row);
  t->pass = (msri_pass){.plan = t->plan,
                        .loops = &kernel->four,
                        .fastest = kernel->fastest,
                        .ways = MSRI_BELOW + 1,
                        .besides = MSRI_WITH_WEIGHT,
                        .meets = true};
  t->stage =
      (msri_stage){.forces = true,
                   .motion = {.k = 1,
                              .L = {1, 1},
                              .w = 10,
                              .weight = {uniform(dice, -most, most), uniform(dice, -most, most)},
                              .kick = {0.001, 0.001},
                              .drift = 0.002,
                              .keep = {1, 1}}};
  place_cells(t, dice);
  const size_t stage = msri_meet_stage_size(CELLS);
  t->memory = zeroed(stage + msri_meet_size(CELLS, CELLS), sizeof *t->memory);
  t->meet = msri_meet_place(CELLS, CELLS, t->memory, t->memory + stage, &t->tally);
  t->debts = (msri_debts){t->debt, 0, CELLS, MSR_OK};
}

static void close_trial(trial *t) {
  free(t->memory);
  msr_plan_free(t->plan);
}

static msri_cells cells_of(trial *t) {
  crowd *c = &t->watched;
  msri_cells s = {.n = CELLS,
                  .x = c->x + AROUND,
                  .y = c->y + AROUND,
                  .vx = c->vx + AROUND,
                  .vy = c->vy + AROUND,
                  .below_x = c->x + AROUND,
                  .below_y = c->y + AROUND,
                  .block = t->block,
                  .blocks = t->n_blocks};
  s.pull[MSRI_BELOW] = (msri_pull){t->pulls[0] + AROUND, t->pulls[1] + AROUND};
  s.back[MSRI_BELOW] = t->pulls[2] - t->pulls[0];
  return s;
}

/* All that was owed is paid before the first kick. */
static void step_tested(trial *t) {
  const msri_motion *m = &t->stage.motion;
  const msri_contact *contact = &t->plan->contact;
  crowd *c = &t->tested;
  double ax[SIZE] = {0}, ay[SIZE] = {0};
  for (size_t k = AROUND; k < AROUND + CELLS; k++)
    if (is_mass(t, k - AROUND)) ax[k] = m->weight[0] * m->w, ay[k] = m->weight[1] * m->w;
  must(msri_debts_pay(&t->debts, 0, ax + AROUND, ay + AROUND, c->vx + AROUND, c->vy + AROUND));
  for (size_t k = AROUND; k < AROUND + CELLS; k++)
    for (int n = 0; n < 2; n++) c->vx[k] += m->kick[n] * ax[k], c->vy[k] += m->kick[n] * ay[k];
  for (size_t k = 0; k < CELLS; k++) {
    const size_t at = AROUND + k;
    const msri_flock one = {1,          k,          c->x + at,  c->y + at, c->vx + at,
                            c->vy + at, c->vx + at, c->vy + at, ax + at,   ay + at};
    if (!is_mass(t, k)) continue;
    if (m->drift != 0)
      t->met += contact->drift(contact->self, m->drift, &one, &t->debts);
    else // of what is infinite comes what is no number
      c->x[at] += 0 * c->vx[at], c->y[at] += 0 * c->vy[at];
  }
}

/* A mass is where there is no place, or goes where there is none. */
static void spoil(trial *t, uint64_t *dice) {
  static const double odd[] = {NO_NUMBER, NO_NUMBER, NO_NUMBER, NO_NUMBER, INFINITE, -INFINITE,
                               DBL_MAX,   1e200,     0x1p22,    -0x1p23,   0x1p52};
  const size_t k = random_below(dice, CELLS), what = random_below(dice, 4);
  double *const watched[] = {t->watched.x, t->watched.y, t->watched.vx, t->watched.vy};
  double *const tested[] = {t->tested.x, t->tested.y, t->tested.vx, t->tested.vy};
  if (!is_mass(t, k)) return;
  watched[what][AROUND + k] = tested[what][AROUND + k] = odd[random_below(dice, LENGTH(odd))];
  if (what < 2) memset(t->until, 0, sizeof t->until), t->meet.near.known = false;
}

/* The masses of a block, or of all, or one, set out for some place in the picture, or for a
 * support: to be there in a step or two, or after many. */
static void set_out(trial *t, uint64_t *dice) {
  const double steps = pow(10, uniform(dice, 0, 3)), h = 0.002;
  const size_t first = random_below(dice, CELLS);
  const size_t count = (size_t[]){1, MSRI_LANES, CELLS}[random_below(dice, 3)];
  const bool aims = random_below(dice, 2);
  const double x = aims ? t->x : uniform(dice, 0, SIDE), y = aims ? t->y : uniform(dice, 0, SIDE);
  for (size_t k = first / count * count; k < first / count * count + count && k < CELLS; k++) {
    const size_t at = AROUND + k;
    if (!is_mass(t, k)) continue;
    t->watched.vx[at] = t->tested.vx[at] = (x - t->tested.x[at]) / (steps * h);
    t->watched.vy[at] = t->tested.vy[at] = (y - t->tested.y[at]) / (steps * h);
  }
}

/* The sign of what is no number is the compiler's. */
static void assert_same(const crowd *a, const crowd *b) {
  const double *const of[2][4] = {{a->x, a->y, a->vx, a->vy}, {b->x, b->y, b->vx, b->vy}};
  for (int what = 0; what < 4; what++)
    for (size_t k = 0; k < SIZE; k++)
      if (!isnan(of[0][what][k]) || !isnan(of[1][what][k]))
        assert_memory_equal(&of[0][what][k], &of[1][what][k], sizeof(double));
}

static void no_mass_passes_untested(void **state) {
  (void)state;
  static const double drifts[] = {0, 0.001, -0.002, 0.02, 1e-300};
  uint64_t dice = 1, met = 0, spared = 0;
  for (int n = 0; n < 3000; n++) {
    trial t;
    open_trial(&t, &dice, n);
    msri_near_open(&t.meet.near, CELLS, &t.gone, t.until);
    const msri_cells cells = cells_of(&t);
    bool set_out_before = false;
    for (int step = 0; step < 500; step++) {
      const bool sets_out = random_below(&dice, set_out_before ? 2 : 30) == 0;
      if (sets_out) set_out(&t, &dice);
      set_out_before = sets_out;
      if (random_below(&dice, 8) == 0) msri_near_open(&t.meet.near, CELLS, &t.gone, t.until);
      if (n % 3 == 0 && random_below(&dice, 100) == 0) spoil(&t, &dice);
      t.stage.motion.drift = random_below(&dice, 20) ? 0.002 : drifts[random_below(&dice, 5)];
      step_tested(&t);
      msri_meet_step(&t.pass, &t.stage, &cells, &t.meet);
      assert_same(&t.watched, &t.tested);
      assert_int_equal(t.tally.met, t.met);
      for (size_t b = 0; b < t.n_blocks; b++)
        spared += !t.meet.near.block[t.block[b].cell / MSRI_LANES];
    }
    met += t.met;
    close_trial(&t);
  }
  assert_true(met > 100000 && spared > 300000);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(no_mass_passes_untested)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
