/* from_picture.c - a scene from a picture and a conf. */
#include "scene/scene.h"

#include "base/pixel.h"
#include "formats/conf.h"
#include "formats/ppm.h"

/* Counts masses and supports; the first pixel that is neither, nor air, is an error. */
static msr_status classify(msr_scene *scene, const char *name, const msr_picture *picture,
                           msr_error *err) {
  size_t unclear = 0, first = 0;
  const size_t pixels = picture->width * picture->height;
  for (size_t p = 0; p < pixels; p++) {
    const msri_pixel kind = msri_pixel_of(picture->rgb + 3 * p);
    scene->n_picture += kind == MSRI_MASS;
    scene->n_supports += kind == MSRI_SUPPORT;
    if (kind == MSRI_UNCLEAR && unclear++ == 0) first = p;
  }
  if (unclear == 0) return MSR_OK;
  const size_t row = first / picture->width, column = first % picture->width;
  const unsigned char *rgb = picture->rgb + 3 * first;
  return msri_fail(err, MSR_EINPUT,
                   "%s:%zu:%zu: pixel (%zu,%zu) is %d,%d,%d, neither white, black nor a clear "
                   "colour (%zu such pixel%s in all); paint it white (255,255,255) for air, black "
                   "(0,0,0) for a support, or a colour such as red for a mass",
                   name, row + 1, column + 1, column, row, rgb[0], rgb[1], rgb[2], unclear,
                   unclear == 1 ? "" : "s");
}

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
  if (status == MSR_OK) status = classify(scene, name, picture, err);
  if (status == MSR_OK && conf->gravity != 0)
    status = msr_scene_add_force(scene, &msr_force_gravity, &(msr_gravity){conf->gravity}, err);
  if (status == MSR_OK) scene->picture = picture;
  return status;
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
