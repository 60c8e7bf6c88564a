/* hash.c - a number for a scene: equal for equal masses, springs, forces, supports and times. */
#include "accuracy/setting.h"

#include "scene/scene.h"

#include <string.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))

/* Byte by byte; numbers go word by word. */
static uint64_t add(uint64_t hash, const void *bytes, size_t size) {
  const unsigned char *byte = bytes;
  for (size_t i = 0; i < size; i++) hash = msri_hash(hash, byte[i]);
  return hash;
}

static uint64_t add_picture(uint64_t hash, const msr_picture *picture) {
  const uint64_t sides[] = {picture->width, picture->height};
  hash = msri_hash_words(hash, sides, COUNT(sides));
  return add(hash, picture->rgb, 3 * picture->width * picture->height);
}

static uint64_t add_mass(uint64_t hash, const msr_mass *mass) {
  const double numbers[] = {mass->x, mass->y, mass->vx, mass->vy, mass->m};
  return add(msri_hash_words(hash, numbers, COUNT(numbers)), mass->rgb, sizeof mass->rgb);
}

static uint64_t add_spring(uint64_t hash, const msri_scene_spring *spring) {
  const uint64_t ends[] = {spring->i, spring->j};
  const double numbers[] = {spring->k, spring->L};
  return msri_hash_words(msri_hash_words(hash, ends, COUNT(ends)), numbers, COUNT(numbers));
}

static uint64_t add_anchor(uint64_t hash, const msr_anchor *anchor) {
  const uint64_t i = anchor->i;
  const double numbers[] = {anchor->x, anchor->y, anchor->k, anchor->L};
  return msri_hash_words(add(hash, &i, sizeof i), numbers, COUNT(numbers));
}

static uint64_t add_force(uint64_t hash, const msri_scene_force *force) {
  hash = add(hash, force->force->name, strlen(force->force->name));
  return add(hash, force->params, force->force->params_size);
}

static uint64_t add_options(uint64_t hash, const msr_scene *scene) {
  const msr_conf *c = &scene->conf;
  const double numbers[] = {c->dt,          c->gravity,         c->mass,
                            c->stiffness,   scene->restitution, scene->friction,
                            scene->diameter};
  const uint64_t counts[] = {c->iterations, c->images, (uint64_t)scene->options.neighbours,
                             scene->options.attach, scene->options.closed_border};
  return msri_hash_words(msri_hash_words(hash, numbers, COUNT(numbers)), counts, COUNT(counts));
}

uint64_t msri_scene_hash(const msr_scene *scene) {
  uint64_t hash = add_options(MSRI_HASH_START, scene);
  if (scene->picture) hash = add_picture(hash, scene->picture);
  for (size_t i = 0; i < scene->n_masses; i++) hash = add_mass(hash, &scene->mass[i]);
  for (size_t i = 0; i < scene->n_springs; i++) hash = add_spring(hash, &scene->spring[i]);
  for (size_t i = 0; i < scene->n_anchors; i++) hash = add_anchor(hash, &scene->anchor[i]);
  for (size_t i = 0; i < scene->n_forces; i++) hash = add_force(hash, &scene->force[i]);
  return hash;
}
