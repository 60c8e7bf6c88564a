/* instants.c - when runs are compared: at the frames and at the end. Every m-th frame is, if there
 * are very many; if there are few, others are between them. Where the horizon may come long before
 * the first frame, or soon after, early instants are denser: each later than the one before by
 * a factor. */
#include "accuracy/instants.h"

#include <math.h>

/* Frames in iterations 1 .. end, were there `images` in the whole run. */
static uint64_t frames_until(const msri_instants_wanted *w, uint64_t images) {
  const double share = (double)(w->end + 1) / (double)w->iterations;
  return (uint64_t)ceil(share * (double)images) - 1;
}

/* i * iterations / images without overflow. */
static uint64_t frame_iteration(const msri_instants_wanted *w, uint64_t images, uint64_t i) {
  return w->iterations / images * i + w->iterations % images * i / images;
}

/* So many images that there are enough frames. */
static uint64_t images_of(const msri_instants_wanted *w) {
  const uint64_t frames = frames_until(w, w->images), room = w->iterations / w->images;
  const uint64_t between = frames > 0 ? (w->fewest + frames - 1) / frames : w->fewest;
  return w->images * (between <= 1 ? 1 : between < room ? between : room);
}

/* A factor that leaves half of the instants to the frames. */
static double ratio_of(const msri_instants_wanted *w) {
  return w->ratio > 0 ? msri_max(w->ratio, pow((double)w->end, 2 / (double)w->most)) : HUGE_VAL;
}

msr_status msri_instants_choose(const msri_instants_wanted *w, msri_instants *instants,
                                msr_error *err) {
  const uint64_t images = images_of(w), frames = frames_until(w, images);
  const double ratio = ratio_of(w);
  const uint64_t apart = frames / (w->ratio > 0 ? (w->most + 1) / 2 : w->most) + 1;
  const double early = w->ratio > 0 ? 2 / (ratio - 1) + log((double)w->end) / log(ratio) : 0;
  uint64_t *iteration =
      msri_alloc(frames / apart + (size_t)early + 3, sizeof *iteration, "the instants", err);
  if (!iteration) return MSR_ENOMEM;
  size_t n = 0;
  uint64_t last = 0;
  for (uint64_t i = apart; last < w->end; last = iteration[n++]) {
    while (i <= frames && frame_iteration(w, images, i) <= last) i += apart;
    const uint64_t next = i <= frames ? frame_iteration(w, images, i) : w->end;
    const double dense = msri_max((double)last + 1, floor((double)last * ratio));
    iteration[n] = next < w->end ? next : w->end;
    if (dense < (double)iteration[n]) iteration[n] = (uint64_t)dense;
  }
  *instants = (msri_instants){n, iteration};
  return MSR_OK;
}
