/* options.c - the table of options: the parser, the help and the checks all read it. */
#include "options.h"

#include "commands.h"
#include "values.h"

#include <string.h>

#define FIELD(name) .field = offsetof(settings, name)

const option all_options[] = {
    {'o', "output", "DIR", "where the frames go (frames); -: to stdout", FOR_RUNS, &a_directory,
     FIELD(output), .clashes = {"--no-frames"}, .group = "Results"},
    {0, "force", NULL, "replace the frames that DIR holds already", FOR_RUNS, &a_flag, FIELD(force),
     .clashes = {"--no-frames"}},
    {0, "no-frames", NULL, "simulate without drawing", FOR_RUNS, &a_flag, FIELD(no_frames)},
    {0, "stats", "FILE.csv", "a row per frame: energies, momentum, contacts ...", FOR_RUNS, &a_path,
     FIELD(stats)},
    {0, "trajectory", "FILE.npy", "NumPy array [frames, masses, 4]: x, y, vx, vy", FOR_RUNS,
     &a_path, FIELD(trajectory)},
    {0, "json", NULL, "the plan as JSON, for programs", FOR_PLAN, &a_flag, FIELD(json)},
    {0, "csv", "FILE.csv", "the table, with all digits; -: to stdout", FOR_ACCURACY, &a_path,
     FIELD(csv), .group = "Results"},
    {0, "plot", "FILE.svg|.png", "the work-precision diagram, by gnuplot", FOR_ACCURACY, &a_figure,
     FIELD(plot)},

    {0, "scale", "N", "pixels of the frames per unit of the scene (1)", FOR_RUNS, &a_count,
     FIELD(scale), .clashes = {"--no-frames"}, .group = "Drawing"},
    {0, "stripes", "N[:COLOUR]", "stripes of N rows; COLOUR: a name or #rrggbb", FOR_RUNS,
     &a_stripe, FIELD(style), .clashes = {"--no-frames"}},

    {0, "accuracy", "EPS", "chooses all of these: within EPS px, at least time", FOR_RUNS,
     &a_positive, FIELD(accuracy),
     .clashes = {"--integrator", "--substeps", "--atol", "--rtol", "--impacts"},
     .group = "Steps in time"},
    {0, "integrator", "NAME", "a name that 'msr list' shows, or auto (auto)", FOR_RUNS,
     &an_integrator, FIELD(integrator)},
    {0, "substeps", "N|auto|off", "steps per DT; auto: as many as it takes (auto)", FOR_RUNS,
     &a_substeps, FIELD(substeps)},
    {0, "atol", "TOL", "error of an adaptive step, in px and px/s (1e-6)", FOR_RUNS, &a_size,
     FIELD(atol)},
    {0, "rtol", "TOL", "added to it: a share of the largest number (0)", FOR_RUNS, &a_size,
     FIELD(rtol)},
    {0, "impacts", "kept|located", "order 1 and no heating, or the full order (kept)", FOR_RUNS,
     &a_rule, FIELD(impacts)},

    {0, "threads", "N", "threads that step, draw and write (1)", FOR_RUNS, &a_team, FIELD(threads),
     .group = "Speed"},

    {0, "until", "T", "how much of the scene is compared, in s (all)", FOR_ACCURACY, &a_positive,
     FIELD(until), .group = "Study"},
    {0, "integrators", "A,B,C", "names that 'msr list' shows (all but euler)", FOR_ACCURACY,
     &integrators, .field = 0},
    {0, "budget", "SECONDS", "how long it may take (60)", FOR_ACCURACY, &a_positive, FIELD(budget)},

    {0, "neighbours", "4|8", "springs to how many neighbours (4)", FOR_SCENES, &a_degree,
     FIELD(neighbours), .group = "Object and supports"},
    {0, "attach", NULL, "tie masses beside a support to it by a spring", FOR_SCENES, &a_flag,
     FIELD(attach)},
    {0, "border", "open|closed", "closed: the picture's border is a support (open)", FOR_SCENES,
     &a_border, FIELD(border_closed)},
    {0, "restitution", "E", "normal speed kept by a bounce, 0 to 1 (1)", FOR_SCENES, &a_share,
     FIELD(restitution)},
    {0, "friction", "MU", "Coulomb friction at supports (0)", FOR_SCENES, &a_size, FIELD(friction)},
    {0, "collide", NULL, "masses collide with each other, as discs", FOR_SCENES, &a_flag,
     FIELD(collide)},
    {0, "diameter", "D", "of these discs, in px (1)", FOR_SCENES, &a_positive, FIELD(diameter),
     .needs = "--collide"},

    {0, "damping", "C", "damping along the springs, in kg/s (0)", FOR_SCENES, &a_size,
     FIELD(damping), .group = "Forces"},
    {0, "drag", "C", "drag of the air, in kg/s (0; in wind: MASSE / 1 s)", FOR_SCENES, &a_size,
     FIELD(drag)},
    {0, "wind", "SPEED", "random wind along x, of mean SPEED in px/s", FOR_SCENES, &a_real,
     FIELD(wind)},
    {0, "gust", "S", "its standard deviation, in px/s (|SPEED| / 2)", FOR_SCENES, &a_size,
     FIELD(gust), .needs = "--wind"},
    {0, "gust-time", "T", "its correlation time, in s (1)", FOR_SCENES, &a_positive,
     FIELD(gust_time), .needs = "--wind"},
    {0, "seed", "N", "what it is drawn from (1)", FOR_SCENES, &a_seed, FIELD(seed),
     .needs = "--wind"},
    {0, "push", "X,Y,FX,FY", "force on the mass of column X, row Y; repeatable", FOR_SCENES,
     &a_push, .field = 0},

    {'q', NULL, NULL, "quieter: errors only", FOR_RUNS | FOR_ACCURACY, &a_flag, FIELD(quiet),
     .clashes = {"-v"}, .group = "Messages"},
    {'v', NULL, NULL, "what is simulated and why, energy, times", FOR_RUNS, &a_flag,
     FIELD(verbose)},
    {'h', "help", NULL, "this help", FOR_ALL, &a_flag, FIELD(help)},
    {0, "version", NULL, "version and licence", FOR_ALL, &a_flag, FIELD(version)},
    {.help = NULL},
};

const option *option_find(const char *word) {
  if (word[0] != '-' || word[1] == '\0') return NULL;
  const char *const name = word[1] == '-' ? word + 2 : NULL;
  const size_t length = name ? strcspn(name, "=") : 0;
  for (const option *o = all_options; o->help; o++) {
    if (!name && o->letter == word[1]) return o;
    if (name && o->name && strncmp(o->name, name, length) == 0 && !o->name[length]) return o;
  }
  return NULL;
}

spelling option_spelling(const option *o) {
  spelling s;
  if (o->name) snprintf(s.text, sizeof s.text, "--%s", o->name);
  if (!o->name) snprintf(s.text, sizeof s.text, "-%c", o->letter);
  return s;
}

uint64_t option_bit(const option *o) { return UINT64_C(1) << (o - all_options); }

bool option_given(const settings *s, const char *word) {
  return (s->given & option_bit(option_find(word))) != 0;
}
