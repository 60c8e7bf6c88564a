/* from_picture.c - a scene from a picture and a conf. */
#include "scene/scene.h"

#include "formats/conf.h"
#include "formats/ppm.h"

static msr_status check_options(const msr_scene_options *o, msr_error *err) {
  if (o->neighbours == 4 || o->neighbours == 8) return MSR_OK;
  return msri_fail(err, MSR_EUSAGE, "neighbours must be 4 or 8, not %d", o->neighbours);
}

/* Takes what the picture and the conf say into an empty scene, and the picture itself if all is
 * well. */
static msr_status fill(msr_scene *scene, const char *name, msr_picture *picture,
                       const msr_conf *conf, const msr_scene_options *options, msr_error *err) {
  if (options) scene->options = *options;
  if (scene->options.neighbours == 0) scene->options.neighbours = 4;
  scene->conf = *conf;
  msr_status status = check_options(&scene->options, err);
  if (status == MSR_OK) status = msri_conf_check("conf", conf, err);
  if (status == MSR_OK && conf->gravity != 0)
    status = msr_scene_add_force(scene, &msr_force_gravity, &(msr_gravity){conf->gravity}, err);
  if (status == MSR_OK) status = msri_grid_create(name, picture, &scene->grid, err);
  if (status != MSR_OK) return status;
  scene->picture = picture;
  scene->n_picture = scene->grid->masses;
  scene->n_supports = scene->grid->supports;
  return MSR_OK;
}

/* As msr_scene_from_picture, of which the scene takes the picture; on failure it is freed. */
static msr_status adopt(const char *name, msr_picture *picture, const msr_conf *conf,
                        const msr_scene_options *options, msr_scene **scene, msr_error *err) {
  msr_scene *made = NULL;
  msr_status status = msr_scene_create(&made, err);
  if (status == MSR_OK) status = fill(made, name, picture, conf, options, err);
  if (status == MSR_OK) {
    *scene = made;
    return MSR_OK;
  }
  msr_scene_free(made);
  msr_picture_free(picture);
  return status;
}

msr_status msr_scene_from_picture(const char *name, const msr_picture *picture,
                                  const msr_conf *conf, const msr_scene_options *options,
                                  msr_scene **scene, msr_error *err) {
  msr_picture *copy;
  const msr_status status = msri_picture_copy(picture, &copy, err);
  if (status != MSR_OK) return status;
  return adopt(name, copy, conf, options, scene, err);
}

/* What a user should know about the files. */
static msr_status note_oddities(msr_scene *scene, const char *picture_path, bool more,
                                msr_error *err) {
  msr_status status = MSR_OK;
  if (more)
    status = msri_notes_add(&scene->notes, err, "%s holds several images: the first is the scene",
                            picture_path);
  if (status == MSR_OK && scene->n_picture == 0)
    status = msri_notes_add(&scene->notes, err, "%s has no mass: nothing will move", picture_path);
  return status;
}

msr_status msr_scene_load(const char *picture_path, const char *conf_path,
                          const msr_scene_options *options, msr_scene **scene, msr_error *err) {
  msr_conf conf;
  msr_picture *picture;
  msr_scene *made;
  bool more = false;
  msr_status status = msr_conf_read(conf_path, &conf, err);
  if (status == MSR_OK) status = msr_picture_read(picture_path, &picture, &more, err);
  if (status == MSR_OK) status = adopt(picture_path, picture, &conf, options, &made, err);
  if (status != MSR_OK) return status;
  status = note_oddities(made, picture_path, more, err);
  if (status == MSR_OK)
    *scene = made;
  else
    msr_scene_free(made);
  return status;
}
