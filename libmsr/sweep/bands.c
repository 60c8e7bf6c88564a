/* bands.c - see bands.h, and rows.c for how parts share a pass. At each stage the springs of a band
 * pull at its masses and at those of the next; then the band moves, and what is known of the forces
 * on the next takes the place of its own: sums are in the order of the springs. Between passes no
 * force is left. */
#include "sweep/bands.h"

#include "base/team.h"
#include "base/vector.h"
#include "forces/motion.h"

#include <stdatomic.h>
#include <string.h>

enum { LEAST = 4 }; /* bands of a part */

static const size_t cache =
    (size_t)640 * 1024; /* bytes of a core's own, what else is needed left out */

/* A part's work. */
typedef struct wave {
  const msri_pass *pass;
  const msri_bands *bands;
  const msri_part *part;
  const msri_springs_kernel *springs;
  double fastest;
} wave;

/* ---- Memory */

/* Each part begins a stage with springs of the band above, which another goes over, too: of few
 * bands that is much, and threads would wait for each other too often. */
unsigned msri_bands_parts(const msri_bands *bands, unsigned threads) {
  const size_t most = bands->n / LEAST;
  return most < 2 ? 1 : most < threads ? (unsigned)most : threads;
}

/* Of a band: x, y, vx, vy and, at each stage, forces on two. */
int msri_bands_stages(const msri_bands *bands, unsigned parts) {
  const size_t fit = cache / (8 * bands->length * sizeof(double));
  const size_t most = parts > 1 ? bands->n / (2 * (size_t)parts) : bands->n;
  const size_t stages = msri_lesser(msri_lesser(fit, most), MSRI_ROWS_STAGES);
  return stages < 1 ? 1 : (int)stages;
}

/* Masses of a band and the one after it. */
static size_t reach(const msri_bands *bands) {
  return bands->n > 1 ? 2 * bands->length : bands->length;
}

/* Of a stage: forces, and places for the part above. */
static size_t stage_size(const msri_bands *bands, size_t parts) {
  return (parts > 1 ? 4 : 2) * reach(bands);
}

size_t msri_bands_size(const msri_bands *bands, unsigned parts, int stages) {
  return (size_t)stages * stage_size(bands, parts);
}

/* On two bands along x, then y. */
static double *forces_at(const wave *w, int stage) {
  const msri_part *part = w->part;
  return part->memory[part->number] + (size_t)stage * stage_size(w->bands, part->parts);
}

/* x of two bands, then y, as they are when a stage of a part opens. */
static double *edge_at(const wave *w, size_t part, int stage) {
  const size_t size = stage_size(w->bands, w->part->parts);
  return w->part->memory[part] + (size_t)stage * size + 2 * reach(w->bands);
}

/* ---- Bands */

static size_t first_band(const wave *w, int stage) {
  const msri_part *part = w->part;
  return part->begin[part->number] + (part->number > 0 ? (size_t)stage : 0);
}

static bool is_last(const wave *w) { return w->part->number + 1 == w->part->parts; }

static size_t end_band(const wave *w, int stage) {
  return w->part->begin[w->part->number + 1] + (is_last(w) ? 0 : (size_t)stage);
}

/* Has the part below been at the next band before this stage? */
static bool is_left_behind(const wave *w, int stage, size_t band) {
  return band + 1 == end_band(w, stage) && !is_last(w);
}

static void pull(const wave *w, int stage, size_t band) {
  const size_t first = band * w->bands->length, wide = reach(w->bands);
  const bool behind = is_left_behind(w, stage, band);
  const double *x = w->pass->state->x + first, *y = w->pass->state->y + first;
  if (behind) x = edge_at(w, w->part->number + 1, stage), y = x + wide;
  double *f = forces_at(w, stage);
  w->springs->add(&w->bands->springs[band], x, y, f, f + wide);
}

static void move(wave *w, int stage, size_t band) {
  const msri_bands *bands = w->bands;
  const msri_swept *s = w->pass->state;
  const msri_motion *motion = &w->pass->stage[stage].motion;
  const size_t first = band * bands->length, n = msri_bands_masses(bands, band);
  double *fx = forces_at(w, stage), *fy = fx + reach(bands);
  const bool more = bands->n > 1;
  const msri_moved x = {n, s->x + first, s->vx + first, fx, more ? fx + bands->length : NULL};
  const msri_moved y = {n, s->y + first, s->vy + first, fy, more ? fy + bands->length : NULL};
  const int besides = msri_field_besides(w->pass, &w->pass->stage[stage]);
  w->fastest = msri_worse(msri_move(&x, motion, 0, besides), w->fastest);
  w->fastest = msri_worse(msri_move(&y, motion, 1, besides), w->fastest);
}

static void drift(const wave *w, int stage, size_t band) {
  const msri_swept *s = w->pass->state;
  const msri_motion *motion = &w->pass->stage[stage].motion;
  const size_t first = band * w->bands->length, n = msri_bands_masses(w->bands, band);
  msri_coast(n, motion, 0, s->vx + first, s->x + first);
  msri_coast(n, motion, 1, s->vy + first, s->y + first);
}

static void step_band(wave *w, int stage, size_t band) {
  if (!w->pass->stage[stage].forces) {
    drift(w, stage, band);
    return;
  }
  pull(w, stage, band);
  move(w, stage, band);
}

/* ---- The wave */

/* Keeps places of the first band of a stage and of the one above it, which stays behind, for the
 * part above. */
static void keep_places(const wave *w, int stage) {
  const size_t band = first_band(w, stage), length = w->bands->length;
  const size_t first = (band - 1) * length, n = length + msri_bands_masses(w->bands, band);
  double *x = edge_at(w, w->part->number, stage), *y = x + reach(w->bands);
  memcpy(x, w->pass->state->x + first, n * sizeof *x);
  memcpy(y, w->pass->state->y + first, n * sizeof *y);
}

/* The forces on it from the band above. */
static void pull_from_above(const wave *w, int stage) {
  const size_t length = w->bands->length;
  double *f = forces_at(w, stage);
  pull(w, stage, first_band(w, stage) - 1);
  for (int axis = 0; axis < 2; axis++, f += reach(w->bands)) {
    memcpy(f, f + length, length * sizeof *f);
    memset(f + length, 0, length * sizeof *f);
  }
}

static void begin_stage(const wave *w, int stage) {
  const msri_part *part = w->part;
  if (part->number == 0) return;
  if (w->pass->stage[stage].forces) {
    keep_places(w, stage);
    pull_from_above(w, stage);
  }
  if (stage + 1 == w->pass->stages)
    atomic_store_explicit(&part->opened[part->number], part->turn, memory_order_release);
}

/* What a part finds of the forces below its end is found there, too. */
static void end_stage(const wave *w, int stage) {
  if (!is_last(w)) memset(forces_at(w, stage), 0, 2 * reach(w->bands) * sizeof(double));
}

static void run(wave *w) {
  const msri_part *part = w->part;
  const size_t begin = part->begin[part->number], end = part->begin[part->number + 1];
  const size_t behind = (size_t)w->pass->stages - 1;
  for (size_t front = begin; front < end + behind + (is_last(w) ? 0 : behind); front++) {
    if (!is_last(w) && front + 1 == end)
      msri_team_wait(&part->opened[part->number + 1], part->turn);
    for (int s = 0; s < w->pass->stages && front >= first_band(w, s) + (size_t)s; s++) {
      const size_t band = front - (size_t)s;
      if (band >= end_band(w, s)) continue;
      if (band == first_band(w, s)) begin_stage(w, s);
      step_band(w, s, band);
      if (band + 1 == end_band(w, s)) end_stage(w, s);
    }
  }
}

double msri_bands_run(const msri_pass *pass, const msri_part *part) {
  wave w = {pass, &pass->plan->bands, part, msri_springs_widest(), 0};
  run(&w);
  return w.fastest;
}
