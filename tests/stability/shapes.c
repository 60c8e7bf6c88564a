/* shapes.c - degenerate geometry: masses at one place, springs without length or stiffness, blocks
 * collapsed or inside out, and objects with hardly any room. */
#include "suite.h"

static const char pair[] = "......\n..oo..\n......\n......\n";
static const char block[] = "............\n"
                            "..oooooooo..\n"
                            "..oooooooo..\n"
                            "..oooooooo..\n"
                            "..oooooooo..\n"
                            "............\n"
                            "............\n"
                            "#####..#####\n"
                            "............\n"
                            "############\n";
static const char slit[] = "#oooooo#\n"
                           "#oooooo#\n"
                           "#oooooo#\n"
                           "##oooo##\n"
                           "##.oo.##\n"
                           "##....##\n"
                           "###..###\n"
                           "###..###\n"
                           "##....##\n"
                           "########\n";
static const char boxes[] = "###########\n"
                            "#o#oo#ooo##\n"
                            "####o#ooo##\n"
                            "#o##o#ooo##\n"
                            "#o#oo######\n"
                            "###########\n";
static const char corridor[] = "##########\n"
                               "#oooooo..#\n"
                               "########.#\n"
                               "#........#\n"
                               "#.########\n"
                               "#........#\n"
                               "##########\n";
static const char stairs[] = "..ooooo.........\n"
                             "..ooooo.........\n"
                             "#.ooooo.........\n"
                             "##..............\n"
                             "###.............\n"
                             "####............\n"
                             "#####...........\n"
                             "######..........\n"
                             "#######.........\n"
                             "########........\n"
                             "################\n";
static const char full[] = "oooooo\noooooo\noooooo\noooooo\n";
static const char one[] = ".....\n..o..\n.....\n#####\n";
static const char none[] = ".....\n.....\n#####\n";

static void collapse(size_t n, msr_mass *m) {
  for (size_t i = 0; i < n; i++) m[i].x = 6, m[i].y = 6;
}

static void collapse_to_a_line(size_t n, msr_mass *m) {
  for (size_t i = 0; i < n; i++) m[i].y = 6;
}

/* The mirror image in x by index: neighbours keep their springs, which push through each other. */
static void invert(size_t n, msr_mass *m) {
  for (size_t i = 0; i < n; i++) m[i].x = 12 - m[i].x;
}

/* Every other mass is where its right neighbour should be, and the other way round. */
static void cross(size_t n, msr_mass *m) {
  for (size_t i = 0; i + 1 < n; i += 2) m[i].x += 1, m[i + 1].x -= 1;
}

/* Masses on one another, tied by springs of length 0, of stiffness 0, and plain ones. */
static msr_scene *coincident(const hard_case *row, bool brief) {
  (void)brief;
  enum { MASSES = 6 };
  msr_scene *scene = empty_scene(row->conf.dt);
  add_force(scene, &msr_force_gravity, &(msr_gravity){row->conf.gravity});
  for (size_t i = 0; i < MASSES; i++) add_mass(scene, 5, i == 5 ? 6 : 5, 0, 0, 0.1);
  for (size_t i = 0; i < MASSES; i++)
    for (size_t j = i + 1; j < MASSES; j++)
      must(msr_scene_add_spring(scene, i, j, (double)((i + j) % 3) * 750, (i * j) % 2 ? 0 : 1,
                                &why));
  must(msr_scene_add_anchor(scene, &(msr_anchor){0, 5, 5, 1500, 0}, &why));
  must(msr_scene_add_anchor(scene, &(msr_anchor){1, 5, 5, 1500, 1}, &why));
  return scene;
}

#define EXAMPLE .conf = {0.005, 9.8, 0.1, 1500, 1, 1}
#define CLOSED  .scene = {.closed_border = true}

static const hard_case rows[] = {
    {.name = "coincident masses, L = 0, k = 0",
     .make = coincident,
     EXAMPLE,
     .brief = 1000,
     .full = 1000,
     .growth = 1e-8,
     .loss = 1e-8,
     .why = why_exact},
    {.name = "no stiffness",
     .art = block,
     .conf = {0.005, 9.8, 0.1, 0, 1, 1},
     CLOSED,
     .brief = 2000,
     .full = 100000,
     .growth = 0.02,
     .loss = 0.02,
     .why =
         "free masses that bounce: kept to rounding, but for half a step of fall at each bounce"},
    {.name = "block collapsed to a point",
     .art = block,
     EXAMPLE,
     CLOSED,
     .place = collapse,
     .brief = 1000,
     .full = 2000,
     .growth = 1e-8,
     .loss = 1e-8,
     .why = why_exact},
    {.name = "block collapsed to a line",
     .art = block,
     EXAMPLE,
     CLOSED,
     .place = collapse_to_a_line,
     .brief = 1000,
     .full = 2000,
     .growth = 1e-8,
     .loss = 1e-8,
     .why = why_exact},
    {.name = "block mirrored",
     .art = block,
     EXAMPLE,
     CLOSED,
     .place = invert,
     .brief = 1000,
     .full = 20000,
     .growth = 0.02,
     .loss = 0.03,
     .why = why_modified},
    {.name = "block with neighbours crossed",
     .art = block,
     EXAMPLE,
     CLOSED,
     .place = cross,
     .brief = 1000,
     .full = 2000,
     .growth = 1e-8,
     .loss = 1e-8,
     .why = why_exact},
    {.name = "jelly with neighbours crossed",
     .art = block,
     EXAMPLE,
     .scene = {.neighbours = 8, .closed_border = true},
     .place = cross,
     .brief = 1000,
     .full = 2000,
     .growth = 1e-8,
     .loss = 1e-8,
     .why = why_exact},
    {.name = "squeezed through a slit",
     .art = slit,
     .conf = {0.005, 100, 0.1, 1500, 1, 1},
     CLOSED,
     .brief = 1000,
     .full = 20000,
     .growth = 0.05,
     .loss = 0.05,
     .why = why_care},
    {.name = "squeezed through a slit, jelly",
     .art = slit,
     .conf = {0.005, 1000, 0.1, 1500, 1, 1},
     .scene = {.neighbours = 8, .closed_border = true},
     .brief = 1000,
     .full = 2000,
     .growth = 0.05,
     .loss = 0.05,
     .why = why_care},
    {.name = "boxed in on all sides",
     .art = boxes,
     EXAMPLE,
     .brief = 1000,
     .full = 100000,
     .vx = 10,
     .vy = 10,
     .growth = 0.02,
     .loss = 0.03,
     .why = why_modified},
    {.name = "corridor of one pixel",
     .art = corridor,
     EXAMPLE,
     .brief = 1000,
     .full = 20000,
     .vx = 50,
     .growth = 0.02,
     .loss = 0.03,
     .why = why_modified},
    {.name = "staircase",
     .art = stairs,
     EXAMPLE,
     CLOSED,
     .brief = 1000,
     .full = 20000,
     .growth = 0.02,
     .loss = 0.03,
     .why = why_modified},
    {.name = "all masses, no air, closed",
     .art = full,
     EXAMPLE,
     CLOSED,
     .brief = 1000,
     .full = 100000,
     .growth = 0.025,
     .loss = 0.06,
     .why = why_modified},
    {.name = "all masses, no air, open",
     .art = full,
     EXAMPLE,
     .brief = 1000,
     .full = 100000,
     .growth = 1e-6,
     .loss = 1e-6,
     .why = "free fall is exact but for rounding, t^2 eps"},
    {.name = "one mass",
     .art = one,
     EXAMPLE,
     .brief = 2000,
     .full = 1000000,
     .growth = 0.02,
     .loss = 0.02,
     .why = "a bounce is early by up to a step: h g / v of its energy, no drift"},
    {.name = "a pair, 8 neighbours, attached",
     .art = pair,
     EXAMPLE,
     .scene = {.neighbours = 8, .attach = true},
     .brief = 1000,
     .full = 100000,
     .growth = 1e-6,
     .loss = 1e-6,
     .why = "free fall is exact but for rounding, t^2 eps"},
    {.name = "no mass",
     .art = none,
     EXAMPLE,
     .brief = 1000,
     .full = 1000000,
     .why = "there is no energy"},
};

void add_shapes(suite *s) {
  for (size_t i = 0; i < LENGTH(rows); i++) add_case(s, &rows[i]);
}
