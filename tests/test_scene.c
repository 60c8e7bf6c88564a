/* test_scene.c - scenes from pictures, from files and by hand: what is accepted, what is refused
 * and with which words, and that a call that fails leaves the scene as it was. */
#include "art.h"
#include "files.h"

static const msr_conf usual = {0.005, 9.8, 0.1, 1500, 8, 2};

static msr_plan *plan_of(const msr_scene *scene) {
  msr_plan *plan;
  must(msr_plan_create(scene, NULL, &plan, &why));
  return plan;
}

/* ---- From a picture */

/* Masses are numbered in reading order and start at the centres of their pixels. */
static void masses_are_in_reading_order(void **unused) {
  (void)unused;
  static const struct {
    size_t column, row;
    double x, y;
  } due[] = {{3, 0, 3.5, 2.5}, {0, 1, 0.5, 1.5}, {2, 1, 2.5, 1.5}, {1, 2, 1.5, 0.5}};
  msr_scene *scene = scene_of("...o\no.o.\n#o.#\n", &usual, NULL);
  assert_int_equal(msr_scene_masses(scene), 4);
  for (size_t i = 0; i < LENGTH(due); i++) {
    size_t index = 99;
    must(msr_scene_mass_at(scene, due[i].column, due[i].row, &index, &why));
    assert_int_equal(index, i);
  }
  msr_plan *plan = plan_of(scene);
  msr_scene_free(scene); // a plan needs it no more
  msr_state *state;
  must(msr_state_create(plan, &state, &why));
  const msr_view view = msr_state_view(state);
  assert_int_equal(view.n, 4);
  assert_true(view.t == 0 && view.m_stride == 0 && view.m[0] == 0.1);
  for (size_t i = 0; i < view.n; i++) {
    assert_true(view.x[i] == due[i].x && view.y[i] == due[i].y);
    assert_true(view.vx[i] == 0 && view.vy[i] == 0);
  }
  msr_state_free(state);
  msr_plan_free(plan);
}

static void no_mass_where_there_is_none(void **unused) {
  (void)unused;
  static const struct {
    size_t column, row;
    const char *message;
  } cases[] = {
      {0, 0, "pixel (0,0) is no mass"},
      {2, 0, "pixel (2,0) is no mass"},
      {3, 0, "pixel (3,0) is outside the picture of 3 x 1"},
      {0, 1, "pixel (0,1) is outside the picture of 3 x 1"},
      {SIZE_MAX, 0, "pixel (18446744073709551615,0) is outside the picture of 3 x 1"},
  };
  msr_scene *scene = scene_of(".o#\n", &usual, NULL);
  msr_error err;
  for (size_t i = 0; i < LENGTH(cases); i++) {
    size_t index = 99;
    const msr_status status = msr_scene_mass_at(scene, cases[i].column, cases[i].row, &index, &err);
    assert_int_equal(status, MSR_EUSAGE);
    assert_int_equal(err.status, MSR_EUSAGE);
    assert_string_equal(err.message, cases[i].message);
    assert_int_equal(index, 99);
  }
  msr_scene_free(scene);
  scene = empty_scene(0.005);
  size_t index;
  assert_int_equal(msr_scene_mass_at(scene, 0, 0, &index, &err), MSR_EUSAGE);
  assert_string_equal(err.message, "pixel (0,0) is outside the picture of 0 x 0");
  msr_scene_free(scene);
}

/* What every colour on a coarse grid and around the limits of its kind stands for. */
static void colours_say_what_a_pixel_is(void **unused) {
  (void)unused;
  static const int levels[] = {0, 1, 62, 63, 64, 65, 128, 190, 191, 192, 193, 254, 255};
  const size_t n = LENGTH(levels);
  msr_picture *picture = paint(".\n");
  for (size_t c = 0; c < n * n * n; c++) {
    const int r = levels[c % n], g = levels[c / n % n], b = levels[c / n / n];
    const int high = r > g ? (r > b ? r : b) : (g > b ? g : b);
    const int low = r < g ? (r < b ? r : b) : (g < b ? g : b);
    const bool air = low == 255, support = high == 0, mass = high - low >= 64;
    picture->rgb[0] = (unsigned char)r;
    picture->rgb[1] = (unsigned char)g;
    picture->rgb[2] = (unsigned char)b;
    msr_scene *scene = NULL;
    const msr_status status = msr_scene_from_picture("p", picture, &usual, NULL, &scene, NULL);
    assert_int_equal(status, air || support || mass ? MSR_OK : MSR_EINPUT);
    if (status != MSR_OK) continue;
    assert_int_equal(msr_scene_masses(scene), mass);
    msr_plan *plan = plan_of(scene);
    assert_int_equal(msr_plan_describe(plan).supports, support);
    msr_plan_free(plan);
    msr_scene_free(scene);
  }
  msr_picture_free(picture);
}

static void the_first_unclear_pixel_is_named(void **unused) {
  (void)unused;
  msr_picture *picture = paint("....\n.o#.\n....\n");
  msr_scene *scene = NULL;
  msr_error err;
  memcpy(picture->rgb + 3 * 6, (const unsigned char[]){128, 129, 130}, 3);
  assert_int_equal(msr_scene_from_picture("a.ppm", picture, &usual, NULL, &scene, &err),
                   MSR_EINPUT);
  assert_string_equal(err.message,
                      "a.ppm:2:3: pixel (2,1) is 128,129,130, neither white, black nor a clear "
                      "colour (1 such pixel in all); paint it white (255,255,255) for air, black "
                      "(0,0,0) for a support, or a colour such as red for a mass");
  memcpy(picture->rgb + 3 * 11, (const unsigned char[]){255, 255, 254}, 3);
  assert_int_equal(msr_scene_from_picture("a.ppm", picture, &usual, NULL, &scene, &err),
                   MSR_EINPUT);
  assert_non_null(strstr(err.message, "pixel (2,1) is 128,129,130"));
  assert_non_null(strstr(err.message, "(2 such pixels in all)"));
  assert_int_equal(msr_scene_from_picture("a\tb\n.ppm", picture, &usual, NULL, &scene, &err),
                   MSR_EINPUT);
  assert_int_equal(strncmp(err.message, "a?b?.ppm:2:3: ", 14), 0); // one line, whatever the name
  assert_null(scene);
  msr_picture_free(picture);
}

static void options_and_conf_out_of_range_are_refused(void **unused) {
  (void)unused;
  static const int neighbours[] = {-4, -1, 1, 2, 3, 5, 7, 9};
  static const struct {
    msr_conf conf;
    const char *message;
  } confs[] = {
      {{0, 9.8, 0.1, 1500, 8, 2}, "conf: DT is 0; it must be greater than 0"},
      {{-1, 9.8, 0.1, 1500, 8, 2}, "conf: DT is -1; it must be greater than 0"},
      {{NO_NUMBER, 9.8, 0.1, 1500, 8, 2}, "conf: DT is nan; it must be greater than 0"},
      {{0.005, INFINITE, 0.1, 1500, 8, 2}, "conf: GRAVITE is inf; it must be finite"},
      {{0.005, 9.8, 0, 1500, 8, 2}, "conf: MASSE is 0; it must be greater than 0"},
      {{0.005, 9.8, 0.1, -1, 8, 2}, "conf: TENSION_RESSORT is -1; it must be 0 or more"},
  };
  msr_picture *picture = paint("o\n");
  msr_scene *scene = NULL;
  msr_error err;
  for (size_t i = 0; i < LENGTH(neighbours); i++) {
    const msr_scene_options options = {.neighbours = neighbours[i]};
    assert_int_equal(msr_scene_from_picture("p", picture, &usual, &options, &scene, &err),
                     MSR_EUSAGE);
    char due[64];
    snprintf(due, sizeof due, "neighbours must be 4 or 8, not %d", neighbours[i]);
    assert_string_equal(err.message, due);
  }
  for (size_t i = 0; i < LENGTH(confs); i++) {
    const msr_status status =
        msr_scene_from_picture("p", picture, &confs[i].conf, NULL, &scene, &err);
    assert_int_equal(status, MSR_EINPUT);
    assert_string_equal(err.message, confs[i].message);
  }
  msr_conf many = usual;
  many.images = 9;
  assert_int_equal(msr_scene_from_picture("p", picture, &many, NULL, &scene, &err), MSR_EINPUT);
  many.images = 1000000001, many.iterations = 1000000001; // msr.h: 1 .. 10^9
  assert_int_equal(msr_scene_from_picture("p", picture, &many, NULL, &scene, &err), MSR_EINPUT);
  assert_null(scene);
  msr_picture_free(picture);
  assert_int_equal(
      msr_scene_from_picture("p", &(msr_picture){0, 5, NULL}, &usual, NULL, &scene, &err),
      MSR_EUSAGE);
}

/* ---- From files */

static const char conf_text[] = "DT\n0.005\nGRAVITE\n9.8\nMASSE\n0.1\nTENSION_RESSORT\n1500\n"
                                "NB_ITERATIONS\n8\nNB_IMAGES\n2\n";
#define RED_AND_AIR "P3 2 1 255\n255 0 0  255 255 255\n"

static void files_are_loaded(void **unused) {
  (void)unused;
  static const struct {
    const char *ppm, *conf;
    msr_status status;
    const char *message; /* after the directory */
  } cases[] = {
      {RED_AND_AIR, conf_text, MSR_OK, NULL},
      {RED_AND_AIR RED_AND_AIR, conf_text, MSR_OK,
       "/s.ppm holds several images: the first is the scene"},
      {"P3 1 1 1 0 0 0", conf_text, MSR_OK, "/s.ppm has no mass: nothing will move"},
      {NULL, conf_text, MSR_EIO, "/s.ppm: cannot read it"},
      {RED_AND_AIR, NULL, MSR_EIO, "/s.conf: cannot read it"},
      {"P3 1 1 255 9 9 9", conf_text, MSR_EINPUT, "/s.ppm:1:1: pixel (0,0) is 9,9,9"},
      {"P3 2 1 255 9", conf_text, MSR_EINPUT, "/s.ppm:1:"},
      {RED_AND_AIR, "DT\n-1\n", MSR_EINPUT, "/s.conf:2:1: DT is -1"},
  };
  for (size_t i = 0; i < LENGTH(cases); i++) {
    msr_scene *scene = NULL;
    msr_error err;
    if (cases[i].ppm) write_file(path_of("s.ppm"), cases[i].ppm);
    if (cases[i].conf) write_file(path_of("s.conf"), cases[i].conf);
    const msr_status status =
        msr_scene_load(path_of("s.ppm"), path_of("s.conf"), NULL, &scene, &err);
    remove(path_of("s.ppm"));
    remove(path_of("s.conf"));
    assert_int_equal(status, cases[i].status);
    const char *note = status ? err.message : msr_scene_warning(scene, 0);
    if (!status) assert_int_equal(msr_scene_masses(scene), strstr(cases[i].ppm, "255 0 0") ? 1 : 0);
    if (!cases[i].message)
      assert_null(note);
    else
      assert_true(strncmp(note + strlen(directory), cases[i].message, strlen(cases[i].message)) ==
                  0);
    if (!status) assert_null(msr_scene_warning(scene, cases[i].message ? 1 : 0));
    if (status) assert_null(scene);
    msr_scene_free(scene);
  }
}

/* ---- By hand: every argument that is refused */

/* Two masses of a picture, and one added. */
static msr_scene *three_masses(void) {
  msr_scene *scene = scene_of("oo.#\n....\n", &usual, NULL);
  must(msr_scene_add_mass(scene, &(msr_mass){.x = 2.5, .y = 0.5, .m = 1}, NULL, &why));
  return scene;
}

/* The scene does what it did before: same masses, springs, anchors, effects. */
static void assert_as_before(const msr_scene *scene) {
  msr_scene *fresh = three_masses();
  msr_plan *plan = plan_of(scene), *due = plan_of(fresh);
  const msr_plan_figures a = msr_plan_describe(plan), b = msr_plan_describe(due);
  assert_true(a.masses == b.masses && a.springs == b.springs && a.anchors == b.anchors);
  assert_true(a.dt == b.dt && a.iterations == b.iterations && a.images == b.images);
  size_t n, m;
  const msr_effect *effects = msr_plan_effects(plan, &n), *dues = msr_plan_effects(due, &m);
  assert_int_equal(n, m);
  for (size_t e = 0; e < n; e++) assert_string_equal(effects[e].reason, dues[e].reason);
  msr_plan_free(plan);
  msr_plan_free(due);
  msr_scene_free(fresh);
}

static void assert_refused(const msr_scene *scene, msr_status status, const msr_error *err,
                           const char *message) {
  assert_int_equal(status, MSR_EUSAGE);
  assert_int_equal(err->status, MSR_EUSAGE);
  assert_string_equal(err->message, message);
  assert_as_before(scene);
}

static void bad_masses_are_refused(void **unused) {
  (void)unused;
  static const struct {
    msr_mass mass;
    const char *message;
  } cases[] = {
      {{.x = NO_NUMBER, .m = 1}, "a mass needs a finite position and velocity"},
      {{.y = INFINITE, .m = 1}, "a mass needs a finite position and velocity"},
      {{.vx = -INFINITE, .m = 1}, "a mass needs a finite position and velocity"},
      {{.vy = NO_NUMBER, .m = 1}, "a mass needs a finite position and velocity"},
      {{.m = 0}, "a mass must be finite and above 0, not 0"},
      {{.m = -1}, "a mass must be finite and above 0, not -1"},
      {{.m = INFINITE}, "a mass must be finite and above 0, not inf"},
      {{.m = NO_NUMBER}, "a mass must be finite and above 0, not nan"},
      {{.x = 3, .y = 1, .m = 1}, "a mass at (3, 1) is inside a support"},
      {{.x = 3.999, .y = 1.999, .m = 1}, "a mass at (3.999, 1.999) is inside a support"},
  };
  msr_scene *scene = three_masses();
  msr_error err;
  size_t index = 99;
  for (size_t i = 0; i < LENGTH(cases); i++)
    assert_refused(scene, msr_scene_add_mass(scene, &cases[i].mass, &index, &err), &err,
                   cases[i].message);
  assert_int_equal(index, 99);
  static const double beside[][2] = {{4, 1.5}, {3.5, 2}, {3.5, 0.999}, {2.999, 1.5}, {1e300, 0}};
  for (size_t i = 0; i < LENGTH(beside); i++) {
    const msr_mass mass = {.x = beside[i][0], .y = beside[i][1], .m = 1};
    must(msr_scene_add_mass(scene, &mass, &index, &why));
    assert_int_equal(index, 3 + i);
  }
  msr_scene_free(scene);
}

/* A pixel owns its lower and left edges, so that the picture owns its own. */
static void masses_beyond_a_closed_border_are_refused(void **unused) {
  (void)unused;
  static const double beyond[][2] = {{4, 0.5}, {-0.001, 0.5}, {0.5, 2}, {0.5, -0.001}, {9, 9}};
  static const double within[][2] = {{0, 0}, {3.999, 1.999}};
  for (int closed = 0; closed < 2; closed++) {
    msr_scene *scene = scene_of("oo..\n....\n", &usual, &(msr_scene_options){0, false, closed});
    for (size_t i = 0; i < LENGTH(beyond); i++) {
      const msr_mass mass = {.x = beyond[i][0], .y = beyond[i][1], .m = 1};
      msr_error err = {.message = ""};
      assert_int_equal(msr_scene_add_mass(scene, &mass, NULL, &err), closed ? MSR_EUSAGE : MSR_OK);
      if (closed) assert_non_null(strstr(err.message, ") is inside a support"));
    }
    for (size_t i = 0; i < LENGTH(within); i++)
      add_mass(scene, within[i][0], within[i][1], 0, 0, 1);
    assert_int_equal(msr_scene_masses(scene), closed ? 4 : 9);
    msr_scene_free(scene);
  }
}

static void bad_springs_and_anchors_are_refused(void **unused) {
  (void)unused;
  static const struct {
    size_t i, j;
    double k, L;
    const char *message;
  } springs[] = {
      {3, 0, 1, 1, "a spring at mass 3: there are 3"},
      {0, 3, 1, 1, "a spring at mass 3: there are 3"},
      {1, 1, 1, 1, "a spring from mass 1 to itself"},
      {0, 1, -1, 1, "a stiffness must be finite and 0 or more, not -1"},
      {0, 1, NO_NUMBER, 1, "a stiffness must be finite and 0 or more, not nan"},
      {0, 1, INFINITE, 1, "a stiffness must be finite and 0 or more, not inf"},
      {0, 1, 1, -1, "a rest length must be finite and 0 or more, not -1"},
      {0, 1, 1, NO_NUMBER, "a rest length must be finite and 0 or more, not nan"},
  };
  static const struct {
    msr_anchor anchor;
    const char *message;
  } anchors[] = {
      {{3, 0, 0, 1, 1}, "a spring at mass 3: there are 3"},
      {{0, 0, 0, -1, 1}, "a stiffness must be finite and 0 or more, not -1"},
      {{0, 0, 0, 1, INFINITE}, "a rest length must be finite and 0 or more, not inf"},
      {{0, NO_NUMBER, 0, 1, 1}, "an anchor needs a finite position"},
      {{0, 0, INFINITE, 1, 1}, "an anchor needs a finite position"},
  };
  msr_scene *scene = three_masses();
  msr_error err;
  for (size_t n = 0; n < LENGTH(springs); n++)
    assert_refused(
        scene,
        msr_scene_add_spring(scene, springs[n].i, springs[n].j, springs[n].k, springs[n].L, &err),
        &err, springs[n].message);
  for (size_t n = 0; n < LENGTH(anchors); n++)
    assert_refused(scene, msr_scene_add_anchor(scene, &anchors[n].anchor, &err), &err,
                   anchors[n].message);
  msr_scene_free(scene);
}

static void bad_forces_are_refused(void **unused) {
  (void)unused;
  static const msr_force nameless = {.summary = "s", .add = add_nothing};
  static const msr_force mute = {.name = "n", .add = add_nothing};
  static const msr_force lame = {.name = "n", .summary = "s"};
  static const msr_force lossless = {
      .name = "n", .summary = "s", .add = add_nothing, .conservative = true};
  const struct {
    const msr_force *force;
    const void *params;
    const char *message;
  } cases[] = {
      {NULL, NULL, "a force needs at least name, summary and add"},
      {&nameless, NULL, "a force needs at least name, summary and add"},
      {&mute, NULL, "a force needs at least name, summary and add"},
      {&lame, NULL, "a force needs at least name, summary and add"},
      {&lossless, NULL, "force n: conservative goes with energy"},
      {&msr_force_springs, NULL, "every scene has its springs already"},
      {&msr_force_drag, NULL, "force drag needs its parameters"},
      {&msr_force_gravity, &(msr_gravity){NO_NUMBER}, "gravity must be a finite number of px/s^2"},
      {&msr_force_drag, &(msr_drag){-1}, "drag must be a finite number of kg/s, 0 or more"},
      {&msr_force_damping, &(msr_damping){INFINITE},
       "damping must be a finite number of kg/s, 0 or more"},
      {&msr_force_wind, &(msr_wind){.gust = -1},
       "wind: speed must be finite, drag and gust finite and 0 or more, gust time 1e-06 s or more"},
      {&msr_force_push, &(msr_push){0, NO_NUMBER, 0}, "a push must be a finite force"},
  };
  msr_scene *scene = three_masses();
  msr_error err;
  for (size_t i = 0; i < LENGTH(cases); i++)
    assert_refused(scene, msr_scene_add_force(scene, cases[i].force, cases[i].params, &err), &err,
                   cases[i].message);
  msr_scene_free(scene);
}

static void bad_settings_are_refused(void **unused) {
  (void)unused;
  static const struct {
    double restitution, friction;
    const char *message;
  } contacts[] = {
      {-0.1, 0, "restitution must be from 0 to 1, not -0.1"},
      {1.1, 0, "restitution must be from 0 to 1, not 1.1"},
      {NO_NUMBER, 0, "restitution must be from 0 to 1, not nan"},
      {1, -1, "friction must be finite and 0 or more, not -1"},
      {1, INFINITE, "friction must be finite and 0 or more, not inf"},
      {1, NO_NUMBER, "friction must be finite and 0 or more, not nan"},
  };
  static const struct {
    double dt;
    uint64_t iterations, images;
    const char *message;
  } times[] = {
      {0, 1, 1, "times: DT is 0; it must be greater than 0"},
      {1, (1ULL << 53) + 1, 1, "times: NB_ITERATIONS is 9007199254740993; it must be at most 2^53"},
      {1, 1, 2,
       "times: NB_IMAGES is 2 and NB_ITERATIONS 1; ask for at most one image per iteration"},
  };
  msr_scene *scene = three_masses();
  msr_error err;
  for (size_t i = 0; i < LENGTH(contacts); i++)
    assert_refused(
        scene, msr_scene_set_contact(scene, contacts[i].restitution, contacts[i].friction, &err),
        &err, contacts[i].message);
  for (size_t i = 0; i < LENGTH(times); i++) {
    const msr_status status =
        msr_scene_set_times(scene, times[i].dt, times[i].iterations, times[i].images, &err);
    assert_int_equal(status, MSR_EINPUT);
    assert_string_equal(err.message, times[i].message);
    assert_as_before(scene);
  }
  assert_int_equal(msr_scene_set_times(scene, 1, 1, 0, &err), MSR_EINPUT);
  msr_scene_free(scene);
}

/* NULL for err is fine wherever something fails. */
static void errors_may_be_ignored(void **unused) {
  (void)unused;
  msr_scene *scene = three_masses();
  assert_int_equal(msr_scene_add_mass(scene, &(msr_mass){.m = -1}, NULL, NULL), MSR_EUSAGE);
  assert_int_equal(msr_scene_add_spring(scene, 0, 0, 1, 1, NULL), MSR_EUSAGE);
  assert_int_equal(msr_scene_add_force(scene, NULL, NULL, NULL), MSR_EUSAGE);
  assert_int_equal(msr_scene_set_contact(scene, 2, 0, NULL), MSR_EUSAGE);
  assert_int_equal(msr_scene_set_times(scene, 0, 0, 0, NULL), MSR_EINPUT);
  msr_scene_free(scene);
  msr_scene_free(NULL);
}

/* ---- By hand: what is added is there */

static void a_scene_from_c(void **unused) {
  (void)unused;
  msr_scene *scene = empty_scene(0.005);
  size_t index;
  for (size_t i = 0; i < 20; i++) {
    const msr_mass mass = {.x = (double)i, .y = 7, .vx = 1, .vy = -(double)i, .m = 1 + (double)i};
    must(msr_scene_add_mass(scene, &mass, &index, &why));
    assert_int_equal(index, i);
    assert_int_equal(msr_scene_masses(scene), i + 1);
  }
  for (size_t i = 19; i > 0; i--) must(msr_scene_add_spring(scene, i, i - 1, (double)i, 1, &why));
  must(msr_scene_add_spring(scene, 0, 19, 5, 19, &why));
  must(msr_scene_add_spring(scene, 3, 4, 7, 2, &why)); // a second one
  must(msr_scene_add_anchor(scene, &(msr_anchor){5, 5, 9, 3, 1}, &why));
  msr_plan *plan = plan_of(scene);
  msr_scene_free(scene);
  const msr_plan_figures f = msr_plan_describe(plan);
  assert_true(f.masses == 20 && f.springs == 21 && f.anchors == 1);
  assert_true(f.dt == 0.005 && f.iterations == 1 && f.images == 1 && f.width == 0);
  msr_state *state;
  must(msr_state_create(plan, &state, &why));
  const msr_view s = msr_state_view(state);
  assert_int_equal(s.m_stride, 1);
  for (size_t i = 0; i < 20; i++) {
    assert_true(s.x[i] == (double)i && s.y[i] == 7 && msr_view_mass(&s, i) == 1 + (double)i);
    assert_true(s.vx[i] == 1 && s.vy[i] == -(double)i);
  }
  // all springs are at rest but the second one (1 px too short) and the anchor (1 px too long)
  assert_true(msr_state_energy(state).spring == 7.0 / 2 + 3.0 / 2);
  double fx[20], fy[20];
  must(msr_state_forces(state, fx, fy, &why));
  for (size_t i = 0; i < 20; i++) {
    assert_true(fx[i] == (i == 3 ? -7 : i == 4 ? 7 : 0));
    assert_true(fy[i] == (i == 5 ? 3 : 0));
  }
  msr_state_free(state);
  msr_plan_free(plan);
}

/* What is added after the picture's masses comes after them, with a mass of its own. */
static void a_picture_and_more(void **unused) {
  (void)unused;
  msr_scene *scene = scene_of("oo..\n", &usual, NULL);
  size_t index;
  must(msr_scene_add_mass(scene, &(msr_mass){.x = 2.5, .y = 0.5, .m = 0.1}, &index, &why));
  assert_int_equal(index, 2);
  must(msr_scene_add_spring(scene, 1, 2, 1500, 1, &why));
  msr_plan *same = plan_of(scene);
  must(msr_scene_add_mass(scene, &(msr_mass){.x = 3.5, .y = 0.5, .m = 3}, &index, &why));
  msr_plan *mixed = plan_of(scene);
  msr_scene_free(scene);
  assert_int_equal(msr_plan_describe(same).springs, 2);
  msr_state *state;
  must(msr_state_create(same, &state, &why));
  assert_int_equal(msr_state_view(state).m_stride, 0); // all equal: one number for all
  msr_state_free(state);
  must(msr_state_create(mixed, &state, &why));
  const msr_view view = msr_state_view(state);
  assert_true(msr_view_mass(&view, 0) == 0.1 && msr_view_mass(&view, 3) == 3);
  msr_state_free(state);
  msr_plan_free(mixed);
  msr_plan_free(same);
}

/* ---- Small scenes are scenes */

static void small_scenes_run_to_the_end(void **unused) {
  (void)unused;
  static const char *const arts[] = {".\n",   "#\n",   "o\n",        "oo\n",       "o\no\n",
                                     "##\n",  "#o#\n", "o\n#\n",     ".o.#.oo.\n", "o\n.\n#\no\n",
                                     "...\n", "#.#\n", "oooooooo\n", ".o\n#o\n"};
  for (size_t a = 0; a < 4 * LENGTH(arts); a++) {
    const msr_scene_options options = {a % 2 ? 8 : 4, a & 2, a & 2};
    const world w = open_world(scene_of(arts[a / 4], &usual, &options), NULL, 0);
    msr_sink sink;
    must(msr_frames_open(w.plan, path_of("out"), NULL, true, &sink, &why));
    const msr_run_options run = {.sinks = &sink, .n_sinks = 1};
    must(msr_run(w.state, &run, &why));
    must(msr_sink_close(&sink, &why));
    assert_int_equal(msr_state_iteration(w.state), usual.iterations);
    close_world(w);
    assert_int_equal(remove(path_of("out/frame-000000.ppm")), 0);
    assert_int_equal(remove(path_of("out/frame-000001.ppm")), 0);
    assert_int_equal(rmdir(path_of("out")), 0);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(masses_are_in_reading_order),
      cmocka_unit_test(no_mass_where_there_is_none),
      cmocka_unit_test(colours_say_what_a_pixel_is),
      cmocka_unit_test(the_first_unclear_pixel_is_named),
      cmocka_unit_test(options_and_conf_out_of_range_are_refused),
      cmocka_unit_test(files_are_loaded),
      cmocka_unit_test(bad_masses_are_refused),
      cmocka_unit_test(masses_beyond_a_closed_border_are_refused),
      cmocka_unit_test(bad_springs_and_anchors_are_refused),
      cmocka_unit_test(bad_forces_are_refused),
      cmocka_unit_test(bad_settings_are_refused),
      cmocka_unit_test(errors_may_be_ignored),
      cmocka_unit_test(a_scene_from_c),
      cmocka_unit_test(a_picture_and_more),
      cmocka_unit_test(small_scenes_run_to_the_end),
  };
  return cmocka_run_group_tests_name("scene", tests, make_directory, remove_directory);
}
