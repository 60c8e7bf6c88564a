/* scene.c - what there is: an empty scene, and what a program sets in it, adds and asks. */
#include "scene/scene.h"

#include "formats/conf.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const msr_conf empty_conf = {.dt = 0.005, .mass = 1, .iterations = 1, .images = 1};

msr_status msr_scene_create(msr_scene **scene, msr_error *err) {
  msr_scene *made = msri_alloc(1, sizeof *made, "a scene", err);
  if (!made) return MSR_ENOMEM;
  made->conf = empty_conf;
  made->restitution = 1;
  *scene = made;
  return MSR_OK;
}

void msr_scene_free(msr_scene *scene) {
  if (!scene) return;
  for (size_t i = 0; i < scene->n_forces; i++) free(scene->force[i].params);
  free(scene->force);
  free(scene->anchor);
  free(scene->spring);
  free(scene->mass);
  msri_grid_free(scene->grid);
  msri_notes_clear(&scene->notes);
  free(scene);
}

/* ---- What a program sets and adds */

msr_status msr_scene_set_times(msr_scene *scene, double dt, uint64_t iterations, uint64_t images,
                               msr_error *err) {
  msr_conf conf = empty_conf;
  conf.dt = dt;
  conf.iterations = iterations;
  conf.images = images;
  const msr_status status = msri_conf_check("times", &conf, err);
  if (status != MSR_OK) return status;
  scene->conf.dt = dt;
  scene->conf.iterations = iterations;
  scene->conf.images = images;
  return MSR_OK;
}

msr_status msr_scene_set_contact(msr_scene *scene, double restitution, double friction,
                                 msr_error *err) {
  if (!(restitution >= 0 && restitution <= 1))
    return msri_fail(err, MSR_EUSAGE, "restitution must be from 0 to 1, not %g", restitution);
  if (!(friction >= 0 && isfinite(friction)))
    return msri_fail(err, MSR_EUSAGE, "friction must be finite and 0 or more, not %g", friction);
  scene->restitution = restitution;
  scene->friction = friction;
  return MSR_OK;
}

msr_status msr_scene_set_collisions(msr_scene *scene, double diameter, msr_error *err) {
  if (!(diameter >= 0 && isfinite(diameter)))
    return msri_fail(err, MSR_EUSAGE, "a diameter must be finite and 0 or more, not %g", diameter);
  scene->diameter = diameter;
  return MSR_OK;
}

/* Is the point in a black pixel of the scene's picture, or beyond its closed border? */
static bool in_support(const msr_scene *scene, double x, double y) {
  const msr_picture *p = scene->picture;
  if (!p) return false;
  const bool inside = x >= 0 && x < (double)p->width && y >= 0 && y < (double)p->height;
  if (!inside) return scene->options.closed_border;
  return msri_pixel_at(p, (size_t)x, p->height - 1 - (size_t)y) == MSRI_SUPPORT;
}

static msr_status check_mass(const msr_scene *scene, const msr_mass *m, msr_error *err) {
  const bool finite = isfinite(m->x) && isfinite(m->y) && isfinite(m->vx) && isfinite(m->vy);
  if (!finite) return msri_fail(err, MSR_EUSAGE, "a mass needs a finite position and velocity");
  if (!(m->m > 0 && isfinite(m->m)))
    return msri_fail(err, MSR_EUSAGE, "a mass must be finite and above 0, not %g", m->m);
  if (in_support(scene, m->x, m->y))
    return msri_fail(err, MSR_EUSAGE, "a mass at (%g, %g) is inside a support", m->x, m->y);
  return MSR_OK;
}

msr_status msr_scene_add_mass(msr_scene *scene, const msr_mass *mass, size_t *index,
                              msr_error *err) {
  const msr_status status = check_mass(scene, mass, err);
  if (status != MSR_OK) return status;
  msr_mass *grown = msri_grow(scene->mass, &scene->mass_capacity, scene->n_masses + 1,
                              sizeof *grown, "masses", err);
  if (!grown) return MSR_ENOMEM;
  scene->mass = grown;
  grown[scene->n_masses++] = *mass;
  if (index) *index = msr_scene_masses(scene) - 1;
  return MSR_OK;
}

static msr_status check_spring(const msr_scene *scene, size_t i, double k, double L,
                               msr_error *err) {
  const size_t n = msr_scene_masses(scene);
  if (i >= n) return msri_fail(err, MSR_EUSAGE, "a spring at mass %zu: there are %zu", i, n);
  if (!(k >= 0 && isfinite(k)))
    return msri_fail(err, MSR_EUSAGE, "a stiffness must be finite and 0 or more, not %g", k);
  if (!(L >= 0 && isfinite(L)))
    return msri_fail(err, MSR_EUSAGE, "a rest length must be finite and 0 or more, not %g", L);
  return MSR_OK;
}

msr_status msr_scene_add_spring(msr_scene *scene, size_t i, size_t j, double k, double L,
                                msr_error *err) {
  msr_status status = check_spring(scene, i, k, L, err);
  if (status == MSR_OK) status = check_spring(scene, j, k, L, err);
  if (status != MSR_OK) return status;
  if (i == j) return msri_fail(err, MSR_EUSAGE, "a spring from mass %zu to itself", i);
  msri_scene_spring *grown = msri_grow(scene->spring, &scene->spring_capacity, scene->n_springs + 1,
                                       sizeof *grown, "springs", err);
  if (!grown) return MSR_ENOMEM;
  scene->spring = grown;
  grown[scene->n_springs++] = (msri_scene_spring){i < j ? i : j, i < j ? j : i, k, L};
  return MSR_OK;
}

msr_status msr_scene_add_anchor(msr_scene *scene, const msr_anchor *anchor, msr_error *err) {
  const msr_status status = check_spring(scene, anchor->i, anchor->k, anchor->L, err);
  if (status != MSR_OK) return status;
  if (!(isfinite(anchor->x) && isfinite(anchor->y)))
    return msri_fail(err, MSR_EUSAGE, "an anchor needs a finite position");
  msr_anchor *grown = msri_grow(scene->anchor, &scene->anchor_capacity, scene->n_anchors + 1,
                                sizeof *grown, "anchors", err);
  if (!grown) return MSR_ENOMEM;
  scene->anchor = grown;
  grown[scene->n_anchors++] = *anchor;
  return MSR_OK;
}

static msr_status check_force(const msr_force *force, const void *params, msr_error *err) {
  if (!force || !force->name || !force->summary || !force->add)
    return msri_fail(err, MSR_EUSAGE, "a force needs at least name, summary and add");
  if (force == &msr_force_springs)
    return msri_fail(err, MSR_EUSAGE, "every scene has its springs already");
  if (force->conservative != (force->energy != NULL))
    return msri_fail(err, MSR_EUSAGE, "force %s: conservative goes with energy", force->name);
  if (force->params_size > 0 && !params)
    return msri_fail(err, MSR_EUSAGE, "force %s needs its parameters", force->name);
  if (!force->check) return MSR_OK;
  msr_error said = {MSR_OK, ""};
  const msr_status status = force->check(params, &said);
  if (status == MSR_OK) return MSR_OK;
  return msri_hand_on(err, status, &said, "force %s: %s", force->name, msr_status_text(status));
}

msr_status msr_scene_add_force(msr_scene *scene, const msr_force *force, const void *params,
                               msr_error *err) {
  const msr_status status = check_force(force, params, err);
  if (status != MSR_OK) return status;
  msri_scene_force *grown = msri_grow(scene->force, &scene->force_capacity, scene->n_forces + 1,
                                      sizeof *grown, "forces", err);
  if (!grown) return MSR_ENOMEM;
  scene->force = grown;
  void *copy = msri_alloc(1, force->params_size, "a force's parameters", err);
  if (!copy) return MSR_ENOMEM;
  if (force->params_size > 0) memcpy(copy, params, force->params_size);
  grown[scene->n_forces++] = (msri_scene_force){force, copy};
  return MSR_OK;
}

/* ---- Questions */

const char *msr_scene_warning(const msr_scene *scene, size_t i) {
  return msri_notes_at(&scene->notes, i);
}

size_t msr_scene_masses(const msr_scene *scene) { return scene->n_picture + scene->n_masses; }

msr_status msr_scene_mass_at(const msr_scene *scene, size_t column, size_t row, size_t *index,
                             msr_error *err) {
  const msr_picture *p = scene->picture;
  if (!p || column >= p->width || row >= p->height)
    return msri_fail(err, MSR_EUSAGE, "pixel (%zu,%zu) is outside the picture of %zu x %zu", column,
                     row, p ? p->width : 0, p ? p->height : 0);
  if (msri_pixel_at(p, column, row) != MSRI_MASS)
    return msri_fail(err, MSR_EUSAGE, "pixel (%zu,%zu) is no mass", column, row);
  *index = msri_grid_mass(scene->grid, column, row);
  return MSR_OK;
}
