/* options.h - what the user asks for: the settings that the command line makes, and the table of
 * options that both the parser and the help read. */
#ifndef CLI_OPTIONS_H
#define CLI_OPTIONS_H

#include "msr.h"

#include <stdio.h>

/* --push X,Y,FX,FY */
typedef struct push {
  uint64_t column, row; /* of a pixel of the picture, from the top left */
  double fx, fy;
} push;

enum { MOST_INTEGRATORS = 64 };

typedef struct settings {
  const struct command *command;
  bool named;          /* the command was named, not understood */
  const char *file[3]; /* the operands, in the user's order; the third is one too many */
  size_t n_files;
  const char *output, *stats, *trajectory;             /* NULL: not asked for */
  const char *csv, *plot;                              /* likewise */
  const msr_integrator *integrator;                    /* NULL: auto */
  const msr_integrator *integrators[MOST_INTEGRATORS]; /* [n_integrators], of the study */
  size_t n_integrators;                                /* 0: all */
  uint64_t substeps, impacts;                          /* as in msr_plan_options, and so are */
  double atol, rtol;
  double accuracy, until, budget;                           /* 0: not asked for */
  uint64_t neighbours, border_closed, seed, scale, threads; /* threads 0: not asked for */
  double wind, gust, gust_time, drag, damping, restitution, friction, diameter;
  push *pushes; /* [n_pushes] */
  size_t n_pushes;
  msr_style style; /* stripes only */
  bool force, no_frames, attach, collide, json, quiet, verbose, help, version;
  const char *program; /* what msr was called */
  struct typed *typed; /* [n_typed], options as they were typed, in order */
  size_t n_typed;
  uint64_t given; /* bit i: row i of the table of options */
} settings;

typedef struct option {
  char letter;          /* -o; 0: none */
  const char *name;     /* --output; NULL: none */
  const char *argument; /* NULL: a flag */
  const char *help;     /* one line */
  unsigned commands;    /* that take it: FOR_... */
  const struct kind *kind;
  size_t field;           /* of settings, that it sets */
  const char *needs;      /* the option without which it makes no sense */
  const char *clashes[6]; /* the options with which it makes none; ends with NULL */
  const char *group;      /* heading of the help before this row; NULL: goes on */
} option;

/* An option of the command line. */
typedef struct typed {
  const option *option;
  const char *value; /* "": a flag */
} typed;

/* The last has no help. */
extern const option all_options[];

/* The row that a word such as -o, -oDIR, --output or --output=DIR begins with, or NULL. */
const option *option_find(const char *word);

/* A row as it is spelt in messages: --output, or -q if it has no name. */
typedef struct spelling {
  char text[32];
} spelling;
spelling option_spelling(const option *o);

/* The bit of settings.given. */
uint64_t option_bit(const option *o);

/* Was the option of this spelling given? */
bool option_given(const settings *s, const char *word);

#endif
