/* scene.c - the scene of a row: a program's own, or from a picture; where masses move at the start,
 * or aren't as drawn, a program adds them to the picture's supports. */
#include "suite.h"

/* Every `step`-th pixel. */
static msr_picture *thinned(const msr_picture *p, size_t step) {
  msr_picture *small;
  must(msr_picture_create(p->width / step, p->height / step, &small, &why));
  for (size_t row = 0; row < small->height; row++)
    for (size_t column = 0; column < small->width; column++)
      memcpy(small->rgb + 3 * (row * small->width + column),
             p->rgb + 3 * (row * step * p->width + column * step), 3);
  return small;
}

static msr_picture *assignment(bool brief) {
  msr_picture *whole;
  must(msr_picture_read("examples/scenes/assignment.ppm", &whole, NULL, &why));
  if (!brief) return whole;
  msr_picture *small = thinned(whole, 4);
  msr_picture_free(whole);
  return small;
}

static void add_forces(const hard_case *row, msr_scene *scene) {
  if (row->damping > 0) add_force(scene, &msr_force_damping, &(msr_damping){row->damping});
  if (row->drag > 0) add_force(scene, &msr_force_drag, &(msr_drag){row->drag});
  if (row->wind != 0 || row->gust > 0)
    add_force(scene, &msr_force_wind, &(msr_wind){.speed = row->wind, .gust = row->gust});
  if (row->push != 0) add_force(scene, &msr_force_push, &(msr_push){.fx = row->push});
}

/* ---- Masses by a program */

static bool is_mass(const msr_picture *p, size_t pixel) {
  const unsigned char *rgb = p->rgb + 3 * pixel;
  return rgb[0] > rgb[2];
}

/* Their number; mass [width * height], in reading order. */
static size_t find_masses(const hard_case *row, const msr_picture *p, msr_mass *mass) {
  size_t n = 0;
  for (size_t pixel = 0; pixel < p->width * p->height; pixel++) {
    if (!is_mass(p, pixel)) continue;
    const double x = (double)(pixel % p->width) + 0.5;
    const double y = (double)(p->height - pixel / p->width) - 0.5;
    mass[n++] = (msr_mass){x, y, row->vx, row->vy, row->conf.mass, {200, 0, 0}};
  }
  return n;
}

/* As drawn, to the right and downwards; with 8 neighbours, to both diagonals below, too. */
static void tie_all(const hard_case *row, msr_scene *scene, size_t n, const msr_mass *mass) {
  const double reach = row->scene.neighbours == 8 ? 1.5 : 1.1;
  for (size_t i = 0; i < n; i++)
    for (size_t j = i + 1; j < n; j++) {
      const double l = hypot(mass[j].x - mass[i].x, mass[j].y - mass[i].y);
      if (l < reach) must(msr_scene_add_spring(scene, i, j, row->conf.stiffness, l, &why));
    }
}

static msr_scene *by_program(const hard_case *row, const msr_picture *picture,
                             const msr_conf *conf) {
  const size_t pixels = picture->width * picture->height;
  msr_picture *supports;
  must(msr_picture_create(picture->width, picture->height, &supports, &why));
  for (size_t p = 0; p < pixels; p++)
    if (!is_mass(picture, p)) memcpy(supports->rgb + 3 * p, picture->rgb + 3 * p, 3);
  msr_scene *scene = scene_from(supports, conf, &row->scene);
  msr_mass *drawn = zeroed(pixels, sizeof *drawn), *placed = zeroed(pixels, sizeof *placed);
  const size_t n = find_masses(row, picture, drawn);
  memcpy(placed, drawn, n * sizeof *placed);
  if (row->place) row->place(n, placed);
  for (size_t i = 0; i < n; i++) must(msr_scene_add_mass(scene, &placed[i], NULL, &why));
  tie_all(row, scene, n, drawn);
  free(drawn);
  free(placed);
  return scene;
}

/* ---- The scene */

msr_status make_scene(const hard_case *row, bool brief, msr_picture **picture, msr_scene **scene) {
  msr_status status = MSR_OK;
  msr_conf conf = row->conf;
  conf.iterations = conf.images = 1;
  *picture = NULL;
  if (row->draw)
    *picture = row->draw(row);
  else if (!row->make)
    *picture = row->art ? paint(row->art) : assignment(brief && !row->whole);
  if (row->make)
    *scene = row->make(row, brief);
  else if (row->place || row->vx != 0 || row->vy != 0)
    *scene = by_program(row, *picture, &conf);
  else
    status = msr_scene_from_picture("case", *picture, &conf, &row->scene, scene, &why);
  if (status != MSR_OK) return status;
  must(msr_scene_set_contact(*scene, 1 - row->softness, row->friction, &why));
  if (row->diameter > 0) must(msr_scene_set_collisions(*scene, row->diameter, &why));
  add_forces(row, *scene);
  return MSR_OK;
}
